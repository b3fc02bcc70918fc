#pragma once

#include <utility>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Cosine and sine of i/n of a turn, exact at the quarters.
std::pair<double, double> turn(int i, int n);

/// A corner of a profile: a point (radius, z), how it is rounded, and the dimension that says so.
struct ProfileCorner {
  Eigen::Vector2d point;
  double rounding = 0.0;
  const char* field = "";
};

/// Points along the polygon with its corners rounded by arcs: lines cut into edges of at most
/// `edge_length`, arcs also into at least eight edges a half turn. First and last corner are ends.
/// @throws InvalidInput naming `shape` and the field of a rounding that does not fit, and for a
/// side of more than 2^13 edges.
std::vector<Eigen::Vector2d> rounded_profile(const char* shape,
                                             const std::vector<ProfileCorner>& corners,
                                             double edge_length);

/// The profile (radius, z) turned around z. It starts and ends on the axis and runs so that the
/// solid lies to its left (the axis upward: outside up, inside down). Rings have `segments`
/// vertices; where these would crowd near the axis, half, a quarter and so on, as long as that
/// divides and leaves six.
TriangleMesh turned_surface(const std::vector<Eigen::Vector2d>& profile, int segments,
                            double edge_length);

}  // namespace graspfit::geometry::internal
