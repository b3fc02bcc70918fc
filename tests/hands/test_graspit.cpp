#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "sidecar_text.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace {

using namespace graspfit;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using hands::HandConfiguration;
using hands::HandModel;
using hands::RigidTransform;
using std::numbers::pi;
using testing::least_sidecar;
using testing::TemporaryFolder;
using testing::with;
namespace fs = std::filesystem;

constexpr double kDegree = pi / 180.0;
constexpr double kMillimeter = 1e-3;

/// Rz(theta) Tz(d) Tx(a) Rx(alpha) multiplied out; degrees and millimeters.
Matrix4d dh(double theta_deg, double d, double a, double alpha_deg) {
  const double ct = std::cos(theta_deg * kDegree);
  const double st = std::sin(theta_deg * kDegree);
  const double ca = std::cos(alpha_deg * kDegree);
  const double sa = std::sin(alpha_deg * kDegree);
  Matrix4d T;
  T << ct, -st * ca, st * sa, a * ct, st, ct * ca, -ct * sa, a * st, 0, sa, ca, d, 0, 0, 0, 1;
  return T;
}

// A chain with everything: a transform of several parts, a universal joint, a sliding joint,
// offsets, ratios of both signs; and one more chain on the first degrees of freedom.
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

const std::string kTetrahedronObj =
    "v 0 0 0\nv 10 0 0\nv 0 20 0\nv 0 0 30\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

const std::string kTetrahedronStl = R"(solid t
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 20 0
vertex 10 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 10 0 0
vertex 0 0 30
endloop
endfacet
facet normal 6 3 2
outer loop
vertex 10 0 0
vertex 0 20 0
vertex 0 0 30
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 30
vertex 0 20 0
endloop
endfacet
endsolid t
)";

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

const hands::Joint& joint(const HandModel& hand, const std::string& name) {
  return hand.joints[static_cast<std::size_t>(hand.joint_index(name))];
}

bool mentions(const std::vector<hands::HandFinding>& findings, hands::FindingKind kind,
              const std::string& item, const std::string& what) {
  return std::any_of(findings.begin(), findings.end(), [&](const hands::HandFinding& finding) {
    return finding.kind == kind && finding.item == item &&
           finding.what.find(what) != std::string::npos;
  });
}

HandConfiguration random_configuration(const HandModel& hand, geometry::Random& random) {
  HandConfiguration c;
  c.q.resize(static_cast<Eigen::Index>(hand.joints.size()));
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    c.q[static_cast<Eigen::Index>(j)] = random.uniform(hand.joints[j].lower, hand.joints[j].upper);
  }
  return c;
}

/// A joint's axis as a line in O.
struct Line {
  Vector3d point;
  Vector3d direction;
};

