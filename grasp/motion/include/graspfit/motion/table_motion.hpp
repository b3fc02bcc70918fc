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
  const SceneObject& object(int index) const { return objects_.at(index); }

  /// The convex hull of an object, exact; its vertices are corners of the object.
  const geometry::TriangleMesh& hull_O(int index) const { return hulls_O_.at(index); }

  /// Returns the height of a link's lowest point over the table [m], or `enough` if the height is
  /// larger; zero where the link touches the table or reaches below it.
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
  Reach,      ///< The free hand moves to the pre-grasp.
  Approach,   ///< The hand moves from the pre-grasp to the grasp.
  Lift,       ///< The hand lifts the object from the table.
  Transport,  ///< The hand carries the object through the air, turning it as need be.
  Place,      ///< The hand lowers the object to the table.
  Release,    ///< The hand opens and leaves the object: an approach backward.
  Retreat,    ///< The free hand moves away.
};
const char* phase_name(MotionPhase phase);
std::optional<MotionPhase> phase_named(std::string_view name);
/// Whether the object moves with the hand, as in Lift, Transport and Place.
bool is_carrying(MotionPhase phase);

/// A straight segment of a motion in the world W.
///
/// While the hand is free, palm position and joints are interpolated linearly, and the palm's
/// rotation along the shortest arc (`interpolated`). While it carries, the object's pose is
/// interpolated in the same manner at the object's center of mass; the palm keeps its pose relative
/// to the object, and joints do not move.
struct MotionSegment {
  MotionPhase phase = MotionPhase::Reach;
  int object = -1;                ///< Index of the handled object.
  hands::HandConfiguration from;  ///< `X_OH` is here the palm's pose in W, X_WH.
  hands::HandConfiguration to;
  geometry::RigidTransform X_WO_from = geometry::RigidTransform::Identity();  ///< Of the object.
  geometry::RigidTransform X_WO_to = geometry::RigidTransform::Identity();
};

/// Configuration of the hand (`X_OH` is X_WH) and pose of the handled object at one point of a
/// segment.
struct MotionState {
  hands::HandConfiguration hand;
  geometry::RigidTransform X_WO;
};

/// Returns the state at a share in [0, 1] of a segment; the shares 0 and 1 give the segment's ends
/// to the last digit.
MotionState state_at(const TableScene& scene, const MotionSegment& segment, double share);

/// Returns an upper bound of how far any point of the hand or of a carried object travels on a
/// segment [m].
double largest_travel(const TableScene& scene, const MotionSegment& segment);

/// Two bodies that cannot be proven apart on a segment.
struct Collision {
  std::string first;   ///< A link, or the carried object.
  std::string second;  ///< "table", an object, or a link.
  std::string text() const { return first + " and " + second; }
};

/// Length at the end of an approach (at the start of a release) over which hand and handled object
/// may come arbitrarily near to each other [m]; as `PreGraspOptions::way_tolerance`.
inline constexpr double kTouchTolerance = 1e-5;

/// Returns the first two bodies that are not proven to stay more than `clearance` [m] ≥ 0 apart on
/// the whole segment; empty if all bodies are. `X_WO` are the poses of all objects; that of the
/// handled object is ignored.
///
/// The proof is conservative advancement, not sampling (`find_pre_grasp`): bodies that are d apart
/// at one share of the segment, and whose points move by at most v per unit of share, keep their
/// clearance c for (d − c) / v of the share before and after it; the segment is free when such
/// intervals cover it. The bodies are all links and the carried object. Each is tested against the
/// table and the standing objects; links are also tested against each other where joints move, with
/// a clearance of zero. Whether a body shares a point with an object is decided exactly at both
/// ends. The phases imply these exceptions:
///
/// - Lift, Place: the carried object may rest on the table at the end of the segment that is on it,
///   1e-9 m deep at most (rounding of its pose). A body that does not turn is lowest at one of the
///   ends, exactly.
/// - Approach, Release: hand and object may come arbitrarily near to each other over the last
///   (first) `kTouchTolerance`, but must share no point in the grasp itself.
/// - Carrying: hand and object do not move relative to each other, so that they are not tested.
///
/// Like `find_pre_grasp` it never reports a segment free wrongly, up to the rounding of distances.
/// It may report a collision wrongly where bodies come within 1e-8 m of the clearance, and where
/// 500 distances of a pair of bodies leave some of the segment uncovered (long sliding motions
/// hardly farther apart than the clearance).
std::optional<Collision> find_collision(const TableScene& scene,
                                        std::span<const geometry::RigidTransform> X_WO,
                                        const MotionSegment& segment, double clearance);

/// Smallest distances at one share of a segment.
struct MotionClearance {
  double hand = 0.0;    ///< Smallest distance of a link from the table and from standing objects,
                        ///< but for the one that is approached or released [m]; 0: they touch.
  double object = 0.0;  ///< Smallest distance of the carried object from standing objects and,
                        ///< except in Lift and Place, from the table [m]; infinite where nothing is
                        ///< carried.
};

/// Measures the clearance at a share of a segment, up to rounding.
MotionClearance clearance_at(const TableScene& scene,
                             std::span<const geometry::RigidTransform> X_WO,
                             const MotionSegment& segment, double share);

/// Returns two bodies that have a common point at a share of a segment, if there are any, decided
/// exactly on the true meshes. Links are tested against each other (except for the pairs that the
/// hand excludes), against standing objects and against the handled object, a carried object
/// against standing ones. A link overlaps the table as `SurroundingsCollision::touches` says, a
/// carried object if it is deeper in it than 1e-9 m. This is the oracle of `find_collision`.
std::optional<Collision> find_overlap(const TableScene& scene,
                                      std::span<const geometry::RigidTransform> X_WO,
                                      const MotionSegment& segment, double share);

}  // namespace graspfit::motion
