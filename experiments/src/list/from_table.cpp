// Question: does the planner pick up what lies on a table: objects at their own sizes, in the poses
// in which they come to rest, per attempt, with each hand, and what is lost?
//
// Answered by one row per object, rest pose and hand: all attempts are made and count, every valid
// grasp is lifted off the table (DexGraspBench's tabletop protocol) and loaded with 1 N from six
// sides. What is asked is that of objects at least 30 mm high and no thicker than the hand spans
// 85 % (Allegro) and 75 % (each other hand) of attempts hold both, and no such object none.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cells/hold_cell.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace from_table_parts {
namespace {

/// The least width of a solid seen from above: of the convex hull of its outline, over all
/// directions across [m].
double least_width(const geometry::TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& vertex : mesh.vertices) seen.emplace_back(vertex.x(), vertex.y(), 0);
  const geometry::ConvexHull3 hull = geometry::convex_hull(seen);
  const std::vector<std::size_t>& corners = hull.vertices;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& start = seen[corners[i]];
    const Eigen::Vector3d along = seen[corners[(i + 1) % corners.size()]] - start;
    double width = 0.0;
    for (const std::size_t j : corners) {
      width = std::max(width, std::abs(along.cross(seen[j] - start).z()) / along.norm());
    }
    least = std::min(least, width);
  }
  return least;
}

void fill(const Planned& planned, sweep::ResultRow& row) {
  const geometry::TriangleMesh& mesh = planned.object_file->mesh;
  row.set("height_m", geometry::bounding_box(mesh).max().z());
  row.set("width_m", least_width(mesh));
  if (const auto& laid = planned.object_file->record.laid) {
    row.set("rest_probability", laid->probability);
  }
  const auto& found = planned.result.statistics.guidance;
  for (const auto& [column, name] : {std::pair("narrowest_pinch_mm", grasp::kNarrowestPinch),
                                     std::pair("widest_pinch_mm", grasp::kWidestPinch)}) {
    const auto count = found.find(std::string(name));
    if (count != found.end()) row.set(column, count->second);
  }
}

}  // namespace
}  // namespace from_table_parts

sweep::Experiment from_table() {
  return hold_experiment(
      "from_table", kTableProtocols,
      {.columns = {{"height_m", "m", "of the object above the table"},
                   {"width_m", "m", "of its outline seen from above, across its narrowest way"},
                   {"rest_probability", "1", "of the rest pose"},
                   {"narrowest_pinch_mm", "mm", "that two fingertips can make squarely"},
                   {"widest_pinch_mm", "mm", "that two fingertips can make squarely"}},
       .fill = from_table_parts::fill});
}

}  // namespace graspfit::experiments::internal
