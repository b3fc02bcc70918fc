#include "graspfit/hands/hand_collision.hpp"

#include <algorithm>
#include <string>

#include "graspfit/base/errors.hpp"

namespace graspfit::hands {

namespace {

// Margin for rounding [m], which is below 1e-14 for coordinates of a hand and its object.
constexpr double kSlack = 1e-9;

/// A box in frame A around a box in frame B. It is conservative: it is widened by far more than its
/// rounding.
Eigen::AlignedBox3d box_around(const Eigen::AlignedBox3d& box_B, const RigidTransform& X_AB) {
  const Eigen::Vector3d center_A = X_AB * box_B.center();
  const Eigen::Vector3d half_A =
      X_AB.linear().cwiseAbs() * (0.5 * box_B.sizes()) + Eigen::Vector3d::Constant(kSlack);
  return {center_A - half_A, center_A + half_A};
}

/// False only if the boxes are apart: the axes of one of the frames separate them. The second frame
/// is asked only where the inverse of the pose is at hand. A pose that is not finite is left to
/// what decides, which refuses it.
bool may_meet(const Eigen::AlignedBox3d& box_A, const Eigen::AlignedBox3d& box_B,
              const RigidTransform& X_AB) {
  if (!X_AB.matrix().allFinite()) return true;
  return box_A.intersects(box_around(box_B, X_AB)) &&
         (!geometry::is_rotation(X_AB) || box_B.intersects(box_around(box_A, X_AB.inverse())));
}

void take_deeper(HandCollision::Result& result, const geometry::Penetration& found, int link_a,
                 std::optional<int> link_b) {
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
  throw base::InvalidInput("hand " + model.name + ": " + std::to_string(X_OL.size()) +
                           " link poses for " + std::to_string(model.links.size()) + " links");
}

}  // namespace

HandCollision::HandCollision(const HandModel& model) : model_(model) {
  for (const Link& link : model_.links) {
    links_.push_back(link.mesh_L.faces.empty()
                         ? std::nullopt
                         : std::optional<geometry::MeshQuery>(geometry::MeshQuery(link.mesh_L)));
    boxes_.push_back(geometry::bounding_box(link.mesh_L));
  }
}

bool HandCollision::link_intersects(const geometry::MeshQuery& object, int link,
                                    const RigidTransform& X_OL) const {
  const auto& query = links_.at(link);
  return query && may_meet(object.box(), boxes_[link], X_OL) &&
         geometry::do_intersect(object, *query, X_OL);
}

geometry::DepthBounds HandCollision::link_depth_above(
    const geometry::MeshQuery& object, int link, const RigidTransform& X_OL, double floor,
    const geometry::PenetrationOptions& options) const {
  const auto& query = links_.at(link);
  if (!query || !may_meet(object.box(), boxes_[link], X_OL)) return {};
  return geometry::depth_above(object, *query, X_OL, floor, options);
}

HandCollision::Result HandCollision::against_object(const geometry::MeshQuery& object,
                                                    const std::vector<RigidTransform>& X_OL) const {
  require_poses(model_, X_OL);
  Result result;
  for (int i = 0; i < std::ssize(links_); ++i) {
    if (!links_[i] || !may_meet(object.box(), boxes_[i], X_OL[i])) continue;
    take_deeper(result, geometry::penetration(object, *links_[i], X_OL[i]), i, std::nullopt);
  }
  return result;
}

template <class Visit>
void HandCollision::for_each_near_pair(const std::vector<RigidTransform>& X_OL,
                                       const Visit& visit) const {
  require_poses(model_, X_OL);
  for (int a = 0; a < std::ssize(links_); ++a) {
    if (!links_[a]) continue;
    for (int b = a + 1; b < std::ssize(links_); ++b) {
      if (!links_[b] || model_.is_excluded(a, b)) continue;
      const RigidTransform X_AB = geometry::relative_pose(X_OL[a], X_OL[b]);
      if (!may_meet(boxes_[a], boxes_[b], X_AB)) continue;
      if (!visit(a, b, X_AB)) return;
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

std::vector<std::pair<int, int>> HandCollision::overlapping_pairs(
    const std::vector<RigidTransform>& X_OL) const {
  std::vector<std::pair<int, int>> pairs;
  for_each_near_pair(X_OL, [&](int a, int b, const RigidTransform& X_AB) {
    if (geometry::do_intersect(*links_[a], *links_[b], X_AB)) pairs.emplace_back(a, b);
    return true;
  });
  return pairs;
}

bool HandCollision::is_deeper_than(double depth, int a, int b, const RigidTransform& X_AB) const {
  const geometry::Penetration found = geometry::penetration(
      *links_[a], *links_[b], X_AB, {.tolerance = 0.5 * depth, .enough = depth});
  return found.depth > depth;
}

std::optional<std::pair<int, int>> HandCollision::pair_deeper_than(
    const std::vector<RigidTransform>& X_OL, double depth,
    const std::optional<std::pair<int, int>>& likely) const {
  std::optional<std::pair<int, int>> pair;
  for (const bool is_likely : {true, false}) {
    if (pair || (is_likely && !likely)) continue;
    for_each_near_pair(X_OL, [&](int a, int b, const RigidTransform& X_AB) {
      if ((likely == std::pair(a, b)) == is_likely && is_deeper_than(depth, a, b, X_AB)) {
        pair = {a, b};
      }
      return !pair;
    });
  }
  return pair;
}

}  // namespace graspfit::hands
