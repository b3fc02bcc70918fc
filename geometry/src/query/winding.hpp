#pragma once

#include <array>

#include "exact/predicates.hpp"
#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {

/// Counts the crossings of the ray from `point` along +x with the triangles given to `add`,
/// exactly.
///
/// Rays through edges and vertices are resolved by symbolic perturbation: the ray counts as moved
/// by (ε, ε²) in (y, z) for an infinitesimal ε, so that it meets every closed surface in the
/// interior of triangles only; a point that is not on the surface stays on the same side of it.
class Winding {
 public:
  explicit Winding(const Eigen::Vector3d& point) : point_(point) {}

  /// Whether the ray can meet something in this box; the answer "no" is exact.
  bool may_meet(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) const {
    return point_[0] <= upper[0] && lower[1] <= point_[1] && point_[1] <= upper[1] &&
           lower[2] <= point_[2] && point_[2] <= upper[2];
  }

  void add(const std::array<Eigen::Vector3d, 3>& corners) {
    const auto& [a, b, c] = corners;
    const Eigen::Vector3d lower = a.cwiseMin(b).cwiseMin(c);
    if (!may_meet(lower, a.cwiseMax(b).cwiseMax(c))) return;
    if (lower[0] <= point_[0] && is_on_triangle(point_, a, b, c)) is_on_surface_ = true;
    const int around = turn(a, b);
    if (around == 0 || turn(b, c) != around || turn(c, a) != around) return;
    // Seen along the ray the triangle holds the ray's start; the triangle is ahead if the start is
    // behind its plane.
    if (lower[0] > point_[0] || around * orientation(a, b, c, point_) < 0) number_ += around;
  }

  /// Any winding number but zero is inside: parts that overlap are united, and a part turned inward
  /// within an outward one is a cavity.
  Containment result() const {
    if (is_on_surface_) return Containment::OnSurface;
    return number_ != 0 ? Containment::Inside : Containment::Outside;
  }
  bool is_on_surface() const { return is_on_surface_; }
  int number() const { return number_; }

 private:
  // On which side of the line from u to v the moved point is, in the (y, z) plane: the sign of the
  // first that is not zero of the orientation, its derivative by y and its derivative by z.
  int turn(const Eigen::Vector3d& u, const Eigen::Vector3d& v) const {
    const int side = orientation_2d(u, v, point_, 1, 2);
    if (side != 0) return side;
    if (u[2] != v[2]) return u[2] > v[2] ? 1 : -1;
    if (u[1] != v[1]) return v[1] > u[1] ? 1 : -1;
    return 0;
  }

  Eigen::Vector3d point_;
  int number_ = 0;
  bool is_on_surface_ = false;
};

/// The winding of a closed mesh's surface around a point.
Winding winding_around(const MeshQuery& query, const Eigen::Vector3d& point);

}  // namespace graspfit::geometry::internal
