#pragma once

#include <string>

#include "graspfit/grasp/grasp.hpp"

namespace graspfit::app {

/// Epsilon of a grasp for tables that people read; "open" if the grasp is not force closure by more
/// than rounding, whatever value the convention gives then. Not for files.
std::string epsilon_text(const grasp::Grasp& grasp, int decimals);

}  // namespace graspfit::app
