#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_derivation {

namespace {

namespace fs = std::filesystem;
using namespace graspfit;
using Eigen::Vector3d;
using hands::ContactPad;
using hands::Finger;
using hands::HandModel;
using hands::Joint;
using hands::RigidTransform;
using nlohmann::json;
using Folder = testing::TemporaryFolder;

/// A copy of the shipped hands whose sidecars keep only the given members.
class StrippedHands {
 public:
  explicit StrippedHands(const std::set<std::string>& members) {
    fs::copy(testing::source_directory() / "hands/models", folder_.path(),
             fs::copy_options::recursive);
    for (const std::string& name : hands::shipped_hands()) {
      const fs::path sidecar = folder_.path() / name / (name + ".graspfit.json");
      json kept = json::object();
      const json whole = json::parse(base::read_file(sidecar));
      for (const auto& [key, value] : whole.items()) {
        if (key == "format" || members.contains(key)) kept[key] = value;
      }
      std::ofstream(sidecar) << kept;
    }
  }
  fs::path file(const std::string& name) const { return folder_.path() / name / (name + ".urdf"); }

 private:
  Folder folder_;
};

/// Returns a shipped hand of which all is derived but its couplings (a URDF cannot say that they
/// break away).
const hands::HandReading& derived(const std::string& name) {
  static const StrippedHands stripped({"couplings"});
  static std::map<std::string, hands::HandReading> known;
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  return known.emplace(name, hands::read_hand(stripped.file(name))).first->second;
}

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

std::vector<std::string> link_names(const HandModel& hand, const Finger& finger) {
  std::vector<std::string> names;
  for (const int link : finger.links)
    names.push_back(hand.links[static_cast<std::size_t>(link)].name);
  return names;
}

/// Returns link poses at the share `closing` of the way from open to closed, with followers where
/// their leaders put them.
std::vector<RigidTransform> closed_by(const HandModel& hand, double closing) {
  hands::HandConfiguration c = hands::open_configuration(hand);
  HandModel rigid = hand;
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const Joint& joint = hand.joints[j];
    if (rigid.joints[j].coupling) rigid.joints[j].coupling->breakaway = false;
    if (joint.closing_sign == 0) continue;
    const double open = joint.closing_sign > 0 ? joint.lower : joint.upper;
    const double closed = joint.closing_sign > 0 ? joint.upper : joint.lower;
    c.q[static_cast<Eigen::Index>(j)] = open + closing * (closed - open);
  }
  hands::apply_couplings(rigid, c.q);
  return hands::forward_kinematics(hand, c);
}

/// Returns the mean distance between the centers of the fingers' tip pads.
double tip_distance(const HandModel& hand, double closing) {
  const auto X_HL = closed_by(hand, closing);
  double sum = 0.0;
  int count = 0;
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
    for (std::size_t g = 0; g < f; ++g, ++count) {
      sum += (hands::pad_pose(hand, *hand.fingers[f].tip_pad, X_HL).translation() -
              hands::pad_pose(hand, *hand.fingers[g].tip_pad, X_HL).translation())
                 .norm();
    }
  }
  return sum / count;
}

TEST_CASE(
    "Of shipped hands without sidecars, fingers, thumb, swing joints and closing signs are found",
    "[hands][derivation]") {
  for (const std::string& name : hands::shipped_hands()) {
    CAPTURE(name);
    const HandModel made = hands::find_hand(name);
    const HandModel& found = derived(name).model;
    REQUIRE(found.joints.size() == made.joints.size());
    for (std::size_t j = 0; j < made.joints.size(); ++j) {
      CAPTURE(made.joints[j].name);
      CHECK(found.joints[j].closing_sign == made.joints[j].closing_sign);
    }
    REQUIRE(found.fingers.size() == made.fingers.size());
    for (const Finger& finger : made.fingers) {
      CAPTURE(finger.name);
      const auto same =
          std::find_if(found.fingers.begin(), found.fingers.end(),
                       [&](const Finger& f) { return f.links.back() == finger.links.back(); });
      REQUIRE(same != found.fingers.end());
      CHECK(same->links == finger.links);
      CHECK(same->joints == finger.joints);
      CHECK(same->is_thumb == finger.is_thumb);
      CHECK(same->swing_joint == finger.swing_joint);
      REQUIRE(same->tip_pad);
      CHECK(found.pads[static_cast<std::size_t>(*same->tip_pad)].link ==
            made.pads[static_cast<std::size_t>(*finger.tip_pad)].link);
    }
  }
}

