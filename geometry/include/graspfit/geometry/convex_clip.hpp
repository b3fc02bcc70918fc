#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// The closed half-space { p : normal · p ≤ offset }. `normal` need not be unit.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset = 0.0;
};

/// A convex volume as an intersection of half-spaces. Empty and unbounded ones are allowed.
using ConvexVolume = std::vector<HalfSpace>;

/// A piece of a triangle inside a convex volume: a convex polygon in the order of the triangle.
struct ClippedPiece {
  std::vector<Eigen::Vector3d> polygon;  ///< At least three corners [m]; rounded, see `clip`.
  double area = 0.0;                     ///< [m²], > 0.
  Eigen::Vector3d centroid;              ///< Area centroid [m].
  std::int32_t face = -1;                ///< Index of the triangle in its mesh.
};

/// The part of `triangle` inside `volume`; empty if that part has no area, as where the triangle
/// touches the volume only at a point or along an edge.
///
/// Which planes cut which edges, and which pieces are empty, is decided exactly, as by real
/// arithmetic on the given doubles; the coordinates are rounded. A corner is off its exact position
/// by at most 2^-42 of the triangle's longest edge, plus two ulps of the triangle's largest
/// coordinate. The area is off by at most 1e-12 of the triangle's area. The centroid is off by as
/// much as a corner, plus 4e-12 of the longest edge times the ratio of the triangle's area to the
/// piece's; these two up to some 256 corners of the piece. A triangle that lies *in* a bounding
/// plane counts as inside (half-spaces are closed).
/// @throws InvalidInput if a half-space or a corner is not finite.
std::optional<ClippedPiece> clip(const std::array<Eigen::Vector3d, 3>& triangle,
                                 const ConvexVolume& volume);

/// Pieces of the given faces of a mesh inside `volume`, in the order of `faces`, empty ones left
/// out.
/// @throws InvalidInput as the other, or for an index that is no face's or no vertex's.
std::vector<ClippedPiece> clip(const TriangleMesh& mesh, std::span<const std::int32_t> faces,
                               const ConvexVolume& volume);

/// The point of a piece nearest to `point`. Rounded, to the piece's rounded corners.
/// @throws InvalidInput for a piece without corners and a point that is not finite.
Eigen::Vector3d closest_point(const ClippedPiece& piece, const Eigen::Vector3d& point);

}  // namespace graspfit::geometry
