#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "object/surface_places.hpp"

namespace graspfit::grasp::internal {

/// A point that may become a target.
struct PoolPoint {
  Eigen::Vector3d point_O;
  Eigen::Vector3d inward_normal_O;
  /// Index into ObjectModel::patches; empty: the point belongs to no patch.
  std::optional<std::int32_t> patch;
  std::int32_t place = -1;  ///< Of a pool of places, the index of this one.
};

/// The object's patches that the options allow, ascending.
std::vector<PoolPoint> pool_of(const ObjectModel& object, const TargetOptions& options);

/// Those of its places, ascending. Sides of thin walls are allowed whatever their patch scores,
/// whose mean normal means nothing.
std::vector<PoolPoint> pool_of(const ObjectModel& object, const std::vector<SurfacePlace>& places,
                               const TargetOptions& options);

/// A set: indices into `TargetPlaces::pool`, the seed first.
using PointIndices = std::span<const std::int32_t>;

/// Which points may be targets, and measures of sets of them (paper section 6) that do not depend
/// on what the hand can reach. Several threads may use them at once.
class TargetPlaces {
 public:
  /// Refers to the object. @throws InvalidInput for fewer than two fingers or one named twice, more
  /// than `kMostParts` parts, or more fingers than can be pairwise stable, where all must be.
  TargetPlaces(const ObjectModel& object, const RequestedParts& parts, const TargetOptions& options,
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

  /// Distance of the points' centroid from the center of mass over the normalizing radius.
  double centroid_error(PointIndices points) const;
  /// Mean error of all edges but the first; 0 for two. The result does not depend, to the bit, on
  /// the order of the targets after the first two.
  double edge_error(PointIndices fingers) const;
  /// The rank of a set (see `RankedTargets`); `palm_misfit` where it has a palm, the last point.
  double rank(PointIndices points, std::optional<double> palm_misfit) const;

  TargetContacts as_targets(PointIndices points, std::optional<double> palm_misfit,
                            int seeds_tried) const;

 protected:
  const ObjectModel& object() const { return object_; }
  const RequestedParts& parts() const { return parts_; }

 private:
  const ObjectModel& object_;
  const RequestedParts parts_;
  const TargetOptions options_;
  const double min_separation_;  ///< 0 where the options ask for none.
  const contact::StablePairTest stable_pairs_;
  std::vector<PoolPoint> pool_;
};

}  // namespace graspfit::grasp::internal
