#pragma once

#include <optional>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::exchange::internal {

/// A degree of freedom of a GraspIt! robot: each of its joints stands at `ratio` times its value,
/// in radians or millimeters.
struct GraspItDof {
  struct Follower {
    int joint = -1;  ///< Of the hand model.
    double ratio = 1.0;
  };
  bool breaks_away = false;  ///< Its joints stop one by one while it goes on (type "b").
  std::vector<Follower> joints;
};

/// The degrees of freedom of a hand read from a GraspIt! robot XML, in the file's order; empty for
/// other descriptions. @throws IoError if the description can no longer be read or is not the one
/// that the hand was read from.
std::optional<std::vector<GraspItDof>> graspit_dofs(const hands::HandModel& hand);

}  // namespace graspfit::exchange::internal
