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

/// Whether this build has a physics engine; without, `HoldTest` throws InvalidInput that says so.
bool is_available();

/// An object as the engine sees it, prepared once: convex pieces with the true solid's center of
/// mass and inertia (uniform density). Frame O.
struct HoldObject {
  geometry::ConvexDecomposition shape;
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Matrix3d inertia_per_mass_O = Eigen::Matrix3d::Zero();  ///< About it, along O's axes [m²].
};
HoldObject prepare_hold_object(const geometry::TriangleMesh& mesh,
                               const geometry::ConvexDecompositionOptions& options = {});

/// A hand as the engine sees it, prepared once: its links in convex pieces each, in L.
struct HoldHand {
  hands::HandModel model;
  std::vector<geometry::ConvexDecomposition> links;  ///< One per link; no pieces without faces.
};
HoldHand prepare_hold_hand(const hands::HandModel& hand,
                           const geometry::ConvexDecompositionOptions& options = {});

/// How far a test came.
enum class HoldStage {
  Rejected,  ///< Deeper than allowed at the pre-grasp, or no pre-grasp or squeeze: not simulated.
  Approach,  ///< Lost between pre-grasp and squeeze: before any load.
  Load,      ///< Lost under load.
  Held,      ///< Not lost.
};

/// One load.
struct DirectionVerdict {
  Eigen::Vector3d direction_O = Eigen::Vector3d::Zero();  ///< Unit.
  HoldStage stage = HoldStage::Held;
  std::optional<double> failed_at;  ///< Of the first failing check, since the load began [s].
  double largest_shift = 0.0;       ///< At any check up to that one, from the squeezed pose [m].
  double largest_turn = 0.0;        ///< [rad]
};

/// What the test says of one grasp.
struct HoldVerdict {
  HoldStage stage = HoldStage::Rejected;  ///< The earliest of all directions.
  std::string reason;  ///< Of a rejection, or of a simulation that went wrong; empty else.
  double approach_shift =
      0.0;                     ///< Largest at any check before the load, from the planned pose [m].
  double approach_turn = 0.0;  ///< [rad]
  double squeeze_force = 0.0;  ///< Sum of the normal forces on the object once squeezed [N].
  /// Six, or one for HoldLoad::Lift; none of a rejected grasp.
  std::vector<DirectionVerdict> directions;
  bool held() const { return stage == HoldStage::Held; }
};

/// The smallest loads at the center of mass that fail, applied at once and held as the test's own.
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

/// Tests grasps of one hand on one object in MuJoCo, the hand's base fixed to the world. One thread
/// at a time per HoldTest; build one per thread. Same grasp, same verdict, whatever was tested
/// before. No warning or error of the engine is printed or ends the program: a simulation that
/// diverges is a grasp that fails, and `reason` says so.
class HoldTest {
 public:
  /// @throws InvalidInput for a bad protocol, a model that the engine refuses (its words), and in a
  /// build without MuJoCo.
  HoldTest(const HoldHand& hand, const HoldObject& object, const HoldProtocol& protocol);
  ~HoldTest();
  HoldTest(HoldTest&&) noexcept;
  HoldTest& operator=(HoldTest&&) noexcept;

  /// @throws InvalidInput for joint positions that do not fit the hand.
  HoldVerdict test(const grasp::Grasp& grasp);

  /// The smallest failing load by bisection: what is returned fails, 2 % less holds. Up to
  /// `largest` [N] (torques: `largest` · 0.1 m); where even that holds, it is returned. Zero where
  /// the grasp is rejected or lost without load. @throws InvalidInput for protocols that lift.
  HoldMargin margin(const grasp::Grasp& grasp, double largest = 100.0);

  /// The same simulation as one direction of `test`, a frame every `interval` seconds and one at
  /// its end; empty for a rejected grasp. @throws InvalidInput for a direction that there is not.
  std::vector<HoldFrame> replay(const grasp::Grasp& grasp, int direction, double interval = 0.02);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace graspfit::hold_test
