#include <algorithm>
#include <map>
#include <set>

#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_check.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "hands/closing.hpp"
#include "hands/kdl_hand.hpp"
#include "hands/shared_hands.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"

namespace test_shared_hands {

// These are hands as others describe them, without a sidecar: everything that a plan needs is
// derived.
namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::ContactPad;
using hands::FindingKind;
using hands::Finger;
using hands::HandModel;
using hands::RigidTransform;
using testing::closed_by;
using testing::SharedHand;
namespace fs = std::filesystem;

struct Read {
  SharedHand source;
  fs::path urdf;
  hands::HandReading reading;
};

/// Returns all seven, read once; empty if one is not there.
const std::vector<Read>& seven() {
  static const std::vector<Read> all = [] {
    std::vector<Read> result;
    for (const SharedHand& hand : testing::shared_hands()) {
      const auto urdf = testing::find_urdf(hand);
      if (!urdf) return std::vector<Read>();
      result.push_back({hand, *urdf, hands::read_hand(*urdf)});
    }
    return result;
  }();
  return all;
}

const char* const kWhySkipped = "hands/ with its seven folders is not there; set GRASPFIT_DATA";

#define REQUIRE_SHARED_HANDS() \
  if (seven().empty()) GRASPFIT_SKIP_TEST(kWhySkipped)

const hands::Link& link_of(const HandModel& hand, const ContactPad& pad) {
  return hand.links[static_cast<std::size_t>(pad.link)];
}

const ContactPad& tip_pad(const HandModel& hand, const Finger& finger) {
  return hand.pads[static_cast<std::size_t>(*finger.tip_pad)];
}

TEST_CASE("The seven shared hands have the fingers, thumb and joints that their makers gave them",
          "[hands][shared_hands]") {
  REQUIRE_SHARED_HANDS();
  for (const auto& [source, urdf, reading] : seven()) {
    CAPTURE(source.folder);
    const HandModel& hand = reading.model;
    CHECK_NOTHROW(hands::validate(hand));
    for (const hands::HandFinding& finding : reading.findings) {
      CHECK(finding.kind != FindingKind::Fault);
    }
    // A wrist may be left out, and nothing else.
    const int num_left_out = source.num_movable - static_cast<int>(hand.joints.size());
    CHECK((num_left_out == 0 || num_left_out == source.num_before_palm));
    CHECK(hand.num_intrinsic_dof() == source.num_independent - num_left_out);
    REQUIRE(hand.fingers.size() == static_cast<std::size_t>(source.num_fingers));
    CHECK(hand.palm.direction_H.norm() == Approx(1.0).margin(1e-12));
    std::set<int> links_of_fingers;
    int num_thumbs = 0;
    for (const Finger& finger : hand.fingers) {
      CAPTURE(finger.name);
      REQUIRE(finger.tip_pad);
      REQUIRE_FALSE(finger.joints.empty());
      // Some joint of each finger closes it, and the pad is carried by it.
      CHECK(std::any_of(finger.joints.begin(), finger.joints.end(), [&](int j) {
        return hand.joints[static_cast<std::size_t>(j)].closing_sign != 0;
      }));
      CHECK(std::count(finger.links.begin(), finger.links.end(), tip_pad(hand, finger).link) == 1);
      for (const int link : finger.links) CHECK(links_of_fingers.insert(link).second);
      num_thumbs += finger.is_thumb;
      if (finger.is_thumb && !source.thumb_link.empty()) {
        CHECK(std::count(finger.links.begin(), finger.links.end(),
                         hand.link_index(source.thumb_link)) == 1);
      }
    }
    CHECK(num_thumbs <= 1);
    if (!source.thumb_link.empty()) CHECK(num_thumbs == 1);
    CHECK(links_of_fingers.count(hand.palm.link) == 0);
  }
}

TEST_CASE("Closing brings the tips of the shared hands to the thumb, pads face to face",
          "[hands][shared_hands]") {
  REQUIRE_SHARED_HANDS();
  for (const auto& [source, urdf, reading] : seven()) {
    const HandModel& hand = reading.model;
    const Finger& thumb = hand.fingers[static_cast<std::size_t>(hand.thumb())];
    const auto distance = [&](const std::vector<RigidTransform>& X_OL, const Finger& finger) {
      return (hands::pad_pose(hand, *finger.tip_pad, X_OL).translation() -
              hands::pad_pose(hand, *thumb.tip_pad, X_OL).translation())
          .norm();
    };
    int num_facing = 0;
    for (const Finger& finger : hand.fingers) {
      if (&finger == &thumb) continue;
      CAPTURE(source.folder, finger.name);
      const double open = distance(hands::forward_kinematics(hand, closed_by(hand, 0.0)), finger);
      double nearest = open;
      bool faces = false;
      for (int step = 1; step <= 20; ++step) {
        const auto X_OL = hands::forward_kinematics(hand, closed_by(hand, step / 20.0));
        nearest = std::min(nearest, distance(X_OL, finger));
        const RigidTransform tip = hands::pad_pose(hand, *finger.tip_pad, X_OL);
        const RigidTransform other = hands::pad_pose(hand, *thumb.tip_pad, X_OL);
        const Vector3d line = (tip.translation() - other.translation()).normalized();
        // Around half closed each pad sees the other within 60 degrees of its normal.
        if (step >= 6 && step <= 14 && other.linear().col(2).dot(line) > 0.5 &&
            -tip.linear().col(2).dot(line) > 0.5) {
          faces = true;
        }
      }
      CAPTURE(open, nearest);
      CHECK(nearest < 0.6 * open);
      num_facing += faces;
    }
    // Of five fingers, those beside the thumb see it, as closing moves no thumb sideways.
    CAPTURE(source.folder);
    CHECK(num_facing >= (source.num_fingers == 5 ? 2 : source.num_fingers - 1));
  }
}

TEST_CASE("Tip pads of the shared hands lie on their link and look where closing takes them",
          "[hands][shared_hands]") {
  REQUIRE_SHARED_HANDS();
  for (const auto& [source, urdf, reading] : seven()) {
    const HandModel& hand = reading.model;
    const hands::HandConfiguration half = closed_by(hand, 0.5);
    const auto X_OL = hands::forward_kinematics(hand, half);
    Eigen::VectorXd closing_speed = Eigen::VectorXd::Zero(half.q.size());
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      const hands::Joint& joint = hand.joints[j];
      closing_speed[static_cast<Eigen::Index>(j)] =
          joint.coupling ? 0.0 : joint.closing_sign * (joint.upper - joint.lower);
    }
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      const auto& coupling = hand.joints[j].coupling;
      if (!coupling) continue;
      closing_speed[static_cast<Eigen::Index>(j)] =
          coupling->ratio * closing_speed[coupling->leader];
    }
    for (const Finger& finger : hand.fingers) {
      const ContactPad& pad = tip_pad(hand, finger);
      CAPTURE(source.folder, finger.name, pad.name);
      const Vector3d velocity =
          (hands::point_jacobian(hand, X_OL, pad.link, pad.X_LC.translation()) * closing_speed)
              .head<3>();
      const Vector3d normal =
          X_OL[static_cast<std::size_t>(pad.link)].linear() * pad.X_LC.linear().col(2);
      CHECK(velocity.normalized().dot(normal) > 0.5);
      // A pad is part of the surface, so that its middle is that near the mesh.
      const geometry::MeshQuery skin(link_of(hand, pad).mesh_L);
      const Vector3d middle_L = pad.X_LC * hands::pad_contact_point_C(pad);
      CHECK((skin.closest_point(middle_L).point - middle_L).norm() < 3e-3);
      // The bound is in m²; a child's fingertip has more.
      CHECK(hands::pad_area(pad) > 20e-6);
      CHECK(hands::pad_area(pad) < 5e-3);
    }
  }
}

