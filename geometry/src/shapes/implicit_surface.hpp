#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// A solid given by a function of space: negative inside, positive outside.
struct ImplicitSolid {
  std::string name;  ///< For messages.
  std::function<double(const Eigen::Vector3d&)> field;
  double slope_bound = 1.0;  ///< |field(p) − field(q)| ≤ slope_bound · |p − q|.
  Eigen::AlignedBox3d box;   ///< Of the solid, touched by it [m].
  int genus = 0;             ///< Of its surface, which is one part.
  /// Points of the surface that become vertices: where the box is touched, so that the mesh is as
  /// large as the solid.
  std::vector<Eigen::Vector3d> extreme_points;
};

/// Surface of the solid as a closed outward manifold with edges of about `edge_length` [m].
///
/// Surface nets [Gibson 1998]: one vertex per lattice cell that the surface passes, one
/// quadrilateral per lattice edge that it crosses. The net is a manifold, since no face of a cell
/// is left with alternating signs and no cell with two sheets. Then vertices move along the surface
/// towards the middle of their neighbors, and diagonals are flipped to be Delaunay. Vertices lie on
/// the zero level, by bisection, to 1e-12 of the box's longest edge.
/// @throws InvalidInput if the lattice is too coarse for the solid: sheets merge or faces turn
/// over.
TriangleMesh polygonize(const ImplicitSolid& solid, double edge_length);

/// Union of solids with the concave edges between them filled to radius `fillet`. Where at most one
/// solid is nearer than `fillet`, the distance of the union is the least distance of a solid;
/// otherwise it is r − √Σ(r − d_i)² with r = fillet over the n distances d_i < r, a function whose
/// slope is at most √n.
class FilletedUnion {
 public:
  explicit FilletedUnion(double fillet) : fillet_(fillet) {}

  void add(double distance) {
    const double inside = std::max(fillet_ - distance, 0.0);
    sum_ += inside * inside;
    least_ = std::min(least_, distance);
  }

  /// Whether a solid at least `distance` away would change nothing.
  bool is_indifferent_to(double distance) const {
    return distance >= fillet_ && distance >= least_;
  }

  double distance() const { return sum_ > 0.0 ? fillet_ - std::sqrt(sum_) : least_; }

 private:
  double fillet_;
  double sum_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
};

/// Distance of the intersection of two solids with distances `a` and `b`, with the convex edge
/// between them rounded to radius `rounding`.
double rounded_intersection(double a, double b, double rounding);

}  // namespace graspfit::geometry::internal