Line axis_line(const HandModel& hand, const std::vector<RigidTransform>& X_OL,
               const std::string& name) {
  const hands::Joint& j = joint(hand, name);
  const RigidTransform X_OJ = X_OL[static_cast<std::size_t>(j.parent_link)] * j.X_PJ;
  return {X_OJ.translation(), X_OJ.linear() * j.axis_J};
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
  Matrix4d last = Matrix4d::Identity();  // (0.8 0.6 0 0): about x, sine 0.96, cosine 0.28
  last.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0.28, -0.96, 0, 0.96, 0.28;
  last.topRightCorner<3, 1>() << 1, 2, 3;
  base = base * last;

  geometry::Random random(5);
  for (int k = 0; k < 100; ++k) {
    const HandConfiguration c = random_configuration(hand, random);
    const auto X_OL = hands::forward_kinematics(hand, c);
    // Positions are without the offsets of theta and d, ratios included.
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
    CHECK(hand.links[0].mesh_L.faces.empty());  // palm.xml is not there
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
  // d1 from max(-10/2, 0/0.5) = 0 to min(90/2, 20/0.5) = 40: the leader 0 to 80, the follower its
  // own 0 to 20.
  CHECK(leader.lower == 0.0);
  CHECK(leader.upper == Approx(80 * kDegree).epsilon(1e-12));
  CHECK(follower.upper == Approx(20 * kDegree).epsilon(1e-12));
  CHECK(mentions(reading.findings, hands::FindingKind::Note, "joint d1_chain0_joint1",
                 "limits narrowed"));
  // Joints alone on their degree of freedom are as the file says, whatever their ratio.
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
    } catch (const geometry::InvalidInput& error) {
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
  // d1*0.5 at 60 to 80 degrees asks for d1 of 120 to 160, the other joint for at most 45.
  bad("<minValue>0</minValue><maxValue>20</maxValue>",
      "<minValue>60</minValue><maxValue>80</maxValue>", "exclude each other");
}

// ---- Meshes of a URDF beside it
// ---------------------------------------------------------------------

// A finger of two bones whose body files are not there, and the same as a URDF that counts its
// angles from elsewhere, with its frames elsewhere and one axis the other way around.
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

// At `turn` = 0 the bone lies along y: zero of d0 (30 degrees from x) is turn = -60 degrees. The
// axis of `bend` is minus the chain's: limits -80 to 10 are its 80 to -10.
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
  geometry::Random random(11);
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
  // 40 um is within it: no finding.
  const TemporaryFolder folder;
  folder.write("other.urdf", with(kFingerUrdf, "0 0.05 -0.007", "0 0.05004 -0.007"));
  folder.write("finger.graspfit.json", least_sidecar("palm", "one", "d0_chain0_joint0", {}));
  CHECK_FALSE(
      hands::read_hand_model(folder.write("finger.xml", kFinger)).links[2].mesh_L.faces.empty());
}

// ---- The hands that GraspIt! ships
// ------------------------------------------------------------------

/// A hand of the data folder, in a folder of its own with a sidecar that leaves its kinematics
/// alone and small closed meshes in place of its own, which may be open.
struct SharedHand {
  std::string folder, file, palm, link, joint;
  std::vector<std::string> closing = {};
};

const SharedHand kBarrettXml = {"barrett_graspit",
                                "graspit_Barrett.xml",
                                "palm",
                                "chain0_link1",
                                "d0_chain0_joint0",
                                {"d1_chain0_joint1", "d2_chain1_joint1", "d3_chain2_joint0"}};
const SharedHand kBarrettUrdf = {"barrett_graspit", "Barrett.urdf", "base_link", "a_link1_joint",
                                 "a_palm_link1_joint"};
const SharedHand kBhandUrdf = {"barrett_hand", "bhand_model.urdf", "base_link",
                               "finger_1_prox_link", "finger_1_prox_joint"};
const SharedHand kHumanXml = {"human_hand_20dof", "graspit_HumanHand20DOF.xml", "palm", "index1",
                              "d1_chain0_joint1"};
const SharedHand kHumanUrdf = {"human_hand_20dof", "HumanHand.urdf", "base_link", "index1_0_joint",
                               "palm_index1_0_joint"};

hands::HandReading read_shared(const SharedHand& hand, const fs::path& file) {
  const TemporaryFolder folder;
  folder.copy(file.parent_path());
  for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "meshes")) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().lexically_relative(folder.path()).generic_string();
    folder.write(name, entry.path().extension() == ".stl" ? kTetrahedronStl : kTetrahedronObj);
  }
  const fs::path copy = folder.path() / hand.file;
  folder.write(hands::sidecar_file_of(hand.file).string(),
               least_sidecar(hand.palm, hand.link, hand.joint, hand.closing));
  return hands::read_hand(copy);
}

