#include <algorithm>
#include <filesystem>
#include <numbers>
#include <set>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_export.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_hand_export {

namespace {

using namespace graspfit;
namespace fs = std::filesystem;
using hands::HandModel;
using hands::RigidTransform;
using Folder = testing::TemporaryFolder;

fs::path exported(const HandModel& hand, const fs::path& folder) {
  return hands::export_hand(hand, folder).back();
}

double difference(const RigidTransform& a, const RigidTransform& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

/// Returns two links and a joint, with the least that a hand needs.
HandModel two_links() {
  HandModel hand;
  hand.name = "pair";
  hand.links.resize(2);
  hand.links[0].name = "palm";
  hand.links[0].mesh_L = geometry::box({0.1, 0.1, 0.02});
  hand.links[1].name = "tip & \"pad\" <1>";
  hand.links[1].parent_link = 0;
  hand.links[1].parent_joint = 0;
  hand.links[1].mesh_L = geometry::ball(1.0 / 30.0, 2);
  hand.joints.resize(1);
  hand.joints[0].name = "hinge";
  hand.joints[0].parent_link = 0;
  hand.joints[0].child_link = 1;
  hand.joints[0].lower = -0.1;
  hand.joints[0].upper = 1.0 / 3.0;
  hand.joints[0].closing_sign = -1;
  hand.palm.link = 0;
  hand.fingers.resize(1);
  hand.fingers[0].name = "finger";
  hand.fingers[0].links = {1};
  hand.fingers[0].joints = {0};
  return hand;
}

/// Checks everything that an export promises to keep.
void require_same(const HandModel& a, const HandModel& b) {
  CHECK(b.name == a.name);
  REQUIRE(b.links.size() == a.links.size());
  for (std::size_t i = 0; i < a.links.size(); ++i) {
    CAPTURE(a.links[i].name);
    CHECK(b.links[i].name == a.links[i].name);
    CHECK(b.links[i].parent_link == a.links[i].parent_link);
    CHECK(b.links[i].parent_joint == a.links[i].parent_joint);
    CHECK(difference(b.links[i].X_PL_fixed, a.links[i].X_PL_fixed) < 1e-12);
    CHECK(b.links[i].mesh_L.vertices == a.links[i].mesh_L.vertices);
    CHECK(b.links[i].mesh_L.faces == a.links[i].mesh_L.faces);
    REQUIRE(b.links[i].inertia.has_value() == a.links[i].inertia.has_value());
    if (!a.links[i].inertia) continue;
    CHECK(b.links[i].inertia->mass == a.links[i].inertia->mass);
    CHECK(b.links[i].inertia->center_L == a.links[i].inertia->center_L);
    CHECK((b.links[i].inertia->inertia_L - a.links[i].inertia->inertia_L).norm() < 1e-15);
  }
  REQUIRE(b.joints.size() == a.joints.size());
  for (std::size_t j = 0; j < a.joints.size(); ++j) {
    CAPTURE(a.joints[j].name);
    CHECK(b.joints[j].name == a.joints[j].name);
    CHECK(b.joints[j].type == a.joints[j].type);
    CHECK(b.joints[j].parent_link == a.joints[j].parent_link);
    CHECK(b.joints[j].child_link == a.joints[j].child_link);
    CHECK(b.joints[j].lower == a.joints[j].lower);
    CHECK(b.joints[j].upper == a.joints[j].upper);
    CHECK(b.joints[j].closing_sign == a.joints[j].closing_sign);
    CHECK(difference(b.joints[j].X_PJ, a.joints[j].X_PJ) < 1e-12);
    CHECK((b.joints[j].axis_J - a.joints[j].axis_J).norm() < 1e-15);
    REQUIRE(b.joints[j].coupling.has_value() == a.joints[j].coupling.has_value());
    if (!a.joints[j].coupling) continue;
    CHECK(b.joints[j].coupling->leader == a.joints[j].coupling->leader);
    CHECK(b.joints[j].coupling->ratio == a.joints[j].coupling->ratio);
    CHECK(b.joints[j].coupling->offset == a.joints[j].coupling->offset);
    CHECK(b.joints[j].coupling->breakaway == a.joints[j].coupling->breakaway);
  }
  REQUIRE(b.fingers.size() == a.fingers.size());
  for (std::size_t f = 0; f < a.fingers.size(); ++f) {
    CHECK(b.fingers[f].name == a.fingers[f].name);
    CHECK(b.fingers[f].links == a.fingers[f].links);
    CHECK(b.fingers[f].joints == a.fingers[f].joints);
    CHECK(b.fingers[f].tip_pad == a.fingers[f].tip_pad);
    CHECK(b.fingers[f].is_thumb == a.fingers[f].is_thumb);
    CHECK(b.fingers[f].swing_joint == a.fingers[f].swing_joint);
  }
  REQUIRE(b.pads.size() == a.pads.size());
  for (std::size_t p = 0; p < a.pads.size(); ++p) {
    CHECK(b.pads[p].name == a.pads[p].name);
    CHECK(b.pads[p].link == a.pads[p].link);
    CHECK(b.pads[p].finger == a.pads[p].finger);
    CHECK(difference(b.pads[p].X_LC, a.pads[p].X_LC) < 1e-12);
    CHECK(b.pads[p].outline == a.pads[p].outline);
    CHECK(b.pads[p].surface == a.pads[p].surface);
    CHECK(b.pads[p].clip_thickness == a.pads[p].clip_thickness);
  }
  CHECK(b.palm.link == a.palm.link);
  CHECK(b.palm.pad == a.palm.pad);
  CHECK(b.palm.center_H == a.palm.center_H);
  CHECK((b.palm.direction_H - a.palm.direction_H).norm() < 1e-15);
  REQUIRE(b.exclusions.size() == a.exclusions.size());
  for (std::size_t i = 0; i < a.exclusions.size(); ++i) {
    CHECK(b.exclusions[i].link_a == a.exclusions[i].link_a);
    CHECK(b.exclusions[i].link_b == a.exclusions[i].link_b);
  }
}

TEST_CASE("An exported hand reads back as the same hand, bit for bit in its surfaces",
          "[hands][hand_export]") {
  for (const std::string& name : hands::shipped_hands()) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const Folder folder;
    const hands::HandReading again = hands::read_hand(exported(hand, folder.path() / "deep/er"));
    CHECK(again.findings.empty());
    require_same(hand, again.model);
  }
}

TEST_CASE("Exporting twice gives the same bytes, and what is exported of the export too",
          "[hands][hand_export]") {
  const HandModel hand = hands::find_hand("human_hand_coupled");
  const Folder folder;
  const auto files = hands::export_hand(hand, folder.path() / "a");
  const auto again = hands::export_hand(hand, folder.path() / "b");
  const auto third = hands::export_hand(hands::read_hand_model(files.back()), folder.path() / "c");
  REQUIRE(again.size() == files.size());
  REQUIRE(third.size() == files.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    CAPTURE(files[i]);
    names.insert(files[i].filename());
    const std::string bytes = base::read_file(files[i]);
    CHECK(base::read_file(again[i]) == bytes);
    // Angles and quaternions are rounded once more, so that only the surfaces must be the same
    // bytes.
    if (files[i].extension() == ".obj") CHECK(base::read_file(third[i]) == bytes);
  }
  // There are one file per link with a surface, the URDF and the sidecar, and nothing else is left.
  const auto num_surfaces =
      std::count_if(hand.links.begin(), hand.links.end(),
                    [](const hands::Link& link) { return !link.mesh_L.faces.empty(); });
  CHECK(names.size() == static_cast<std::size_t>(num_surfaces) + 2);
  std::size_t num_entries = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "a")) {
    num_entries += names.count(entry.path().filename());
    CHECK(names.contains(entry.path().filename()));
  }
  CHECK(num_entries == names.size());
}