TEST_CASE("No shared hand touches itself when open, exclusions aside", "[hands][shared_hands]") {
  REQUIRE_SHARED_HANDS();
  for (const auto& [source, urdf, reading] : seven()) {
    const HandModel& hand = reading.model;
    const auto found = hands::HandCollision(hand).against_self(
        hands::forward_kinematics(hand, hands::open_configuration(hand)));
    CAPTURE(source.folder, found.link_a, found.link_b, found.depth);
    CHECK_FALSE(found.intersects);
    // Exclusions are for neighbors and what always overlaps, not for everything.
    std::size_t num_pairs = 0, num_excluded = 0;
    for (std::size_t a = 0; a < hand.links.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (hand.links[a].mesh_L.faces.empty() || hand.links[b].mesh_L.faces.empty()) continue;
        ++num_pairs;
        num_excluded += hand.is_excluded(static_cast<int>(a), static_cast<int>(b));
      }
    }
    CHECK(num_excluded < num_pairs);
    for (const Finger& one : hand.fingers) {
      for (const Finger& two : hand.fingers) {
        if (&one == &two) continue;
        CHECK_FALSE(hand.is_excluded(tip_pad(hand, one).link, tip_pad(hand, two).link));
      }
    }
  }
}

/// Returns the findings whose item or text has all the words in it.
std::vector<hands::HandFinding> matching(const hands::HandCheck& check, FindingKind kind,
                                         const std::vector<std::string>& words) {
  std::vector<hands::HandFinding> result;
  for (const hands::HandFinding& finding : check.findings) {
    const std::string text = finding.item + ": " + finding.what;
    if (finding.kind == kind && std::all_of(words.begin(), words.end(), [&](const auto& word) {
          return text.find(word) != std::string::npos;
        })) {
      result.push_back(finding);
    }
  }
  return result;
}

