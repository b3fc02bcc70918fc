#include "graspfit/hands/hand_collision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "graspfit/geometry/errors.hpp"

namespace graspfit::hands {

namespace {

// Room for rounding [m]: of coordinates of a hand and its object, below 1e-14.
constexpr double kSlack = 1e-9;

/// Box in frame A around a box in frame B: conservative, widened by far more than its own rounding.
Eigen::AlignedBox3d box_around(const Eigen::AlignedBox3d& box_B, const RigidTransform& X_AB) {
  const Eigen::Vector3d center_A = X_AB * box_B.center();
  const Eigen::Vector3d half_A =
      X_AB.linear().cwiseAbs() * (0.5 * box_B.sizes()) + Eigen::Vector3d::Constant(kSlack);
  return {center_A - half_A, center_A + half_A};
}

/// False only if the boxes are apart: neither frame's axes separate them.
bool may_meet(const Eigen::AlignedBox3d& box_A, const Eigen::AlignedBox3d& box_B,
              const RigidTransform& X_AB) {
  return box_A.intersects(box_around(box_B, X_AB)) &&
         box_B.intersects(box_around(box_A, X_AB.inverse()));
}

/// The part of a convex polygon with lower ≤ coordinate ≤ upper along an axis. Corners rounded.
std::vector<Eigen::Vector3d> clipped(const std::vector<Eigen::Vector3d>& polygon, int axis,
                                     double lower, double upper) {
  std::vector<Eigen::Vector3d> kept = polygon;
  for (const auto& [sign, limit] : {std::pair{1.0, upper}, std::pair{-1.0, -lower}}) {
    const std::vector<Eigen::Vector3d> whole = std::move(kept);
    kept.clear();
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const Eigen::Vector3d& a = whole[i];
      const Eigen::Vector3d& b = whole[(i + 1) % whole.size()];
      const double beyond_a = sign * a[axis] - limit;
      const double beyond_b = sign * b[axis] - limit;
      if (beyond_a <= 0.0) kept.push_back(a);
      if ((beyond_a < 0.0 && beyond_b > 0.0) || (beyond_a > 0.0 && beyond_b < 0.0)) {
        kept.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
      }
    }
  }
  return kept;
}

/// Lower bound of the distance of a point from the object of a map [m]; 0 inside it.
///
/// A point and its voxel's center are at most half a diagonal apart, so are a point of the surface
/// and the center of the partial voxel that holds it; the map says how far the centers are apart.
/// From beyond the lattice the way to the object leads through the nearest point of the lattice's
/// box: at that point the angle between the two parts is at least 90 degrees.
double distance_bound(const geometry::SignedDistanceMap& map, const Eigen::Vector3d& point_O) {
  const geometry::VoxelLattice& lattice = map.lattice;
  const Eigen::Vector3d top = lattice.origin + lattice.voxel_size * lattice.counts.cast<double>();
  const Eigen::Vector3d inside = point_O.cwiseMax(lattice.origin).cwiseMin(top);
  const Eigen::Vector3i voxel =
      lattice.voxel_at(inside).cwiseMax(0).cwiseMin(lattice.counts - Eigen::Vector3i::Ones());
  constexpr double kFloatRounding = 1e-7;  // relative, of the map's values
  const double voxels =
      map.at(voxel) * (1.0 - kFloatRounding) - std::numbers::sqrt3;  // negative inside the object
  const double along = std::max(0.0, voxels * lattice.voxel_size);
  const double beyond = (point_O - inside).norm();
  return beyond == 0.0 ? along : std::hypot(beyond, along);
}

void take_deeper(HandCollision::Result& result, const geometry::Penetration& found, int link_a,
                 int link_b) {
  if (!found.intersects) return;
  if (!result.intersects || found.depth > result.depth) {
    result.depth = found.depth;
    result.link_a = link_a;
    result.link_b = link_b;
  }
  result.intersects = true;
  result.depth_bound = std::max(result.depth_bound, found.depth_bound);
}

void require_poses(const HandModel& model, const std::vector<RigidTransform>& X_OL) {
  if (X_OL.size() == model.links.size()) return;
  throw geometry::InvalidInput("hand " + model.name + ": " + std::to_string(X_OL.size()) +
                               " link poses for " + std::to_string(model.links.size()) + " links");
}

}  // namespace

HandCollision::HandCollision(const HandModel& model) : model_(model) {
  for (const Link& link : model_.links) {
    links_.push_back(link.mesh_L.faces.empty()
                         ? std::nullopt
                         : std::optional<geometry::MeshQuery>(geometry::MeshQuery(link.mesh_L)));
    boxes_.push_back(geometry::bounding_box(link.mesh_L));
    covers_.push_back(covering_balls(link.mesh_L));
  }
}

