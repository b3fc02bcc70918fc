#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "hands/graspit_hands.hpp"
#include "hands/sidecar_text.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_graspit {

namespace {

using namespace graspfit;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using hands::HandConfiguration;
using hands::HandModel;
using hands::RigidTransform;
using std::numbers::pi;
using testing::axis_line;
using testing::joint;
using testing::least_sidecar;
using testing::Line;
using testing::mentions;
using testing::random_configuration;
using testing::TemporaryFolder;
using testing::with;
namespace fs = std::filesystem;

constexpr double kDegree = pi / 180.0;
constexpr double kMillimeter = 1e-3;

/// Returns Rz(theta) Tz(d) Tx(a) Rx(alpha) multiplied out, in degrees and millimeters.
Matrix4d dh(double theta_deg, double d, double a, double alpha_deg) {
  const double ct = std::cos(theta_deg * kDegree);
  const double st = std::sin(theta_deg * kDegree);
  const double ca = std::cos(alpha_deg * kDegree);
  const double sa = std::sin(alpha_deg * kDegree);
  Matrix4d T;
  T << ct, -st * ca, st * sa, a * ct, st, ct * ca, -ct * sa, a * st, 0, sa, ca, d, 0, 0, 0, 1;
  return T;
}

// The chain has everything: a transform of several parts, a universal joint, a sliding joint,
// offsets, ratios of both signs; and there is one more chain on the first degrees of freedom.
const std::string kRobot = R"(<?xml version="1.0" ?>
<robot type="Hand" DBName="Odd">
  <palm>palm.xml</palm>
  <dof type="r"><defaultVelocity>1.0</defaultVelocity></dof>
  <dof type="b"><breakAwayTorque>0.5</breakAwayTorque></dof>
  <dof type="r"/>
  <chain>
    <transform>
      <translation>10 20 30</translation>
      <rotation>-90 y</rotation>
      <rotationMatrix>0 1 0 -1 0 0 0 0 1</rotationMatrix>
      <fullTransform>(0.8 0.6 0 0)[1 2 3]</fullTransform>
    </transform>
    <joint type="Revolute"><theta>d0+12</theta><d>4</d><a>0</a><alpha>90</alpha>
      <minValue>-20</minValue><maxValue>30</maxValue></joint>
    <joint type="Revolute"><theta> d1*2 + -7.5 </theta><d>0</d><a>40</a><alpha>-30</alpha>
      <minValue>-10</minValue><maxValue>90</maxValue></joint>
    <joint type="Prismatic"><theta>25</theta><d>d2*-1+6</d><a>8</a><alpha>60</alpha>
      <minValue>-5</minValue><maxValue>15</maxValue></joint>
    <link dynamicJointType="Universal">bar.xml</link>
    <link dynamicJointType="Prismatic">slider.xml</link>
  </chain>
  <chain>
    <joint type="Revolute"><theta>d1*0.5</theta><d>0</d><a>30</a><alpha>0</alpha>
      <minValue>0</minValue><maxValue>20</maxValue></joint>
    <link dynamicJointType="Revolute">bar.xml</link>
  </chain>
</robot>
)";

const std::string kTetrahedron =
    "OFF\n4 4 0\n0 0 0\n10 0 0\n0 20 0\n0 0 30\n3 0 2 1\n3 0 1 3\n"
    "3 1 2 3\n3 0 3 2\n";

/// Writes kRobot or an edit of it with a sidecar that leaves its kinematics alone.
fs::path write_robot(const TemporaryFolder& folder, const std::string& xml = kRobot) {
  folder.write("odd.graspfit.json",
               least_sidecar("palm", "chain0_bar", "d1_chain0_joint1", {"d1_chain0_joint1"}));
  return folder.write("odd.xml", xml);
}

void write_bodies(const TemporaryFolder& folder) {
  folder.write("iv/bar.xml",
               "<?xml version=\"1.0\"?><root><mass>5</mass>"
               "<geometryFile type=\"off\"> bar.off </geometryFile></root>");
  folder.write("iv/bar.off", kTetrahedron);
  folder.write("slider.xml", "<root><geometryFile>iv/bar.off</geometryFile></root>");
}

