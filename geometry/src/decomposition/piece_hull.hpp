#pragma once

#include <optional>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Convex hull of points, with few vertices.
struct PieceHull {
  TriangleMesh mesh;         ///< Closed, outward, convex; every vertex one of the points.
  Eigen::Matrix3Xd normals;  ///< Outward unit normal of each face.
  Eigen::VectorXd offsets;   ///< A point of the hull has normal · point ≤ offset.
  double left_out = 0.0;     ///< To rounding no point is farther from the hull [m].

  /// Largest signed distance of `point` from the plane of a face [m], > 0 outside.
  double height(const Eigen::Vector3d& point) const {
    return (normals.transpose() * point - offsets).maxCoeff();
  }
};

/// How closely a `PieceHull` follows the convex hull of the points.
struct PieceHullOptions {
  double tolerance = 0.0;    ///< Points no farther than this outside may be left out [m].
  int max_vertices = 64;     ///< Most vertices, at least 8; the points farthest outside are added
                             ///< first.
  double least_width = 0.0;  ///< No hull thinner than this is returned [m].
};

/// The convex hull of points with few vertices; empty if the points span no volume, or if the hull
/// is thinner than least_width.
std::optional<PieceHull> piece_hull(const std::vector<Eigen::Vector3d>& points,
                                    const PieceHullOptions& options);

}  // namespace graspfit::geometry::internal
