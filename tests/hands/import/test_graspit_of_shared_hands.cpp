#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "hands/graspit_hands.hpp"
#include "hands/sidecar_text.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_graspit_of_shared_hands {

// These tests compare the hands that GraspIt! ships with the URDFs beside them and with ours.
namespace {

using namespace graspfit;
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
namespace fs = std::filesystem;

constexpr double kDegree = pi / 180.0;
constexpr double kMillimeter = 1e-3;

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

/// A hand of the data folder, in a folder of its own with a sidecar that leaves its kinematics
/// alone, and with small closed meshes in place of its own, which may be open.
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

/// Reads a hand of the data folder into `reading`; skips if it is not there.
#define READ_SHARED(reading, hand)                                                              \
  const auto reading##_file = testing::find_data("hands/" + (hand).folder + "/" + (hand).file); \
  if (!reading##_file) {                                                                        \
    GRASPFIT_SKIP_TEST("hands/" + (hand).folder + " is not there; set GRASPFIT_DATA");          \
  }                                                                                             \
  const hands::HandReading reading = read_shared(hand, *reading##_file)

/// Checks that meshes of both have the same poses when all joints, in the order of both files, have
/// the same positions.
void check_same_meshes(const hands::HandReading& xml, const HandModel& urdf, double tolerance) {
  const HandModel& hand = xml.model;
  REQUIRE(hand.joints.size() == urdf.joints.size());
  base::Random random(23);
  double farthest = 0.0;
  for (int k = 0; k < 100; ++k) {
    const HandConfiguration c = random_configuration(hand, random);
    const auto X_OL = hands::forward_kinematics(hand, c);
    const auto X_OU = hands::forward_kinematics(urdf, c);
    std::size_t u = 0;  // Links with meshes come in the same order.
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
  // The URDF writes eight decimals, which leaves 5e-9 rad in each of six angles on 0.2 m.
  check_same_meshes(xml, urdf.model, 1e-8);
}

TEST_CASE("GraspIt!'s human hand is its URDF", "[hands][graspit][human_hand]") {
  READ_SHARED(xml, kHumanXml);
  READ_SHARED(urdf, kHumanUrdf);
  CHECK(xml.model.num_intrinsic_dof() == 20);
  // The thumb's base is a matrix with four decimals, 5e-5 in nine entries, of which the URDF takes
  // some angles and we the nearest rotation. They differ by 1e-4 rad at most, on 0.15 m.
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

/// Compares the axes of all pairs in random configurations of `theirs`, moved by `X_HT` and, where
/// a joint's name in ours starts with "thumb", by `thumb_shift` besides.
AxisDifference difference_of(const HandModel& ours, const HandModel& theirs,
                             const std::vector<JointPair>& pairs, const RigidTransform& X_HT,
                             const Vector3d& thumb_shift) {
  base::Random random(31);
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
  // GraspIt!'s older file is of the BH8-262, ours of its BH8-280. The bases lie 2.32 mm lower (the
  // thumb's 2.05 mm, and 0.8 mm aside), the proximal link starts at -2.46 and not at +5 degrees,
  // the distal one at 42.46 and not at 40. With that taken off, all axes agree to rounding.
  const RigidTransform lower = shift(0, 0, -3.32 + 1.0);
  const Vector3d thumb = kMillimeter * Vector3d(0.8, 0, -3.05 + 3.32);
  const AxisDifference explained =
      difference_of(ours, xml.model, barrett_pairs(5 + 2.46, 40 - 42.46), lower, thumb);
  CHECK(explained.place < 1e-12);
  CHECK(explained.direction < 1e-12);
  // At equal joint positions they differ by the bases' 2.32 mm and by 7.46 degrees of the 70 mm
  // proximal link, a chord of 9.11 mm: by the two together at most.
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
  // Their second finger has another proximal link, atan(3.4087 / 69.917) = 2.791 degrees: 0.335
  // degrees on 70 mm are 0.41 mm. Right angles are written 1.5708, 4e-6 rad too large, twice on 0.2
  // m.
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
  // This takes GraspIt!'s palm frame to H, as hands/models/human_hand/SOURCE.md says: x from z, y
  // from -x - 130 mm, z from -y - 15 mm.
  RigidTransform X_HT = shift(0, -130, -15);
  X_HT.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const AxisDifference difference = difference_of(ours, xml.model, pairs, X_HT, Vector3d::Zero());
  // Ours has two decimals of a millimeter: 0.005 in each of three coordinates of the base and of
  // two bones are 0.019 mm. The thumb's base is a matrix with four decimals, made orthonormal in
  // different ways: 1e-4 rad on the 93 mm of its bones.
  CHECK(difference.place < 3e-5);
  CHECK(difference.direction < 1e-4);
}

}  // namespace

}  // namespace test_graspit_of_shared_hands
