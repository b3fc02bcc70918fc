#include "graspfit/hold_test/hold_protocol.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <string_view>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"

namespace graspfit::hold_test {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

HoldProtocol dexgraspbench() {
  HoldProtocol protocol;
  protocol.name = "dexgraspbench-100g";
  protocol.source =
      "DexGraspBench (JYChen18/DexGraspBench, main; BODex, ICRA 2025): step, friction, contact "
      "parameters of the hand, impratio, noslip, mass, 10 N/kg along six axes, times, checks, "
      "penetration. Dexonomy (JYChen18/Dexonomy, op/eval.yaml): 5 cm and 15 degrees. Ours: base "
      "fixed instead of welded to a mocap body, displacement from the squeezed pose in the palm's "
      "frame, multi-point contacts, armature, integrator implicit (implicitfast there)";
  return protocol;
}

HoldProtocol dexonomy_hard() {
  HoldProtocol protocol = dexgraspbench();
  protocol.name = "dexonomy-hard";
  protocol.source =
      "Dexonomy (JYChen18/Dexonomy, op/eval.yaml, hard: noslip 0, impratio 1, half the tangential "
      "and a tenth of the torsional friction; 9.8 N/kg). The rest as dexgraspbench-100g";
  protocol.sliding_friction = 0.3;
  protocol.torsional_friction = 0.002;
  protocol.impratio = 1.0;
  protocol.noslip_iterations = 0;
  protocol.force = 0.98;
  return protocol;
}

HoldProtocol gendexgrasp() {
  HoldProtocol protocol = dexgraspbench();
  protocol.name = "gendexgrasp";
  protocol.source =
      "GenDexGrasp (tengyu-liu/GenDexGrasp, envs/tasks/grasp_test_force.yaml): 0.5 m/s2 along six "
      "axes (5000 N/m3 at 10000 kg/m3) for 50 steps of 1/60 s, 2 cm and any rotation, checked at "
      "the end, friction 10, object damping 10 and 100 1/s. Ours: MuJoCo instead of PhysX and its "
      "contact parameters, 0.1 kg instead of the density, pre-grasp and squeeze, a reset before "
      "each force";
  protocol.sliding_friction = 10.0;
  protocol.object_linear_damping = 10.0;
  protocol.object_angular_damping = 100.0;
  protocol.force = 0.05;
  protocol.hold_time = 50.0 / 60.0;
  protocol.check_interval = 50.0 / 60.0;
  protocol.largest_shift = 0.02;
  protocol.largest_turn = kTwoPi;
  return protocol;
}

HoldProtocol dro() {
  HoldProtocol protocol = dexgraspbench();
  protocol.name = "dro";
  protocol.source =
      "D(R,O) (zhenyuwei2003/DRO-Grasp, validation/isaac_validator.py, utils/controller.py): "
      "friction 3, density 500 kg/m3, no gravity, joints from a quarter of the way to the limit on "
      "the opening side to 0.15 of it on the closing side in 1 s, then 0.5 N/kg along +x +y +z -x "
      "-y -z for 1 s each without a reset, 2 cm and any rotation, checked at the end. Ours: MuJoCo "
      "instead of PhysX and its contact parameters, base fixed instead of on drives, kp 5 N m/rad "
      "instead of 1000 up to the limits of the hand files used there, commands that move instead "
      "of jump, joints close to the side that the hand's description says (there: toward the "
      "object's origin), lost, too, what is moved by 2 cm before the load";
  protocol.load = HoldLoad::SixInTurn;
  protocol.squeeze = SqueezeRule::Limits;
  protocol.sliding_friction = 3.0;
  protocol.object_density = 500.0;
  protocol.object_mass = 1.0;
  protocol.force = 0.5;
  protocol.approach_time = 0.5;
  protocol.squeeze_time = 0.5;
  protocol.hold_time = 6.0;
  protocol.check_interval = 6.0;
  protocol.largest_shift = 0.02;
  protocol.largest_turn = kTwoPi;
  return protocol;
}

HoldProtocol tabletop_lift() {
  HoldProtocol protocol = dexgraspbench();
  protocol.name = "tabletop-lift";
  protocol.source =
      "DexGraspBench (eval_func/tabletop_mocap.py): 10 N/kg from the start, 0.1 m up in 0.4 s, 5 "
      "cm and 15 degrees. Ours: the base on a slide instead of a mocap body, the table at the "
      "object's lowest point along z of O, on which the corners of its hull up to 1 mm higher "
      "stand beside its pieces, 0.6 s held after lifting. The rest as dexgraspbench-100g";
  protocol.load = HoldLoad::Lift;
  protocol.gravity = 10.0;
  protocol.hold_time = 1.0;
  return protocol;
}

const std::vector<HoldProtocol>& protocols() {
  static const std::vector<HoldProtocol> all = {dexgraspbench(), dexonomy_hard(), gendexgrasp(),
                                                dro(), tabletop_lift()};
  return all;
}

void require(bool is_met, std::string_view field, double value, std::string_view rule) {
  if (is_met && std::isfinite(value)) return;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << "HoldProtocol: " << field << " is " << value << "; it must be " << rule;
  throw base::InvalidInput(message.str());
}

}  // namespace