TEST_CASE("Of shipped hands without sidecars, palms and pads are found where they were made",
          "[hands][derivation]") {
  struct Case {
    std::string hand;
    double palm_deg;    ///< Palm direction.
    double pad_deg;     ///< Pad normals.
    double least_area;  ///< Of the made pad's.
    double largest_area;
    double deviation;  ///< Of derived pads' tops from the mesh [m].
  };
  // The bounds were measured. For grippers and the Barrett hand, made pads keep a little off the
  // edges of their planes, and palms end where the jaws' way does. For human hands, made pads are
  // narrow ellipses, derived ones go on to where the skin leans by 50 degrees; made tip pads look
  // 14 degrees toward the tip.
  const std::vector<Case> cases = {
      {"parallel_gripper", 0.01, 0.1, 0.8, 1.1, 1e-6},
      {"franka_gripper", 0.01, 0.1, 0.8, 1.1, 1e-6},
      {"barrett", 0.01, 0.1, 0.95, 1.1, 1e-6},
      {"human_hand", 0.01, 20.0, 1.5, 7.0, 3e-6},
      {"human_hand_small", 0.01, 20.0, 1.5, 7.0, 3e-6},
  };
  for (const Case& c : cases) {
    CAPTURE(c.hand);
    const HandModel made = hands::find_hand(c.hand);
    const HandModel& found = derived(c.hand).model;
    CHECK(degrees_between(found.palm.direction_H, made.palm.direction_H) <= c.palm_deg);
    for (const ContactPad& pad : made.pads) {
      CAPTURE(pad.name);
      const auto same = std::find_if(found.pads.begin(), found.pads.end(),
                                     [&](const ContactPad& p) { return p.link == pad.link; });
      REQUIRE(same != found.pads.end());
      const double angle = degrees_between(same->X_LC.linear().col(2), pad.X_LC.linear().col(2));
      const double area = hands::pad_area(*same) / hands::pad_area(pad);
      CHECK(angle <= c.pad_deg);
      CHECK(area >= c.least_area);
      CHECK(area <= c.largest_area);
      CHECK(same->surface.empty() == pad.surface.empty());
      const geometry::MeshQuery mesh(made.links[static_cast<std::size_t>(pad.link)].mesh_L);
      for (Vector3d point : same->surface) {
        CHECK(std::abs(mesh.signed_distance(same->X_LC * point)) <= c.deviation);
      }
    }
  }
}

struct SharedHand {
  std::string file;
  std::size_t num_fingers;
  std::string thumb;  ///< Its last link with a surface; empty: none.
  int num_dof;
  double closest;  ///< Mean tip distance somewhere between open and closed is below this, of open.
};

// The counts are those of SOURCES.md beside the hands; the Shadow hand is without its two wrist
// joints.
const std::vector<SharedHand>& shared_hands() {
  static const std::vector<SharedHand> hands = {
      {"hands/robotiq_2f_85/robotiq_2f_85.urdf", 2, "", 1, 0.2},
      {"hands/panda_gripper/franka_panda.urdf", 2, "", 1, 0.2},
      {"hands/barrett_hand/bhand_model.urdf", 3, "finger_3_dist_link", 8, 0.6},
      {"hands/barrett_graspit/Barrett.urdf", 3, "c_link3", 8, 0.6},
      {"hands/human_hand_20dof/HumanHand.urdf", 5, "thumb3", 20, 0.8},
      {"hands/shadow_hand/shadow_hand_right.urdf", 5, "thtip", 22, 0.8},
      {"hands/allegro_hand/allegro_hand_right.urdf", 4, "link_15.0_tip", 16, 0.8},
  };
  return hands;
}

