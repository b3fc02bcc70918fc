#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// The vertices that belong to a face, in their order in the mesh: those of its surface. Others are
/// no part of the solid, wherever they are. Exact.
/// @throws InvalidInput if a face has an index that is no vertex's.
std::vector<Eigen::Vector3d> used_vertices(const TriangleMesh& mesh);

}  // namespace graspfit::geometry
