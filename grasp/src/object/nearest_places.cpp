#include "object/nearest_places.hpp"

#include <array>
#include <limits>

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Sweeps of the lattice, forth and back on each axis, in which a voxel takes over the place of a
/// neighbor if that is nearer than its own.
NearestPlaces::NearestPlaces(const ObjectModel& object, const std::vector<SurfacePlace>& places,
                             const std::vector<bool>& is_meant)
    : lattice_(object.grid.lattice),
      last_voxel_((lattice_.counts.array() - 1).cast<double>()),
      places_(places),
      place_of_voxel_(object.patch_of_voxel) {
  for (const SurfacePlace& place : places) {
    const bool is_other_meant = place.other_side >= 0 && is_meant[place.other_side];
    other_side_.push_back(is_other_meant ? place.other_side : -1);
  }
  struct Nearest {
    std::int32_t place = -1;
    float squared = std::numeric_limits<float>::infinity();
  };
  const Vector3i n = lattice_.counts;
  // In the order of the sweeps, in which the third axis is the fastest.
  const std::array<std::int64_t, 3> strides = {std::int64_t{n[1]} * n[2], n[2], 1};
  std::vector<Nearest> nearest(place_of_voxel_.size());
  const auto for_each_voxel = [&](bool is_back, const auto& visit) {
    const auto number = [&](int i, int axis) { return is_back ? n[axis] - 1 - i : i; };
    for (int a = 0; a < n[0]; ++a) {
      for (int b = 0; b < n[1]; ++b) {
        for (int c = 0; c < n[2]; ++c) {
          const Vector3i voxel(number(a, 0), number(b, 1), number(c, 2));
          visit(voxel, voxel[0] * strides[0] + voxel[1] * strides[1] + voxel[2]);
        }
      }
    }
  };
  for_each_voxel(false, [&](const Vector3i& voxel, std::int64_t index) {
    const std::int32_t first = place_of_voxel_[lattice_.index(voxel)];
    if (first < 0) return;
    // A partial voxel keeps its own.
    const std::int32_t own = is_meant[first] ? first : other_side_[first];
    if (own >= 0) nearest[index] = {own, 0.0F};
  });
  const auto visit = [&](const Vector3i& voxel, std::int64_t index) {
    Nearest& own = nearest[index];
    if (own.squared == 0.0F) return;
    const Vector3d center =
        lattice_.origin + lattice_.voxel_size * (voxel.cast<double>().array() + 0.5).matrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        if (voxel[axis] + step < 0 || voxel[axis] + step >= n[axis]) continue;
        const std::int32_t place = nearest[index + step * strides[axis]].place;
        if (place < 0 || place == own.place) continue;
        const auto squared = static_cast<float>((center - places[place].point_O).squaredNorm());
        if (squared < own.squared) own = {place, squared};
      }
    }
  };
  for (int round = 0; round < 2; ++round) {
    for_each_voxel(false, visit);
    for_each_voxel(true, visit);
  }
  for_each_voxel(false, [&](const Vector3i& voxel, std::int64_t index) {
    place_of_voxel_[lattice_.index(voxel)] = nearest[index].place;
  });
}

}  // namespace graspfit::grasp::internal
