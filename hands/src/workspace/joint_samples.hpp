#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/hand_model.hpp"

/// \file
/// Positions of a hand's independent joints: on grids, drawn, or improved step by step.

namespace graspfit::hands::internal {

/// Joints that are moved alike: all to the same share of their ranges. In a group of several the
/// share is counted from the limit that opens the hand, so that mirrored joints close together;
/// of joints that swing, whose ranges are mirror images, from limits of opposite signs.
using JointGroup = std::vector<int>;

/// Moves the joints of a group by a share of their ranges, within their limits.
void move_group(const HandModel& model, const JointGroup& group, double share, Eigen::VectorXd& q);

/// Every joint a group of its own.
std::vector<JointGroup> each_alone(const std::vector<int>& joints);

/// Positions of some independent joints: a grid or, if `per_group` is 0, `count` random positions.
class JointSamples {
 public:
  JointSamples(const HandModel& model, std::vector<JointGroup> groups, int per_group,
               std::int64_t count);

  std::int64_t size() const { return size_; }

  /// Sets the joints of the groups to the positions of a sample.
  void set(std::int64_t sample, Eigen::VectorXd& q) const;

 private:
  const HandModel& model_;
  std::vector<JointGroup> groups_;
  int per_group_;
  std::int64_t size_;
};

/// The independent joints that move one part of the hand relative to another: those that move both,
/// and those that move only the one or only the other. Also the joints that carry both alike.
struct PairJoints {
  std::vector<int> shared, only_a, only_b, all;
  /// Joints, coupled ones too, from the root to where the chains of the two links part.
  std::vector<int> carrying;
};

PairJoints joints_of_pair(const HandModel& model, int link_a, int link_b);

/// Positions of all joints, and their value to a search for the largest one.
struct ValuedPositions {
  double value = -std::numeric_limits<double>::infinity();
  Eigen::VectorXd q;
};

/// Steps of a local search.
struct SearchSteps {
  double first_share;  ///< The first step, as a share of the joints' ranges, > 0.
  double finest;       ///< The search ends at steps of this share of the first one, > 0.
  int num_drawn;       ///< Number of random steps in all groups at once, per round, ≥ 0.
};

/// Local search: improves positions of `groups` as long as their value grows, by steps in one group
/// at a time, then by random steps in all groups at once (at the border of the allowed positions,
/// steps in one group may not help), larger steps first. `value(q, best)` is empty where q is not
/// allowed or not better than `best`. Deterministic; ends near a local best, which it returns.
template <class Value>
ValuedPositions move_on(const HandModel& model, const std::vector<JointGroup>& groups,
                        const SearchSteps& steps, ValuedPositions start, const Value& value) {
  constexpr int kMostRounds = 2000;
  base::Random random(0);
  ValuedPositions best = std::move(start);
  const auto takes = [&](const Eigen::VectorXd& trial) {
    if (trial == best.q) return false;
    const std::optional<double> found = value(trial, best.value);
    if (!found) return false;
    best = {*found, trial};
    return true;
  };
  int rounds = 0;
  for (double share = steps.first_share;
       share > steps.first_share * steps.finest && rounds < kMostRounds; ++rounds) {
    bool is_better = false;
    for (const JointGroup& group : groups) {
      for (const double sign : {1.0, -1.0}) {
        Eigen::VectorXd trial = best.q;
        move_group(model, group, sign * share, trial);
        if (!takes(trial)) continue;
        is_better = true;
        break;
      }
    }
    for (int i = 0; i < steps.num_drawn && !is_better; ++i) {
      Eigen::VectorXd trial = best.q;
      for (const JointGroup& group : groups) {
        move_group(model, group, share * random.uniform(-1.0, 1.0), trial);
      }
      is_better = takes(trial);
    }
    if (!is_better) share /= 2;
  }
  return best;
}

}  // namespace graspfit::hands::internal
