#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry {

/// How the pieces inside one voxel are averaged.
enum class PatchAveraging {
  AreaWeighted,  ///< Pieces count by their area.
  Plain,         ///< Every piece counts alike (the paper's words).
};

/// The paper's S_i: the object's triangles inside one partial voxel, clipped by its six planes.
///
/// Tie rule: each bit of surface of positive area belongs to exactly one voxel. A piece that lies
/// in the plane between two voxels belongs to the one with the higher index on that axis.
struct SurfacePatch {
  std::int64_t voxel = -1;   ///< Index in the lattice.
  double area = 0.0;         ///< [m²], > 0.
  Eigen::Vector3d centroid;  ///< Mean of the pieces' centroids, projected to the nearest point of
                             ///< the patch [m].
  Eigen::Vector3d outward_normal;  ///< Mean of the pieces' normals, unit; zero if !has_normal.
  bool has_normal = false;  ///< False where the mean normal before scaling is shorter than 0.1
                            ///< (both sides of a thin part): never a target.
  std::vector<std::int32_t> faces;  ///< Faces with a piece here, ascending.

  // Both averages, whatever the options; `centroid` and `outward_normal` come from one of them.

  /// Center of area, not projected [m].
  Eigen::Vector3d area_centroid = Eigen::Vector3d::Zero();
  /// Mean of the pieces' outward unit normals weighted by area: the patch's vector area divided by
  /// its area. Its length tells how flat the patch is: 1 for a patch in a plane, 0 for a closed
  /// one.
  Eigen::Vector3d area_weighted_normal = Eigen::Vector3d::Zero();
  /// Mean of the pieces' outward unit normals with equal weights; not scaled to unit length either.
  Eigen::Vector3d plain_normal = Eigen::Vector3d::Zero();
};

/// Options of `surface_patches`.
struct SurfacePatchOptions {
  PatchAveraging averaging = PatchAveraging::AreaWeighted;  ///< Of `centroid`, `outward_normal`.
};

/// All patches of a mesh, one per partial voxel, ascending by voxel index.
///
/// Which triangle has area in which voxel is decided exactly; areas, centroids and normals are
/// rounded (see `clip` for the pieces; sums add an ulp per piece). Degenerate faces have no pieces.
/// Cost: linear in the number of pieces.
/// @throws InvalidInput if the mesh leaves the lattice, a coordinate is not finite or a face has a
/// vertex that is none.
std::vector<SurfacePatch> surface_patches(const TriangleMesh& mesh, const VoxelLattice& lattice,
                                          const SurfacePatchOptions& options = {});

/// Indices of the voxels that have a patch, ascending: where nothing else of the patches is wanted,
/// by the same decisions in less time. @throws InvalidInput as `surface_patches`
std::vector<std::int64_t> surface_voxels(const TriangleMesh& mesh, const VoxelLattice& lattice);

/// A clipped polygon with the voxel that holds it.
struct VoxelPiece {
  std::int64_t voxel = -1;
  ClippedPiece piece;
};

/// The pieces that `surface_patches` averages, ascending by (voxel, face). They are cut by the same
/// code, with the error bounds of `clip`, except that a corner in a voxel plane has that plane's
/// coordinate exactly. By the tie rule of `SurfacePatch` the pieces of a triangle cover it without
/// gap or overlap.
std::vector<VoxelPiece> clip_by_voxels(const TriangleMesh& mesh, const VoxelLattice& lattice);

}  // namespace graspfit::geometry
