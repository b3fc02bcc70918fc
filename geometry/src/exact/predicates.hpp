#pragma once

#include <Eigen/Core>
#include <array>

/// \file
/// Signs of CGAL's kernel of exact predicates (`Exact_predicates_inexact_constructions_kernel`) for
/// points of Eigen. They are right for all finite input.

namespace graspfit::geometry::internal {

/// Sign of det(b − a, c − a, d − a): positive if d is on the side to which the normal of the
/// triangle (a, b, c) points; zero if the four are coplanar.
int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d);

/// Sign of the area of (a, b, c) in the plane of the coordinates `u` and `v`: positive if
/// counter-clockwise with u to the right and v up.
int orientation_2d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   int u, int v);

/// Sign of the cross product of b − a and d − c in the plane of the coordinates `u` and `v`:
/// positive if the second points to the left of the first.
int cross_2d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d, int u, int v);

/// Whether the three points lie on one line.
bool are_collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Whether all corners of the triangle `other` are on one side of the plane of the triangle
/// `plane`, off it; never so of a degenerate `plane`.
bool is_beside(const std::array<Eigen::Vector3d, 3>& plane,
               const std::array<Eigen::Vector3d, 3>& other);

/// Whether `point` lies in the closed triangle (a, b, c), which may be degenerate.
bool is_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Vector area of (a, b, c): the vector along the triangle's normal whose length is the triangle's
/// area, with an error of at most 2^-42 of that length, where it is above 1e-290. Unlike for a
/// cross product in doubles this bound also holds for slivers, which are computed in rationals. The
/// vector is never zero unless the corners are collinear.
Eigen::Vector3d accurate_vector_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c);

}  // namespace graspfit::geometry::internal
