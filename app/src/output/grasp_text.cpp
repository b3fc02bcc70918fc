#include "output/grasp_text.hpp"

#include "output/text_table.hpp"

namespace graspfit::app {

std::string epsilon_text(const grasp::Grasp& grasp, int decimals) {
  return grasp.is_closed() ? fixed_decimal(grasp.epsilon(), decimals) : "open";
}

}  // namespace graspfit::app
