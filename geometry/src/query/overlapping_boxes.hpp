#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// A cheap first test of a mesh of several parts: whether the boxes of any two parts overlap.

namespace graspfit::geometry::internal {

/// Box of the faces of every part. Exact.
inline std::vector<Eigen::AlignedBox3d> boxes_of_parts(const TriangleMesh& mesh,
                                                       const std::vector<std::int32_t>& parts,
                                                       std::size_t num_parts) {
  std::vector<Eigen::AlignedBox3d> boxes(num_parts);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face]) {
      boxes[parts[face]].extend(mesh.vertices[vertex]);
    }
  }
  return boxes;
}

/// Whether any two of the closed boxes share a point.
inline bool do_boxes_overlap(const std::vector<Eigen::AlignedBox3d>& boxes) {
  std::vector<std::size_t> by_start(boxes.size());
  std::iota(by_start.begin(), by_start.end(), 0);
  std::sort(by_start.begin(), by_start.end(),
            [&](std::size_t a, std::size_t b) { return boxes[a].min()[0] < boxes[b].min()[0]; });
  for (std::size_t i = 0; i < by_start.size(); ++i) {
    const Eigen::AlignedBox3d& box = boxes[by_start[i]];
    for (std::size_t j = i + 1; j < by_start.size(); ++j) {
      const Eigen::AlignedBox3d& other = boxes[by_start[j]];
      if (other.min()[0] > box.max()[0]) break;
      if (box.intersects(other)) return true;
    }
  }
  return false;
}

}  // namespace graspfit::geometry::internal
