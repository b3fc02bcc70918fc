#include "graspfit/hands/hand_closing.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::hands {

namespace {

/// Independent joints that close together and stop together.
struct Group {
  std::optional<int> finger;  ///< Empty: they belong to none.
  std::vector<int> joints;
};

/// One group per finger that has a closing joint of its own, then one per closing joint of no
/// finger.
std::vector<Group> closing_groups(const HandModel& model) {
  std::vector<bool> is_taken(model.joints.size(), false);
  const auto take = [&](int joint, Group& group) {
    const int moved = leader_of(model, joint);
    if (model.joints[moved].closing_sign == 0) return;
    if (is_taken[moved]) return;
    is_taken[moved] = true;
    group.joints.push_back(moved);
  };
  std::vector<Group> groups;
  for (int f = 0; f < std::ssize(model.fingers); ++f) {
    Group group{f, {}};
    for (const int joint : model.fingers[f].joints) take(joint, group);
    if (!group.joints.empty()) groups.push_back(std::move(group));
  }
  for (int j = 0; j < std::ssize(model.joints); ++j) {
    Group group;
    take(j, group);
    if (!group.joints.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

/// The model, with all pairs of links excluded that touch while the hand is open.
HandModel without_open_overlaps(HandModel model) {
  const auto X_HL = forward_kinematics(model, open_configuration(model));
  for (const auto& [link_a, link_b] : HandCollision(model).overlapping_pairs(X_HL)) {
    model.exclusions.push_back({link_a, link_b});
  }
  return model;
}

struct Closing {
  HandConfiguration configuration;
  std::vector<ClosingStop> stops;
};

Closing closing_of(const HandModel& model, double share) {
  constexpr int kSteps = 64;
  const HandConfiguration open = open_configuration(model);
  const HandConfiguration closed = closed_configuration(model, share);
  const std::vector<Group> groups = closing_groups(model);
  const HandCollision collision(without_open_overlaps(model));

  std::vector<int> steps(groups.size(), 0);
  const auto configuration = [&] {
    HandConfiguration result = open;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double way = static_cast<double>(steps[g]) / kSteps;
      for (const int joint : groups[g].joints) {
        result.q[joint] = (1.0 - way) * open.q[joint] + way * closed.q[joint];
      }
    }
    apply_couplings(model, result.q);
    return result;
  };
  std::vector<ClosingStop> stops;
  std::vector<bool> has_stopped(groups.size(), false);
  for (int step = 1; step <= kSteps; ++step) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (has_stopped[g]) continue;
      steps[g] = step;
      const HandCollision::Result found =
          collision.against_self(forward_kinematics(model, configuration()));
      if (!found.intersects) continue;
      steps[g] = step - 1;
      has_stopped[g] = true;
      stops.push_back(
          {groups[g].finger, static_cast<double>(step - 1) / kSteps, *found.link_a, *found.link_b});
    }
  }
  return {configuration(), std::move(stops)};
}

}  // namespace

HandConfiguration closed_without_overlap(const HandModel& model, double share) {
  return closing_of(model, share).configuration;
}

std::vector<ClosingStop> closing_stops(const HandModel& model, double share) {
  return closing_of(model, share).stops;
}

}  // namespace graspfit::hands