void HoldProtocol::validate() const {
  const auto positive = [](double value, std::string_view field) {
    require(value > 0.0, field, value, "finite and > 0");
  };
  const auto not_negative = [](double value, std::string_view field) {
    require(value >= 0.0, field, value, "finite and >= 0");
  };
  require(step >= kShortestStep, "step", step, "finite and >= 1e-05");
  not_negative(sliding_friction, "sliding_friction");
  not_negative(torsional_friction, "torsional_friction");
  positive(impratio, "impratio");
  not_negative(noslip_iterations, "noslip_iterations");
  for (const auto* solimp : {&hand_solimp, &object_solimp}) {
    for (const double value : *solimp) {
      require(value > 0.0 && value <= 1.0, "solimp", value, "in (0, 1]");
    }
  }
  for (const auto* solref : {&hand_solref, &object_solref}) {
    for (const double value : *solref) positive(value, "solref");
  }
  positive(object_mass, "object_mass");
  not_negative(object_density, "object_density");
  not_negative(object_linear_damping, "object_linear_damping");
  not_negative(object_angular_damping, "object_angular_damping");
  positive(stiffness, "stiffness");
  positive(slide_stiffness, "slide_stiffness");
  not_negative(damping_time, "damping_time");
  not_negative(armature, "armature");
  not_negative(slide_armature, "slide_armature");
  positive(link_density, "link_density");
  not_negative(extrapolation, "extrapolation");
  for (const auto& [share, field] :
       {std::pair(opening_share, "opening_share"), {closing_share, "closing_share"}}) {
    require(share >= 0.0 && share <= 1.0, field, share, "in [0, 1]");
  }
  const auto require_time = [](double time, double least, std::string_view field,
                               std::string_view rule) {
    require(time >= least && time <= kLongestTime, field, time, rule);
  };
  require_time(approach_time, step, "approach_time", "in [step, 1000]");
  require_time(squeeze_time, step, "squeeze_time", "in [step, 1000]");
  not_negative(force, "force");
  not_negative(gravity, "gravity");
  positive(lift_height, "lift_height");
  require_time(lift_time, step, "lift_time", "in [step, 1000]");
  require_time(hold_time, load == HoldLoad::Lift ? lift_time : step, "hold_time",
               "in [step, 1000], of a protocol that lifts >= lift_time");
  require_time(check_interval, step, "check_interval", "in [step, 1000]");
  positive(largest_shift, "largest_shift");
  positive(largest_turn, "largest_turn");
  not_negative(largest_penetration, "largest_penetration");
}

const std::vector<std::string>& hold_protocol_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const HoldProtocol& protocol : protocols()) result.push_back(protocol.name);
    return result;
  }();
  return names;
}

HoldProtocol hold_protocol(const std::string& name) {
  const std::string today = name == "multidex-0.05g" ? "gendexgrasp" : name;
  for (const HoldProtocol& protocol : protocols()) {
    if (protocol.name == today) return protocol;
  }
  throw base::InvalidInput("hold_protocol: no protocol \"" + name + "\"; there are " +
                           base::list_text(protocols(), &HoldProtocol::name));
}

}  // namespace graspfit::hold_test
