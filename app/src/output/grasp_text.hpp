#pragma once

#include <string>

#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::app {

/// Epsilon of a grasp for tables that people read; "open" if the grasp is not force closure by more
/// than rounding, whatever value the convention gives then. Not for files.
std::string epsilon_text(const grasp::Grasp& grasp, int decimals);

/// How many grasps of a file are force closure, in words: "all closed", "3 closed".
std::string closed_text(const grasp::GraspFile& file);

/// Of a search by reach with style auto, in words: how many grasps press on the palm or with pads
/// behind fingertips, and what the hand can pinch squarely by fingertips alone. Empty of any other
/// search.
std::string grip_text(const grasp::GraspFile& file);

}  // namespace graspfit::app
