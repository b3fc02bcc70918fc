#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "geometry/rational_clip.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "voxel/triangle_clip.hpp"

/// \file
/// Asks the shipped cutter where each corner of its polygons comes from. Its polygons are those of
/// `clip` and `clip_by_voxels`, which its users check bit for bit.

namespace graspfit::testing {

/// A cut polygon, each corner with its origin; empty without area.
struct TracedPolygon {
  std::vector<Eigen::Vector3d> corners;
  std::vector<CornerOrigin> origins;
  geometry::internal::CutMeasure measure;
};

/// Cuts triangles as `clip` and `clip_by_voxels` do, by the same `TriangleCutter`.
///
/// The origins are those of real arithmetic. A corner where several planes meet names those that
/// cut there first.
class ClipTracer {
 public:
  TracedPolygon clip(const Triangle& triangle, const geometry::ConvexVolume& volume);

  /// Returns polygons by the index of the voxel. Precondition: the triangle lies in the lattice.
  std::map<std::int64_t, TracedPolygon> clip_by_voxels(const Triangle& triangle,
                                                       const geometry::VoxelLattice& lattice);

  /// Returns the statistics of all that was cut so far.
  const geometry::internal::ClipStatistics& statistics() const { return cutter_.statistics(); }

 private:
  bool begin(const Triangle& triangle);
  TracedPolygon traced(const geometry::internal::CutPolygon& polygon);
  CornerOrigin origin(const geometry::internal::CutEdge& of) const;
  void cut_along(int axis, geometry::internal::CutPolygon rest);

  geometry::internal::TriangleCutter cutter_;
  std::vector<CuttingPlane> planes_;  // These are by the names of their lines, which begin at 3.

  // These are of `clip_by_voxels`: cells of the triangle, the line of the plane above the first of
  // them, the cell at hand and what has been cut.
  std::array<int, 3> first_;
  std::array<int, 3> last_;
  std::array<std::uint32_t, 3> first_line_;
  Eigen::Vector3i voxel_;
  const geometry::VoxelLattice* lattice_ = nullptr;
  std::map<std::int64_t, TracedPolygon> pieces_;
};

}  // namespace graspfit::testing