/// Returns whether a link's mesh files, taken by themselves, leave an edge open.
bool is_open(const fs::path& urdf, const std::vector<std::string>& mesh_files) {
  return std::any_of(mesh_files.begin(), mesh_files.end(), [&](const std::string& file) {
    return !geometry::analyze(geometry::read_mesh(urdf.parent_path() / file).mesh).is_closed;
  });
}

/// Checks a hand from its file alone: what its source names is found, and nothing that stops it.
void check_shared_hand(const SharedHand& source) {
  CAPTURE(source.folder);
  const auto urdf = testing::find_urdf(source);
  REQUIRE(urdf);
  const hands::HandCheck check = hands::check_hand(*urdf);
  CHECK(check.model.has_value());
  CHECK(check.count(FindingKind::Fault) == 0);
  for (const hands::HandFinding& finding : check.findings) {
    CAPTURE(finding.item, finding.what);
    CHECK_FALSE(finding.what.empty());
    CHECK(finding.what.find('\n') == std::string::npos);
  }
  // Open skins are closed for collision, and each is reported: as many as there are by themselves.
  const testing::KdlHand file(*urdf);
  for (const testing::KdlHand::Link& link : file.links()) {
    if (!is_open(*urdf, link.mesh_files)) continue;
    CAPTURE(link.name);
    const bool is_said = std::any_of(
        check.findings.begin(), check.findings.end(),
        [&](const hands::HandFinding& finding) { return finding.item == "link " + link.name; });
    CHECK(is_said);
  }
  if (source.folder == "barrett_graspit") {
    // The coupling distal = proximal / 3 is written as an axis of that length.
    for (const char* joint :
         {"a_link2_link3_joint", "b_link2_link3_joint", "c_link2_link3_joint"}) {
      CAPTURE(joint);
      CHECK_FALSE(matching(check, FindingKind::Suspicious, {joint, "0.333"}).empty());
    }
  }
  if (source.folder == "barrett_hand") {
    // There is no <mimic>: the hand has eight joints and four motors.
    for (const char* joint :
         {"finger_1_dist_joint", "finger_2_dist_joint", "finger_3_dist_joint"}) {
      CAPTURE(joint);
      CHECK_FALSE(matching(check, FindingKind::Suspicious, {joint}).empty());
    }
    CHECK_FALSE(matching(check, FindingKind::Suspicious, {"finger_2_prox_joint"}).empty());
  }
}

