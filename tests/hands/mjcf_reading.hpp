#pragma once

#include <dlfcn.h>
#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <locale>
#include <map>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "description/joint_motion.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "import/mjcf.hpp"
#include "import/urdf.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

/// \file
/// Reads MJCF, and computes MuJoCo's own kinematics of the same file.

namespace graspfit::testing {

using base::InvalidInput;
using base::IoError;
using Eigen::Vector3d;
using geometry::RigidTransform;
using hands::FindingKind;
using hands::internal::DescribedJoint;
using hands::internal::DescribedLink;
using hands::internal::Findings;
using hands::internal::RobotDescription;
namespace fs = std::filesystem;

inline constexpr double kPi = std::numbers::pi;

struct Reading {
  RobotDescription robot;
  std::vector<hands::HandFinding> findings;

  const DescribedJoint& joint(const std::string& name) const {
    for (const DescribedJoint& joint : robot.joints) {
      if (joint.name == name) return joint;
    }
    FAIL("no joint " << name);
    throw 0;
  }
  const DescribedLink& link(const std::string& name) const {
    for (const DescribedLink& link : robot.links) {
      if (link.name == name) return link;
    }
    FAIL("no link " << name);
    throw 0;
  }
  bool has(FindingKind kind, const std::string& words) const {
    for (const hands::HandFinding& finding : findings) {
      if (finding.kind == kind && (finding.item + ": " + finding.what).find(words) != words.npos) {
        return true;
      }
    }
    return false;
  }
};

inline Reading read(const fs::path& file) {
  Findings findings(Findings::AtFault::Throw);
  Reading reading;
  reading.robot = hands::internal::parse_mjcf(base::read_file(file), file, findings);
  reading.findings = findings.list();
  return reading;
}

/// Returns MJCF with angles in radians and limits where there is a range.
inline std::string mjcf(const std::string& worldbody, const std::string& rest = "") {
  return "<mujoco model=\"test\"><compiler angle=\"radian\" autolimits=\"true\"/>" + rest +
         "<worldbody>" + worldbody + "</worldbody></mujoco>";
}

using Positions = std::map<std::string, double>;
using Poses = std::map<std::string, RigidTransform>;

/// Returns poses of the links in the root's frame, joint by joint; joints that `q` leaves out are
/// at 0.
inline Poses link_poses(const RobotDescription& robot, const Positions& q) {
  Poses poses;
  for (const DescribedLink& link : robot.links) poses[link.name] = RigidTransform::Identity();
  for (const DescribedJoint& joint : robot.joints) poses.erase(joint.child);
  REQUIRE(poses.size() == 1);
  while (poses.size() < robot.links.size()) {
    const std::size_t before = poses.size();
    for (const DescribedJoint& joint : robot.joints) {
      const auto parent = poses.find(joint.parent);
      if (parent == poses.end() || poses.contains(joint.child)) continue;
      const double position = q.contains(joint.name) ? q.at(joint.name) : 0.0;
      poses[joint.child] = parent->second * joint.X_PJ * joint_motion(joint, position);
    }
    REQUIRE(poses.size() > before);
  }
  return poses;
}

/// Computes MuJoCo's own kinematics.
class Mujoco {
 public:
  explicit Mujoco(const fs::path& file) {
    std::array<char, 1000> error{};
    model_ = mj_loadXML(file.c_str(), nullptr, error.data(), 1000);
    CAPTURE(error.data());
    REQUIRE(model_ != nullptr);
    data_ = mj_makeData(model_);
  }
  ~Mujoco() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  Mujoco(const Mujoco&) = delete;
  Mujoco& operator=(const Mujoco&) = delete;

  const mjModel& model() const { return *model_; }

  void set(const Positions& q) {
    mj_resetData(model_, data_);
    for (const auto& [name, position] : q) {
      const int joint = mj_name2id(model_, mjOBJ_JOINT, name.c_str());
      REQUIRE(joint >= 0);
      data_->qpos[model_->jnt_qposadr[joint]] = position;
    }
    mj_kinematics(model_, data_);
  }

