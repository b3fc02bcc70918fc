#pragma once

#include "graspfit/viewer/motion_page.hpp"

namespace graspfit::testing {

/// Returns a motion in which the hand of sample_scene.hpp first moves its ball by 0.2 m along x and
/// turns it by a right angle, then moves a block of 40 mm by 0.2 m along y. It is made up by
/// formulas, with every phase, and nothing of it is checked. A third object, a flat box, stays
/// because "it is too flat".
viewer::MotionInput sample_motion();

}  // namespace graspfit::testing
