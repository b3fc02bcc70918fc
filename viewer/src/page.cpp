#include "graspfit/viewer/page.hpp"

#include "graspfit/geometry/atomic_file.hpp"
#include "internal/page_data.hpp"
#include "internal/page_template.hpp"

namespace graspfit::viewer {

std::string page_html(const PageInput& input) {
  return filled_page({input.title, std::string(kGraspsJs), page_data(input)});
}

void write_page(const std::filesystem::path& file, const PageInput& input) {
  geometry::write_file_atomically(file, page_html(input));
}

}  // namespace graspfit::viewer
