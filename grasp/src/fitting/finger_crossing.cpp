#include "fitting/finger_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {

using geometry::RigidTransform;
using hands::HandConfiguration;
using hands::HandModel;

namespace {

// Steps over the range of a swing joint: more steps find narrower free ranges, at the cost of
// intersection tests of the finger's links at each.
constexpr int kJointTurns = 16;

/// Pairs of links, one of each list, that meet.
int num_meeting(const FittingHand& hand, const std::vector<int>& links,
                const std::vector<int>& others, const std::vector<RigidTransform>& X_OL) {
  int count = 0;
  for (const int a : links) {
    for (const int b : others) {
      if (a == b || hand.model().is_excluded(a, b)) continue;
      count += do_links_meet(hand, a, b, geometry::relative_pose(X_OL[a], X_OL[b])) ? 1 : 0;
    }
  }
  return count;
}

/// The position of the swing joint, of those tried, in which the fewest of the finger's links meet
/// the others; of several such positions the one nearest to the current one.
double position_apart(const FittingHand& hand, const hands::Finger& finger,
                      const std::vector<int>& others, HandConfiguration goal) {
  const int index = *finger.swing_joint;
  const hands::Joint& joint = hand.model().joints[index];
  const double now = goal.q[index];
  std::vector<double> positions = {now};
  for (int turn = 0; turn <= kJointTurns; ++turn) {
    positions.push_back(joint.lower + (joint.upper - joint.lower) * turn / kJointTurns);
  }
  std::stable_sort(positions.begin(), positions.end(),
                   [&](double a, double b) { return std::abs(a - now) < std::abs(b - now); });
  double best = now;
  int fewest = std::numeric_limits<int>::max();
  for (const double position : positions) {
    goal.q[index] = position;
    const HandConfiguration open = opened_from(hand.model(), goal);
    const int count =
        num_meeting(hand, finger.links, others, hands::forward_kinematics(hand.model(), open));
    if (count < fewest) {
      fewest = count;
      best = position;
    }
    if (count == 0) break;
  }
  return best;
}

}  // namespace

bool do_links_meet(const FittingHand& hand, int link_a, int link_b, const RigidTransform& X_AB) {
  const auto& a = hand.collision().link_solid(link_a);
  const auto& b = hand.collision().link_solid(link_b);
  if (!a || !b) return false;
  const double apart = (X_AB * b->box().center() - a->box().center()).norm();
  // Balls that are apart by more than their numbers can be off.
  const double reach = 0.5 * (a->box().diagonal().norm() + b->box().diagonal().norm());
  if (apart > (1.0 + 1e-9) * reach) return false;
  return geometry::do_intersect(*a, *b, X_AB);
}

HandConfiguration opened_from(const HandModel& hand, const HandConfiguration& goal) {
  HandConfiguration start = goal;
  const HandConfiguration open = hands::open_configuration(hand);
  for (std::size_t joint = 0; joint < hand.joints.size(); ++joint) {
    if (hand.joints[joint].closing_sign != 0) {
      start.q[joint] = open.q[joint];
    }
  }
  hands::apply_couplings(hand, start.q);
  return start;
}

bool do_fingers_cross(const FittingHand& hand, const HandConfiguration& goal) {
  const HandModel& model = hand.model();
  const auto X_OL = hands::forward_kinematics(model, opened_from(model, goal));
  const auto num_links = base::as_index<int>(model.links.size());
  for (int a = 0; a < num_links; ++a) {
    for (int b = a + 1; b < num_links; ++b) {
      if (model.is_excluded(a, b)) continue;
      if (do_links_meet(hand, a, b, geometry::relative_pose(X_OL[a], X_OL[b]))) return true;
    }
  }
  return false;
}

HandConfiguration with_fingers_apart(const FittingHand& hand, const TargetContacts& targets,
                                     HandConfiguration goal) {
  const HandModel& model = hand.model();
  std::vector<bool> has_target(model.fingers.size(), false);
  for (const TargetContact& target : targets.contacts) {
    if (target.finger) has_target[*target.finger] = true;
  }
  std::vector<int> placed, free;
  for (int f = 0; f < std::ssize(model.fingers); ++f) {
    const bool is_free = !has_target[f] && model.fingers[f].swing_joint &&
                         !model.joints[*model.fingers[f].swing_joint].coupling;
    (is_free ? free : placed).push_back(f);
  }
  const auto X_OL = hands::forward_kinematics(model, goal);
  const auto base = [&](int finger) -> Eigen::Vector3d {
    return X_OL[model.fingers[finger].links.front()].translation();
  };
  std::vector<int> others;
  for (const int finger : placed) {
    const std::vector<int>& links = model.fingers[finger].links;
    others.insert(others.end(), links.begin(), links.end());
  }
  while (!free.empty()) {
    const auto distance = [&](int finger) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const int other : placed)
        nearest = std::min(nearest, (base(finger) - base(other)).norm());
      return nearest;
    };
    const auto next = std::min_element(free.begin(), free.end(),
                                       [&](int a, int b) { return distance(a) < distance(b); });
    const hands::Finger& finger = model.fingers[*next];
    goal.q[*finger.swing_joint] = position_apart(hand, finger, others, goal);
    hands::apply_couplings(model, goal.q);
    others.insert(others.end(), finger.links.begin(), finger.links.end());
    placed.push_back(*next);
    free.erase(next);
  }
  return goal;
}

HandConfiguration fitting_goal(const FittingHand& hand, const TargetContacts& targets,
                               const TargetPosture& posture, const FittingOptions& options) {
  if (!options.guard_self) return posture.configuration;
  return with_fingers_apart(hand, targets, posture.configuration);
}

}  // namespace graspfit::grasp::internal
