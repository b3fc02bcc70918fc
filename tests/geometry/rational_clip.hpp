#pragma once

#include <CGAL/Gmpq.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

namespace graspfit::testing {

/// A triangle clipped by closed half-spaces in rational arithmetic, straight from the definition:
/// the oracle of the filtered clipper, with which it shares no code and no idea (points in space
/// here, lines in barycentric coordinates there).
class RationalPolygon {
 public:
  using Number = CGAL::Gmpq;
  using Point = std::array<Number, 3>;

  explicit RationalPolygon(const std::array<Eigen::Vector3d, 3>& triangle) {
    for (const Eigen::Vector3d& p : triangle) {
      corners_.push_back({Number(p[0]), Number(p[1]), Number(p[2])});
    }
    whole_ = vector_area();
  }

  /// Keeps what has normal · p ≤ offset.
  void clip(const std::array<Number, 3>& normal, const Number& offset) {
    std::vector<Point> kept;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Point& p = corners_[i];
      const Point& q = corners_[(i + 1) % corners_.size()];
      const Number fp = dot(normal, p) - offset;
      const Number fq = dot(normal, q) - offset;
      if (fp <= 0) kept.push_back(p);
      if ((fp < 0 && fq > 0) || (fp > 0 && fq < 0)) {
        const Number t = fp / (fp - fq);
        kept.push_back(
            {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
      }
    }
    corners_ = kept;
  }

  void clip(const Eigen::Vector3d& normal, double offset) {
    clip({Number(normal[0]), Number(normal[1]), Number(normal[2])}, Number(offset));
  }

  /// Keeps lower ≤ p[axis] ≤ upper.
  void clip_slab(int axis, double lower, double upper) {
    std::array<Number, 3> normal = {0, 0, 0};
    normal[axis] = 1;
    clip(normal, Number(upper));
    normal[axis] = -1;
    clip(normal, -Number(lower));
  }

  bool has_area() const {
    const Point area = vector_area();
    return area[0] != 0 || area[1] != 0 || area[2] != 0;
  }

  /// Exact part of the triangle's area; the vector areas are parallel.
  Number fraction() const {
    const Point area = vector_area();
    for (int axis = 0; axis < 3; ++axis) {
      if (whole_[axis] != 0) return area[axis] / whole_[axis];
    }
    return 0;
  }

  double area() const {
    const Point doubled = vector_area();
    return 0.5 * std::sqrt(CGAL::to_double(dot(doubled, doubled)));
  }

  /// Whether all of it lies in p[axis] = coordinate.
  bool is_in_plane(int axis, double coordinate) const {
    for (const Point& p : corners_) {
      if (p[axis] != Number(coordinate)) return false;
    }
    return true;
  }

  const std::vector<Point>& corners() const { return corners_; }

 private:
  static Number dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  // Twice the vector area.
  Point vector_area() const {
    Point sum = {0, 0, 0};
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Point& p = corners_[i];
      const Point& q = corners_[(i + 1) % corners_.size()];
      for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        sum[axis] += p[u] * q[v] - p[v] * q[u];
      }
    }
    return sum;
  }

  std::vector<Point> corners_;
  Point whole_;
};

}  // namespace graspfit::testing
