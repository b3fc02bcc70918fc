#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/grasp/target_contacts.hpp"
#include "targets/reachable_turns.hpp"
#include "targets/target_places.hpp"

namespace graspfit::grasp::internal {

/// One assignment of targets to fingers: for each target the position of its finger in
/// `RequestedParts::fingers`; the seed's, 0, comes first.
using FingerOrder = std::array<std::int8_t, kMostParts>;

/// Which targets form a feasible set (paper section 6): the same rules for every search for targets
/// that the hand may meet.
class TargetRules : public TargetPlaces {
 public:
  /// Refers to the object and the distances. @throws InvalidInput as `TargetSelector`.
  TargetRules(const ObjectModel& object, const PartDistances& distances,
              const RequestedParts& parts, const TargetOptions& options);
  /// The same with `pool` in place of the object's patches.
  TargetRules(const ObjectModel& object, const PartDistances& distances,
              const RequestedParts& parts, const TargetOptions& options,
              std::vector<PoolPoint> pool);

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

  /// Mean distance of the fingers' targets from the points that their tips reach while the palm is
  /// at `palm`, in normalizing radii, for the best turn and assignment; empty if `palm` cannot be
  /// the palm's target.
  std::optional<double> palm_misfit(PointIndices fingers, const std::vector<FingerOrder>& orders,
                                    std::int32_t palm) const;

 private:
  bool reaches(int order_a, int order_b, double distance) const;
  bool can_take(const FingerOrder& order, std::size_t size, int finger,
                std::span<const double> distances) const;
  bool has_palm_space(std::int32_t palm) const;
  std::optional<double> tip_misfit(PointIndices fingers, const std::vector<FingerOrder>& orders,
                                   const PoolPoint& palm) const;

  const PartDistances& distances_;
  enum class PalmSpace : signed char { Unknown, Free, Taken };
  /// Per point: whether the space before it is free for the palm.
  mutable std::vector<std::atomic<PalmSpace>> palm_space_;
  std::vector<Eigen::Matrix3d> turns_H_;  ///< About the palm's direction.
  std::optional<PalmAxes> palm_axes_;
  std::vector<std::optional<ReachableTurns>> reachable_turns_;  ///< Per finger of the hand.
};

}  // namespace graspfit::grasp::internal
