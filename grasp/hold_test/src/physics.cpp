#include "physics.hpp"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>

#include "graspfit/base/errors.hpp"
#include "import/mujoco_model.hpp"
#include "scene_text.hpp"

namespace graspfit::hold_test::internal {

using geometry::RigidTransform;
using hands::internal::MujocoMessages;

namespace {

struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// Warnings of the engine after which a simulation means nothing.
constexpr std::array kFatalWarnings = {mjWARN_CONTACTFULL, mjWARN_CNSTRFULL, mjWARN_BADQPOS,
                                       mjWARN_BADQVEL, mjWARN_BADQACC};

/// How many times stiffer and more damped the drive of a follower that broke away is than those of
/// joints that press. Such a drive does not give way, like a worm gear (Barrett's); the squeeze
/// assumes this, as it asks no torque of such a joint.
constexpr double kLockedFactor = 50.0;

Eigen::Quaterniond quaternion(const mjtNum* wxyz) {
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
}

void set_quaternion(mjtNum* wxyz, const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  const std::array values = {q.w(), q.x(), q.y(), q.z()};
  std::copy(values.begin(), values.end(), wxyz);
}

hands::internal::MujocoModel load(const HoldHand& hand, const HoldObject& object,
                                  const HoldProtocol& protocol) {
  try {
    return hands::internal::load_mujoco_text("hold_test.xml", scene_text(hand, object, protocol));
  } catch (const base::IoError& error) {
    throw base::InvalidInput("HoldTest: hand " + hand.model.name + ": " + error.what());
  }
}

}  // namespace

struct Physics::Engine {
  Engine(const HoldHand& hold_hand, const HoldObject& object, const HoldProtocol& protocol)
      : hand(hold_hand.model), center_O(object.center_of_mass_O) {
    loaded = load(hold_hand, object, protocol);
    model = loaded.model.get();
    const MujocoMessages messages;
    data.reset(mj_makeData(model));
    object_body = mj_name2id(model, mjOBJ_BODY, "object");
    palm_body = body_of_link(hand.palm.link);
    link_of_body.resize(model->nbody);
    for (int link = 0; link < std::ssize(hand.links); ++link) {
      link_of_body[body_of_link(link)] = link;
    }
    const int object_joint = model->body_jntadr[object_body];
    object_position = model->jnt_qposadr[object_joint];
    const int object_dof = model->jnt_dofadr[object_joint];
    for (int i = 0; i < 3; ++i) {
      model->dof_damping[object_dof + i] = protocol.object_linear_damping * protocol.object_mass;
      model->dof_damping[object_dof + 3 + i] =
          protocol.object_angular_damping * protocol.object_mass * object.inertia_per_mass_O(i, i);
    }
    for (int j = 0; j < std::ssize(hand.joints); ++j) {
      const std::string name = joint_name(j);
      joints.push_back({model->jnt_qposadr[mj_name2id(model, mjOBJ_JOINT, name.c_str())],
                        mj_name2id(model, mjOBJ_ACTUATOR, name.c_str()),
                        mj_name2id(model, mjOBJ_EQUALITY, name.c_str()),
                        model->jnt_dofadr[mj_name2id(model, mjOBJ_JOINT, name.c_str())], 0.0, 0.0});
      JointIds& ids = joints.back();
      ids.damping = model->dof_damping[ids.dof];
      if (ids.actuator >= 0) ids.stiffness = model->actuator_gainprm[mjNGAIN * ids.actuator];
    }
    lift = mj_name2id(model, mjOBJ_ACTUATOR, "lift");
  }

  int body_of_link(int link) const {
    return mj_name2id(model, mjOBJ_BODY, link_name(link).c_str());
  }

  /// Sets the stiffness of a position actuator, whose force is kp (command − position).
  void set_stiffness(int actuator, double kp) {
    model->actuator_gainprm[mjNGAIN * actuator] = kp;
    model->actuator_biasprm[mjNBIAS * actuator + 1] = -kp;
  }

  std::optional<int> link_of_geom(int geom) const { return link_of_body[model->geom_bodyid[geom]]; }

  struct JointIds {
    int position;  ///< In qpos.
    int actuator;  ///< −1: none.
    int equality;  ///< −1: none.
    int dof;
    double stiffness;
    double damping;
  };

