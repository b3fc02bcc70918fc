#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"

namespace graspfit::hold_test {

/// Says whether this build has a physics engine. In a build without one, `HoldTest` throws
/// InvalidInput that says so.
bool is_available();

/// An object as the engine sees it, prepared once: convex pieces with the true solid's center of
/// mass and inertia (uniform density), all in frame O.
struct HoldObject {
  geometry::ConvexDecomposition shape;
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Matrix3d inertia_per_mass_O = Eigen::Matrix3d::Zero();  ///< Inertia over mass, about the
                                                                 ///< center of mass along O's axes
                                                                 ///< [m²].
  double volume = 0.0;                                           ///< Of the true solid [m³].
  /// Points in O whose convex hull stands on the table, beside the pieces: the corners of the
  /// mesh's hull at most 1 mm above its lowest one, and a point of the object over each. Round
  /// objects roll off pieces, which have fewer corners than they rest on.
  std::vector<Eigen::Vector3d> foot_O;
};
HoldObject prepare_hold_object(const geometry::TriangleMesh& mesh,
                               const geometry::ConvexDecompositionOptions& options = {});

/// Height along z of O of the table under `HoldLoad::Lift`: of the lowest point of pieces and foot,
/// at least one of which there is [m].
double table_z_O(const HoldObject& object);

/// A hand as the engine sees it, prepared once: the convex pieces of each link in the link's frame
/// L.
struct HoldHand {
  hands::HandModel model;
  std::vector<geometry::ConvexDecomposition> links;  ///< Pieces of each link; none for a link
                                                     ///< without faces.
};
HoldHand prepare_hold_hand(const hands::HandModel& hand,
                           const geometry::ConvexDecompositionOptions& options = {});

/// The stage at which a test ended.
enum class HoldStage {
  Rejected,  ///< Not simulated: deeper penetration than allowed at the pre-grasp, or no pre-grasp
             ///< or squeeze.
  Approach,  ///< The object was lost between pre-grasp and squeeze, before the six forces or the
             ///< lift.
  Load,      ///< The object was lost under load.
  Held,      ///< The object was not lost.
};

/// What the test found of one load.
struct DirectionVerdict {
  /// Unit direction of the load; zero of HoldLoad::SixInTurn.
  Eigen::Vector3d direction_O = Eigen::Vector3d::Zero();
  HoldStage stage = HoldStage::Held;
  std::optional<double> failed_at;  ///< Time of the first failing check, since the load began [s].
  double largest_shift = 0.0;  ///< Largest displacement from the squeezed pose at any check up to
                               ///< the failing one [m].
  double largest_turn = 0.0;   ///< Largest rotation from the squeezed pose [rad].
};

/// What the test says of one grasp.
struct HoldVerdict {
  HoldStage stage = HoldStage::Rejected;  ///< The earliest stage of all directions.
  std::string reason;  ///< Reason of a rejection, or why a simulation went wrong; empty otherwise.
  /// Largest displacement from the planned pose at any check before the load [m].
  double approach_shift = 0.0;
  double approach_turn = 0.0;  ///< Largest rotation from the planned pose [rad].
  double squeeze_force = 0.0;  ///< Sum of the normal forces on the object once squeezed [N].
  /// Verdicts of the six loads, or of the single one of SixInTurn and Lift; none for a rejected
  /// grasp.
  std::vector<DirectionVerdict> directions;
  bool held() const { return stage == HoldStage::Held; }
};

/// The smallest loads at the center of mass that fail, applied at once and held as long as the
/// test's own.
struct HoldMargin {
  double force = 0.0;  ///< Least over the six directions [N].
  Eigen::Vector3d force_direction_O = Eigen::Vector3d::Zero();
  double torque = 0.0;  ///< Least over the six axes [N m].
  Eigen::Vector3d torque_axis_O = Eigen::Vector3d::Zero();
};

/// The bodies at one time, for replaying a test.
struct HoldFrame {
  double time = 0.0;              ///< Since the pre-grasp [s].
  geometry::RigidTransform X_OB;  ///< Pose of the object; identity as it was planned.
  hands::HandConfiguration hand;  ///< Palm pose and all joints as they stand.
};

/// Tests grasps of one hand on one object in MuJoCo, with the hand's base fixed to the world. A
/// HoldTest serves one thread at a time; build one per thread. The same grasp gets the same
/// verdict, whatever was tested before. No warning or error of the engine is printed or ends the
/// program: a grasp whose simulation diverges fails, and `reason` says so.
class HoldTest {
 public:
  /// @throws InvalidInput for a bad protocol, a model that the engine refuses (with its message),
  /// and in a build without MuJoCo.
  HoldTest(const HoldHand& hand, const HoldObject& object, const HoldProtocol& protocol);
  ~HoldTest();
  HoldTest(HoldTest&&) noexcept;
  HoldTest& operator=(HoldTest&&) noexcept;

  /// @throws InvalidInput for joint positions that do not fit the hand.
  HoldVerdict test(const grasp::Grasp& grasp);

  /// Whether the grasp holds with every load `share` > 0 times the protocol's.
  /// @throws InvalidInput as `test`, and for another share.
  bool holds_at(const grasp::Grasp& grasp, double share);

  /// Whether the verdict of `test` is one near a limit: 0.9 or 1.1 times the load changes whether
  /// the grasp holds. Never true of a grasp that is lost before any load begins
  /// (under `HoldLoad::Lift` it weighs from the start).
  bool is_near_limit(const grasp::Grasp& grasp, const HoldVerdict& verdict);

  /// Finds the smallest failing loads by bisection: a returned load fails, a load that is 2 %
  /// smaller holds. Loads are tried up to `largest` [N] (torques: `largest` · 0.1 m); where even
  /// this load holds, it is returned. The loads are zero where the grasp is rejected or lost
  /// without load. @throws InvalidInput unless the protocol has margins.
  HoldMargin margin(const grasp::Grasp& grasp, double largest = 100.0);

  /// Repeats the simulation of one direction of `test` and returns a frame every `interval` seconds
  /// and one at the end; none for a rejected grasp. @throws InvalidInput for a direction that there
  /// is not.
  std::vector<HoldFrame> replay(const grasp::Grasp& grasp, int direction, double interval = 0.02);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace graspfit::hold_test
