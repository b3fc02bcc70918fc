#pragma once

#include <string>

#include "graspfit/viewer/page.hpp"

namespace graspfit::viewer::internal {

// All that the page shows, as JSON. Large arrays are base64 of little-endian numbers. The text
// contains no "</", so that it can stand in a script element.
std::string page_data(const PageInput& input);

}  // namespace graspfit::viewer::internal
