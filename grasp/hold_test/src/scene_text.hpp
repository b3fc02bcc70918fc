#pragma once

#include <string>

#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test::internal {

/// Names in the scene: "link_3", "joint_0" (its actuator and the equality that couples it too),
/// "object", "lift".
std::string link_name(int link);
std::string joint_name(int joint);

/// Returns hand, object and, for protocols that lift, a table as the text of an MJCF model; frame W
/// is O.
///
/// - The hand's root link is a child of the world, or of a body on a vertical slide; its pose is to
///   be set in the compiled model. Every link is a body, every joint a hinge or slide with the
///   hand's limits.
/// - Independent joints have a position actuator; so have followers that may break away. Every
///   follower has an equality constraint with its leader.
/// - Bodies collide by their convex pieces: hand and object, hand and hand except what the model
///   excludes, all with the table.
/// - The object's body frame is at its center of mass with the axes of O.
///
/// Numbers are in shortest round-trip form in the C locale.
std::string scene_text(const HoldHand& hand, const HoldObject& object,
                       const HoldProtocol& protocol);

}  // namespace graspfit::hold_test::internal
