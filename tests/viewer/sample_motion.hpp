#pragma once

#include "graspfit/viewer/motion_page.hpp"

namespace graspfit::testing {

/// The hand of sample_scene.hpp moves first its ball by 0.2 m along x and turns it by a
/// right angle, then a block of 40 mm by 0.2 m along y; made up by formulas, with every phase, and
/// nothing of it checked. A third object, a flat box, stays because "it is too flat".
viewer::MotionInput sample_motion();

}  // namespace graspfit::testing
