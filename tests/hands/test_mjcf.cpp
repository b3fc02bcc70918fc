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

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "internal/joint_motion.hpp"
#include "internal/mjcf.hpp"
#include "internal/urdf.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using geometry::InvalidInput;
using geometry::IoError;
using geometry::RigidTransform;
using hands::FindingKind;
using hands::internal::DescribedJoint;
using hands::internal::DescribedLink;
using hands::internal::Findings;
using hands::internal::RobotDescription;
namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;

struct TemporaryFolder : testing::TemporaryFolder {
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((path() / name).parent_path());
    geometry::write_file_atomically(path() / name, text);
    return path() / name;
  }
};

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

Reading read(const fs::path& file) {
  Findings findings(Findings::AtFault::Throw);
  Reading reading;
  reading.robot = hands::internal::parse_mjcf(geometry::read_file(file), file, findings);
  reading.findings = findings.list();
  return reading;
}

/// Angles in radians, limits where there is a range.
std::string mjcf(const std::string& worldbody, const std::string& rest = "") {
  return "<mujoco model=\"test\"><compiler angle=\"radian\" autolimits=\"true\"/>" + rest +
         "<worldbody>" + worldbody + "</worldbody></mujoco>";
}

using Positions = std::map<std::string, double>;
using Poses = std::map<std::string, RigidTransform>;