/// Returns whether all seven folders are there; nothing is read.
bool are_there() {
  const std::vector<SharedHand> all = testing::shared_hands();
  return std::all_of(all.begin(), all.end(),
                     [](const SharedHand& hand) { return testing::find_urdf(hand).has_value(); });
}

TEST_CASE("Checking shared hands of up to four fingers finds what their sources name",
          "[hands][shared_hands]") {
  if (!are_there()) GRASPFIT_SKIP_TEST(kWhySkipped);
  // Hands of five fingers take half a minute; they have a test of their own.
  for (const SharedHand& source : testing::shared_hands()) {
    if (source.num_fingers < 5) check_shared_hand(source);
  }
}

TEST_CASE("Checking every shared hand finds what their sources name, and nothing that stops them",
          "[hands][shared_hands][full]") {
  if (!are_there()) GRASPFIT_SKIP_TEST(kWhySkipped);
  for (const SharedHand& source : testing::shared_hands()) check_shared_hand(source);
}

TEST_CASE("The human hand's skin is open everywhere, and closed for collision",
          "[hands][shared_hands]") {
  REQUIRE_SHARED_HANDS();
  const auto human = std::find_if(seven().begin(), seven().end(), [](const Read& read) {
    return read.source.folder == "human_hand_20dof";
  });
  const testing::KdlHand file(human->urdf);
  int num_open = 0;
  for (const testing::KdlHand::Link& link : file.links()) {
    num_open += is_open(human->urdf, link.mesh_files);
  }
  CHECK(num_open == 16);  // They are the palm and three per finger.
  for (const hands::Link& link : human->reading.model.links) {
    if (link.mesh_L.faces.empty()) continue;
    CAPTURE(link.name);
    CHECK(geometry::analyze(link.mesh_L).is_closed);
  }
}

TEST_CASE("GraspIt!'s own files give back the couplings that the URDFs beside them lost",
          "[hands][shared_hands]") {
  const auto barrett = testing::find_data("hands/barrett_graspit/graspit_Barrett.xml");
  const auto human = testing::find_data("hands/human_hand_20dof/graspit_HumanHand20DOF.xml");
  if (!barrett || !human) {
    GRASPFIT_SKIP_TEST("hands/barrett_graspit and hands/human_hand_20dof are not there");
  }
  const HandModel three = hands::read_hand_model(*barrett);
  CHECK(three.fingers.size() == 3);
  CHECK(three.joints.size() == 8);
  CHECK(three.num_intrinsic_dof() == 4);
  int num_distal = 0;
  for (const hands::Joint& joint : three.joints) {
    if (!joint.coupling || joint.coupling->ratio == 1.0) continue;
    CAPTURE(joint.name);
    ++num_distal;
    CHECK(joint.coupling->ratio == 0.333333333);  // It is as the file writes it.
    CHECK(joint.coupling->breakaway);             // Its degrees of freedom are of type b.
  }
  CHECK(num_distal == 3);
  CHECK(three.palm.direction_H == Vector3d::UnitZ());
  const HandModel five = hands::read_hand_model(*human);
  CHECK(five.fingers.size() == 5);
  CHECK(five.num_intrinsic_dof() == 20);
  // GraspIt! has it so: approach direction (0, -1, 0) from (-130, -15, 0) mm.
  CHECK((five.palm.direction_H - Vector3d(0, -1, 0)).norm() < 1e-12);
  // The file's own point is not read; the derived center is beside it on the palm.
  CHECK((five.palm.center_H - Vector3d(-0.130, -0.015, 0)).norm() < 0.012);
}

}  // namespace

}  // namespace test_shared_hands
