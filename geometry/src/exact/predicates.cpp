#include "exact/predicates.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/exact_number.hpp"

namespace graspfit::geometry::internal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Eigen::Vector3d;

Kernel::Point_3 point_3(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Kernel::Point_2 point_2(const Vector3d& p, int u, int v) { return {p[u], p[v]}; }

[[gnu::cold, gnu::noinline]] Vector3d exact_vector_area(const Vector3d& a, const Vector3d& b,
                                                        const Vector3d& c) {
  Rational ab[3];
  Rational ac[3];
  for (int i = 0; i < 3; ++i) {
    ab[i] = Rational(b[i]) - Rational(a[i]);
    ac[i] = Rational(c[i]) - Rational(a[i]);
  }
  Vector3d area;
  for (int i = 0; i < 3; ++i) {
    const int u = (i + 1) % 3;
    const int v = (i + 2) % 3;
    const Rational doubled = ab[u] * ac[v] - ab[v] * ac[u];
    area[i] = 0.5 * nearest_double(doubled);
    // Too small for a double is not nothing.
    if (area[i] == 0.0) area[i] = sign_of(doubled) * std::numeric_limits<double>::min();
  }
  return area;
}

bool is_on_segment(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  return (point.array() >= a.cwiseMin(b).array()).all() &&
         (point.array() <= a.cwiseMax(b).array()).all() && are_collinear(point, a, b);
}

}  // namespace

int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return static_cast<int>(CGAL::orientation(point_3(a), point_3(b), point_3(c), point_3(d)));
}

int orientation_2d(const Vector3d& a, const Vector3d& b, const Vector3d& c, int u, int v) {
  return static_cast<int>(CGAL::orientation(point_2(a, u, v), point_2(b, u, v), point_2(c, u, v)));
}

int cross_2d(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, int u,
             int v) {
  // A cross product is the scalar product with the second vector turned by a right angle, of whose
  // sign CGAL's predicate makes an angle.
  const Kernel::Point_2 turned_c(c[v], -c[u]);
  const Kernel::Point_2 turned_d(d[v], -d[u]);
  return static_cast<int>(CGAL::angle(point_2(a, u, v), point_2(b, u, v), turned_c, turned_d));
}

bool are_collinear(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return CGAL::collinear(point_3(a), point_3(b), point_3(c));
}

bool is_beside(const std::array<Vector3d, 3>& plane, const std::array<Vector3d, 3>& other) {
  const auto& [a, b, c] = plane;
  const int side = orientation(a, b, c, other[0]);
  return side != 0 && orientation(a, b, c, other[1]) == side &&
         orientation(a, b, c, other[2]) == side;
}

Vector3d accurate_vector_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const Vector3d doubled = ab.cross(ac);
  // Each component is off by at most 8 kEps |ab| |ac|, the vector by twice that; compared in
  // squares, all in a range where neither they nor the products above lose bits to underflow.
  constexpr double kLeast = 0x1p-450;
  constexpr double kGreatest = 0x1p450;
  constexpr double kEps = 0x1p-53;  // Half an ulp of 1.
  constexpr double kSquaredRatio = (0x1p42 * 16.0 * kEps) * (0x1p42 * 16.0 * kEps);
  const double ab_squared = ab.squaredNorm();
  const double ac_squared = ac.squaredNorm();
  const double squared_length = doubled.squaredNorm();
  if (kSquaredRatio * (ab_squared * ac_squared) <= squared_length &&
      std::min(ab_squared, ac_squared) > kLeast && std::max(ab_squared, ac_squared) < kGreatest) {
    return 0.5 * doubled;
  }
  return exact_vector_area(a, b, c);
}

bool is_on_triangle(const Vector3d& point, const Vector3d& a, const Vector3d& b,
                    const Vector3d& c) {
  // In a coordinate plane where the projection of the triangle has area, three signs tell whether
  // the projection of the point is inside; a fourth sign tells whether the point is in the
  // triangle's plane.
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const int around = orientation_2d(a, b, c, u, v);
    if (around == 0) continue;
    return around * orientation_2d(a, b, point, u, v) >= 0 &&
           around * orientation_2d(b, c, point, u, v) >= 0 &&
           around * orientation_2d(c, a, point, u, v) >= 0 && orientation(a, b, c, point) == 0;
  }
  return is_on_segment(point, a, b) || is_on_segment(point, b, c) || is_on_segment(point, c, a);
}

}  // namespace graspfit::geometry::internal
