#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

/// \file
/// Points on the unit sphere at which the measure has known closed forms.

namespace graspfit::testing {

inline double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Returns three points on the equator, `first` and `second` degrees of arc apart.
inline std::vector<Eigen::Vector3d> equator(double first, double second) {
  std::vector<Eigen::Vector3d> directions;
  for (const double angle : {0.0, first, first + second}) {
    directions.emplace_back(std::cos(radians(angle)), std::sin(radians(angle)), 0.0);
  }
  return directions;
}

inline std::vector<Eigen::Vector3d> tetrahedron() {
  const double s = 1 / std::sqrt(3.0);
  return {{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}};
}

inline std::vector<Eigen::Vector3d> octahedron() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

inline std::vector<Eigen::Vector3d> bipyramid() {
  std::vector<Eigen::Vector3d> directions = equator(120, 120);
  directions.emplace_back(0, 0, 1);
  directions.emplace_back(0, 0, -1);
  return directions;
}

}  // namespace graspfit::testing
