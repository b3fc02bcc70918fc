#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace graspfit::geometry {

/// Angle between two vectors [rad], in [0, π], also of nearly parallel ones to rounding; 0 where
/// one of them is zero.
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace graspfit::geometry
