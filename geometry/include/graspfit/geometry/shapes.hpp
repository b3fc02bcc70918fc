#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Closed, outward meshes built in code, centered at the origin unless said otherwise. Lengths in
/// meters. All throw InvalidInput for a non-positive size or too few segments.

namespace graspfit::geometry {

/// Sphere with its vertices on the sphere: an icosahedron subdivided `subdivisions` times
/// (20 · 4^s faces), 0 ≤ s ≤ 8.
TriangleMesh ball(double radius, int subdivisions = 4);

/// Axis-aligned box of the given edge lengths, 12 faces.
TriangleMesh box(const Eigen::Vector3d& size);

/// Torus around the z axis: tube of radius `minor_radius` along the circle of radius `major_radius`
/// (> minor). Vertices on the torus.
TriangleMesh torus(double major_radius, double minor_radius, int major_segments = 96,
                   int minor_segments = 48);

/// Cylinder along z with flat caps.
TriangleMesh cylinder(double radius, double height, int segments = 96);

/// Cylinder of length `height` between two half-balls along z; overall length height + 2 radius.
TriangleMesh capsule(double radius, double height, int segments = 48);

/// Solid of revolution around z of the polyline (radius, z) that starts and ends on the axis
/// (radius 0), z descending or ascending; radii in between > 0.
TriangleMesh solid_of_revolution(const std::vector<Eigen::Vector2d>& profile, int segments = 96);

}  // namespace graspfit::geometry
