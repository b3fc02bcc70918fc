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
  Limits,         ///< Of each joint that closes the hand `closing_share` of the way from the grasp
                  ///< to its closed limit; the test starts `opening_share` of the way to its open
                  ///< one, with the palm at the grasp, instead of at the pre-grasp.
  None,           ///< The grasp's joints themselves.
};

/// What loads the object once it is squeezed.
enum class HoldLoad {
  SixForces,  ///< `force` at the center of mass along ±x ±y ±z of O in turn, a reset before each.
  SixInTurn,  ///< `force` at the center of mass along +x +y +z −x −y −z of O, one after another
              ///< without a reset, each for a sixth of `hold_time`: one load.
  Lift,  ///< Gravity acts from the start, with the object on a table; the hand moves up by
         ///< `lift_height`.
};

/// A named way to decide whether a grasp holds: every number that the verdict depends on
/// (DexGraspBench, Dexonomy, MultiDex; `source` says where each comes from). A protocol is a value:
/// copy one, change a parameter, and give it a name of its own.
struct HoldProtocol {
  std::string name;
  std::string source;
  HoldLoad load = HoldLoad::SixForces;
  SqueezeRule squeeze = SqueezeRule::Forces;

  /// Shortest step and longest phase [s]: with a hundred thousand steps a second, the two seconds
  /// under load of one grasp take minutes already, and steps are counted in an int.
  static constexpr double kShortestStep = 1e-5;
  static constexpr double kLongestTime = 1000.0;

  double step = 0.004;               ///< Time step of the simulation [s], >= kShortestStep.
  double sliding_friction = 0.6;     ///< Coulomb's μ of all bodies.
  double torsional_friction = 0.02;  ///< [m]
  double impratio = 10.0;  ///< Ratio of frictional to normal constraint impedance (MuJoCo).
  int noslip_iterations = 2;
  /// Contact parameters of hand and object (MuJoCo); where both meet, the engine takes the mean.
  std::array<double, 3> hand_solimp = {0.5, 0.99, 0.0001};
  std::array<double, 2> hand_solref = {0.005, 1.0};
  std::array<double, 3> object_solimp = {0.9, 0.95, 0.001};  ///< MuJoCo's defaults.
  std::array<double, 2> object_solref = {0.02, 1.0};
  bool multi_point_contacts = true;  ///< Several contact points where flat pieces meet (MuJoCo's
                                     ///< multiccd): with a single one, light flat pads shake loose.

  double object_mass = 0.1;  ///< [kg]
  /// Density of the object [kg/m³]. Above 0 its mass is this times its volume, and `force` is what
  /// would act on `object_mass`: it grows with the mass.
  double object_density = 0.0;
  double object_linear_damping = 0.0;   ///< Damping of the object's velocity [1/s].
  double object_angular_damping = 0.0;  ///< Damping of its angular velocity [1/s].

  double stiffness = 5.0;           ///< kp of revolute joints [N m/rad].
  double slide_stiffness = 2000.0;  ///< kp of slides [N/m].
  double damping_time = 0.02;       ///< Damping of a joint over its stiffness [s]: 0.1 N m s/rad at
                                    ///< kp 5, the Allegro hand's of MuJoCo Menagerie.
  double armature = 1e-4;           ///< Rotor inertia of revolute joints [kg m²].
  double slide_armature = 0.1;  ///< Rotor inertia of slides [kg]: at a step of 4 ms, lighter jaws
                                ///< shake flat objects loose.
  double link_density = 800.0;  ///< Density of links whose description states no mass [kg/m³].

  double extrapolation = 1.0;   ///< See SqueezeRule.
  double opening_share = 0.25;  ///< In [0, 1]; see SqueezeRule::Limits.
  double closing_share = 0.15;  ///< In [0, 1].
  // Times are >= step and <= kLongestTime.
  double approach_time = 0.4;  ///< Duration of the linear motion from pre-grasp to grasp [s].
  double squeeze_time = 0.4;   ///< Duration of the linear motion from grasp to squeeze [s].
  double force = 1.0;          ///< Force of HoldLoad::SixForces and SixInTurn [N].
  double gravity = 9.81;  ///< Gravity of HoldLoad::Lift, on the object alone, along −z of O [m/s²].
  double lift_height = 0.1;     ///< Height by which HoldLoad::Lift lifts [m].
  double lift_time = 0.4;       ///< Duration of the lift [s].
  double hold_time = 2.0;       ///< Duration of the phase under load, lifting included [s].
  double check_interval = 0.2;  ///< Time between checks of the object's pose [s].
  double largest_shift = 0.05;  ///< Displacement of the center of mass from the squeezed pose, in
                                ///< the palm's frame [m], from which on the grasp fails; it also
                                ///< fails where the object gets as far from its planned pose before
                                ///< the load.
  double largest_turn = 0.26179938779914941;  ///< Rotation of the object from which on the grasp
                                              ///< fails alike [rad] (15°).
  double largest_penetration = 0.01;  ///< Largest penetration of hand and object or hand and hand
                                      ///< at the pre-grasp [m]: a deeper one is rejected untested.

  void validate() const;  ///< Throws InvalidInput naming the field and its value.

  /// Whether `HoldTest::margin` finds margins: six loads, each from the same state.
  bool has_margins() const { return load == HoldLoad::SixForces; }
};

/// Names of the shipped protocols: dexgraspbench-100g (the default), dexonomy-hard, gendexgrasp,
/// dro, tabletop-lift.
const std::vector<std::string>& hold_protocol_names();

/// Returns the shipped protocol of that name, or of a former one (multidex-0.05g is gendexgrasp).
/// @throws InvalidInput that lists the names there are,
/// if there is none of that name.
HoldProtocol hold_protocol(const std::string& name);

}  // namespace graspfit::hold_test
