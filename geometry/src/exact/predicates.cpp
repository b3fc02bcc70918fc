#include "exact/predicates.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/exact_number.hpp"

namespace graspfit::geometry::internal {
namespace {

// Half an ulp of 1; the bounds are ccwerrboundA and o3derrboundA of [Shewchuk 1997].
constexpr double kEps = 0x1p-53;
constexpr double kBound2 = (3.0 + 16.0 * kEps) * kEps;
constexpr double kBound3 = (7.0 + 56.0 * kEps) * kEps;

// Below this the products may have lost bits to underflow, which the bounds do not cover.
constexpr double kLeastPermanent = 0x1p-900;

int sign(double value) { return (value > 0.0) - (value < 0.0); }

bool is_certain(double value, double bound, double permanent) {
  return std::abs(value) > bound * permanent && permanent > kLeastPermanent && permanent < 0x1p1000;
}

[[gnu::cold, gnu::noinline]] int exact_orientation(const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& b,
                                                   const Eigen::Vector3d& c,
                                                   const Eigen::Vector3d& d) {
  Rational m[3][3];
  for (int i = 0; i < 3; ++i) {
    m[0][i] = Rational(b[i]) - Rational(a[i]);
    m[1][i] = Rational(c[i]) - Rational(a[i]);
    m[2][i] = Rational(d[i]) - Rational(a[i]);
  }
  return sign_of(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                 m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                 m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

[[gnu::cold, gnu::noinline]] int exact_orientation_2d(const Eigen::Vector3d& a,
                                                      const Eigen::Vector3d& b,
                                                      const Eigen::Vector3d& c, int u, int v) {
  const Rational left = (Rational(a[u]) - Rational(c[u])) * (Rational(b[v]) - Rational(c[v]));
  const Rational right = (Rational(a[v]) - Rational(c[v])) * (Rational(b[u]) - Rational(c[u]));
  return sign_of(left - right);
}

[[gnu::cold, gnu::noinline]] Eigen::Vector3d exact_vector_area(const Eigen::Vector3d& a,
                                                               const Eigen::Vector3d& b,
                                                               const Eigen::Vector3d& c) {
  Rational ab[3];
  Rational ac[3];
  for (int i = 0; i < 3; ++i) {
    ab[i] = Rational(b[i]) - Rational(a[i]);
    ac[i] = Rational(c[i]) - Rational(a[i]);
  }
  Eigen::Vector3d area;
  for (int i = 0; i < 3; ++i) {
    const int u = (i + 1) % 3;
    const int v = (i + 2) % 3;
    const Rational doubled = ab[u] * ac[v] - ab[v] * ac[u];
    area[i] = 0.5 * CGAL::to_double(doubled);
    // Too small for a double is not nothing.
    if (area[i] == 0.0) area[i] = sign_of(doubled) * std::numeric_limits<double>::min();
  }
  return area;
}

bool is_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b) {
  return (point.array() >= a.cwiseMin(b).array()).all() &&
         (point.array() <= a.cwiseMax(b).array()).all() && are_collinear(point, a, b);
}

}  // namespace

int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
  const double adx = b[0] - a[0], ady = b[1] - a[1], adz = b[2] - a[2];
  const double bdx = c[0] - a[0], bdy = c[1] - a[1], bdz = c[2] - a[2];
  const double cdx = d[0] - a[0], cdy = d[1] - a[1], cdz = d[2] - a[2];
  const double bc = bdx * cdy, cb = cdx * bdy;
  const double ca = cdx * ady, ac = adx * cdy;
  const double ab = adx * bdy, ba = bdx * ady;
  const double det = adz * (bc - cb) + bdz * (ca - ac) + cdz * (ab - ba);
  const double permanent = (std::abs(bc) + std::abs(cb)) * std::abs(adz) +
                           (std::abs(ca) + std::abs(ac)) * std::abs(bdz) +
                           (std::abs(ab) + std::abs(ba)) * std::abs(cdz);
  if (is_certain(det, kBound3, permanent)) return sign(det);
  return exact_orientation(a, b, c, d);
}

int orientation_2d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   int u, int v) {
  const double left = (a[u] - c[u]) * (b[v] - c[v]);
  const double right = (a[v] - c[v]) * (b[u] - c[u]);
  const double det = left - right;
  if (is_certain(det, kBound2, std::abs(left) + std::abs(right))) return sign(det);
  return exact_orientation_2d(a, b, c, u, v);
}

int cross_2d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d, int u, int v) {
  const double left = (b[u] - a[u]) * (d[v] - c[v]);
  const double right = (b[v] - a[v]) * (d[u] - c[u]);
  const double value = left - right;
  // Two rounded differences, a product and the last difference, as in the orientation of points.
  if (is_certain(value, kBound2, std::abs(left) + std::abs(right))) return sign(value);
  return sign_of((Rational(b[u]) - Rational(a[u])) * (Rational(d[v]) - Rational(c[v])) -
                 (Rational(b[v]) - Rational(a[v])) * (Rational(d[u]) - Rational(c[u])));
}

bool are_collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return orientation_2d(a, b, c, 0, 1) == 0 && orientation_2d(a, b, c, 1, 2) == 0 &&
         orientation_2d(a, b, c, 2, 0) == 0;
}

Eigen::Vector3d accurate_vector_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d doubled = ab.cross(ac);
  // Each component is off by at most 8 kEps |ab| |ac|, the vector by twice that; compared in
  // squares, all in a range where neither they nor the products above lose bits to underflow.
  constexpr double kLeast = 0x1p-450;
  constexpr double kGreatest = 0x1p450;
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

bool is_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
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