/// Reads a hand of the data folder into `reading`, or skips.
#define READ_SHARED(reading, hand)                                                              \
  const auto reading##_file = testing::find_data("hands/" + (hand).folder + "/" + (hand).file); \
  if (!reading##_file) {                                                                        \
    GRASPFIT_SKIP_TEST("hands/" + (hand).folder + " is not there; set GRASPFIT_DATA");          \
  }                                                                                             \
  const hands::HandReading reading = read_shared(hand, *reading##_file)

/// Meshes of both stand at the same places when all joints, in the order of both files, have the
/// same positions.
void check_same_meshes(const hands::HandReading& xml, const HandModel& urdf, double tolerance) {
  const HandModel& hand = xml.model;
  REQUIRE(hand.joints.size() == urdf.joints.size());
  geometry::Random random(23);
  double farthest = 0.0;
  for (int k = 0; k < 100; ++k) {
    const HandConfiguration c = random_configuration(hand, random);
    const auto X_OL = hands::forward_kinematics(hand, c);
    const auto X_OU = hands::forward_kinematics(urdf, c);
    std::size_t u = 0;  // links with meshes come in the same order
    for (std::size_t l = 0; l < hand.links.size(); ++l) {
      const auto& mesh = hand.links[l].mesh_L;
      if (mesh.faces.empty()) continue;
      while (urdf.links[u].mesh_L.faces.empty()) ++u;
      REQUIRE(mesh.vertices.size() == urdf.links[u].mesh_L.vertices.size());
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        farthest = std::max(
            farthest,
            (X_OL[l] * mesh.vertices[v] - X_OU[u] * urdf.links[u].mesh_L.vertices[v]).norm());
      }
      ++u;
    }
  }
  CAPTURE(farthest);
  CHECK(farthest < tolerance);
}

TEST_CASE("GraspIt!'s Barrett is its URDF with the coupling that the URDF lost",
          "[hands][graspit][barrett]") {
  READ_SHARED(xml, kBarrettXml);
  READ_SHARED(urdf, kBarrettUrdf);
  const HandModel& hand = xml.model;
  CHECK(hand.num_intrinsic_dof() == 4);
  REQUIRE(hand.joints.size() == 8);
  CHECK(joint(hand, "d0_chain1_joint0").coupling->ratio == 1.0);
  CHECK_FALSE(joint(hand, "d0_chain1_joint0").coupling->breakaway);
  for (const char* distal : {"d1_chain0_joint2", "d2_chain1_joint2", "d3_chain2_joint1"}) {
    CHECK(joint(hand, distal).coupling->ratio == Approx(1.0 / 3.0).epsilon(1e-8));
    CHECK(joint(hand, distal).coupling->breakaway);
    CHECK(joint(hand, distal).upper == Approx(144 * kDegree).epsilon(1e-12));
  }
  for (const hands::Link& link : hand.links) {
    CAPTURE(link.name);
    CHECK_FALSE(link.mesh_L.faces.empty());
    CHECK(mentions(xml.findings, hands::FindingKind::Note, "link " + link.name,
                   "taken from Barrett.urdf"));
  }
  // The URDF writes eight decimals: 5e-9 rad in each of six angles on 0.2 m.
  check_same_meshes(xml, urdf.model, 1e-8);
}

TEST_CASE("GraspIt!'s human hand is its URDF", "[hands][graspit][human_hand]") {
  READ_SHARED(xml, kHumanXml);
  READ_SHARED(urdf, kHumanUrdf);
  CHECK(xml.model.num_intrinsic_dof() == 20);
  // The thumb's base is a matrix with four decimals, 5e-5 in nine entries, of which the URDF takes
  // some angles and we the nearest rotation: 1e-4 rad at most, on 0.15 m.
  check_same_meshes(xml, urdf.model, 1.5e-5);
}

/// Largest distance between corresponding axes and largest angle between their directions.
struct AxisDifference {
  double place = 0.0;
  double direction = 0.0;
};

void compare(const Line& ours, const Line& theirs, AxisDifference& difference) {
  difference.place =
      std::max(difference.place, (theirs.point - ours.point).cross(ours.direction).norm());
  difference.direction =
      std::max(difference.direction, ours.direction.cross(theirs.direction).norm());
}

/// A joint of ours and the one it corresponds to: ours = sign · theirs + offset [degrees].
struct JointPair {
  const char* ours;
  const char* theirs;
  double sign;
  double offset_deg;
};

