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
  double left_out = 0.0;     ///< No point is farther from the hull [m].

  /// > 0 outside: the largest distance to a face's plane.
  double height(const Eigen::Vector3d& point) const {
    return (normals.transpose() * point - offsets).maxCoeff();
  }
};

/// How closely a hull is followed.
struct PieceHullOptions {
  double tolerance = 0.0;    ///< Points no farther than this outside may be left out [m].
  int max_vertices = 64;     ///< At least 8; the farthest points come first.
  double least_width = 0.0;  ///< Thinner hulls are none [m].
};

/// Empty for points that span no volume, or a thinner one than wanted.
std::optional<PieceHull> piece_hull(const std::vector<Eigen::Vector3d>& points,
                                    const PieceHullOptions& options);

}  // namespace graspfit::geometry::internal