/// Returns a shared hand, read once; nullptr if it is not there.
const hands::HandReading* shared(const std::string& relative) {
  static std::map<std::string, hands::HandReading> known;
  const auto found = known.find(relative);
  if (found != known.end()) return &found->second;
  const auto file = testing::find_data(relative);
  if (!file) return nullptr;
  return &known.emplace(relative, hands::read_hand(*file)).first->second;
}

TEST_CASE("Every shared hand is derived with its fingers, its thumb and one tip pad per finger",
          "[hands][derivation]") {
  for (const SharedHand& expected : shared_hands()) {
    CAPTURE(expected.file);
    const hands::HandReading* reading = shared(expected.file);
    if (reading == nullptr) GRASPFIT_SKIP_TEST(expected.file + " is not there; set GRASPFIT_DATA");
    const HandModel& hand = reading->model;
    CHECK(hand.fingers.size() == expected.num_fingers);
    CHECK(hand.num_intrinsic_dof() == expected.num_dof);
    std::string thumb;
    for (const Finger& finger : hand.fingers) {
      if (finger.is_thumb) thumb = link_names(hand, finger).back();
      REQUIRE(finger.tip_pad);
    }
    CHECK(thumb == expected.thumb);
    CHECK(hand.palm.pad);
    for (const hands::HandFinding& finding : reading->findings) {
      CHECK(finding.what.find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("Shared hands close on something: tips come together and tip pads turn toward each other",
          "[hands][derivation]") {
  for (const SharedHand& expected : shared_hands()) {
    CAPTURE(expected.file);
    const hands::HandReading* reading = shared(expected.file);
    if (reading == nullptr) GRASPFIT_SKIP_TEST(expected.file + " is not there; set GRASPFIT_DATA");
    const HandModel& hand = reading->model;
    const double open = tip_distance(hand, 0.0);
    double least = open;
    for (int i = 1; i <= 10; ++i) least = std::min(least, tip_distance(hand, 0.1 * i));
    CHECK(least <= expected.closest * open);
    // No pad turns its back on what the hand closes on, a point before the palm between the tips.
    const auto X_HL = closed_by(hand, 0.5);
    Vector3d between = Vector3d::Zero();
    for (const Finger& finger : hand.fingers) {
      between += hands::pad_pose(hand, *finger.tip_pad, X_HL).translation() /
                 static_cast<double>(hand.fingers.size());
    }
    CHECK(hand.palm.direction_H.dot(between - hand.palm.center_H) > 0.0);
    const Vector3d held = 0.5 * (between + hand.palm.center_H);
    for (const Finger& finger : hand.fingers) {
      CAPTURE(finger.name);
      const RigidTransform pad = hands::pad_pose(hand, *finger.tip_pad, X_HL);
      const Vector3d goal = hand.fingers.size() == 2 ? between : held;
      // The bound is 75 degrees, as fingers of Barrett hands are far past each other when all
      // joints are half way.
      CHECK(pad.linear().col(2).dot((goal - pad.translation()).normalized()) > 0.25);
    }
  }
}

TEST_CASE("No derived hand collides with itself when open", "[hands][derivation]") {
  std::vector<const hands::HandReading*> readings;
  for (const std::string& name : hands::shipped_hands()) readings.push_back(&derived(name));
  for (const SharedHand& hand : shared_hands()) {
    if (const hands::HandReading* reading = shared(hand.file)) readings.push_back(reading);
  }
  for (const hands::HandReading* reading : readings) {
    CAPTURE(reading->model.description_file);
    CHECK_FALSE(hands::HandCollision(reading->model)
                    .against_self(closed_by(reading->model, 0.0))
                    .intersects);
  }
}

TEST_CASE("A derived sidecar reads back as the hand that was derived",
          "[hands][derivation][sidecar]") {
  const StrippedHands stripped({"couplings"});
  for (const std::string name : {"barrett", "human_hand"}) {
    CAPTURE(name);
    const fs::path file = stripped.file(name);
    const HandModel& first = derived(name).model;
    const std::string text = hands::derived_sidecar_text(file);
    CHECK(text == hands::derived_sidecar_text(file));  // The same input gives the same bytes.
    std::ofstream(hands::sidecar_file_of(file), std::ios::binary) << text;
    const hands::HandReading second = hands::read_hand(file);
    CHECK(second.findings.empty());
    REQUIRE(second.model.pads.size() == first.pads.size());
    for (std::size_t p = 0; p < first.pads.size(); ++p) {
      CHECK(second.model.pads[p].name == first.pads[p].name);
      CHECK(second.model.pads[p].outline == first.pads[p].outline);
      CHECK(second.model.pads[p].surface == first.pads[p].surface);
      CHECK((second.model.pads[p].X_LC.matrix() - first.pads[p].X_LC.matrix()).norm() < 1e-14);
    }
    CHECK(second.model.exclusions.size() == first.exclusions.size());
  }
}

// These small hands are written here.

std::string box_link(const std::string& name, const std::string& size, const std::string& at) {
  return "<link name=\"" + name + "\"><collision><origin xyz=\"" + at +
         "\"/><geometry><box size=\"" + size + "\"/></geometry></collision></link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& at, const std::string& axis,
                  const std::string& limits, const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><origin " + at + "/><axis xyz=\"" + axis +
         "\"/><limit " + limits + " effort=\"1\" velocity=\"1\"/>" + more + "</joint>\n";
}

/// Returns the links of two fingers of two boxes that curl toward each other over a plate (its top
/// at z = 0.01).
std::string pinch_links() {
  std::string text = box_link("plate", "0.1 0.06 0.02", "0 0 0");
  for (const std::string side : {"left", "right"}) {
    text += box_link(side + "_lower", "0.01 0.02 0.04", "0 0 0.02") +
            box_link(side + "_upper", "0.01 0.02 0.04", "0 0 0.02");
    const std::string x = side == "left" ? "xyz=\"-0.045 0 0.012\""
                                         : "xyz=\"0.045 0 0.012\" rpy=\"0 0 3.141592653589793\"";
    text += joint(side + "_bend", "revolute", "plate", side + "_lower", x, "0 1 0",
                  "lower=\"-0.2\" upper=\"1.2\"") +
            joint(side + "_curl", "revolute", side + "_lower", side + "_upper", "xyz=\"0 0 0.042\"",
                  "0 -1 0", "lower=\"-1.2\" upper=\"0.1\"");
  }
  return text;
}

std::string robot(const std::string& content) {
  return "<robot name=\"pinch\">" + content + "</robot>";
}

TEST_CASE(
    "Flat links give flat pads that are their faces, and axes against each other opposite signs",
    "[hands][derivation]") {
  const Folder folder;
  const HandModel hand = hands::read_hand_model(folder.write("pinch.urdf", robot(pinch_links())));
  for (const std::string side : {"left", "right"}) {
    CHECK(hand.joints[static_cast<std::size_t>(hand.joint_index(side + "_bend"))].closing_sign ==
          1);
    CHECK(hand.joints[static_cast<std::size_t>(hand.joint_index(side + "_curl"))].closing_sign ==
          -1);
    const Finger& finger = hand.fingers[static_cast<std::size_t>(hand.finger_index(side))];
    CHECK_FALSE(finger.is_thumb);
    CHECK_FALSE(finger.swing_joint);
    const ContactPad& pad = hand.pads[static_cast<std::size_t>(*finger.tip_pad)];
    CHECK(pad.surface.empty());
    // The pad is the inner face of a box 0.01 x 0.02 x 0.04 whose middle is at z = 0.02.
    CHECK(degrees_between(pad.X_LC.linear().col(2), Vector3d::UnitX()) < 1e-6);
    CHECK((pad.X_LC.translation() - Vector3d(0.005, 0, 0.02)).norm() < 1e-9);
    CHECK(hands::pad_area(pad) == Approx(0.02 * 0.04).epsilon(1e-9));
  }
  CHECK(hand.palm.direction_H == Vector3d::UnitZ());
  CHECK(hand.palm.center_H.z() == Approx(0.01).margin(1e-9));
  const ContactPad& palm = hand.pads[static_cast<std::size_t>(*hand.palm.pad)];
  // It is as wide as the first joints stand apart, 0.09; the other way it has the plate's 0.06.
  CHECK(hands::pad_area(palm) == Approx(0.09 * 0.06).epsilon(1e-9));
}

TEST_CASE("What a partial sidecar says is kept, and the rest follows it", "[hands][derivation]") {
  const Folder folder;
  const fs::path file = folder.write("pinch.urdf", robot(pinch_links()));
  const std::string format = R"({"format": {"name": "graspfit hand sidecar", "version": 1}, )";
  const auto read = [&](const std::string& members) {
    folder.write("pinch.graspfit.json", format + members + "}");
    return hands::read_hand_model(file);
  };
  SECTION("closing directions: pads are on the side that moves ahead") {
    const HandModel hand = read(R"("closing": {"left_bend": -1, "left_curl": 1, "right_bend": 1})");
    CHECK(hand.joints[static_cast<std::size_t>(hand.joint_index("left_bend"))].closing_sign == -1);
    CHECK(hand.joints[static_cast<std::size_t>(hand.joint_index("right_curl"))].closing_sign == 0);
    const Finger& left = hand.fingers[static_cast<std::size_t>(hand.finger_index("left"))];
    CHECK(degrees_between(hand.pads[static_cast<std::size_t>(*left.tip_pad)].X_LC.linear().col(2),
                          -Vector3d::UnitX()) < 1e-6);
  }
  SECTION("fingers: names, thumb and tip pad") {
    const HandModel hand = read(
        R"("fingers": [{"name": "one", "thumb": true, "links": ["left_lower", "left_upper"],
            "joints": ["left_bend", "left_curl"], "tip_pad": "my_pad"}])");
    REQUIRE(hand.fingers.size() == 1);
    CHECK(hand.fingers[0].is_thumb);
    CHECK(hand.pads[static_cast<std::size_t>(*hand.fingers[0].tip_pad)].name == "my_pad");
    CHECK(hand.links[static_cast<std::size_t>(
                         hand.pads[static_cast<std::size_t>(*hand.fingers[0].tip_pad)].link)]
              .name == "left_upper");
  }
  SECTION("pads: their fingers are named after them") {
    const HandModel hand = read(
        R"("pads": [{"name": "p", "link": "right_upper", "finger": "friend",
            "frame": {"translation_m": [0.005, 0, 0.02], "rotation_wxyz": [0.7071, 0, 0.7071, 0]},
            "outline_m": [[0.01, -0.01], [0.01, 0.01], [-0.01, 0.01], [-0.01, -0.01]]}])");
    REQUIRE(hand.pads.size() == 1);
    CHECK(hand.pads[0].finger == hand.finger_index("friend"));
    CHECK(!hand.palm.pad);
    CHECK(hand.finger_index("left") >= 0);
  }
  SECTION("palm: its direction, center and pad's name") {
    const HandModel hand = read(
        R"("palm": {"link": "plate", "center_m": [0, 0, -0.01], "direction": [0, 0, -1], "pad": "back"})");
    CHECK(hand.palm.direction_H == -Vector3d::UnitZ());
    CHECK(hand.pads[static_cast<std::size_t>(*hand.palm.pad)].name == "back");
    CHECK(hand.pads[static_cast<std::size_t>(*hand.palm.pad)].X_LC.linear()(2, 2) == Approx(-1.0));
  }
}