/// The axes of all pairs in random configurations of `theirs`, moved by `X_HT` and, where a joint's
/// name in ours starts with "thumb", by `thumb_shift` besides.
AxisDifference difference_of(const HandModel& ours, const HandModel& theirs,
                             const std::vector<JointPair>& pairs, const RigidTransform& X_HT,
                             const Vector3d& thumb_shift) {
  geometry::Random random(31);
  AxisDifference result;
  for (int k = 0; k < 100; ++k) {
    const HandConfiguration c = random_configuration(theirs, random);
    HandConfiguration same{.q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pairs.size()))};
    REQUIRE(ours.joints.size() == pairs.size());
    for (const JointPair& pair : pairs) {
      same.q[ours.joint_index(pair.ours)] =
          pair.sign * c.q[theirs.joint_index(pair.theirs)] + pair.offset_deg * kDegree;
    }
    const auto X_OL = hands::forward_kinematics(ours, same);
    const auto X_OT = hands::forward_kinematics(theirs, c);
    for (const JointPair& pair : pairs) {
      Line line = axis_line(theirs, X_OT, pair.theirs);
      line.point = X_HT * line.point;
      line.direction = X_HT.linear() * line.direction;
      if (std::string(pair.ours).starts_with("thumb")) line.point += thumb_shift;
      compare(axis_line(ours, X_OL, pair.ours), line, result);
    }
  }
  return result;
}

RigidTransform shift(double x_mm, double y_mm, double z_mm) {
  RigidTransform X = RigidTransform::Identity();
  X.translation() = kMillimeter * Vector3d(x_mm, y_mm, z_mm);
  return X;
}

std::vector<JointPair> barrett_pairs(double proximal_deg, double distal_deg) {
  return {{"finger_1_spread", "d0_chain0_joint0", 1, 0},
          {"finger_1_proximal", "d1_chain0_joint1", 1, proximal_deg},
          {"finger_1_distal", "d1_chain0_joint2", 1, distal_deg},
          {"finger_2_spread", "d0_chain1_joint0", 1, 0},
          {"finger_2_proximal", "d2_chain1_joint1", 1, proximal_deg},
          {"finger_2_distal", "d2_chain1_joint2", 1, distal_deg},
          {"thumb_proximal", "d3_chain2_joint0", 1, proximal_deg},
          {"thumb_distal", "d3_chain2_joint1", 1, distal_deg}};
}

TEST_CASE("GraspIt!'s Barrett and ours have the same axes", "[hands][graspit][barrett]") {
  READ_SHARED(xml, kBarrettXml);
  const HandModel ours = hands::find_hand("barrett");
  // GraspIt!'s older file is of the BH8-262, ours of its BH8-280: the bases lie 2.32 mm lower (the
  // thumb's 2.05 mm, and 0.8 mm aside), the proximal link starts at -2.46 and not at +5 degrees,
  // the distal at 42.46 and not at 40. With that taken off, all axes agree to rounding.
  const RigidTransform lower = shift(0, 0, -3.32 + 1.0);
  const Vector3d thumb = kMillimeter * Vector3d(0.8, 0, -3.05 + 3.32);
  const AxisDifference explained =
      difference_of(ours, xml.model, barrett_pairs(5 + 2.46, 40 - 42.46), lower, thumb);
  CHECK(explained.place < 1e-12);
  CHECK(explained.direction < 1e-12);
  // At equal joint positions the bases' 2.32 mm and 7.46 degrees of the 70 mm proximal link,
  // a chord of 9.11 mm: the two together at most.
  const AxisDifference plain = difference_of(ours, xml.model, barrett_pairs(0, 0),
                                             RigidTransform::Identity(), Vector3d::Zero());
  const double chord = 2 * 70 * std::sin(7.46 / 2 * kDegree) * kMillimeter;
  CHECK(plain.place < chord + 2.32e-3);
  CHECK(plain.place > chord);
  CHECK(plain.direction < 1e-12);
}

