#include "fitting/idle_fingers.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {
namespace {

/// Whether two configurations differ in nothing but what moves links of `finger` alone.
bool moves_only(const hands::HandModel& hand, int finger, const hands::HandConfiguration& from,
                const hands::HandConfiguration& to) {
  if (from.X_OH.matrix() != to.X_OH.matrix()) return false;
  const std::vector<int>& own = hand.fingers[finger].links;
  for (int joint = 0; joint < std::ssize(hand.joints); ++joint) {
    if (from.q[joint] == to.q[joint]) continue;
    const std::vector<int> moved = hands::links_moved_by(hand, joint);
    const auto is_own = [&](int link) {
      return std::find(own.begin(), own.end(), link) != own.end();
    };
    if (!std::all_of(moved.begin(), moved.end(), is_own)) return false;
  }
  return true;
}

}  // namespace

hands::HandConfiguration with_idle_fingers_closed(const GraspScene& scene,
                                                  const hands::HandConfiguration& grasp,
                                                  const std::vector<int>& used,
                                                  FittingOptions options) {
  const hands::HandModel& hand = scene.hand.model();
  options.guard = PenetrationGuard::Meshes;
  options.guard_self = true;
  options.contact_state = ContactState::Closed;
  options.palm_after_contact = PalmAfterContact::Frozen;
  hands::HandConfiguration configuration = grasp;
  for (int finger = 0; finger < std::ssize(hand.fingers); ++finger) {
    if (std::find(used.begin(), used.end(), finger) != used.end()) continue;
    if (!hand.fingers[finger].tip_pad) continue;
    RequestedParts idle;
    idle.fingers = {finger};
    FittingResult closed = close_hand(scene, GraspStyle::Precision, idle, configuration,
                                      {.most_steps = 0, .closes_in_collision = true}, options);
    if (closed.stop == FittingStop::Contact &&
        moves_only(hand, finger, configuration, closed.configuration)) {
      configuration = std::move(closed.configuration);
    }
  }
  return configuration;
}

}  // namespace graspfit::grasp::internal