TEST_CASE("Orientations survive roll, pitch and yaw to 1e-12, at and near gimbal lock too",
          "[hands][hand_export]") {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double quarter = std::numbers::pi / 2;
  const Folder folder;
  base::Random random(5);
  for (const double pitch : {quarter, -quarter, quarter - 1e-9, quarter + 1e-9, quarter - 1e-15,
                             -quarter + 1e-12, 0.0, 0.3, std::numbers::pi}) {
    for (int k = 0; k < 20; ++k) {
      const double yaw = random.uniform(-4, 4);
      const double roll = random.uniform(-4, 4);
      CAPTURE(pitch, yaw, roll);
      HandModel hand = two_links();
      hand.joints[0].X_PJ =
          RigidTransform(AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
                         AngleAxisd(roll, Vector3d::UnitX()));
      const HandModel again = hands::read_hand_model(exported(hand, folder.path()));
      CHECK(difference(again.joints[0].X_PJ, hand.joints[0].X_PJ) < 1e-14);
    }
  }
}

TEST_CASE("Names with signs of XML are written so that they read back", "[hands][hand_export]") {
  const Folder folder;
  const HandModel hand = two_links();
  require_same(hand, hands::read_hand_model(exported(hand, folder.path())));
}

TEST_CASE("Names that no file can bear are refused before anything is written",
          "[hands][hand_export]") {
  for (const std::string name : {"a/b", "..", ".hidden", "back\\slash", "line\nbreak"}) {
    CAPTURE(name);
    const Folder folder;
    HandModel hand = two_links();
    hand.links[1].name = name;
    CHECK_THROWS_AS(hands::export_hand(hand, folder.path() / "out"), base::InvalidInput);
    hand = two_links();
    hand.name = name;
    CHECK_THROWS_AS(hands::export_hand(hand, folder.path() / "out"), base::InvalidInput);
    CHECK_FALSE(fs::exists(folder.path() / "out"));
  }
}

}  // namespace

}  // namespace test_hand_export