/// Poses of the links in the root's frame, joint by joint; joints that `q` leaves out are at 0.
Poses link_poses(const RobotDescription& robot, const Positions& q) {
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

/// MuJoCo's own kinematics.
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

  /// Poses of the named bodies in the frame of one of them.
  Poses poses(const std::string& root) const {
    const RigidTransform X_RW = pose(mj_name2id(model_, mjOBJ_BODY, root.c_str())).inverse();
    Poses result;
    for (int body = 0; body < model_->nbody; ++body) {
      const char* name = mj_id2name(model_, mjOBJ_BODY, body);
      if (name && *name) result[name] = X_RW * pose(body);
    }
    return result;
  }

  /// By how much active equality constraints are missed at the position that was set.
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

Positions random_positions(const RobotDescription& robot, geometry::Random& random) {
  Positions q;
  for (const DescribedJoint& joint : robot.joints) {
    if (joint.type == DescribedJoint::Type::Fixed) continue;
    q[joint.name] = random.uniform(joint.lower, joint.upper);
  }
  return q;
}

/// The largest difference of two poses' entries: of a position [m] or of a rotation matrix.
double largest_difference(const RigidTransform& X, const RigidTransform& Y) {
  return (X.matrix() - Y.matrix()).cwiseAbs().maxCoeff();
}

/// Over the names that both have, at least `least` of them.
double largest_difference(const Poses& some, const Poses& others, std::size_t least) {
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

// Two fingers on a palm, as a start.
const std::string kTwoFingers = R"(
  <body name="palm"><geom type="box" size=".1 .1 .01"/>
    <body name="a" pos=".1 0 0"><joint name="ja" axis="0 1 0" range="0 1"/><geom size=".01"/>
      <body name="b" pos="0 0 .05"><joint name="jb" axis="0 1 0" range="0 2" ref=".25"/><geom size=".01"/></body></body>
    <body name="c" pos="-.1 0 0"><joint name="jc" axis="0 1 0" range="-1 0" ref="-.5"/><geom size=".01"/></body>
  </body>)";

TEST_CASE("MJCF: includes, defaults, degrees and frames come out as written", "[hands][mjcf]") {
  const TemporaryFolder folder;
  folder.write("deep/finger.xml", R"(<mujocoinclude>
    <body name="finger" pos=".1 .2 .3" euler="0 90 30">
      <joint name="bend" class="finger"/>
      <geom class="finger"/><geom type="sphere" size=".01" pos="0 0 .1"/>
    </body></mujocoinclude>)");
  const Reading reading = read(folder.write("hand.xml", R"(
    <mujoco model="pinch">
      <compiler angle="degree" eulerseq="zyx" autolimits="true"/>
      <default><geom contype="0" conaffinity="0"/>
        <default class="finger">
          <joint axis="0 3 4" range="-30 90"/><geom type="box" size=".01 .02 .03" contype="1"/>
        </default>
      </default>
      <worldbody><body name="palm"><include file="deep/finger.xml"/></body></worldbody>
    </mujoco>)"));
  CHECK(reading.robot.name == "pinch");
  REQUIRE(reading.robot.links.size() == 2);
  CHECK(reading.robot.links[0].name == "palm");
  const DescribedJoint& bend = reading.joint("bend");
  CHECK(bend.type == DescribedJoint::Type::Revolute);
  CHECK(bend.parent == "palm");
  CHECK(bend.child == "finger");
  CHECK((bend.axis - Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
  CHECK(bend.lower == Approx(-kPi / 6).epsilon(1e-15));
  CHECK(bend.upper == Approx(kPi / 2).epsilon(1e-15));
  // Turned about z by 0, then about the new y by 90, then about the new x by 30 degrees: x looks
  // down, y lies in the parent's x-y plane.
  CHECK((bend.X_PJ.translation() - Vector3d(0.1, 0.2, 0.3)).norm() < 1e-15);
  CHECK((bend.X_PJ.linear().col(0) - Vector3d(0, 0, -1)).norm() < 1e-15);
  CHECK((bend.X_PJ.linear().col(1) - Vector3d(0.5, std::sqrt(0.75), 0)).norm() < 1e-15);
  const DescribedLink& finger = reading.link("finger");
  REQUIRE(finger.collision.size() == 1);
  CHECK(std::get<hands::internal::BoxShape>(finger.collision[0].shape).size ==
        Vector3d(0.02, 0.04, 0.06));
  REQUIRE(finger.visual.size() == 1);
  CHECK(std::get<hands::internal::SphereShape>(finger.visual[0].shape).radius == 0.01);
  CHECK(finger.visual[0].X_LG.translation() == Vector3d(0, 0, 0.1));
}

TEST_CASE("MJCF: a joint's anchor and ref move the link as MuJoCo does", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const Reading reading = read(folder.write("hand.xml", mjcf(R"(
    <body name="palm">
      <body name="f" pos="0 0 1">
        <joint name="turn" axis="0 0 1" pos=".1 0 5" ref=".5" range="0 3"/>
        <joint name="slide" type="slide" axis="1 0 0" ref=".02" range="0 .1"/>
        <geom size=".01"/>
      </body>
      <body><joint axis="0 0 2" pos="0 0 7"/><geom size=".01"/></body>
    </body>)")));
  CHECK(reading.joint("turn").child == "f__turn");
  CHECK(reading.joint("slide").parent == "f__turn");
  CHECK(reading.joint("slide").child == "f");
  CHECK(!reading.link("f__turn").inertia.has_value());
  // An anchor on the axis through the origin is none; an unlimited hinge makes one turn.
  const DescribedJoint& free = reading.joint("body_3_joint");
  CHECK(free.child == "body_3");
  CHECK(free.type == DescribedJoint::Type::Continuous);
  CHECK(free.lower == -kPi);
  CHECK(free.upper == kPi);
  // A quarter turn beyond ref about (0.1, 0): the origin goes to (0.1, -0.1), x becomes y; then
  // 3 cm along that.
  const RigidTransform X =
      link_poses(reading.robot, {{"turn", 0.5 + kPi / 2}, {"slide", 0.05}}).at("f");
  CHECK((X.translation() - Vector3d(0.1, -0.07, 1.0)).norm() < 1e-15);
  CHECK((X.linear().col(0) - Vector3d(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("MJCF: geoms of every kind become the shapes that they are", "[hands][mjcf]") {
  const TemporaryFolder folder;
  // A tetrahedron of volume 1/6 beside the origin, as OBJ with two normals per corner.
  folder.write("package.xml", "");
  folder.write("meshes/corner.obj",
               "v 2 0 0\nv 3 0 0\nv 2 1 0\nv 2 0 1\nvn 0 0 -1\nvn 1 0 0\n"
               "f 1//1 3//1 2//1\nf 1//2 2//2 4//2\nf 1//2 4//1 3//1\nf 2//1 3//2 4//2\n");
  folder.write("robot/assets.xml",
               R"(<assets><mesh name="m" file="corner.obj" scale=".1 .1 .2"/></assets>)");
  const Reading reading = read(folder.write("robot/hand.xml", R"(
    <mujoco><compiler angle="radian" meshdir="../meshes"/>
      <asset><include file="assets.xml"/></asset>
      <worldbody><body name="palm">
        <geom type="sphere" size=".01" pos="1 2 3"/>
        <geom type="capsule" fromto="0 0 0 0 .2 0" size=".02"/>
        <geom type="cylinder" size=".03 .04"/>
        <geom type="ellipsoid" size=".01 .02 .03"/>
        <geom type="box" size=".01 .02 .03" quat=".6 0 0 .8"/>
        <geom type="mesh" mesh="m" pos="0 0 .5"/>
        <geom type="plane" size="1 1 1"/>
        <body name="f"><joint axis="0 0 1"/><geom size=".1"/></body>
      </body></worldbody></mujoco>)"));
  using namespace hands::internal;
  const auto& parts = reading.link("palm").collision;
  REQUIRE(parts.size() == 6);
  CHECK(std::get<SphereShape>(parts[0].shape).radius == 0.01);
  CHECK(parts[0].X_LG.translation() == Vector3d(1, 2, 3));
  CHECK(std::get<CapsuleShape>(parts[1].shape).radius == 0.02);
  CHECK(std::get<CapsuleShape>(parts[1].shape).length == Approx(0.2).epsilon(1e-15));
  CHECK((parts[1].X_LG.translation() - Vector3d(0, 0.1, 0)).norm() < 1e-15);
  CHECK(std::abs(parts[1].X_LG.linear()(1, 2)) == Approx(1.0).epsilon(1e-15));
  CHECK(std::get<CylinderShape>(parts[2].shape).length == 0.08);
  CHECK(std::get<EllipsoidShape>(parts[3].shape).radii == Vector3d(0.01, 0.02, 0.03));
  CHECK(std::get<BoxShape>(parts[4].shape).size == Vector3d(0.02, 0.04, 0.06));
  CHECK((parts[4].X_LG.linear().col(0) - Vector3d(-0.28, 0.96, 0)).norm() < 1e-15);
  CHECK(reading.has(FindingKind::Note, "link palm: its planes"));
  CHECK(reading.has(FindingKind::Note, "single precision"));

  // The mesh lies where the file says, though MuJoCo keeps it about its center of mass.
  const auto& loaded = std::get<LoadedMeshShape>(parts[5].shape);
  CHECK(loaded.filename == "../meshes/corner.obj");
  REQUIRE(loaded.mesh.vertices.size() == 4);
  REQUIRE(loaded.mesh.faces.size() == 4);
  const geometry::TriangleMesh mesh_L = geometry::transformed(loaded.mesh, parts[5].X_LG);
  const std::array<Vector3d, 4> corners = {Vector3d(0.2, 0, 0.5), Vector3d(0.3, 0, 0.5),
                                           Vector3d(0.2, 0.1, 0.5), Vector3d(0.2, 0, 0.7)};
  for (const Vector3d& corner : corners) {
    double nearest = 1.0;
    for (const Vector3d& v : mesh_L.vertices) nearest = std::min(nearest, (v - corner).norm());
    CHECK(nearest < 1e-7);  // single precision of 0.3 m is 3e-8
  }
  CHECK(geometry::signed_volume(mesh_L) == Approx(0.1 * 0.1 * 0.2 / 6).epsilon(1e-5));
}

TEST_CASE("MJCF: masses and inertias are turned into the link's frame", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const Reading reading = read(folder.write("hand.xml", mjcf(R"(
    <body name="palm"><geom type="box" size=".1 .2 .3" density="100"/>
      <body name="f"><joint axis="0 0 1"/><geom size=".01"/>
        <inertial pos="1 2 3" quat=".6 0 0 .8" mass="2" diaginertia=".1 .2 .25"/></body>
    </body>)")));
  const hands::LinkInertia& palm = *reading.link("palm").inertia;
  CHECK(palm.mass == Approx(0.2 * 0.4 * 0.6 * 100).epsilon(1e-14));
  // Of a box: m (b² + c²) / 12.
  CHECK(palm.inertia_L(0, 0) == Approx(4.8 * (0.16 + 0.36) / 12).epsilon(1e-14));
  CHECK(palm.inertia_L(2, 2) == Approx(4.8 * (0.04 + 0.16) / 12).epsilon(1e-14));
  const hands::LinkInertia& f = *reading.link("f").inertia;
  CHECK(f.mass == 2.0);
  CHECK(f.center_L == Vector3d(1, 2, 3));
  // R = [c −s; s c] with c = −0.28, s = 0.96: Ixx = c² 0.1 + s² 0.2, Ixy = c s (0.1 − 0.2).
  CHECK(f.inertia_L(0, 0) == Approx(0.0784 * 0.1 + 0.9216 * 0.2).epsilon(1e-14));
  CHECK(f.inertia_L(0, 1) == Approx(-0.28 * 0.96 * (0.1 - 0.2)).epsilon(1e-14));
  CHECK(f.inertia_L(2, 2) == Approx(0.25).epsilon(1e-14));
}

/// A tree of bodies with up to three joints each, frames, anchors, axes and refs at random.
std::string random_tree(std::uint64_t seed) {
  geometry::Random random(seed);
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
    // The first one below the root has a joint, so that there is one.
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

TEST_CASE("MJCF: random trees stand as in MuJoCo's kinematics at 1000 random configurations",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  double largest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const fs::path file = folder.write("tree.xml", random_tree(seed));
    const Reading reading = read(file);
    Mujoco mujoco(file);
    geometry::Random random(seed);
    for (int i = 0; i < 50; ++i) {
      const Positions q = random_positions(reading.robot, random);
      mujoco.set(q);
      largest = std::max(largest,
                         largest_difference(link_poses(reading.robot, q), mujoco.poses("b0"), 8));
    }
  }
  CHECK(largest < 1e-9);
}

TEST_CASE("MJCF: linear equalities become couplings that MuJoCo's constraints accept",
          "[hands][mjcf]") {
  struct Case {
    std::string constraint;
    std::string follower;
    std::string leader;
    double ratio;
    double offset;
  };
  // refs: ja 0, jb 0.25, jc −0.5
  const std::vector<Case> cases = {
      {R"(<equality><joint joint1="ja" joint2="jb"/></equality>)", "ja", "jb", 1.0, -0.25},
      {R"(<equality><joint joint1="jb" joint2="jc" polycoef=".1 -2 0 0 0"/></equality>)", "jb",
       "jc", -2.0, 0.25 + 0.1 + 2.0 * -0.5},
      // 2 (ja − 0) + 4 (jb − 0.25) = 0.4
      {R"(<tendon><fixed name="t"><joint joint="ja" coef="2"/><joint joint="jb" coef="4"/></fixed></tendon>
          <equality><tendon tendon1="t" polycoef=".4 0 0 0 0"/></equality>)",
       "jb", "ja", -0.5, 0.25 + 0.1},
      // 2 (jc + 0.5) = 0.1 + 3 · 4 (ja − 0)
      {R"(<tendon><fixed name="t"><joint joint="jc" coef="2"/></fixed>
                  <fixed name="u"><joint joint="ja" coef="4"/></fixed></tendon>
          <equality><tendon tendon1="t" tendon2="u" polycoef=".1 3 0 0 0"/></equality>)",
       "jc", "ja", 6.0, -0.5 + 0.05}};
  const TemporaryFolder folder;
  for (const Case& expected : cases) {
    CAPTURE(expected.constraint);
    const fs::path file = folder.write("hand.xml", mjcf(kTwoFingers, expected.constraint));
    const Reading reading = read(file);
    const auto& coupling = reading.joint(expected.follower).coupling;
    REQUIRE(coupling.has_value());
    CHECK(coupling->joint == expected.leader);
    CHECK(coupling->multiplier == Approx(expected.ratio).epsilon(1e-14));
    CHECK(coupling->offset == Approx(expected.offset).epsilon(1e-14));
    CHECK_FALSE(coupling->breakaway);
    Mujoco mujoco(file);
    for (const double q : {-0.7, 0.0, 0.4}) {
      mujoco.set({{expected.leader, q}, {expected.follower, expected.ratio * q + expected.offset}});
      const std::vector<double> missed = mujoco.missed();
      REQUIRE(missed.size() == 1);
      CHECK(std::abs(missed[0]) < 1e-14);
    }
  }
}

TEST_CASE("MJCF: a curved equality becomes the nearest line, and is said to", "[hands][mjcf]") {
  const TemporaryFolder folder;
  // jb − 0.25 = ja²; over 0 to 1 the nearest line to x² is x − 1/6, off by 1/6 at both ends.
  const Reading square = read(folder.write(
      "square.xml",
      mjcf(
          kTwoFingers,
          R"(<equality><joint name="e" joint1="jb" joint2="ja" polycoef="0 0 1 0 0"/></equality>)")));
  CHECK(square.joint("jb").coupling->multiplier == Approx(1.0).epsilon(1e-14));
  CHECK(square.joint("jb").coupling->offset == Approx(0.25 - 1.0 / 6).epsilon(1e-14));
  CHECK(square.has(FindingKind::Suspicious, "equality e: is a curve between joints ja and jb"));
  CHECK(square.has(FindingKind::Suspicious, "up to 0.1666"));
  // All powers of x = jb − 0.25, against the normal equations of many samples of jb from 0 to 2.
  const Reading quartic = read(folder.write(
      "quartic.xml",
      mjcf(
          kTwoFingers,
          R"(<equality><joint joint1="ja" joint2="jb" polycoef=".1 .2 -.3 .4 -.05"/></equality>)")));
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double q = 2.0 * (i + 0.5) / kSamples;
    const double x = q - 0.25;
    const double y = 0.1 + x * (0.2 + x * (-0.3 + x * (0.4 - 0.05 * x)));
    normal += Eigen::Vector2d(q, 1.0) * Eigen::RowVector2d(q, 1.0);
    right += y * Eigen::Vector2d(q, 1.0);
  }
  const Eigen::Vector2d line = normal.ldlt().solve(right);
  // The midpoint rule with 20000 samples is off by less than 1e-8.
  CHECK(quartic.joint("ja").coupling->multiplier == Approx(line[0]).margin(1e-7));
  CHECK(quartic.joint("ja").coupling->offset == Approx(line[1]).margin(1e-7));
}

TEST_CASE("MJCF: a tendon with an actuator closes its joints together, and lets one go on",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  const std::string pulls =
      R"(<tendon><fixed name="t"><joint joint="ja" coef="1"/><joint joint="jb" coef="1"/><joint joint="jc" coef="-1"/></fixed></tendon>)";
  const Reading driven = read(folder.write(
      "hand.xml",
      mjcf(kTwoFingers, pulls + R"(<actuator><position name="m" tendon="t"/></actuator>)")));
  CHECK(!driven.joint("ja").coupling.has_value());
  const auto& same_way = driven.joint("jb").coupling;  // 0..1 and 0..2
  REQUIRE(same_way.has_value());
  CHECK(same_way->joint == "ja");
  CHECK(same_way->multiplier == 2.0);
  CHECK(same_way->offset == 0.0);
  CHECK(same_way->breakaway);
  const auto& other_way = driven.joint("jc").coupling;  // 0..1 and 0..−1
  REQUIRE(other_way.has_value());
  CHECK(other_way->multiplier == -1.0);
  CHECK(other_way->offset == 0.0);
  CHECK(driven.has(FindingKind::Note, "tendon t: is driven by actuator m and shared by joints ja"));

  // Joints with actuators or leaders of their own are left as they are; so is an idle tendon.
  const Reading own = read(folder.write(
      "own.xml", mjcf(kTwoFingers, pulls + R"(<equality><joint joint1="jb" joint2="ja"/></equality>
                      <actuator><motor tendon="t"/><motor joint="jc"/></actuator>)")));
  CHECK(own.joint("jb").coupling->multiplier == 1.0);
  CHECK_FALSE(own.joint("jb").coupling->breakaway);
  CHECK(!own.joint("jc").coupling.has_value());
  const Reading idle = read(folder.write("idle.xml", mjcf(kTwoFingers, pulls)));
  for (const DescribedJoint& joint : idle.robot.joints) CHECK(!joint.coupling.has_value());
}

TEST_CASE("MJCF: constraints that no coupling says are held, left out, and said", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& rest) {
    return read(folder.write("hand.xml", mjcf(kTwoFingers, rest)));
  };
  const Reading held = with(R"(<equality><joint joint1="jb" joint2="ja" polycoef="0 2 0 0 0"/>
      <joint joint1="ja" polycoef=".5 0 0 0 0"/></equality>)");
  // ja is held at 0.5, so its follower at 0.25 + 1.
  CHECK(held.joint("ja").type == DescribedJoint::Type::Fixed);
  CHECK(held.joint("jb").type == DescribedJoint::Type::Fixed);
  const Reading loose = with("");
  const Poses X = link_poses(held.robot, {});
  const Poses Y = link_poses(loose.robot, {{"ja", 0.5}, {"jb", 1.25}});
  CHECK(largest_difference(X, Y, 4) < 1e-15);

  CHECK(with(R"(<equality><connect name="k" body1="b" body2="c" anchor="0 0 0"/></equality>)")
            .has(FindingKind::Suspicious, "equality k: joins body b and body c: closed loops"));
  CHECK(with(R"(<equality><weld body1="palm"/></equality>)")
            .has(FindingKind::Note, "not both of the hand"));
  const Reading inactive =
      with(R"(<equality><joint name="off" active="false" joint1="jb" joint2="ja"/></equality>)");
  CHECK(!inactive.joint("jb").coupling.has_value());
  CHECK(inactive.has(FindingKind::Note, "equality off: is not active"));
  const Reading mutual = with(R"(<equality><joint joint1="jb" joint2="ja"/>
      <joint joint1="ja" joint2="jb"/><joint joint1="jb" joint2="jc"/></equality>)");
  CHECK(mutual.joint("jb").coupling->joint == "ja");
  CHECK(!mutual.joint("ja").coupling.has_value());
  CHECK(mutual.has(FindingKind::Suspicious, "joint jb follows ja already; that it follows jc"));
  CHECK(mutual.has(FindingKind::Suspicious, "joint jb follows ja already; the other way round"));
  const std::string three =
      R"(<tendon><fixed name="t"><joint joint="ja" coef="1"/><joint joint="jb" coef="1"/><joint joint="jc" coef="1"/></fixed></tendon>)";
  CHECK(with(three + R"(<equality><tendon tendon1="t"/></equality>)")
            .has(FindingKind::Suspicious, "joins 3 joints by one equation"));
}

TEST_CASE("MJCF: <exclude>, contype and conaffinity exclude pairs, <pair> includes them",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  // Bits: a 1/1, b 2/2, c 1/2 (meets both), d none (only seen).
  const std::string bodies = R"(
    <body name="a"><geom name="ga" size=".1" contype="1" conaffinity="1"/>
      <body name="b"><joint name="jb" axis="0 0 1"/><geom name="gb" size=".1" contype="2" conaffinity="2"/></body>
      <body name="c"><joint name="jc" axis="0 0 1"/><geom size=".1" contype="1" conaffinity="2"/></body>
      <body name="d"><joint name="jd" axis="0 0 1"/><geom size=".1" contype="0" conaffinity="0"/></body>
    </body>)";
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  const auto exclusions = [&](const std::string& contact) {
    return read(folder.write("hand.xml", mjcf(bodies, contact))).robot.exclusions;
  };
  CHECK(exclusions("") == Pairs{{"a", "b"}});
  CHECK(exclusions(R"(<contact><exclude body1="d" body2="c"/></contact>)") ==
        Pairs{{"c", "d"}, {"a", "b"}});
  CHECK(exclusions(R"(<contact><pair geom1="gb" geom2="ga"/></contact>)").empty());
}

TEST_CASE("MJCF: the root is what the hand hangs on, and scenery stays away", "[hands][mjcf]") {
  struct Case {
    std::string worldbody;
    std::vector<std::string> links;
  };
  const std::string joint = R"(<joint axis="0 0 1"/><geom size=".1"/>)";
  const std::string finger = R"(<body name="f">)" + joint + "</body>";
  const std::vector<Case> cases = {
      // a hand that floats, over a floor, with a ball and a table
      {R"(<geom type="plane" size="1 1 1"/><body name="palm"><freejoint/><geom size=".1"/>)" +
           finger + R"(</body><body name="ball"><freejoint/><geom size=".1"/></body>
           <body name="table"><geom type="box" size="1 1 .1"/></body>)",
       {"palm", "f"}},
      // a mount without joints
      {R"(<geom type="box" size="1 1 .1"/><body name="mount"><body name="palm"><geom size=".1"/>)" +
           finger + "</body></body>",
       {"mount", "palm", "f"}},
      // as MuJoCo's URDF reader leaves it: the palm is the world's, one fingertip fixed to it
      {R"(<geom type="box" size=".1 .1 .1"/>)" + finger + R"(<body name="g">)" + joint +
           R"(</body><body name="bump"><geom size=".1"/></body><body name="target" mocap="true"/>)",
       {"world", "f", "g", "bump"}},
      {finger, {"world", "f"}}};
  const TemporaryFolder folder;
  for (const Case& expected : cases) {
    CAPTURE(expected.worldbody);
    const Reading reading = read(folder.write("hand.xml", mjcf(expected.worldbody)));
    std::vector<std::string> links;
    for (const DescribedLink& link : reading.robot.links) links.push_back(link.name);
    CHECK(links == expected.links);
  }
  const Reading first = read(folder.write("hand.xml", mjcf(cases[0].worldbody)));
  CHECK(first.has(FindingKind::Note, "body ball, body table"));
  CHECK(first.has(FindingKind::Note, "link palm: its free joint is left out"));
}

/// Numbers as 1.234,5.
struct CommaNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_CASE("MJCF: a program whose C++ locale has decimal commas reads the same numbers",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("hand.xml", mjcf(kTwoFingers));
  const double plain = read(file).joint("jb").X_PJ.translation().z();
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaNumbers));
  const Reading reading = read(file);
  const bool is_restored =
      std::use_facet<std::numpunct<char>>(std::locale()).decimal_point() == ',';
  std::locale::global(before);
  CHECK(reading.joint("jb").X_PJ.translation().z() == plain);
  CHECK(plain == 0.05);
  CHECK(is_restored);
}

TEST_CASE("MJCF: threads read at once what each reads alone, faults included", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const fs::path good = folder.write("good.xml", random_tree(7));
  const fs::path bad = folder.write("bad.xml", mjcf("<body><geom size=\"0\"/></body>"));
  const Poses expected = link_poses(read(good).robot, {});
  std::array<double, 4> differences{};
  std::array<int, 4> refused{};
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 25; ++i) {
        Findings findings(Findings::AtFault::Throw);
        const RobotDescription robot =
            hands::internal::parse_mjcf(geometry::read_file(good), good, findings);
        differences[t] += robot.joints.size() == 0 ? 1.0 : 0.0;
        differences[t] += largest_difference(
            robot.joints.back().X_PJ,
            hands::internal::parse_mjcf(geometry::read_file(good), good, findings)
                .joints.back()
                .X_PJ);
        try {
          hands::internal::parse_mjcf(geometry::read_file(bad), bad, findings);
        } catch (const IoError&) {
          ++refused[t];
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < 4; ++t) {
    CHECK(differences[t] == 0.0);
    CHECK(refused[t] == 25);
  }
  CHECK(mju_user_error == nullptr);
  CHECK(mju_user_warning == nullptr);
}

TEST_CASE("MJCF: bad files give one clear line and leave no log behind", "[hands][mjcf]") {
  struct Case {
    std::string text;
    bool is_unreadable;  ///< IoError, else InvalidInput.
    std::string words;
  };
  const std::string f = R"(<body name="p"><geom size=".1"/><body name="f">)";
  const std::vector<Case> cases = {
      {"<mujoco><worldbody><bodi/></worldbody></mujoco>", true,
       "MuJoCo: XML Error: Schema violation: unrecognized element; Element 'bodi', line 1"},
      {mjcf(f + "<joint name=\"j\" axis=\"0 0 0\"/><geom size=\".1\"/></body></body>"), true,
       "axis too small"},
      {mjcf(f + R"(<joint name="j" type="ball"/><geom size=".1"/></body></body>)"), false,
       "joint j: is a ball joint"},
      {mjcf(f + R"(<joint name="j" type="slide"/><geom size=".1"/></body></body>)"), false,
       "joint j: no limits"},
      {mjcf(f + R"(<joint/><geom size=".1" pos="0 nan 0"/></body></body>)"), false,
       "line 1: <geom> pos \"0 nan 0\" is not finite"},
      {mjcf(f + R"(<joint range="0 inf"/><geom size=".1"/></body></body>)"), false,
       "<joint> range \"0 inf\" is not finite"},
      {mjcf(f + R"(<joint/><geom size=".1"/><body name="p"/></body></body>)"), true,
       "repeated name in body array"},
      {mjcf(f + R"(<joint/><geom type="mesh" mesh="m"/></body></body>)",
            R"(<asset><mesh name="m" file="none.stl"/></asset>)"),
       true, "<mesh> none.stl is not there"},
      {mjcf(f + "</body></body>", R"(<asset><mesh name="m" file="../outside.stl"/></asset>)"),
       false, "<mesh> ../outside.stl lies outside the description's package"},
      {mjcf(f + "</body></body>",
            R"(<compiler meshdir="/"/><asset><mesh name="m" file="etc/passwd"/></asset>)"),
       false, "<mesh> etc/passwd lies outside"},
      {mjcf(f + "</body></body>", R"(<asset><texture type="2d" file="/etc/passwd"/></asset>)"),
       false, "<texture> /etc/passwd lies outside"},
      {mjcf(f + "</body></body>", R"(<include file="../x.xml"/>)"), false,
       "<include> ../x.xml lies outside"},
      {mjcf(f + "</body></body>", R"(<include file="x.xml"/>)"), true,
       "<include> x.xml is not there"},
      {mjcf(f + "</body></body>", R"(<include file="hand.xml"/>)"), true, "MuJoCo: XML Error"},
      {mjcf(f + "</body></body>", R"(<asset><mesh name="m" file="junk.stl"/></asset>)"), true,
       "MuJoCo: Error:"},
      {mjcf(
           R"(<body name="p"><freejoint/><geom size=".1"/><body><joint/><geom size=".1"/></body></body>
               <body name="o"><geom size=".1"/><body><joint/><geom size=".1"/></body></body>)"),
       false, "body p moves freely of body o"}};
  const TemporaryFolder folder;
  folder.write("junk.stl", "not a mesh");
  for (const Case& bad : cases) {
    CAPTURE(bad.text);
    const fs::path file = folder.write("hand.xml", bad.text);
    std::string message;
    bool is_unreadable = false;
    try {
      read(file);
    } catch (const IoError& error) {
      message = error.what();
      is_unreadable = true;
    } catch (const InvalidInput& error) {
      message = error.what();
    }
    CAPTURE(message);
    CHECK(is_unreadable == bad.is_unreadable);
    CHECK(message.rfind(file.string() + ": ", 0) == 0);
    CHECK(message.find(bad.words) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  }
  CHECK_FALSE(fs::exists("MUJOCO_LOG.TXT"));
}

TEST_CASE("MJCF: read_hand takes a hand in MJCF with its sidecar", "[hands][mjcf]") {
  const TemporaryFolder folder;
  folder.write("hand.graspfit.json", R"({
    "format": {"name": "graspfit hand sidecar", "version": 1},
    "fingers": [{"name": "one", "links": ["a", "b"], "joints": ["ja", "jb"]},
                {"name": "two", "links": ["c"], "joints": ["jc"]}],
    "pads": [], "palm": {"link": "palm", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
    "closing": {"ja": 1, "jc": -1}, "exclusions": []})");
  const fs::path file = folder.write(
      "hand.xml",
      mjcf(kTwoFingers,
           R"(<equality><joint joint1="jb" joint2="ja" polycoef="0 2 0 0 0"/></equality>)"));
  const hands::HandReading reading = hands::read_hand(file);
  const hands::HandModel& hand = reading.model;
  CHECK(hand.num_intrinsic_dof() == 2);
  CHECK(hand.joints[static_cast<std::size_t>(hand.joint_index("jb"))].closing_sign == 1);
  CHECK(geometry::signed_volume(hand.links[0].mesh_L) == Approx(0.2 * 0.2 * 0.02));
  Mujoco mujoco(file);
  geometry::Random random(1);
  for (int i = 0; i < 100; ++i) {
    hands::HandConfiguration configuration{RigidTransform::Identity(), Eigen::VectorXd::Zero(3)};
    Positions q;
    for (std::size_t j = 0; j < 3; ++j) {
      configuration.q[static_cast<Eigen::Index>(j)] = q[hand.joints[j].name] =
          random.uniform(hand.joints[j].lower, hand.joints[j].upper);
    }
    mujoco.set(q);
    const auto X_OL = hands::forward_kinematics(hand, configuration);
    Poses poses;
    for (std::size_t l = 0; l < X_OL.size(); ++l) poses[hand.links[l].name] = X_OL[l];
    CHECK(largest_difference(poses, mujoco.poses("palm"), 4) < 1e-12);
  }
}

/// Decimals that MuJoCo's XML writer keeps, while it lives. The library exports the setting for its
/// own tests and declares it nowhere; where it is not there, nothing changes.
class WriterDigits {
 public:
  explicit WriterDigits(int digits) {
    if (set_ != nullptr && get_ != nullptr) {
      before_ = get_();
      set_(digits);
      is_set_ = true;
    }
  }
  ~WriterDigits() {
    if (is_set_) set_(before_);
  }
  WriterDigits(const WriterDigits&) = delete;
  WriterDigits& operator=(const WriterDigits&) = delete;

  bool is_set() const { return is_set_; }

 private:
  void (*set_)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT,
                                                            "_mjPRIVATE__set_xml_precision"));
  int (*get_)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "_mjPRIVATE__get_xml_precision"));
  int before_ = 0;
  bool is_set_ = false;
};

/// `urdf` beside itself as MuJoCo writes it, `hand.xml`. What MuJoCo refuses of the shared hands is
/// told to it or changed first: paths of meshes are kept; links without mass get some, which moving
/// bodies must have; the visual geometry goes, since two mesh files of one name (visual and
/// collision) are one to MuJoCo.
fs::path converted_by_mujoco(const fs::path& urdf, bool fuses) {
  tinyxml2::XMLDocument document;
  REQUIRE(document.LoadFile(urdf.c_str()) == tinyxml2::XML_SUCCESS);
  tinyxml2::XMLElement* robot = document.RootElement();
  for (auto* link = robot->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    while (auto* visual = link->FirstChildElement("visual")) link->DeleteChild(visual);
    tinyxml2::XMLElement* inertial = link->FirstChildElement("inertial");
    if (inertial && inertial->FirstChildElement("mass")->DoubleAttribute("value") > 0.0) continue;
    if (inertial) link->DeleteChild(inertial);
    inertial = link->InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", 1e-3);
    tinyxml2::XMLElement* inertia = inertial->InsertNewChildElement("inertia");
    for (const char* entry : {"ixx", "iyy", "izz"}) inertia->SetAttribute(entry, 1e-6);
    for (const char* entry : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(entry, 0.0);
  }
  tinyxml2::XMLElement* compiler = document.NewElement("compiler");
  compiler->SetAttribute("strippath", "false");
  compiler->SetAttribute("fusestatic", fuses ? "true" : "false");
  compiler->SetAttribute("balanceinertia", "true");
  tinyxml2::XMLElement* extension = document.NewElement("mujoco");
  extension->InsertEndChild(compiler);
  robot->InsertFirstChild(extension);
  const fs::path readable = urdf.parent_path() / "for_mujoco.urdf";
  REQUIRE(document.SaveFile(readable.c_str()) == tinyxml2::XML_SUCCESS);
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(readable.c_str(), nullptr, error.data(), 1000);
  CAPTURE(error.data());
  REQUIRE(model != nullptr);
  const fs::path xml = urdf.parent_path() / "hand.xml";
  const bool is_saved = mj_saveLastXML(xml.c_str(), model, error.data(), 1000) == 1;
  mj_deleteModel(model);
  REQUIRE(is_saved);
  return xml;
}

TEST_CASE("MJCF: what MuJoCo writes of each shared URDF stands as the URDF does", "[hands][mjcf]") {
  struct Hand {
    std::string urdf;
    std::size_t links;  ///< Of the same name when fixed ones are kept.
    std::size_t fused;  ///< And when MuJoCo fuses them with their parents.
  };
  // Movable joints of SOURCES.md; each moves one link, which fusing keeps.
  const std::vector<Hand> all = {{"robotiq_2f_85/robotiq_2f_85.urdf", 12, 6},
                                 {"panda_gripper/franka_panda.urdf", 4, 2},
                                 {"barrett_hand/bhand_model.urdf", 9, 8},
                                 {"barrett_graspit/Barrett.urdf", 27, 8},
                                 {"human_hand_20dof/HumanHand.urdf", 45, 20},
                                 {"shadow_hand/shadow_hand_right.urdf", 32, 24},
                                 {"allegro_hand/allegro_hand_right.urdf", 23, 16}};
  struct Digits {
    int digits;
    double tolerance;
    int configurations;
  };
  // MuJoCo writes 6 significant digits unless told otherwise: 5e-7 of each number, and some ten of
  // them, quaternions included, stand between the palm and a fingertip. Measured: 1.5e-6.
  for (const Digits writer : {Digits{17, 1e-9, 1000}, Digits{6, 1e-5, 100}}) {
    const WriterDigits digits(writer.digits);
    if (writer.digits == 17 && !digits.is_set()) continue;
    for (const Hand& hand : all) {
      const auto found = testing::find_data("hands/" + hand.urdf);
      if (!found) {
        GRASPFIT_SKIP_TEST("hands/" + hand.urdf + " is not in the data folder; set GRASPFIT_DATA");
      }
      const fs::path source = *found;
      for (const bool fuses : {false, true}) {
        CAPTURE(hand.urdf, fuses, writer.digits);
        const TemporaryFolder folder;
        fs::copy(source.parent_path(), folder.path(),
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        const fs::path urdf = folder.path() / source.filename();
        const fs::path xml = converted_by_mujoco(urdf, fuses);
        const RobotDescription robot = read(xml).robot;
        Findings findings(Findings::AtFault::Throw);
        const RobotDescription original =
            hands::internal::parse_urdf(geometry::read_file(source), source.string(), findings);
        geometry::Random random(3);
        double largest = 0.0;
        for (int i = 0; i < writer.configurations; ++i) {
          const Positions q = random_positions(original, random);
          Poses expected = link_poses(original, q);
          // A fixed link above a jointless body is the world's, and not kept.
          if (const auto root = expected.find(robot.links[0].name); root != expected.end()) {
            const RigidTransform X_RO = root->second.inverse();
            for (auto& [name, X] : expected) X = X_RO * X;
          }
          largest = std::max(largest, largest_difference(link_poses(robot, q), expected,
                                                         fuses ? hand.fused : hand.links));
        }
        CHECK(largest < writer.tolerance);
      }
    }
  }
}

}  // namespace