TEST_CASE("An arm before the hand is left out, unless the sidecar's palm link says otherwise",
          "[hands][derivation]") {
  const std::string arm = box_link("base", "0.1 0.1 0.1", "0 0 0") +
                          box_link("arm", "0.05 0.05 0.2", "0 0 0.1") +
                          joint("shoulder", "revolute", "base", "arm", "xyz=\"0 0 0.05\"", "0 0 1",
                                "lower=\"-1\" upper=\"1\"") +
                          joint("wrist", "revolute", "arm", "plate", "xyz=\"0 0 0.25\"", "1 0 0",
                                "lower=\"-1\" upper=\"1\"");
  const Folder folder;
  const fs::path file = folder.write("pinch.urdf", robot(pinch_links() + arm));
  const hands::HandReading reading = hands::read_hand(file);
  CHECK(reading.model.links[0].name == "plate");
  CHECK(reading.model.joints.size() == 4);
  const auto note = std::find_if(
      reading.findings.begin(), reading.findings.end(),
      [](const hands::HandFinding& f) { return f.what.find("left out") != std::string::npos; });
  REQUIRE(note != reading.findings.end());
  CHECK(note->what.find("links base, arm and joints shoulder, wrist") != std::string::npos);

  folder.write("pinch.graspfit.json",
               R"({"format": {"name": "graspfit hand sidecar", "version": 1},
                   "palm": {"link": "base", "center_m": [0, 0, 0.05], "direction": [0, 0, 1]}})");
  const HandModel whole = hands::read_hand_model(file);
  CHECK(whole.links[0].name == "base");
  CHECK(whole.joints.size() == 6);
}

