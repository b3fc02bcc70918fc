#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test::internal {

/// The simulated scene: hand, object and what acts on them. Only this class knows the engine.
class Physics {
 public:
  /// @throws InvalidInput if the engine refuses the scene.
  Physics(const HoldHand& hand, const HoldObject& object, const HoldProtocol& protocol);
  ~Physics();

  /// Puts all bodies at rest without load: the object as planned, the hand at `start`, commanded to
  /// stay there. `follows` says for each joint whether it follows its leader; a follower that does
  /// not is driven by its own actuator.
  void reset(const hands::HandConfiguration& start, const std::vector<bool>& follows);

  /// Puts the palm at its pose in `to`, where forces do not move it, and commands the joints.
  void command(const hands::HandConfiguration& to);
  /// Commands the lifting slide of HoldLoad::Lift [m].
  void command_lift(double height);
  /// Sets the force and torque that act on the object at its center of mass from now on [N, N m].
  void set_load(const Eigen::Vector3d& force_O, const Eigen::Vector3d& torque_O);
  /// Simulates one time step. Returns why the result is not to be trusted; empty if it is. After a
  /// failure only `reset` and `restore` lead back to a state that can be trusted.
  std::string step();

  double time() const;                    ///< Since the reset [s].
  geometry::RigidTransform X_OB() const;  ///< Pose of the object; identity as planned.
  hands::HandConfiguration hand() const;  ///< Palm pose and joints as they are.
  double squeeze_force() const;           ///< Normal forces of the hand on the object [N].

  /// Deepest overlap of hand and object, or hand and hand, between the engine's convex pieces; of
  /// depth 0 if there is none.
  struct Overlap {
    double depth = 0.0;  ///< [m]
    int link_a = 0;
    std::optional<int> link_b;  ///< Empty: the object (or the table).
  };
  Overlap deepest_overlap() const;

  /// All that the future depends on, besides commands.
  struct State {
    double time = 0.0;
    std::vector<double> positions, velocities, controls, warm_start;
  };
  State state() const;
  void restore(const State& state);

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace graspfit::hold_test::internal
