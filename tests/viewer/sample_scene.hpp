#pragma once

#include <vector>

#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/viewer/hand_page.hpp"

namespace graspfit::testing {

/// A ball of 40 mm radius around the origin of O and a hand that holds it, built in code: three
/// straight fingers around a palm, each with one joint at its root. At joint position 0 the fingers
/// stand along the palm direction and their pads touch the ball's equator.
struct SampleScene {
  geometry::TriangleMesh object_O;
  hands::HandModel hand;
  /// Grasp #1 is valid (M 0.4), #2 usable but penetrating (M 0.6), #3 has two contacts of three and
  /// M 0. The first has a pre-grasp 30 mm back, a squeeze, and ε 0.1234.
  std::vector<grasp::Grasp> grasps;
  grasp::Surroundings surroundings;  ///< A table at z = -0.12 m and a cube on it, off the hand.
};
SampleScene sample_scene();

/// Returns the same hand by itself, open and closed: joint_2 follows joint_1 by a half plus 0.1,
/// joint_3 follows it alike, but may break away, and slides.
viewer::HandScene sample_hand_scene();

}  // namespace graspfit::testing