TEST_CASE("A bar of a linkage is no finger", "[hands][derivation]") {
  // A bar beside the left finger follows its joints, overlaps its upper link and ends lower.
  const std::string follow = "<mimic joint=\"right_bend\" multiplier=\"1\"/>";
  std::string links = pinch_links();
  const auto coupled = [&](const std::string& name, const std::string& ratio) {
    const std::size_t at = links.find("</joint>", links.find("<joint name=\"" + name + "\""));
    links.insert(at, "<mimic joint=\"right_bend\" multiplier=\"" + ratio + "\"/>");
  };
  coupled("left_bend", "1");
  coupled("left_curl", "-0.1");
  links += box_link("bar", "0.01 0.01 0.05", "0 0 0.025") +
           joint("bar_bend", "revolute", "plate", "bar", "xyz=\"-0.045 0.01 0.012\"", "0 1 0",
                 "lower=\"-0.2\" upper=\"1.2\"", follow);
  const Folder folder;
  const hands::HandReading reading = hands::read_hand(folder.write("pinch.urdf", robot(links)));
  CHECK(reading.model.fingers.size() == 2);
  CHECK(reading.model.joints[static_cast<std::size_t>(reading.model.joint_index("bar_bend"))]
            .closing_sign == 1);
  CHECK(std::any_of(reading.findings.begin(), reading.findings.end(), [](const auto& f) {
    return f.item == "link bar" && f.what.find("no finger") != std::string::npos;
  }));
}

TEST_CASE("Hands from which nothing can be derived are refused in one line",
          "[hands][derivation]") {
  const Folder folder;
  const std::string bare =
      robot("<link name=\"a\"/><link name=\"b\"/>" +
            joint("j", "revolute", "a", "b", "xyz=\"0 0 0\"", "0 0 1", "lower=\"0\" upper=\"1\""));
  try {
    hands::read_hand(folder.write("bare.urdf", bare));
    FAIL("accepted");
  } catch (const base::InvalidInput& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(message.find("bare.urdf") != std::string::npos);
    CHECK(message.find("no finger can be derived") != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  }
}

}  // namespace

}  // namespace test_derivation
