#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "graspfit/hold_test/hold_test.hpp"
#include "physics.hpp"

namespace graspfit::hold_test::internal {

/// The test of one grasp by a protocol: one simulation up to the squeeze, then any number of loads
/// that each start from the squeezed state.
class HoldRun {
 public:
  using Watch = std::function<void()>;  ///< Called after every step.

  HoldRun(Physics& physics, const HoldHand& hand, const HoldObject& object,
          const HoldProtocol& protocol)
      : physics_(physics), hand_(hand.model), object_(object), protocol_(protocol) {}

  /// Simulates the motion from the pre-grasp to the grasp and on to the squeeze. Returns the stage
  /// (Rejected, Approach, or Held so far), the reason, how far the approach moved the object, and
  /// the force of the squeeze; loads are left to `load`. `load_share` scales the weight under which
  /// a lift approaches.
  HoldVerdict approach(const grasp::Grasp& grasp, const Watch& watch = {}, double load_share = 1.0);

  /// Simulates a load from the squeezed state; may be called as often as wanted.
  DirectionVerdict load(const Eigen::Vector3d& direction_O, const Eigen::Vector3d& force_O,
                        const Eigen::Vector3d& torque_O, const Watch& watch = {});

  /// As `load`, with a force of that size along +x +y +z −x −y −z of O, one after another.
  DirectionVerdict load_in_turn(double force, const Watch& watch = {});

  /// Why the last call's simulation went wrong; empty else.
  const std::string& failure() const { return failure_; }

 private:
  struct Motion {
    double shift = 0.0;  ///< Displacement of the center of mass [m].
    double turn = 0.0;   ///< [rad]
  };

  /// Where the test of a grasp starts, and where it squeezes.
  struct Ends {
    hands::HandConfiguration start;
    hands::HandConfiguration squeeze;
  };

  std::string rejection(const grasp::Grasp& grasp) const;
  std::string overlap_at(const hands::HandConfiguration& start, const Eigen::VectorXd& q);
  Ends ends_of(const grasp::Grasp& grasp) const;
  /// Simulates `hold_time` from the squeezed state; `act` is called before every step with its
  /// number, from 1, and the number of all.
  DirectionVerdict hold(const Eigen::Vector3d& direction_O,
                        const std::function<void(int, int)>& act, const Watch& watch);
  /// Moves linearly from one command to another, with checks on the way, each of which goes into
  /// the largest motion of `verdict`. Returns false if the object was lost or the simulation went
  /// wrong.
  bool move(const hands::HandConfiguration& from, const hands::HandConfiguration& to,
            double duration, HoldVerdict& verdict, const Watch& watch);
  bool step(const Watch& watch);  ///< Returns false if the simulation went wrong.
  Motion motion(const geometry::RigidTransform& X_HB_before,
                const geometry::RigidTransform& X_HB_now) const;
  geometry::RigidTransform X_HB() const;
  bool is_lost(const Motion& motion) const;
  int num_steps(double duration) const;

  Physics& physics_;
  const hands::HandModel& hand_;
  const HoldObject& object_;
  const HoldProtocol& protocol_;
  Physics::State squeezed_state_;
  geometry::RigidTransform X_HB_squeezed_;
  std::string failure_;
};

}  // namespace graspfit::hold_test::internal