  const hands::HandModel hand;
  const Eigen::Vector3d center_O;
  hands::internal::MujocoModel loaded;
  mjModel* model = nullptr;
  std::unique_ptr<mjData, DataDeleter> data;
  int object_body = -1;
  int object_position = -1;
  int palm_body = -1;
  int lift = -1;
  std::vector<JointIds> joints;
  std::vector<std::optional<int>> link_of_body;
};

Physics::Physics(const HoldHand& hand, const HoldObject& object, const HoldProtocol& protocol)
    : engine_(std::make_unique<Engine>(hand, object, protocol)) {}
Physics::~Physics() = default;

void Physics::reset(const hands::HandConfiguration& start, const std::vector<bool>& follows) {
  const MujocoMessages messages;
  Engine& e = *engine_;
  mj_resetData(e.model, e.data.get());
  for (std::size_t j = 0; j < e.joints.size(); ++j) {
    const Engine::JointIds& ids = e.joints[j];
    e.data->qpos[ids.position] = start.q[j];
    if (ids.equality < 0) continue;
    e.model->eq_active[ids.equality] = follows[j] ? 1 : 0;
    if (ids.actuator < 0) continue;
    e.set_stiffness(ids.actuator, follows[j] ? 0.0 : kLockedFactor * ids.stiffness);
    e.model->dof_damping[ids.dof] = (follows[j] ? 1.0 : kLockedFactor) * ids.damping;
  }
  command(start);
  mj_forward(e.model, e.data.get());
}

void Physics::command(const hands::HandConfiguration& to) {
  Engine& e = *engine_;
  for (int i = 0; i < 3; ++i) e.model->body_pos[3 * e.palm_body + i] = to.X_OH.translation()[i];
  set_quaternion(e.model->body_quat + 4 * e.palm_body, to.X_OH.linear());
  for (std::size_t j = 0; j < e.joints.size(); ++j) {
    const int actuator = e.joints[j].actuator;
    if (actuator >= 0) e.data->ctrl[actuator] = to.q[j];
  }
}

void Physics::command_lift(double height) { engine_->data->ctrl[engine_->lift] = height; }

void Physics::set_load(const Eigen::Vector3d& force_O, const Eigen::Vector3d& torque_O) {
  mjtNum* load = engine_->data->xfrc_applied + 6 * engine_->object_body;
  for (int i = 0; i < 3; ++i) {
    load[i] = force_O[i];
    load[3 + i] = torque_O[i];
  }
}

std::string Physics::step() {
  const MujocoMessages messages;
  try {
    mj_step(engine_->model, engine_->data.get());
  } catch (const hands::internal::MujocoError& error) {
    return error.what();
  }
  for (const mjtWarning warning : kFatalWarnings) {
    if (engine_->data->warning[warning].number == 0) continue;
    const bool is_full = warning == mjWARN_CONTACTFULL || warning == mjWARN_CNSTRFULL;
    return is_full ? "more contacts than the engine has room for" : "the simulation diverged";
  }
  return {};
}

double Physics::time() const { return engine_->data->time; }

RigidTransform Physics::X_OB() const {
  const Engine& e = *engine_;
  const mjtNum* position = e.data->qpos + e.object_position;
  RigidTransform X_OC = RigidTransform::Identity();
  X_OC.translation() = Eigen::Vector3d(position[0], position[1], position[2]);
  X_OC.linear() = quaternion(position + 3).toRotationMatrix();
  return X_OC * Eigen::Translation3d(-e.center_O);
}

hands::HandConfiguration Physics::hand() const {
  const Engine& e = *engine_;
  hands::HandConfiguration result;
  const mjtNum* palm = e.model->body_pos + 3 * e.palm_body;
  result.X_OH.translation() = Eigen::Vector3d(palm[0], palm[1], palm[2]);
  if (e.lift >= 0) {
    const int lift_joint = e.model->actuator_trnid[2 * e.lift];
    result.X_OH.translation().z() += e.data->qpos[e.model->jnt_qposadr[lift_joint]];
  }
  result.X_OH.linear() = quaternion(e.model->body_quat + 4 * e.palm_body).toRotationMatrix();
  result.q.resize(std::ssize(e.joints));
  for (std::size_t j = 0; j < e.joints.size(); ++j) {
    result.q[j] = e.data->qpos[e.joints[j].position];
  }
  return result;
}

double Physics::squeeze_force() const {
  const Engine& e = *engine_;
  double sum = 0.0;
  for (int i = 0; i < e.data->ncon; ++i) {
    const mjContact& contact = e.data->contact[i];
    const int body_1 = e.model->geom_bodyid[contact.geom1];
    const int body_2 = e.model->geom_bodyid[contact.geom2];
    const bool is_object = body_1 == e.object_body || body_2 == e.object_body;
    const bool is_hand = e.link_of_geom(contact.geom1) || e.link_of_geom(contact.geom2);
    if (!is_object || !is_hand || contact.efc_address < 0) continue;
    std::array<mjtNum, 6> force{};
    mj_contactForce(e.model, e.data.get(), i, force.data());
    sum += force[0];
  }
  return sum;
}

Physics::Overlap Physics::deepest_overlap() const {
  const Engine& e = *engine_;
  Overlap deepest;
  for (int i = 0; i < e.data->ncon; ++i) {
    const mjContact& contact = e.data->contact[i];
    std::optional<int> a = e.link_of_geom(contact.geom1);
    std::optional<int> b = e.link_of_geom(contact.geom2);
    if (!a) std::swap(a, b);
    if (!a || -contact.dist <= deepest.depth) continue;
    deepest = {-contact.dist, *a, b};
  }
  return deepest;
}

Physics::State Physics::state() const {
  const mjModel& m = *engine_->model;
  const mjData& d = *engine_->data;
  return {d.time,
          {d.qpos, d.qpos + m.nq},
          {d.qvel, d.qvel + m.nv},
          {d.ctrl, d.ctrl + m.nu},
          {d.qacc_warmstart, d.qacc_warmstart + m.nv}};
}

void Physics::restore(const State& state) {
  const MujocoMessages messages;
  Engine& e = *engine_;
  mj_resetData(e.model, e.data.get());
  e.data->time = state.time;
  std::copy(state.positions.begin(), state.positions.end(), e.data->qpos);
  std::copy(state.velocities.begin(), state.velocities.end(), e.data->qvel);
  std::copy(state.controls.begin(), state.controls.end(), e.data->ctrl);
  std::copy(state.warm_start.begin(), state.warm_start.end(), e.data->qacc_warmstart);
}

}  // namespace graspfit::hold_test::internal