  /// Returns poses of the named bodies in the frame of one of them.
  Poses poses(const std::string& root) const {
    const RigidTransform X_RW = pose(mj_name2id(model_, mjOBJ_BODY, root.c_str())).inverse();
    Poses result;
    for (int body = 0; body < model_->nbody; ++body) {
      const char* name = mj_id2name(model_, mjOBJ_BODY, body);
      if (name && *name) result[name] = X_RW * pose(body);
    }
    return result;
  }

  /// Returns by how much active equality constraints are missed at the position that was set.
  std::vector<double> missed() {
    mj_fwdPosition(model_, data_);
    return {data_->efc_pos, data_->efc_pos + data_->ne};
  }

 private:
  RigidTransform pose(int body) const {
    RigidTransform X = RigidTransform::Identity();
    X.translation() = Eigen::Map<const Vector3d>(data_->xpos + 3 * body);
    X.linear() =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * body);
    return X;
  }

  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

inline Positions random_positions(const RobotDescription& robot, base::Random& random) {
  Positions q;
  for (const DescribedJoint& joint : robot.joints) {
    if (joint.type == DescribedJoint::Type::Fixed) continue;
    q[joint.name] = random.uniform(joint.lower, joint.upper);
  }
  return q;
}

/// Returns the largest difference of two poses' entries: of a position [m] or of a rotation matrix.
inline double largest_difference(const RigidTransform& X, const RigidTransform& Y) {
  return (X.matrix() - Y.matrix()).cwiseAbs().maxCoeff();
}

/// Returns the largest difference over the names that both have, at least `least` of them.
inline double largest_difference(const Poses& some, const Poses& others, std::size_t least) {
  double largest = 0.0;
  std::size_t shared = 0;
  for (const auto& [name, X] : some) {
    const auto other = others.find(name);
    if (other == others.end()) continue;
    ++shared;
    largest = std::max(largest, largest_difference(X, other->second));
  }
  REQUIRE(shared >= least);
  return largest;
}

// Two fingers on a palm from which tests start.
const std::string kTwoFingers = R"(
  <body name="palm"><geom type="box" size=".1 .1 .01"/>
    <body name="a" pos=".1 0 0"><joint name="ja" axis="0 1 0" range="0 1"/><geom size=".01"/>
      <body name="b" pos="0 0 .05"><joint name="jb" axis="0 1 0" range="0 2" ref=".25"/><geom size=".01"/></body></body>
    <body name="c" pos="-.1 0 0"><joint name="jc" axis="0 1 0" range="-1 0" ref="-.5"/><geom size=".01"/></body>
  </body>)";

/// Returns a tree of bodies with up to three joints each; frames, anchors, axes and refs are
/// random.
inline std::string random_tree(std::uint64_t seed) {
  base::Random random(seed);
  std::ostringstream text;
  text << std::setprecision(17);
  const auto numbers = [&](const char* name, int count) {
    text << ' ' << name << "=\"";
    for (int i = 0; i < count; ++i) text << random.uniform(-1.0, 1.0) << ' ';
    text << '"';
  };
  constexpr int kBodies = 8;
  std::array<std::vector<int>, kBodies> children;
  for (int b = 1; b < kBodies; ++b) {
    children[random.index(static_cast<std::uint64_t>(b))].push_back(b);
  }
  const auto body = [&](const auto& self, int b) -> void {
    text << "<body name=\"b" << b << '"';
    numbers("pos", 3);
    numbers("quat", 4);
    text << "><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>";
    // The first body below the root has a joint, so that there is one.
    const int joints = b == 0 ? 0 : b == 1 ? 2 : static_cast<int>(random.index(4));
    for (int j = 0; j < joints; ++j) {
      const bool slides = random.index(3) == 0;
      text << "<joint name=\"j" << b << '_' << j << "\" range=\"-3 2\" type=\""
           << (slides ? "slide" : "hinge") << '"';
      numbers("axis", 3);
      if (random.index(2) == 0) numbers("pos", 3);
      if (random.index(2) == 0) numbers("ref", 1);
      text << "/>";
    }
    for (const int child : children[static_cast<std::size_t>(b)]) self(self, child);
    text << "</body>";
  };
  body(body, 0);
  return mjcf(text.str());
}

}  // namespace graspfit::testing
