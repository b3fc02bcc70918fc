#pragma once

#include <string>

#include "graspfit/grasp/grasp.hpp"

namespace graspfit::app {

/// Epsilon of a grasp for tables of people; "open" where its contacts do not close by more
/// than rounding, whatever the convention makes of that. Not for files.
std::string epsilon_text(const grasp::Grasp& grasp, int decimals);

}  // namespace graspfit::app
