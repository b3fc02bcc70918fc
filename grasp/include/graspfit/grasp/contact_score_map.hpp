#pragma once

#include <vector>

#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::grasp {

/// How raw scores become comparable with the threshold 0.6: the paper does not say, and
/// nothing else that it leaves open matters as much.
enum class ScoreNormalization {
  /// x = C_d/L + C_a/gamma is floored at 0.05 and inverted; after the mean filter the score is
  /// min(1, score / (1.25 · median)) [R].
  FloorMedian,
  /// Scores are divided by the largest one, and x is floored at 0.05 so that planes do not give
  /// infinity.
  Max,
  Raw,  ///< As the formula stands; unbounded (infinite on planes).
};

/// Signed or unsigned distances to the oriented plane.
enum class PlaneDistance {
  Unsigned,    ///< Mean of |distance|.
  SignedMean,  ///< |mean of signed distance| [R, after the paper's "oriented plane" and its Fig.
               ///< 8].
};

/// Parameters of the contact score map (paper section 5).
struct ScoreOptions {
  int neighborhood = 5;        ///< Edge of the cubic window in voxels, odd, in [3, 63] [P].
  double gamma_deg = 180.0;    ///< Normalizer of the mean normal angle, > 0 [P].
  double length_voxels = 5.0;  ///< L: normalizer of the mean plane distance in voxels, > 0 [R].
  ScoreNormalization normalization = ScoreNormalization::FloorMedian;  ///< [R]
  PlaneDistance plane_distance = PlaneDistance::SignedMean;            ///< [R]
  int mean_filter_radius = 1;   ///< Voxels: 1 is a 3×3×3 window, self included; [0, 31].
  int mean_filter_passes = 1;   ///< In [0, 1000].
  double floor = 0.05;          ///< Smallest C_d/L + C_a/gamma (FloorMedian, Max), > 0.
  double median_factor = 1.25;  ///< Score 1 at this multiple of the median (FloorMedian), > 0.
  void validate() const;        ///< Throws InvalidInput naming the field and its value.
};

/// Suitability of every partial voxel for a contact: [0, 1] for FloorMedian and Max, [0, ∞] for
/// Raw.
struct ContactScoreMap {
  std::vector<double> scores;                 ///< One per patch, in the order of the patches.
  std::vector<double> mean_plane_distance;    ///< C_d [voxels], per patch.
  std::vector<double> mean_normal_angle_deg;  ///< C_a [degrees], per patch.
};

/// The paper's contact score map. Neighbors are all other partial voxels with a normal in the
/// window, connected or not: the far side of a thin part is what marks it as thin. A patch
/// without a normal or without neighbors scores 0, after the mean filter too, and counts as 0 in
/// the mean of others. The median of FloorMedian is taken over the scored ones, after the mean
/// filter.
///
/// Rounded. Reordering the patches or rotating the lattice by 90° permutes the scores up to
/// rounding. Cost: linear in the patches, plus one array over the box of partial voxels.
/// @throws InvalidInput for bad options, or a patch whose voxel is not in the lattice.
ContactScoreMap contact_score_map(const std::vector<geometry::SurfacePatch>& patches,
                                  const geometry::VoxelLattice& lattice,
                                  const ScoreOptions& options = {});

}  // namespace graspfit::grasp
