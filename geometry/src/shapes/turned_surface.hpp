#pragma once

#include <utility>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Cosine and sine of i/n of a turn, exact at the quarters.
std::pair<double, double> turn(int i, int n);

/// A corner of a profile: a point (radius, z), the radius of its rounding, and the name of the
/// dimension that sets this radius.
struct ProfileCorner {
  Eigen::Vector2d point;
  double rounding = 0.0;
  const char* field = "";
};

/// Points along the polygon with its corners rounded by arcs: lines cut into edges of at most
/// `edge_length`, arcs also into at least eight edges a half turn. The first and the last corner
/// are the ends of the profile and are not rounded.
/// @throws InvalidInput naming `shape` and the field of a rounding that does not fit, and for a
/// side of more than 2^13 edges.
std::vector<Eigen::Vector2d> rounded_profile(const char* shape,
                                             const std::vector<ProfileCorner>& corners,
                                             double edge_length);

/// The profile (radius, z) turned around z. It starts and ends on the axis and runs so that the
/// solid lies to its left (the axis upward: outside up, inside down). Rings have `segments`
/// vertices; where these would crowd near the axis, rings have half as many, a quarter and so on,
/// as long as that number is whole and at least six.
TriangleMesh turned_surface(const std::vector<Eigen::Vector2d>& profile, int segments,
                            double edge_length);

}  // namespace graspfit::geometry::internal
