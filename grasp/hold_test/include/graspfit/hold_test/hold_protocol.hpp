#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace graspfit::hold_test {

/// Where the commanded joints of the squeeze come from.
enum class SqueezeRule {
  Forces,         ///< The grasp's own squeeze: Δq = Jᵀ f / kp from balanced forces.
  Extrapolation,  ///< Grasp + (grasp − pre-grasp) · `extrapolation`, clamped to the limits.
  None,           ///< The grasp's joints themselves.
};

/// What loads the object once it is squeezed.
enum class HoldLoad {
  SixForces,  ///< `force` at the center of mass along ±x ±y ±z of O in turn, a reset before each.
  Lift,       ///< Gravity from the start, the object on a table; the hand goes up by `lift_height`.
};

/// A named way to decide whether a grasp holds: every number that the verdict depends on
/// (DexGraspBench, Dexonomy, MultiDex; `source` cites it). A protocol is a value: copy one, change
/// a knob, and give it a name of its own.
struct HoldProtocol {
  std::string name;
  std::string source;
  HoldLoad load = HoldLoad::SixForces;
  SqueezeRule squeeze = SqueezeRule::Forces;
  double step = 0.004;                                 ///< [s]
  double gravity = 0.0;                                ///< Along −z of O [m/s²].
  double sliding_friction = 0.6;                       ///< Coulomb's μ of all bodies.
  double torsional_friction = 0.02;                    ///< [m]
  std::array<double, 3> solimp = {0.5, 0.99, 0.0001};  ///< Of the hand's contacts (MuJoCo).
  std::array<double, 2> solref = {0.005, 1.0};
  double impratio = 10.0;
  int noslip_iterations = 2;
  double object_mass = 0.1;         ///< [kg]
  double stiffness = 5.0;           ///< kp of revolute joints [N m/rad].
  double slide_stiffness = 2000.0;  ///< kp of slides [N/m].
  double extrapolation = 1.0;       ///< See SqueezeRule.
  double approach_time = 0.4;       ///< Pre-grasp to grasp, linear [s].
  double squeeze_time = 0.4;        ///< Grasp to squeeze, linear [s].
  double force = 1.0;               ///< [N]
  double hold_time = 2.0;           ///< [s]
  double check_interval = 0.2;      ///< [s]
  double largest_shift = 0.05;      ///< Of the center of mass, from the squeezed pose, in the
                                    ///< palm's frame [m]: at or above it the grasp fails.
  double largest_turn = 0.26179938779914941;  ///< The same for the rotation [rad] (15°).
  double largest_penetration = 0.01;          ///< Deeper at the pre-grasp: rejected untested [m].
  double lift_height = 0.1;                   ///< Of HoldLoad::Lift [m].
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Names of the shipped protocols: dexgraspbench-100g (the default), dexonomy-hard,
/// multidex-0.05g, tabletop-lift.
const std::vector<std::string>& hold_protocol_names();

/// @throws InvalidInput that lists the names there are, if there is none of that name.
HoldProtocol hold_protocol(const std::string& name);

}  // namespace graspfit::hold_test
