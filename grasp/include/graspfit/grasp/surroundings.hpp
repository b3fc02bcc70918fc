#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// The usual `Surroundings::table_clearance` of planning [m].
inline constexpr double kTableClearance = 0.001;

/// What stands around the object and must not be touched, in the object frame O.
struct Surroundings {
  std::optional<double> table_z_O;             ///< Everything at or below z = this is solid [m].
  std::vector<geometry::MeshQuery> obstacles;  ///< Closed solids in O.
  /// The hand comes no nearer to the table than this [m], ≥ 0, finite: what is lower counts as the
  /// table.
  double table_clearance = 0.0;

  bool is_empty() const { return !table_z_O && obstacles.empty(); }

  /// Throws InvalidInput (which, what, what to do) for a table or clearance that is not finite, a
  /// clearance below 0 and an obstacle that is not finite or not closed.
  void validate() const;
};

/// Distance of a link from the surroundings.
struct SurroundingsDistance {
  double distance = 0.0;  ///< [m]; zero where they touch; infinite if there are none.
  /// Point of the link nearest to the surroundings; meaningless where the distance is zero or
  /// infinite.
  Eigen::Vector3d point_on_link_O;
  /// Unit, from the surroundings to the link; meaningless where the distance is zero or infinite.
  Eigen::Vector3d normal_O;
};

/// A hand prepared for many queries of collision with, and distance from, surroundings. Links
/// without faces touch nothing.
class SurroundingsCollision {
 public:
  /// @throws InvalidInput as `Surroundings::validate`. Cost: without a table and obstacles nothing;
  /// with a table one convex hull per link.
  SurroundingsCollision(const hands::HandModel& hand, Surroundings surroundings);

  const Surroundings& surroundings() const { return surroundings_; }

  /// Whether a link shares a point with the surroundings. Touching counts. Exact for obstacles as
  /// `HandCollision::link_intersects`; for the table on the corners of the link's convex hull
  /// (exact) mapped to O and rounded once. `collision` and `link` belong to the same hand.
  /// @throws InvalidInput for a pose that is not finite.
  bool touches(const hands::HandCollision& collision, int link,
               const hands::RigidTransform& X_OL) const;

  /// The corners of a link's convex hull.
  /// @throws std::out_of_range without a table, for which they are computed, and for a link that
  /// the hand does not have.
  const std::vector<Eigen::Vector3d>& corners_L(int link) const { return corners_L_.at(link); }

  /// The lowest corner of a link's convex hull over the table.
  struct OverTable {
    double height = 0.0;  ///< Above what must not be touched: the table and its clearance [m];
                          ///< negative below.
    Eigen::Vector3d corner_O;
  };
  /// Empty without a table and where the link is surely higher than `enough` [m]. Rounded.
  /// @throws InvalidInput for a pose that is not finite.
  std::optional<OverTable> over_table(int link, const hands::RigidTransform& X_OL,
                                      double enough) const;

  /// Distance of one link from the surroundings, where it is at most `enough` [m] ≥ 0; infinite
  /// where it is more. Approximate, to rounding; zero where `touches`, and where it rounds to zero.
  /// Of equal distances the table counts first, then obstacles in order.
  /// @throws InvalidInput for a pose that is not finite.
  SurroundingsDistance distance(const hands::HandCollision& collision, int link,
                                const hands::RigidTransform& X_OL, double enough) const;

 private:
  Surroundings surroundings_;
  std::vector<std::vector<Eigen::Vector3d>> corners_L_;  ///< Per link: those of its convex hull.
  std::vector<Eigen::AlignedBox3d> boxes_L_;             ///< Per link: of those corners.
};

}  // namespace graspfit::grasp
