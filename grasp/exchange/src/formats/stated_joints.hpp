#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "graspfit/exchange/imported_grasps.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::exchange::internal {

/// The joints of a hand as a file states them, NaN where it does not, checked and completed.
/// Positions are in radians or meters.
class StatedJoints {
 public:
  explicit StatedJoints(const hands::HandModel& hand);

  /// The index of the joint of that name; empty if the hand has none.
  std::optional<Eigen::Index> index_of(const std::string& name) const;

  /// "hand H has no such joint; it has a, b, c".
  std::string unknown_text() const;

  /// States a joint. Returns what is wrong, in words: "is 2, outside the joint's 0 to 1".
  std::optional<std::string> state(Eigen::Index joint, double position,
                                   const ImportTolerances& tolerances);

  /// Puts followers that were not stated where their leaders put them. Returns what is wrong, in
  /// words: an independent joint that was not stated, a follower that is not where its leader puts
  /// it.
  std::optional<std::string> complete(const ImportTolerances& tolerances);

  /// All joints, once they are complete.
  const Eigen::VectorXd& q() const { return q_; }

 private:
  const hands::HandModel& hand_;
  Eigen::VectorXd q_;
};

}  // namespace graspfit::exchange::internal
