#include "approach/way_up.hpp"

#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "scene/straight_way.hpp"

namespace graspfit::grasp::internal {
namespace {

using hands::RigidTransform;

constexpr double kLift = 0.1;      // [m]
constexpr double kLeaves = 0.001;  // of the object, from what it stands on [m]

/// The obstacle in O as seen from a body that has gone up.
RigidTransform lowered(double height) {
  RigidTransform X = RigidTransform::Identity();
  X.translation().z() = -height;
  return X;
}

/// Whether a body goes from one height to another without touching the obstacle.
bool passes(const geometry::MeshQuery& body, const RigidTransform& X_OB,
            const geometry::MeshQuery& obstacle, double from, double to) {
  const RigidTransform X_BO = geometry::inverted(X_OB);
  return are_apart_on_way(to - from, 0.0, [&](double share, double enough) {
    const RigidTransform X = X_BO * lowered(from + share * (to - from));
    return geometry::surface_clearance(body, obstacle, X, enough, kNearEnough).at_least;
  });
}

}  // namespace

bool is_way_up_free(const PreGraspScene& scene, const hands::PosedConfiguration& grasp) {
  const RigidTransform X_OO = RigidTransform::Identity();
  for (const geometry::MeshQuery& obstacle : scene.surroundings.surroundings().obstacles) {
    for (int link = 0; link < std::ssize(grasp.X_OL); ++link) {
      const auto& solid = scene.collision.link_solid(link);
      if (solid && !passes(*solid, grasp.X_OL[link], obstacle, 0.0, kLift)) return false;
    }
    if (geometry::do_intersect(scene.object, obstacle, lowered(kLeaves))) continue;
    if (!passes(scene.object, X_OO, obstacle, kLeaves, kLift)) return false;
  }
  return true;
}

}  // namespace graspfit::grasp::internal