TEST_CASE("GraspIt!'s chains are multiplied as Denavit and Hartenberg say", "[hands][graspit]") {
  const TemporaryFolder folder;
  write_bodies(folder);
  const HandModel hand = hands::read_hand_model(write_robot(folder));
  CHECK(hand.name == "Odd");
  REQUIRE(hand.joints.size() == 4);
  Matrix4d base = Matrix4d::Identity();
  base.topLeftCorner<3, 3>() =
      (Eigen::AngleAxisd(-pi / 2, Vector3d::UnitY()) * Eigen::AngleAxisd(pi / 2, Vector3d::UnitZ()))
          .toRotationMatrix();
  base.topRightCorner<3, 1>() << 10, 20, 30;
  // The quaternion (0.8 0.6 0 0) is a turn about x with the sine 0.96 and the cosine 0.28.
  Matrix4d last = Matrix4d::Identity();
  last.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0.28, -0.96, 0, 0.96, 0.28;
  last.topRightCorner<3, 1>() << 1, 2, 3;
  base = base * last;

  base::Random random(5);
  for (int k = 0; k < 100; ++k) {
    const HandConfiguration c = random_configuration(hand, random);
    const auto X_OL = hands::forward_kinematics(hand, c);
    // Positions are without the offsets of theta and d, and include ratios.
    const auto q = [&](const char* name) { return c.q[hand.joint_index(name)]; };
    const Matrix4d first = base * dh(q("d0_chain0_joint0") / kDegree + 12, 4, 0, 90);
    const Matrix4d bar = first * dh(q("d1_chain0_joint1") / kDegree - 7.5, 0, 40, -30);
    const Matrix4d slider = bar * dh(25, q("d2_chain0_joint2") / kMillimeter + 6, 8, 60);
    const Matrix4d other = dh(q("d1_chain1_joint0") / kDegree, 0, 30, 0);
    // A joint's axis is the z axis of the frame before it.
    const auto check_axis = [&](const char* name, const Matrix4d& before) {
      const Line line = axis_line(hand, X_OL, name);
      CHECK((line.direction - before.col(2).head<3>()).norm() < 1e-12);
      CHECK((line.point - kMillimeter * before.col(3).head<3>()).cross(line.direction).norm() <
            1e-14);
    };
    check_axis("d0_chain0_joint0", base);
    check_axis("d1_chain0_joint1", first);
    check_axis("d2_chain0_joint2", bar);
    check_axis("d1_chain1_joint0", Matrix4d::Identity());
    // Body files are in the frame behind the last joint of their link.
    const auto check_mesh = [&](const char* link, const Matrix4d& frame) {
      const auto l = static_cast<std::size_t>(hand.link_index(link));
      REQUIRE(hand.links[l].mesh_L.vertices.size() == 4);
      const Vector3d corner_O = X_OL[l] * hand.links[l].mesh_L.vertices[3];
      const Vector3d expected = (frame * Eigen::Vector4d(0, 0, 30, 1)).head<3>();
      CHECK((corner_O - kMillimeter * expected).norm() < 1e-14);
    };
    check_mesh("chain0_bar", bar);
    check_mesh("slider", slider);
    check_mesh("chain1_bar", other);
    CHECK(hand.links[0].mesh_L.faces.empty());  // The file palm.xml is not there.
  }
}

