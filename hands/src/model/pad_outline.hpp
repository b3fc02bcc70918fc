#pragma once

#include <Eigen/Core>
#include <vector>

/// \file
/// Convex outlines in the plane of a pad, counter-clockwise.

namespace graspfit::hands::internal {

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A line of the outline as unit inward normal n and offset: n · p ≥ offset inside.
struct Side {
  Eigen::Vector2d inward;
  double offset = 0.0;
};

/// The sides of an outline, without edges of length zero.
std::vector<Side> sides(const std::vector<Eigen::Vector2d>& outline);

/// The area of an outline; it is negative if the outline is clockwise.
double area_of(const std::vector<Eigen::Vector2d>& outline);

}  // namespace graspfit::hands::internal
