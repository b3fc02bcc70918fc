#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_workspace.hpp"

/// \file
/// Distances between two tips of a hand, or between a tip and the palm, over all joint positions.

namespace graspfit::hands::internal {

/// A tip pad's contact point and outward normal, in H; without a pad, the palm's center and
/// direction.
struct Tip {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

/// The hand with its fingers open, and what its tips do when independent joints move.
class SampledHand {
 public:
  explicit SampledHand(const HandModel& model);

  const HandModel& model() const { return model_; }
  /// Joint positions of the open hand, to start from: only independent joints may be changed.
  const Eigen::VectorXd& open() const { return open_; }

  std::vector<RigidTransform> poses(const Eigen::VectorXd& q) const;
  Tip tip(std::optional<int> pad, const std::vector<RigidTransform>& X_HL) const;

  int link_of(std::optional<int> pad) const { return pad ? model_.pads[*pad].link : 0; }

  /// Largest distance that a tip moves per unit of the independent joint `leader`, if the joints in
  /// `standing` do not move: the sum, over `leader` and the joints that follow it, of the tip's
  /// largest distance from the joint, times the joint's ratio.
  double speed(std::optional<int> pad, int leader, const std::vector<int>& standing) const;

 private:
  const HandModel& model_;
  Eigen::VectorXd open_;
  std::vector<Eigen::Vector3d> contact_points_C_;  ///< Per pad, see `pad_contact_point_C`.
};

/// Range of the distances between two tips; an empty pad stands for the palm's center.
DistanceRange tip_distance_range(const SampledHand& hand, std::optional<int> pad_a,
                                 std::optional<int> pad_b, const WorkspaceOptions& options);

using IsClear = std::function<bool(const Eigen::VectorXd& q)>;

/// Whether no link overlaps another by more than `touch_depth` [m]: `HandCollision::overlaps_self`,
/// but the pair of links that overlapped last is tested first, since most that overlap overlap
/// there again. For one thread; `hand` and `collision` must outlive it.
IsClear clear_of_itself(const SampledHand& hand, const HandCollision& collision,
                        double touch_depth);

/// Range of the distances at which two pads face each other; `is_clear` is called for as few
/// configurations as possible.
DistanceRange facing_distance_range(const SampledHand& hand, int pad_a, int pad_b,
                                    const WorkspaceOptions& options, const IsClear& is_clear);

}  // namespace graspfit::hands::internal