/// The solid is cut into columns along its shortest extent, about as wide as long. A line along a
/// column through a point of the solid leaves it at either end through the surface, inside the
/// column: so the box of the surface in a column holds all of the solid there.
std::vector<HandCollision::Ball> HandCollision::covering_balls(const TriangleMesh& mesh) {
  constexpr double kMostCells = 8;  // along an axis
  const Eigen::AlignedBox3d box = geometry::bounding_box(mesh);
  if (mesh.faces.empty()) return {};
  const Eigen::Vector3d size = box.sizes();
  int along = 0;
  size.minCoeff(&along);
  const int u = (along + 1) % 3;
  const int v = (along + 2) % 3;
  const auto num_cells = [&](int axis) {
    const double ratio = std::ceil(size[axis] / size[along]);  // not finite for a flat mesh
    return static_cast<int>(ratio <= kMostCells ? std::max(ratio, 1.0) : kMostCells);
  };
  const Eigen::Vector2i counts(num_cells(u), num_cells(v));
  const auto border = [&](int axis, int count, int i) {
    return i == count ? box.max()[axis] : box.min()[axis] + size[axis] * i / count;
  };
  std::vector<Eigen::AlignedBox3d> cells(static_cast<std::size_t>(counts.prod()));
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto corners = geometry::corners(mesh, face);
    const std::vector<Eigen::Vector3d> triangle(corners.begin(), corners.end());
    for (int i = 0; i < counts[0]; ++i) {
      const auto strip = clipped(triangle, u, border(u, counts[0], i), border(u, counts[0], i + 1));
      if (strip.empty()) continue;
      for (int j = 0; j < counts[1]; ++j) {
        for (const Eigen::Vector3d& corner :
             clipped(strip, v, border(v, counts[1], j), border(v, counts[1], j + 1))) {
          cells[static_cast<std::size_t>(i * counts[1] + j)].extend(corner);
        }
      }
    }
  }
  std::vector<Ball> balls;
  for (const Eigen::AlignedBox3d& cell : cells) {
    if (!cell.isEmpty()) balls.push_back({cell.center(), 0.5 * cell.diagonal().norm() + kSlack});
  }
  return balls;
}

bool HandCollision::surely_clear(const geometry::SignedDistanceMap& map, int link,
                                 const RigidTransform& X_OL) const {
  const std::vector<Ball>& balls = covers_.at(static_cast<std::size_t>(link));
  return std::all_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return distance_bound(map, X_OL * ball.center_L) > ball.radius;
  });
}

bool HandCollision::link_intersects(const geometry::MeshQuery& object, int link,
                                    const RigidTransform& X_OL) const {
  const auto& query = links_.at(static_cast<std::size_t>(link));
  return query && may_meet(object.box(), boxes_[static_cast<std::size_t>(link)], X_OL) &&
         geometry::do_intersect(object, *query, X_OL);
}

HandCollision::Result HandCollision::against_object(const geometry::MeshQuery& object,
                                                    const std::vector<RigidTransform>& X_OL) const {
  require_poses(model_, X_OL);
  Result result;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!links_[i] || !may_meet(object.box(), boxes_[i], X_OL[i])) continue;
    take_deeper(result, geometry::penetration(object, *links_[i], X_OL[i]), static_cast<int>(i),
                -1);
  }
  return result;
}

template <class Visit>
void HandCollision::for_each_near_pair(const std::vector<RigidTransform>& X_OL,
                                       const Visit& visit) const {
  require_poses(model_, X_OL);
  for (std::size_t a = 0; a < links_.size(); ++a) {
    if (!links_[a]) continue;
    for (std::size_t b = a + 1; b < links_.size(); ++b) {
      if (!links_[b] || model_.is_excluded(static_cast<int>(a), static_cast<int>(b))) continue;
      const RigidTransform X_AB = X_OL[a].inverse() * X_OL[b];
      if (!may_meet(boxes_[a], boxes_[b], X_AB)) continue;
      if (!visit(static_cast<int>(a), static_cast<int>(b), X_AB)) return;
    }
  }
}

HandCollision::Result HandCollision::against_self(const std::vector<RigidTransform>& X_OL) const {
  Result result;
  for_each_near_pair(X_OL, [&](int a, int b, const RigidTransform& X_AB) {
    take_deeper(result, geometry::penetration(*links_[a], *links_[b], X_AB), a, b);
    return true;
  });
  return result;
}

bool HandCollision::overlaps_self(const std::vector<RigidTransform>& X_OL, double depth) const {
  bool overlaps = false;
  for_each_near_pair(X_OL, [&](int a, int b, const RigidTransform& X_AB) {
    const geometry::Penetration found = geometry::penetration(
        *links_[a], *links_[b], X_AB, {.tolerance = 0.5 * depth, .enough = depth});
    overlaps = found.depth > depth;
    return !overlaps;
  });
  return overlaps;
}

}  // namespace graspfit::hands
