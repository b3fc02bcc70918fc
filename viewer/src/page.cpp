#include "graspfit/viewer/page.hpp"

#include "graspfit/base/atomic_file.hpp"
#include "page_data.hpp"
#include "page_template.hpp"

namespace graspfit::viewer {

std::string page_html(const PageInput& input) {
  return internal::filled_page({input.title,
                                std::string(internal::kGraspSceneJs).append(internal::kGraspsJs),
                                internal::page_data(input)});
}

void write_page(const std::filesystem::path& file, const PageInput& input) {
  base::write_file_atomically(file, page_html(input));
}

}  // namespace graspfit::viewer
