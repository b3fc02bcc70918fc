#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/grasp/object_model.hpp"
#include "object/surface_places.hpp"

namespace graspfit::grasp::internal {

/// For every voxel of an object's lattice one of some places: the nearest one, or nearly so; a
/// voxel with such a place has its own. A question costs a look-up, some nanoseconds.
class NearestPlaces {
 public:
  /// Refers to object and places, which are its. Unless some entry of `is_meant`, parallel to
  /// these, is true, nothing may be asked.
  NearestPlaces(const ObjectModel& object, const std::vector<SurfacePlace>& places,
                const std::vector<bool>& is_meant);

  /// Index of the place for the voxel that holds `point_O`, or for the lattice's voxel nearest to
  /// it; either side of a thin wall.
  std::int32_t at(const Eigen::Vector3d& point_O) const {
    const Eigen::Array3d position = (point_O - lattice_.origin).array() * inverse_size_;
    const Eigen::Array3d inside = position.max(0.0).min(last_voxel_);
    return place_of_voxel_[lattice_.index(inside.cast<int>().matrix())];
  }

  /// The other side of a place's wall, if that is meant; −1: none.
  std::int32_t other_side(std::int32_t place) const { return other_side_[place]; }

  /// The place for a point of a pad that presses along `inward_O`: of a thin wall the side on which
  /// the point is, unless it is within about a millimeter of the wall; there the pad's direction
  /// tells.
  std::int32_t at(const Eigen::Vector3d& point_O, const Eigen::Vector3d& inward_O) const {
    const std::int32_t place = at(point_O);
    const std::int32_t other = other_side_[place];
    if (other < 0) return place;
    return fit(places_[other], point_O, inward_O) > fit(places_[place], point_O, inward_O) ? other
                                                                                           : place;
  }

 private:
  static constexpr double kDirectionLever = 0.001;  // of a direction's cosine, beside a height [m]

  static double fit(const SurfacePlace& side, const Eigen::Vector3d& point_O,
                    const Eigen::Vector3d& inward_O) {
    return side.outward_normal_O.dot(point_O - side.point_O - kDirectionLever * inward_O);
  }

  const geometry::VoxelLattice& lattice_;
  const double inverse_size_ = 1.0 / lattice_.voxel_size;
  Eigen::Array3d last_voxel_;
  const std::vector<SurfacePlace>& places_;
  std::vector<std::int32_t> place_of_voxel_;
  std::vector<std::int32_t> other_side_;  ///< Per place; −1 where it is not meant.
};

}  // namespace graspfit::grasp::internal
