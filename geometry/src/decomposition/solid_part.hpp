#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {

/// The plane { p : normal · p = offset }; `normal` is unit.
struct CutPlane {
  Eigen::Vector3d normal;
  double offset = 0.0;

  double height(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
};

/// A closed convex polyhedron as its polygons.
using ConvexCell = std::vector<std::vector<Eigen::Vector3d>>;

/// The part of a solid in a convex cell, given by the piece of the solid's surface in the cell and
/// by the corners of the cell that are inside the solid. The convex hull of both is that of the
/// part.
struct SolidPart {
  std::vector<Eigen::Vector3d> points;  ///< Corners of the polygons.
  std::vector<std::int32_t> corners;    ///< Of all polygons, indices of `points`.
  std::vector<std::int32_t> starts;  ///< Index in `corners` of each polygon's first corner, and the
                                     ///< end.
  std::vector<std::int32_t> faces;   ///< The mesh's face that each polygon is a piece of.
  std::vector<Eigen::Vector3d> inner_corners;  ///< Of the cell, strictly inside the solid.
  ConvexCell cell;

  std::size_t num_polygons() const { return faces.size(); }
  /// The points whose convex hull is the part's.
  std::vector<Eigen::Vector3d> hull_points() const;
};

/// The whole solid; the cell is its box, a little larger.
SolidPart whole_solid(const MeshQuery& solid);

/// The parts below and above the plane. Corners within `on_plane` [m] of the plane count as on it;
/// a polygon in the plane goes to the side where the solid is.
std::pair<SolidPart, SolidPart> cut(const SolidPart& part, const CutPlane& plane, double on_plane,
                                    const MeshQuery& solid);

}  // namespace graspfit::geometry::internal