TEST_CASE("Joints on one degree of freedom follow the first, within the limits of all",
          "[hands][graspit]") {
  const TemporaryFolder folder;
  const auto reading = hands::read_hand(write_robot(folder));
  const HandModel& hand = reading.model;
  std::vector<std::string> names;
  for (const hands::Link& link : hand.links) names.push_back(link.name);
  CHECK(names == std::vector<std::string>{"palm", "d0_chain0_joint0_link", "chain0_bar", "slider",
                                          "chain1_bar"});
  const hands::Joint& leader = joint(hand, "d1_chain0_joint1");
  const hands::Joint& follower = joint(hand, "d1_chain1_joint0");
  REQUIRE(follower.coupling.has_value());
  CHECK(follower.coupling->leader == hand.joint_index("d1_chain0_joint1"));
  CHECK(follower.coupling->ratio == Approx(0.5 / 2.0).epsilon(1e-15));
  CHECK(follower.coupling->offset == 0.0);
  CHECK(follower.coupling->breakaway);
  // The range of d1 is from max(-10/2, 0/0.5) = 0 to min(90/2, 20/0.5) = 40: the leader moves from
  // 0 to 80, the follower within its own 0 to 20.
  CHECK(leader.lower == 0.0);
  CHECK(leader.upper == Approx(80 * kDegree).epsilon(1e-12));
  CHECK(follower.upper == Approx(20 * kDegree).epsilon(1e-12));
  CHECK(mentions(reading.findings, hands::FindingKind::Note, "joint d1_chain0_joint1",
                 "limits narrowed"));
  // Joints that are alone on their degree of freedom are as the file says, whatever their ratio.
  CHECK_FALSE(joint(hand, "d2_chain0_joint2").coupling.has_value());
  CHECK(joint(hand, "d2_chain0_joint2").type == hands::JointType::Prismatic);
  CHECK(joint(hand, "d2_chain0_joint2").lower == Approx(-0.005));
  CHECK(joint(hand, "d2_chain0_joint2").upper == Approx(0.015));
  CHECK(joint(hand, "d0_chain0_joint0").lower == Approx(-20 * kDegree));
  // Without the torque of a clutch nothing breaks away.
  const std::string rigid = with(with(kRobot, "<breakAwayTorque>0.5</breakAwayTorque>", ""),
                                 "<dof type=\"b\">", "<dof type=\"r\">");
  const HandModel stiff = hands::read_hand_model(write_robot(folder, rigid));
  CHECK_FALSE(joint(stiff, "d1_chain1_joint0").coupling->breakaway);
}

