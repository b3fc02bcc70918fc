#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "targets/reachable_turns.hpp"

namespace graspfit::grasp::internal {

/// A point that may become a target.
struct PoolPoint {
  Eigen::Vector3d point_O;
  Eigen::Vector3d inward_normal_O;
  /// Index into ObjectModel::patches; empty: the point belongs to no patch.
  std::optional<std::int32_t> patch;
};

/// One assignment of targets to fingers: for each target the position of its finger in
/// `RequestedParts::fingers`; the seed's, 0, comes first.
using FingerOrder = std::array<std::int8_t, kMostParts>;

/// A set: indices into `TargetRules::pool`, the seed first.
using PointIndices = std::span<const std::int32_t>;

/// Which points may be targets, and which targets form a feasible set (paper section 6): the same
/// rules for every kind of search. Several threads may use them at once.
class TargetRules {
 public:
  /// Refers to the object and the distances. @throws InvalidInput as `TargetSelector`.
  TargetRules(const ObjectModel& object, const PartDistances& distances,
              const RequestedParts& parts, const TargetOptions& options);
  /// The same with `pool` in place of the object's patches.
  TargetRules(const ObjectModel& object, const PartDistances& distances,
              const RequestedParts& parts, const TargetOptions& options,
              std::vector<PoolPoint> pool);

  const TargetOptions& options() const { return options_; }
  /// Whether this distance between targets of different parts is below the separation that they
  /// need.
  bool is_too_near(double distance) const { return distance < min_separation_; }
  /// The points that may be targets; where they are patches, ascending by patch.
  const std::vector<PoolPoint>& pool() const { return pool_; }
  const std::vector<int>& fingers() const { return parts_.fingers; }
  std::size_t num_fingers() const { return parts_.fingers.size(); }
  bool has_palm() const { return parts_.palm; }
  double normalizing_radius() const { return object_.normalizing_radius; }
  const Eigen::Vector3d& center_of_mass_O() const { return object_.mass.center_of_mass; }

  double distance(std::int32_t a, std::int32_t b) const {
    return (pool_[a].point_O - pool_[b].point_O).norm();
  }

  bool is_stable_pair(std::int32_t a, std::int32_t b) const {
    return stable_pairs_(pool_[a].point_O, pool_[a].inward_normal_O, pool_[b].point_O,
                         pool_[b].inward_normal_O);
  }
  /// Mean angle of a stable pair over theta_max.
  double angle_share(std::int32_t a, std::int32_t b) const;
  /// Number of pairs that have to be stable among that many targets.
  static double num_stable_pairs(PairRule rule, std::size_t num_targets);

  /// Whether the tips of the seed's finger and of some other one can be `distance` apart.
  bool is_in_seed_reach(double distance) const;
  /// The only assignment of the seed alone.
  static std::vector<FingerOrder> seed_orders() { return {FingerOrder{}}; }
  /// The assignments that extend those of `orders` by one more target, to a finger that has none
  /// yet; `distances` are the new target's distances from the assigned targets, in order.
  std::vector<FingerOrder> extended(const std::vector<FingerOrder>& orders,
                                    std::span<const double> distances) const;
  bool is_extendable(const std::vector<FingerOrder>& orders,
                     std::span<const double> distances) const;

  /// Distance of the points' centroid from the center of mass over the normalizing radius.
  double centroid_error(PointIndices points) const;
  /// Mean error of all edges but the first; 0 for two. The result does not depend, to the bit, on
  /// the order of the targets after the first two.
  double edge_error(PointIndices fingers) const;
  /// The rank of a set (see `RankedTargets`); `palm_misfit` where it has a palm, the last point.
  double rank(PointIndices points, std::optional<double> palm_misfit) const;

  /// Mean distance of the fingers' targets from the points that their tips reach while the palm is
  /// at `palm`, in normalizing radii, for the best turn and assignment; empty if `palm` cannot be
  /// the palm's target.
  std::optional<double> palm_misfit(PointIndices fingers, const std::vector<FingerOrder>& orders,
                                    std::int32_t palm) const;

  TargetContacts as_targets(PointIndices points, std::optional<double> palm_misfit,
                            int seeds_tried) const;

 private:
  bool reaches(int order_a, int order_b, double distance) const;
  bool can_take(const FingerOrder& order, std::size_t size, int finger,
                std::span<const double> distances) const;
  bool has_palm_space(std::int32_t palm) const;
  std::optional<double> tip_misfit(PointIndices fingers, const std::vector<FingerOrder>& orders,
                                   const PoolPoint& palm) const;

  const ObjectModel& object_;
  const PartDistances& distances_;
  const RequestedParts parts_;
  const TargetOptions options_;
  const double min_separation_;  ///< 0 where the options ask for none.
  const contact::StablePairTest stable_pairs_;
  std::vector<PoolPoint> pool_;
  enum class PalmSpace : signed char { Unknown, Free, Taken };
  /// Per point: whether the space before it is free for the palm.
  mutable std::vector<std::atomic<PalmSpace>> palm_space_;
  std::vector<Eigen::Matrix3d> turns_H_;  ///< About the palm's direction.
  std::optional<PalmAxes> palm_axes_;
  std::vector<std::optional<ReachableTurns>> reachable_turns_;  ///< Per finger of the hand.
};

}  // namespace graspfit::grasp::internal
