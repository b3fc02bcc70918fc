#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::motion {

/// A solid that stands on the table or is carried over it.
struct SceneObject {
  std::string name;
  geometry::MeshQuery surface_O;
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();
};

/// What stays the same while a hand moves objects about on a table: hand, objects, the table. In W
/// everything at or below z = 0 is solid.
class TableScene {
 public:
  /// @throws InvalidInput for two objects of one name.
  TableScene(hands::HandModel hand, std::vector<SceneObject> objects);

  const hands::HandModel& hand() const { return hand_; }
  const hands::HandCollision& collision() const { return collision_; }
  const std::vector<SceneObject>& objects() const { return objects_; }
  const SceneObject& object(int index) const {
    return objects_.at(static_cast<std::size_t>(index));
  }

  /// The convex hull of an object, exact; its vertices are corners of the object.
  const geometry::TriangleMesh& hull_O(int index) const {
    return hulls_O_.at(static_cast<std::size_t>(index));
  }

  /// Height of a link's lowest point over the table [m], ≤ `enough` or else `enough`; zero where it
  /// touches or is below.
  double height_of_link(int link, const geometry::RigidTransform& X_WL, double enough) const;
  /// Height of an object's lowest point [m]; negative below the table. Rounded.
  double height_of_object(int object, const geometry::RigidTransform& X_WO) const;

 private:
  hands::HandModel hand_;
  hands::HandCollision collision_;
  grasp::SurroundingsCollision table_;
  std::vector<SceneObject> objects_;
  std::vector<geometry::TriangleMesh> hulls_O_;
};

/// What happens in a segment of a motion.
enum class MotionPhase {
  Reach,      ///< The hand, free, to the pre-grasp.
  Approach,   ///< To the grasp.
  Lift,       ///< Object in hand, up from the table.
  Transport,  ///< Object in hand, through the air, turning as need be.
  Place,      ///< Object in hand, down to the table.
  Release,    ///< The hand opens and leaves the object: an approach backward.
  Retreat,    ///< The hand, free, away.
};
const char* phase_name(MotionPhase phase);
std::optional<MotionPhase> phase_named(std::string_view name);
/// Lift, Transport, Place: the object moves with the hand.
bool is_carrying(MotionPhase phase);

/// A straight segment of a motion in the world W.
///
/// Hand free: palm position and joints linear, palm rotation along the shortest arc
/// (`interpolated`). Carrying: the same of the object's pose, taken at its center of mass; the palm
/// keeps its place against it and joints do not move.
struct MotionSegment {
  MotionPhase phase = MotionPhase::Reach;
  int object = -1;                ///< The one that the motion is about.
  hands::HandConfiguration from;  ///< `X_OH` is here the palm's pose in W, X_WH.
  hands::HandConfiguration to;
  geometry::RigidTransform X_WO_from = geometry::RigidTransform::Identity();  ///< Of the object.
  geometry::RigidTransform X_WO_to = geometry::RigidTransform::Identity();
};

/// Hand (`X_OH` is X_WH) and handled object somewhere on a segment.
struct MotionState {
  hands::HandConfiguration hand;
  geometry::RigidTransform X_WO;
};

/// At a share in [0, 1] of a segment; 0 and 1 are its ends to the last digit.
MotionState state_at(const TableScene& scene, const MotionSegment& segment, double share);

/// Upper bound of the way that any point of the hand or of a carried object goes on a segment [m].
double largest_travel(const TableScene& scene, const MotionSegment& segment);

/// Two bodies that cannot be proven apart on a segment.
struct Collision {
  std::string first;   ///< A link, or the carried object.
  std::string second;  ///< "table", an object, or a link.
  std::string text() const { return first + " and " + second; }
};

/// Over so much of the end of an approach (the start of a release) hand and handled object may be
/// as near each other as they like [m]; as `PreGraspOptions::way_tolerance`.
inline constexpr double kTouchTolerance = 1e-5;

/// The first two bodies that are not proven to stay more than `clearance` [m] ≥ 0 apart on the
/// whole segment; empty: all are. `X_WO` are the poses of all objects, that of the handled one does
/// not count.
///
/// The proof is conservative advancement, not sampling (`find_pre_grasp`): bodies that are d apart
/// at one place of the segment, and of which no point goes faster than v per unit of its share,
/// keep their clearance c for (d − c) / v of the share before and after it; the segment is free
/// when such intervals cover it. Bodies are all links, and the carried object; each is held against
/// the table and the objects that stand, links also against each other where joints move. That none
/// is inside an object is decided exactly at both ends. Exceptions, each of them by meaning:
///
/// - Lift, Place: a carried object may rest on the table at the end that is on it, 1e-9 m deep at
///   most (rounding of its pose). Without turning, a body is lowest at one of the ends, exactly.
/// - Approach, Release: hand and object over the last (first) `kTouchTolerance`: there they touch.
/// - Carrying: hand and object keep their places against each other, so that nothing is looked at.
///
/// Like `find_pre_grasp` it never says free wrongly, up to the rounding of distances. It may say
/// collision wrongly: where bodies come within 1e-8 m of the clearance, and where 500 distances of
/// a pair of bodies leave some of the segment uncovered (long slides hardly farther apart than the
/// clearance).
std::optional<Collision> find_collision(const TableScene& scene,
                                        std::span<const geometry::RigidTransform> X_WO,
                                        const MotionSegment& segment, double clearance);

/// Distances at one place of a segment.
struct MotionClearance {
  double hand = 0.0;    ///< Smallest distance of a link from the table and from standing objects,
                        ///< but for the one that is approached or released [m]; 0: they touch.
  double object = 0.0;  ///< Of the carried object from standing objects, and from the table but for
                        ///< Lift and Place [m]; infinite where nothing is carried.
};

/// Measured at a share of a segment, up to rounding.
MotionClearance clearance_at(const TableScene& scene,
                             std::span<const geometry::RigidTransform> X_WO,
                             const MotionSegment& segment, double share);

/// Whether at a share some two bodies share a point, decided exactly on the true meshes: links with
/// each other (exclusions of the hand besides), with standing objects, with the handled object, a
/// carried object with standing ones. The table: links as `SurroundingsCollision::touches`, a
/// carried object deeper than 1e-9 m. The oracle of `find_collision`.
std::optional<Collision> find_overlap(const TableScene& scene,
                                      std::span<const geometry::RigidTransform> X_WO,
                                      const MotionSegment& segment, double share);

}  // namespace graspfit::motion