TEST_CASE("Barrett's own URDF and ours have the same axes", "[hands][graspit][barrett]") {
  READ_SHARED(urdf, kBhandUrdf);
  const HandModel ours = hands::find_hand("barrett");
  // Their origin is the wrist, 78.72 mm below ours, and their angles run negative but for the
  // second spread. The thumb's base, 0.8 mm aside and 0.27 mm higher in ours, is taken off. Their
  // proximal links at zero rise by atan(3 / 69.936) = 2.456 degrees over the palm plane, ours, by
  // GraspIt!'s BH8-280, fall by 2.46: the sources count from different places.
  const double rise_deg = std::atan2(3.0, 69.936) / kDegree;
  const double zero_deg = rise_deg + 2.46;
  const std::vector<JointPair> pairs = {{"finger_1_spread", "finger_1_prox_joint", -1, 0},
                                        {"finger_1_proximal", "finger_1_med_joint", -1, zero_deg},
                                        {"finger_1_distal", "finger_1_dist_joint", -1, 0},
                                        {"finger_2_spread", "finger_2_prox_joint", 1, 0},
                                        {"finger_2_proximal", "finger_2_med_joint", -1, zero_deg},
                                        {"finger_2_distal", "finger_2_dist_joint", -1, 0},
                                        {"thumb_proximal", "finger_3_med_joint", -1, zero_deg},
                                        {"thumb_distal", "finger_3_dist_joint", -1, 0}};
  const AxisDifference difference =
      difference_of(ours, urdf.model, pairs, shift(0, 0, -3.32 - 41.5 - 33.9),
                    kMillimeter * Vector3d(0.8, 0, 0.27));
  // Their second finger's proximal link is another, atan(3.4087 / 69.917) = 2.791 degrees: 0.335
  // degrees on 70 mm are 0.41 mm. Right angles are written 1.5708, 4e-6 rad too large, twice on
  // 0.2 m.
  const double other = std::atan2(3.4087, 69.917) - rise_deg * kDegree;
  CHECK(difference.place < 0.070 * other + 2e-6);
  CHECK(difference.place > 0.070 * other - 2e-6);
  CHECK(difference.direction < 1e-5);
}

TEST_CASE("GraspIt!'s human hand and ours have the same axes and limits",
          "[hands][graspit][human_hand]") {
  READ_SHARED(xml, kHumanXml);
  const HandModel ours = hands::find_hand("human_hand");
  std::vector<JointPair> pairs;
  const std::vector<std::string> fingers = {"index", "middle", "ring", "little", "thumb"};
  std::vector<std::string> names;
  for (std::size_t f = 0; f < 5; ++f) {
    for (const char* bend : {"_abduction", "_mcp", "_pip", "_dip"})
      names.push_back(fingers[f] + bend);
  }
  names[17] = "thumb_cmc";
  names[18] = "thumb_mcp";
  names[19] = "thumb_ip";
  for (std::size_t j = 0; j < 20; ++j) {
    const hands::Joint& theirs = xml.model.joints[j];
    CHECK(theirs.name == "d" + std::to_string(j) + "_chain" + std::to_string(j / 4) + "_joint" +
                             std::to_string(j % 4));
    CHECK(joint(ours, names[j]).lower == Approx(theirs.lower).margin(1e-12));
    CHECK(joint(ours, names[j]).upper == Approx(theirs.upper).epsilon(1e-12));
    pairs.push_back({names[j].c_str(), theirs.name.c_str(), 1, 0});
  }
  // From GraspIt!'s palm frame to H, see SOURCE.md: x from z, y from -x - 130 mm, z from -y - 15
  // mm.
  RigidTransform X_HT = shift(0, -130, -15);
  X_HT.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const AxisDifference difference = difference_of(ours, xml.model, pairs, X_HT, Vector3d::Zero());
  // Ours has two decimals of a millimeter, 0.005 in each of three coordinates of the base and of
  // two bones: 0.019 mm. The thumb's base is a matrix with four decimals, made orthonormal in
  // different ways: 1e-4 rad on the 93 mm of its bones.
  CHECK(difference.place < 3e-5);
  CHECK(difference.direction < 1e-4);
}

}  // namespace