TEST_CASE("A bad GraspIt! file gives one line with the file and the item", "[hands][graspit]") {
  const TemporaryFolder folder;
  const auto bad = [&](const std::string& old, const std::string& fresh, const std::string& about) {
    CAPTURE(old, fresh);
    const fs::path file = write_robot(folder, with(kRobot, old, fresh));
    try {
      hands::read_hand_model(file);
      FAIL_CHECK("accepted");
    } catch (const base::InvalidInput& error) {
      const std::string message = error.what();
      CAPTURE(message);
      CHECK(message.find("odd.xml") != std::string::npos);
      CHECK(message.find(about) != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
    }
  };
  bad("<theta>d0+12</theta>", "<theta>45</theta>", "names no degree of freedom");
  bad("<theta>d0+12</theta>", "<theta>d3+12</theta>", "uses degree of freedom 3 of 3");
  bad("<theta>d0+12</theta>", "<theta>d0*0+12</theta>", "ratio of 0");
  bad("<theta>d0+12</theta>", "<theta>d0+nan</theta>", "is not d#*ratio+offset");
  bad("<theta>d0+12</theta>", "<theta>d0+12x</theta>", "is not d#*ratio+offset");
  bad("<theta>d0+12</theta>", "", "no <theta>");
  bad("<minValue>-20</minValue>", "", "d0_chain0_joint0: no limits");
  bad("<minValue>-20</minValue>", "<minValue>40</minValue>",
      "limits 40 to 30 degrees are reversed");
  bad("<a>40</a>", "<a>inf</a>", "is not finite");
  bad("<a>40</a>", "<a>4O</a>", "is not a number");
  bad("<a>40</a>", "<a></a>", "<a> is empty");
  bad("<rotation>-90 y</rotation>", "<rotation>-90</rotation>", "does not end in x, y or z");
  bad("0 1 0 -1 0 0 0 0 1", "0 1 0 1 0 0 0 0 1", "is no rotation");
  bad("0 1 0 -1 0 0 0 0 1", "0 2 0 -1 0 0 0 0 1", "is no rotation");
  bad("0 1 0 -1 0 0 0 0 1", "0 1 0 -1 0 0 0 0", "has 8 of 9 numbers");
  bad("(0.8 0.6 0 0)", "(0.8 0.8 0 0)", "quaternion of length");
  bad("dynamicJointType=\"Universal\"", "dynamicJointType=\"Revolute\"",
      "its links hang on 2 joints, but it has 3");
  bad("dynamicJointType=\"Universal\"", "dynamicJointType=\"Saddle\"", "dynamicJointType Saddle");
  bad("<joint type=\"Prismatic\">", "<joint type=\"Ball\">", "neither Revolute nor Prismatic");
  // With d1*0.5 at 60 to 80 degrees d1 would be 120 to 160, with the other joint at most 45.
  bad("<minValue>0</minValue><maxValue>20</maxValue>",
      "<minValue>60</minValue><maxValue>80</maxValue>", "exclude each other");
}

// The following tests are about the meshes of a URDF beside the file.

// A finger of two bones has body files that are not there. The same finger is a URDF that counts
// its angles from elsewhere, with its frames elsewhere and one axis the other way around.
const std::string kFinger = R"(<robot type="Hand">
  <palm>palm.xml</palm>
  <dof type="r"/><dof type="r"/>
  <chain>
    <transform><translation>0 0 10</translation></transform>
    <joint type="Revolute"><theta>d0+30</theta><d>0</d><a>50</a><alpha>90</alpha>
      <minValue>0</minValue><maxValue>60</maxValue></joint>
    <joint type="Revolute"><theta>d1</theta><d>0</d><a>40</a><alpha>0</alpha>
      <minValue>-10</minValue><maxValue>80</maxValue></joint>
    <link dynamicJointType="Revolute">one.xml</link>
    <link dynamicJointType="Revolute">two.xml</link>
  </chain>
</robot>
)";

// At `turn` = 0 the bone lies along y: the zero of d0 (30 degrees from x) is turn = -60 degrees.
// The axis of `bend` is minus the chain's, so that limits -80 to 10 are its 80 to -10.
const std::string kFingerUrdf = R"(<robot name="finger">
  <link name="mount"/>
  <link name="base"><visual><origin xyz="0 0 0.002"/><geometry><box size="0.03 0.03 0.01"/></geometry></visual></link>
  <joint name="weld" type="fixed"><parent link="mount"/><child link="base"/></joint>
  <link name="bone1"><visual><origin xyz="0 0.02 0"/><geometry><box size="0.01 0.03 0.01"/></geometry></visual>
    <inertial><origin xyz="0 0.02 0"/><mass value="0.1"/><inertia ixx="1e-5" iyy="2e-6" izz="1e-5"/></inertial></link>
  <link name="bone2"><visual><origin xyz="0.02 0 0"/><geometry><box size="0.03 0.01 0.008"/></geometry></visual></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="bone1"/>
    <origin xyz="0 0 0.017"/><axis xyz="0 0 1"/><limit lower="-2" upper="2"/></joint>
  <joint name="bend" type="revolute"><parent link="bone1"/><child link="bone2"/>
    <origin xyz="0 0.05 -0.007" rpy="1.5707963267948966 0 1.5707963267948966"/><axis xyz="0 0 -1"/>
    <limit lower="-1.3962634015954636" upper="0.17453292519943295"/></joint>
</robot>
)";

