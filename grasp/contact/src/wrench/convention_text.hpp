#pragma once

#include <string>
#include <string_view>

#include "graspfit/contact/wrench_convention.hpp"

namespace graspfit::contact::internal {

/// A convention in words, with a norm of forces by its name and without the value outside.
std::string describe(const WrenchConvention& convention, std::string_view norm);

}  // namespace graspfit::contact::internal
