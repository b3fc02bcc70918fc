#include "graspfit/grasp/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "scene/distance_up_to.hpp"
#include "scene/infinity.hpp"

namespace graspfit::grasp {

using base::InvalidInput;
using Eigen::Vector3d;
using hands::RigidTransform;

namespace {

/// Corners of the convex hull of what the faces of a mesh use, exact.
std::vector<Vector3d> hull_corners(const geometry::TriangleMesh& mesh) {
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const geometry::Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) is_used[vertex] = true;
  }
  std::vector<Vector3d> used;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i]) used.push_back(mesh.vertices[i]);
  }
  std::vector<Vector3d> corners;
  for (const std::size_t i : geometry::convex_hull(used).vertices) corners.push_back(used[i]);
  return corners;
}

}  // namespace

void Surroundings::validate() const {
  if (table_z_O) {
    base::require(std::isfinite(*table_z_O), "surroundings", "table_z_O", *table_z_O, "finite [m]");
  }
  base::require(table_clearance >= 0.0 && std::isfinite(table_clearance), "surroundings",
                "table_clearance", table_clearance, "finite and >= 0 [m]");
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::string which = "surroundings: obstacle " + std::to_string(i);
    const geometry::TriangleMesh& mesh = obstacles[i].mesh();
    for (const Vector3d& vertex : mesh.vertices) {
      if (!vertex.allFinite()) throw InvalidInput(which + ": a vertex is not finite");
    }
    const geometry::MeshAnalysis analysis = geometry::analyze(mesh);
    if (!analysis.is_closed) {
      throw InvalidInput(which + " is not closed (" + std::to_string(analysis.num_boundary_edges) +
                         " boundary edges, " + std::to_string(analysis.num_nonmanifold_edges) +
                         " edges with more than two faces, " +
                         std::to_string(analysis.num_inconsistent_edges) +
                         " between faces turned against each other): repair its mesh first");
    }
  }
}

SurroundingsCollision::SurroundingsCollision(const hands::HandModel& hand,
                                             Surroundings surroundings)
    : surroundings_(std::move(surroundings)) {
  surroundings_.validate();
  if (!surroundings_.table_z_O) return;
  for (const hands::Link& link : hand.links) {
    corners_L_.push_back(hull_corners(link.mesh_L));
    Eigen::AlignedBox3d box;
    for (const Vector3d& corner : corners_L_.back()) box.extend(corner);
    boxes_L_.push_back(box);
  }
}

std::optional<SurroundingsCollision::OverTable> SurroundingsCollision::over_table(
    int link, const RigidTransform& X_OL, double enough) const {
  if (!surroundings_.table_z_O) return std::nullopt;
  const auto& corners = corners_L_.at(link);
  if (corners.empty()) return std::nullopt;
  const double table = *surroundings_.table_z_O + surroundings_.table_clearance;
  const Eigen::AlignedBox3d& box = boxes_L_[link];
  if (!X_OL.matrix().allFinite()) {
    throw InvalidInput("SurroundingsCollision: the pose of a link is not finite");
  }
  const double box_height = (X_OL * box.center()).z() -
                            X_OL.linear().row(2).cwiseAbs().dot(0.5 * box.sizes().transpose()) -
                            table;
  if (box_height > enough + internal::kBoxSlack) return std::nullopt;
  Vector3d lowest(0.0, 0.0, internal::kInfinity);
  for (const Vector3d& corner : corners) {
    const Vector3d corner_O = X_OL * corner;
    if (corner_O.z() < lowest.z()) lowest = corner_O;
  }
  return OverTable{lowest.z() - table, lowest};
}

bool SurroundingsCollision::touches(const hands::HandCollision& collision, int link,
                                    const RigidTransform& X_OL) const {
  const std::optional<OverTable> lowest = over_table(link, X_OL, 0.0);
  if (lowest && lowest->height <= 0.0) return true;
  for (const geometry::MeshQuery& obstacle : surroundings_.obstacles) {
    if (collision.link_intersects(obstacle, link, X_OL)) return true;
  }
  return false;
}

SurroundingsDistance SurroundingsCollision::distance(const hands::HandCollision& collision,
                                                     int link, const RigidTransform& X_OL,
                                                     double enough) const {
  SurroundingsDistance nearest{internal::kInfinity, Vector3d::Zero(), Vector3d::UnitZ()};
  const std::optional<OverTable> lowest = over_table(link, X_OL, enough);
  if (lowest && lowest->height <= enough) {
    nearest = {std::max(0.0, lowest->height), lowest->corner_O, Vector3d::UnitZ()};
  }
  const auto& solid = collision.link_solid(link);
  if (!solid) return nearest;
  for (const geometry::MeshQuery& obstacle : surroundings_.obstacles) {
    const geometry::MeshDistance found =
        internal::distance_up_to(obstacle, *solid, X_OL, std::min(enough, nearest.distance));
    if (found.distance >= nearest.distance) continue;
    const Vector3d way = found.point_on_b_A - found.point_on_a_A;
    nearest = {found.distance, found.point_on_b_A,
               found.distance > 0.0 ? Vector3d(way / found.distance) : Vector3d::UnitZ()};
  }
  return nearest;
}

}  // namespace graspfit::grasp
