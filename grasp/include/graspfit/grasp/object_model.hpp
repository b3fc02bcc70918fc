#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "graspfit/geometry/weak_regions.hpp"
#include "graspfit/grasp/contact_score_map.hpp"

namespace graspfit::grasp {

/// Voxels of margin around the object where `ObjectModelOptions::margin` is empty.
///
/// Enough for any hand: beyond the lattice the distance map goes on as a lower bound, so that a
/// hand farther away only takes shorter steps than it could.
inline constexpr int kMarginVoxels = 8;

/// How an object is prepared for planning.
struct ObjectModelOptions {
  int resolution = 30;  ///< Voxels along the object's longest extent, in [4, 512] [P].
  /// Margin of the voxel grid around the object [m], ≥ 0; empty: `kMarginVoxels`, for any hand.
  std::optional<double> margin = {};
  geometry::PatchAveraging averaging = geometry::PatchAveraging::AreaWeighted;  ///< [R]
  ScoreOptions score = {};
  /// Options of the search for weak regions; empty: no search.
  std::optional<geometry::WeakRegionOptions> weak = {};
  base::ContentCache weak_cache = {};  ///< Where weak regions of earlier runs are kept.
  void validate() const;               ///< Throws InvalidInput naming the field and its value.
};

/// Seconds spent in each step of `build_object_model`; what a cache gave took none of them.
struct ObjectModelTimings {
  double query_s = 0.0;
  double patches_s = 0.0;
  double voxels_s = 0.0;
  double distance_s = 0.0;
  double scores_s = 0.0;
  double weak_s = 0.0;
};

/// All that is computed once per object, in the object frame O (the mesh's own frame, in meters);
/// for every hand, seed and option that is not among `ObjectModelOptions`.
struct ObjectModel {
  geometry::MeshQuery query;                    ///< The mesh with its box tree.
  geometry::MassProperties mass;                ///< Center of mass at uniform density.
  double normalizing_radius = 0.0;              ///< `contact::normalizing_radius` of the box [m].
  geometry::VoxelGrid grid;                     ///< The object and a margin around it.
  std::vector<geometry::SurfacePatch> patches;  ///< The paper's S_i.
  std::vector<std::int32_t> patch_of_voxel;     ///< Index into patches, −1 where not partial.
  geometry::SignedDistanceMap distance;
  ContactScoreMap scores;                     ///< Parallel to patches.
  std::optional<geometry::WeakRegions> weak;  ///< Empty: not looked for, nothing is known.
  std::vector<bool> is_weak_patch;  ///< Parallel to patches: at least half of its area is on weak
                                    ///< faces. All false where nothing is known.
  ObjectModelTimings timings;       ///< Never part of results.

  const geometry::TriangleMesh& mesh() const { return query.mesh(); }
  /// Index into patches of the one in a voxel of the lattice, given by index; empty: not partial.
  std::optional<std::int32_t> patch_in(std::int64_t voxel) const {
    const std::int32_t patch = patch_of_voxel[voxel];
    return patch >= 0 ? std::optional(patch) : std::nullopt;
  }
};

/// Contact score at `point_O`, a point on the surface: the score of the patch in the voxel that
/// holds the point. Where rounding put the point into a voxel without surface, the score is that of
/// the patch with the nearest centroid in the 26 voxels around. The result is empty for points
/// farther away.
std::optional<double> contact_score_at(const ObjectModel& object, const Eigen::Vector3d& point_O);

/// Builds the model of a closed outward mesh (`geometry::repair_mesh` makes or refuses one; a mesh
/// with holes is not noticed here and gets wrong classes behind them). @throws InvalidInput for bad
/// options or a mesh without faces, DegenerateGeometry for one without positive volume.
ObjectModel build_object_model(const geometry::TriangleMesh& mesh,
                               const ObjectModelOptions& options);

/// The kind of entry that `cached_object_model` keeps.
inline constexpr std::string_view kObjectModelKind = "object_model";

/// The same model as of `build_object_model`, bit for bit, but for its timings. Patches, classes,
/// distances and scores that were computed before are read from the cache, and new ones are stored
/// there; the box tree and the mass are computed again, and weak regions have entries of their own
/// (`ObjectModelOptions::weak_cache`). Damaged entries are ignored and replaced.
ObjectModel cached_object_model(const geometry::TriangleMesh& mesh,
                                const ObjectModelOptions& options,
                                const base::ContentCache& cache = {});

}  // namespace graspfit::grasp
