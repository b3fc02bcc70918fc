#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace graspfit::geometry::internal {

/// Keeps one vertex for each position, the first one; −0 becomes 0. Returns the new index of each
/// old vertex.
std::vector<std::int32_t> weld_equal(std::vector<Eigen::Vector3d>& vertices);

/// Goes through the vertices in order: a vertex within `distance` (> 0) of kept vertices is merged
/// into the first of these, any other vertex is kept. So no vertex moves by more than `distance`,
/// and chains of close vertices do not collapse into one. Returns the new index of each old vertex.
std::vector<std::int32_t> weld_near(std::vector<Eigen::Vector3d>& vertices, double distance);

}  // namespace graspfit::geometry::internal
