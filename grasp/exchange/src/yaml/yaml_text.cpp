#include "yaml/yaml_text.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "graspfit/base/number_text.hpp"

namespace graspfit::exchange::internal {

std::string in_quotes(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string yaml_number(double value) {
  std::string text = base::shortest_decimal(value);
  if (text.find('.') == std::string::npos) {
    const std::size_t exponent = text.find('e');
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text;
}

std::string yaml_list(const Eigen::Vector3d& v) {
  return '[' + yaml_number(v.x()) + ", " + yaml_number(v.y()) + ", " + yaml_number(v.z()) + ']';
}

std::string object_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

}  // namespace graspfit::exchange::internal