TEST_CASE("Meshes come from the URDF beside it, wherever its angles are counted from",
          "[hands][graspit]") {
  const TemporaryFolder folder;
  folder.write("other.urdf", kFingerUrdf);
  folder.write("finger.graspfit.json", least_sidecar("palm", "one", "d0_chain0_joint0", {}));
  folder.write("other.graspfit.json", least_sidecar("mount", "bone1", "turn", {}));
  const auto reading = hands::read_hand(folder.write("finger.xml", kFinger));
  const HandModel& hand = reading.model;
  const HandModel other = hands::read_hand_model(folder.path() / "other.urdf");
  CHECK(mentions(reading.findings, hands::FindingKind::Note, "link one", "taken from other.urdf"));
  REQUIRE(hand.links.size() == 3);
  base::Random random(11);
  for (int k = 0; k < 20; ++k) {
    const HandConfiguration c = random_configuration(hand, random);
    HandConfiguration same{.q = Eigen::VectorXd(2)};
    same.q << c.q[0] - 60 * kDegree, -c.q[1];
    const auto X_OL = hands::forward_kinematics(hand, c);
    const auto X_OU = hands::forward_kinematics(other, same);
    for (const auto& [ours, theirs] :
         {std::pair{"palm", "base"}, {"one", "bone1"}, {"two", "bone2"}}) {
      const auto l = static_cast<std::size_t>(hand.link_index(ours));
      const auto u = static_cast<std::size_t>(other.link_index(theirs));
      REQUIRE(hand.links[l].mesh_L.vertices.size() == 8);
      for (std::size_t v = 0; v < 8; ++v) {
        CHECK((X_OL[l] * hand.links[l].mesh_L.vertices[v] -
               X_OU[u] * other.links[u].mesh_L.vertices[v])
                  .norm() < 1e-12);
      }
    }
    const auto& bone = hand.links[1].inertia;
    REQUIRE(bone.has_value());
    CHECK((X_OL[1] * bone->center_L -
           X_OU[static_cast<std::size_t>(other.link_index("bone1"))] * Vector3d(0, 0.02, 0))
              .norm() < 1e-12);
  }
}

TEST_CASE("A URDF whose joints stand elsewhere lends no mesh, and the finding says why",
          "[hands][graspit]") {
  const auto check = [](const std::vector<std::string>& urdfs, const std::string& why) {
    CAPTURE(why);
    const TemporaryFolder folder;
    for (std::size_t i = 0; i < urdfs.size(); ++i) {
      folder.write("other" + std::to_string(i) + ".urdf", urdfs[i]);
    }
    folder.write("finger.graspfit.json", least_sidecar("palm", "one", "d0_chain0_joint0", {}));
    const auto reading = hands::read_hand(folder.write("finger.xml", kFinger));
    for (const hands::Link& link : reading.model.links) CHECK(link.mesh_L.faces.empty());
    CHECK(mentions(reading.findings, hands::FindingKind::Suspicious, "", why));
  };
  check({}, "there are 0 URDF files beside it, not one");
  check({kFingerUrdf, kFingerUrdf}, "there are 2 URDF files beside it");
  check({"<robot"}, "not XML");
  // A tenth of a millimeter is twice the tolerance.
  check({with(kFingerUrdf, "0 0.05 -0.007", "0 0.0501 -0.007")},
        "stands where joint d1_chain0_joint1 does");
  check({with(kFingerUrdf, "0 0 0.017", "0.0001 0 0.017")},
        "stands where joint d0_chain0_joint0 does");
  check({with(kFingerUrdf, "0 0 0.017", "0 0 0.018")}, "stands where joint d1_chain0_joint1 does");
  check({with(kFingerUrdf, "<joint name=\"turn\" type=\"revolute\">",
              "<joint name=\"turn\" type=\"fixed\">")},
        "it has 1 joints, not 2");
  // 40 um is within the tolerance and gives no finding.
  const TemporaryFolder folder;
  folder.write("other.urdf", with(kFingerUrdf, "0 0.05 -0.007", "0 0.05004 -0.007"));
  folder.write("finger.graspfit.json", least_sidecar("palm", "one", "d0_chain0_joint0", {}));
  CHECK_FALSE(
      hands::read_hand_model(folder.write("finger.xml", kFinger)).links[2].mesh_L.faces.empty());
}

}  // namespace

}  // namespace test_graspit
