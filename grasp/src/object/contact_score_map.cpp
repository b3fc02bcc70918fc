#include "graspfit/grasp/contact_score_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "graspfit/base/option_check.hpp"
#include "graspfit/base/units.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using geometry::SurfacePatch;

/// Patches by voxel: a dense array over the box of partial voxels, which is the object alone and
/// not the margin kept around it for the hand.
class PatchLookup {
 public:
  PatchLookup(const std::vector<SurfacePatch>& patches, const geometry::VoxelLattice& lattice) {
    Vector3i highest = Vector3i::Zero();
    for (const SurfacePatch& patch : patches) {
      base::require(patch.voxel >= 0 && patch.voxel < lattice.num_voxels(), "SurfacePatch", "voxel",
                    patch.voxel, "an index of the lattice");
      voxels_.push_back(lattice.voxel(patch.voxel));
      lowest_ = voxels_.size() == 1 ? voxels_.back() : lowest_.cwiseMin(voxels_.back());
      highest = voxels_.size() == 1 ? voxels_.back() : highest.cwiseMax(voxels_.back());
    }
    if (voxels_.empty()) return;
    counts_ = highest - lowest_ + Vector3i::Ones();
    patches_.assign(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2], -1);
    for (std::int32_t i = 0; i < std::ssize(voxels_); ++i) {
      patches_[index(voxels_[i] - lowest_)] = i;
    }
  }

  /// Calls `visit(i, j)` once for every unordered pair of different patches whose voxels lie in
  /// each other's window of `radius` voxels to every side.
  template <typename Visit>
  void for_each_pair(int radius, Visit visit) const {
    for (std::int32_t i = 0; i < std::ssize(voxels_); ++i) {
      const Vector3i center = voxels_[i] - lowest_;
      // The half of the window that follows the center in index order.
      const int last_z = std::min(center[2] + radius, counts_[2] - 1);
      for (int z = center[2]; z <= last_z; ++z) {
        const int first_y = z == center[2] ? center[1] : std::max(center[1] - radius, 0);
        const int last_y = std::min(center[1] + radius, counts_[1] - 1);
        for (int y = first_y; y <= last_y; ++y) {
          const bool is_own_row = z == center[2] && y == center[1];
          const int first_x = is_own_row ? center[0] + 1 : std::max(center[0] - radius, 0);
          const int last_x = std::min(center[0] + radius, counts_[0] - 1);
          const std::int32_t* row = patches_.data() + index({0, y, z});
          for (int x = first_x; x <= last_x; ++x) {
            if (row[x] >= 0) visit(i, row[x]);
          }
        }
      }
    }
  }

 private:
  std::size_t index(const Vector3i& voxel) const {
    return voxel[0] + static_cast<std::size_t>(counts_[0]) *
                          (voxel[1] + static_cast<std::size_t>(counts_[1]) * voxel[2]);
  }

  std::vector<Vector3i> voxels_;  // per patch
  Vector3i lowest_ = Vector3i::Zero();
  Vector3i counts_ = Vector3i::Zero();
  std::vector<std::int32_t> patches_;  // per voxel of the box; −1 where there is none
};

/// Each score replaced by the mean over the partial voxels of the window, itself included.
std::vector<double> mean_filtered(const std::vector<double>& scores, const PatchLookup& lookup,
                                  int radius) {
  std::vector<double> sums = scores;
  std::vector<int> counts(scores.size(), 1);
  lookup.for_each_pair(radius, [&](std::int32_t i, std::int32_t j) {
    sums[i] += scores[j];
    sums[j] += scores[i];
    ++counts[i];
    ++counts[j];
  });
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
  return sums;
}

/// Middle value; mean of the two middle ones for an even count. Zero for none.
double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

}  // namespace

void ScoreOptions::validate() const {
  internal::require_ranges("ScoreOptions", *this, internal::score_rows);
  base::require(neighborhood % 2 == 1, "ScoreOptions", "neighborhood", neighborhood, "odd");
}

ContactScoreMap contact_score_map(const std::vector<SurfacePatch>& patches,
                                  const geometry::VoxelLattice& lattice,
                                  const ScoreOptions& options) {
  options.validate();
  base::require(lattice.voxel_size > 0.0 && std::isfinite(lattice.voxel_size), "VoxelLattice",
                "voxel_size", lattice.voxel_size, "finite and above 0");
  const PatchLookup lookup(patches, lattice);

  // C_d and C_a: means over the other partial voxels of the window. A pair is visited once, because
  // the angle between two normals is the costly part and serves both.
  std::vector<double> distances(patches.size(), 0.0);
  std::vector<double> angles(patches.size(), 0.0);
  std::vector<int> counts(patches.size(), 0);
  lookup.for_each_pair(options.neighborhood / 2, [&](std::int32_t i, std::int32_t j) {
    const SurfacePatch& a = patches[i];
    const SurfacePatch& b = patches[j];
    if (!a.has_normal || !b.has_normal) return;
    const Vector3d a_to_b = b.centroid - a.centroid;
    const double from_a = a.outward_normal.dot(a_to_b);
    const double from_b = -b.outward_normal.dot(a_to_b);
    const bool is_signed = options.plane_distance == PlaneDistance::SignedMean;
    distances[i] += is_signed ? from_a : std::abs(from_a);
    distances[j] += is_signed ? from_b : std::abs(from_b);
    // By tangent: acos would see 1e-8 rad between equal normals, and a plane must be flat.
    const double angle = std::atan2(a.outward_normal.cross(b.outward_normal).norm(),
                                    a.outward_normal.dot(b.outward_normal));
    angles[i] += angle;
    angles[j] += angle;
    ++counts[i];
    ++counts[j];
  });

  ContactScoreMap map;
  map.scores.resize(patches.size());
  map.mean_plane_distance.resize(patches.size());
  map.mean_normal_angle_deg.resize(patches.size());
  std::vector<bool> is_scored(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (counts[i] == 0) continue;
    is_scored[i] = true;
    map.mean_plane_distance[i] = std::abs(distances[i]) / counts[i] / lattice.voxel_size;
    map.mean_normal_angle_deg[i] = angles[i] / counts[i] * base::kDegreesPerRadian;
    double roughness = map.mean_plane_distance[i] / options.length_voxels +
                       map.mean_normal_angle_deg[i] / options.gamma_deg;
    if (options.normalization != ScoreNormalization::Raw) {
      roughness = std::max(roughness, options.floor);
    }
    map.scores[i] = roughness > 0.0 ? 1.0 / roughness : std::numeric_limits<double>::infinity();
  }

  for (int pass = 0; pass < options.mean_filter_passes; ++pass) {
    map.scores = mean_filtered(map.scores, lookup, options.mean_filter_radius);
    // A voxel without a normal drags its neighbors down but gains nothing from them.
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (!is_scored[i]) map.scores[i] = 0.0;
    }
  }

  double full_score = 1.0;
  if (options.normalization == ScoreNormalization::FloorMedian) {
    std::vector<double> scored;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (is_scored[i]) scored.push_back(map.scores[i]);
    }
    full_score = options.median_factor * median(std::move(scored));
  } else if (options.normalization == ScoreNormalization::Max && !map.scores.empty()) {
    full_score = *std::max_element(map.scores.begin(), map.scores.end());
  }
  if (options.normalization != ScoreNormalization::Raw && full_score > 0.0) {
    for (double& score : map.scores) score = std::min(1.0, score / full_score);
  }
  return map;
}

}  // namespace graspfit::grasp
