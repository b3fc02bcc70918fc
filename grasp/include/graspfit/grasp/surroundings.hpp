#pragma once

#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// What stands around the object and must not be touched, in the object frame O (A45).
struct Surroundings {
  std::optional<double> table_z_O;             ///< Everything at or below z = this is solid [m].
  std::vector<geometry::MeshQuery> obstacles;  ///< Closed solids in O.

  bool is_empty() const { return !table_z_O && obstacles.empty(); }
};

/// Distance of a link from the surroundings.
struct SurroundingsDistance {
  double distance = 0.0;            ///< [m]; zero where they touch; infinite if there are none.
  Eigen::Vector3d point_on_link_O;  ///< Nearest to them; meaningless at distance zero.
  Eigen::Vector3d normal_O;         ///< Unit, from the surroundings to the link; as the point.
};

/// A hand with what is needed to hold it against surroundings many times.
class SurroundingsCollision {
 public:
  SurroundingsCollision(const hands::HandModel& hand, Surroundings surroundings);

  const Surroundings& surroundings() const { return surroundings_; }

  /// Whether a link shares a point with the surroundings. Touching counts. Exact for obstacles as
  /// `HandCollision::link_intersects`; for the table on the link's vertices mapped to O and rounded
  /// once.
  bool touches(const hands::HandCollision& collision, int link,
               const hands::RigidTransform& X_OL) const;

  /// Nearest approach of one link. Values above `enough` [m] are not searched further: the result
  /// is then some distance above it. Rounded; zero exactly where `touches`.
  SurroundingsDistance distance(const hands::HandCollision& collision, int link,
                                const hands::RigidTransform& X_OL, double enough) const;

 private:
  Surroundings surroundings_;
  std::vector<std::vector<Eigen::Vector3d>> corners_L_;  ///< Per link: those of its convex hull.
};

}  // namespace graspfit::grasp
