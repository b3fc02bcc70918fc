#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// All pairs (lower, higher) of faces that share a point other than their common corners and edges,
/// ascending. Exact. Corners are common where their coordinates are; faces without area are left
/// out. With `parts`, one number per face, only pairs of faces of different parts.
std::vector<std::pair<std::int32_t, std::int32_t>> crossing_faces(
    const TriangleMesh& mesh, std::span<const std::int32_t> parts = {});

}  // namespace graspfit::geometry::internal
