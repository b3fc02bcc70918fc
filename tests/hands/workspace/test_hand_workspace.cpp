#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "hands/workspace/planar_hand.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_hand_workspace {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using Eigen::Vector3d;
using hands::DistanceRange;
using hands::HandModel;
using hands::HandWorkspace;
using hands::RigidTransform;
using hands::TipDistances;
using hands::WorkspaceOptions;
using std::numbers::pi;

TEST_CASE("Two planar fingers of two links reach what two rings reach", "[hands][hand_workspace]") {
  struct Case {
    double base, proximal, distal;
    double tips, palm;  ///< Smallest distances between the tips, and from the middle to a tip.
  };
  // A tip of two links reaches a ring around its base, here the upper half of it and more (each
  // joint turns by 1.3 pi). The nearest points of the rings lie on the line between the bases.
  // In the first case the rings cross and hold the middle, in the second the distances are 2 (150 −
  // 120) and 150 − 120, in the third the rings touch in the middle, and in the last the middle is
  // in the hole, 60 − 10 from the ring.
  for (const Case& c : {Case{0.05, 0.07, 0.05, 0.0, 0.0}, Case{0.15, 0.07, 0.05, 0.06, 0.03},
                        Case{0.12, 0.07, 0.05, 0.0, 0.0}, Case{0.01, 0.09, 0.03, 0.0, 0.05}}) {
    CAPTURE(c.base);
    const HandModel hand = planar_hand(c.base, {c.proximal, c.distal}, 1.3 * pi);
    const double widest = 2 * (c.base + c.proximal + c.distal);
    struct Grid {
      WorkspaceOptions options;
      double margin;  ///< Margin of the whole grid, about its step; moved on from a coarser one,
                      ///< the documented 0.1 mm.
    };
    for (const Grid& grid : {Grid{{}, 0.012}, Grid{{.max_configurations = 6 * 6 * 6 * 6}, 1e-4}}) {
      const HandWorkspace workspace = hands::hand_workspace(hand, grid.options);
      const DistanceRange tips = workspace.tip_to_tip[0][1];
      CAPTURE(grid.margin, tips.smallest, tips.largest, tips.error);
      // It is at limits, and so on every grid.
      CHECK(tips.largest == Approx(widest).margin(1e-12));
      CHECK(tips.smallest >= c.tips - 1e-12);
      CHECK(tips.smallest <= c.tips + grid.margin);
      CHECK(tips.smallest <= c.tips + tips.error);
      for (const DistanceRange& palm : workspace.palm_to_tip) {
        CHECK(palm.largest == Approx(widest / 2).margin(1e-12));
        CHECK(palm.smallest >= c.palm - 1e-12);
        CHECK(palm.smallest <= c.palm + 0.012);  // Two joints always have the whole grid.
        CHECK(palm.smallest <= c.palm + palm.error);
      }
    }
    // The error is half a step of 1.3 pi, for the two joints of two fingers, at most this far from
    // the tips.
    const DistanceRange tips = hands::tip_distances(hand)[0][1];
    CHECK(tips.error == Approx(2 * (c.proximal + 2 * c.distal) * 0.5 * 1.3 * pi / 23));
  }
}

TEST_CASE("Pads on arms that turn face each other between the angles that the cone allows",
          "[hands][hand_workspace]") {
  // Arms of length l at ±b, both raised by s, have the distance 2 (b + l cos s), and the pads look
  // along the line between them within |s − 90°|. Raised differently they are no farther apart and
  // no nearer at the same mean angle s: (distance / 2)² = b² + 2 b l cos s cos t + l² cos² s, where
  // t is half the difference. So with a facing angle of f the distances are 2 (b ± l sin f), as
  // long as b > l sin f.
  const double base = 0.06, length = 0.08;
  const HandModel hand = planar_hand(base, {length}, pi);
  for (const double facing_deg : {5.0, 30.0, 45.0}) {
    CAPTURE(facing_deg);
    const double facing = facing_deg * pi / 180;
    const HandWorkspace workspace = hands::hand_workspace(hand, {.facing_angle = facing});
    const DistanceRange range = workspace.graspable_diameter[1];
    CHECK(range.smallest == Approx(2 * (base - length * std::sin(facing))).margin(1e-5));
    CHECK(range.largest == Approx(2 * (base + length * std::sin(facing))).margin(1e-5));
    CHECK(range.smallest >= 2 * (base - length * std::sin(facing)) - 1e-12);
    CHECK(range.largest <= 2 * (base + length * std::sin(facing)) + 1e-12);
    CHECK(workspace.any_graspable_diameter == range);
    CHECK(workspace.graspable_diameter[0] == DistanceRange{});
  }
  // Pads on the backs of the arms never face each other.
  HandModel backs = hand;
  for (hands::ContactPad& pad : backs.pads) {
    pad.X_LC.linear() = Eigen::AngleAxisd(pi, Vector3d::UnitX()).toRotationMatrix();
  }
  CHECK(hands::hand_workspace(backs).any_graspable_diameter.largest == 0.0);
}

TEST_CASE("What stands between the jaws is not graspable, and pads that meet are no collision",
          "[hands][hand_workspace]") {
  // The jaws slide from ±50 mm to the middle, as blocks 10 mm thick behind their pads.
  HandModel hand = bare_palm();
  for (const double side : {1.0, -1.0}) {
    RigidTransform X = at({side * 0.05, 0, 0.1});
    if (side > 0) X.linear() = Eigen::AngleAxisd(pi, Vector3d::UnitZ()).toRotationMatrix();
    const int link = add_link(hand, 0, X, 0.0, 0.05, hands::JointType::Prismatic);
    hand.links[link].mesh_L =
        geometry::transformed(geometry::box({0.01, 0.02, 0.02}), at({-0.005, 0, 0}));
    // The pad's z axis is along x of the jaw.
    RigidTransform X_LC = RigidTransform::Identity();
    X_LC.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    add_finger(hand, 1, X_LC);
  }
  const auto range = [&] { return hands::hand_workspace(hand).any_graspable_diameter; };
  CHECK(range().smallest == Approx(0.0).margin(1e-12));
  CHECK(range().largest == Approx(0.1).margin(1e-12));
  // The palm has a post 30 mm wide, and the jaws may sink 0.1 mm into it on either side.
  hand.links[0].mesh_L = geometry::transformed(geometry::box({0.03, 0.02, 0.2}), at({0, 0, 0.05}));
  CHECK(range().smallest == Approx(0.0298).margin(2e-5));
  CHECK(range().largest == Approx(0.1).margin(1e-12));
  // Distances of the tips do not depend on it.
  CHECK(hands::tip_distances(hand)[0][1].smallest == Approx(0.0).margin(1e-12));
  hand.exclusions = {{0, 1}, {0, 2}};
  CHECK(range().smallest == Approx(0.0).margin(1e-12));
}

TEST_CASE("Joints that carry both tips count for nothing, except through what follows them",
          "[hands][hand_workspace]") {
  const HandModel hand = planar_hand(0.05, {0.07, 0.05}, 2.0);
  const HandWorkspace still = hands::hand_workspace(hand);
  // The hand is the same on a wrist: links and joints are moved up by one.
  const auto on_wrist = [&hand] {
    HandModel result = bare_palm();
    add_link(result, 0, at({0.01, 0.02, 0.03}), -1.0, 1.0);
    for (std::size_t i = 1; i < hand.links.size(); ++i) {
      hands::Link link = hand.links[i];
      hands::Joint joint = hand.joints[*link.parent_joint];
      ++*link.parent_link, ++*link.parent_joint, ++joint.parent_link, ++joint.child_link;
      link.name += "'", joint.name += "'";
      result.links.push_back(link), result.joints.push_back(joint);
    }
    result.fingers = hand.fingers;
    result.pads = hand.pads;
    for (hands::Finger& finger : result.fingers) {
      for (int& link : finger.links) ++link;
      for (int& joint : finger.joints) ++joint;
    }
    for (hands::ContactPad& pad : result.pads) ++pad.link;
    return result;
  };
  HandModel wrist = on_wrist();
  const DistanceRange before = still.tip_to_tip[0][1];
  const DistanceRange after = hands::tip_distances(wrist)[0][1];
  CHECK(after.smallest == Approx(before.smallest).margin(1e-12));
  CHECK(after.largest == Approx(before.largest).margin(1e-12));
  CHECK(after.error == Approx(before.error).margin(1e-12));
  CHECK(hands::hand_workspace(wrist).palm_to_tip[0].largest >
        hands::hand_workspace(hand).palm_to_tip[0].largest + 0.01);

  // A wrist that sets a joint of one finger moves the tips apart through it.
  wrist.joints[1].coupling = hands::Coupling{.leader = 0};
  wrist.joints[1].lower = -1.0;
  double largest = 0.0;
  const int samples = 24;
  hands::HandConfiguration c = hands::open_configuration(wrist);
  for (int i = 0; i < samples; ++i) {
    c.q[0] = -1.0 + 2.0 * i / (samples - 1);
    for (int j = 0; j < samples; ++j) {
      c.q[2] = c.q[3] = c.q[4] = 0.0;
      c.q[2] = 2.0 * j / (samples - 1);
      hands::apply_couplings(wrist, c.q);
      const auto X = hands::forward_kinematics(wrist, c);
      largest = std::max(largest, (hands::pad_pose(wrist, 0, X).translation() -
                                   hands::pad_pose(wrist, 1, X).translation())
                                      .norm());
    }
  }
  CHECK(hands::tip_distances(wrist)[0][1].largest >= largest - 1e-12);
}

/// Returns the smallest and largest distance of two fingers' tip pads over a grid of the
/// independent joints, one configuration of the whole hand after the other.
DistanceRange searched_range(const HandModel& hand, int finger_a, int finger_b, int samples) {
  std::vector<int> free_joints;
  for (const int finger : {finger_a, finger_b}) {
    for (const int joint : hand.fingers[finger].joints) {
      const auto& coupling = hand.joints[joint].coupling;
      const int independent = coupling ? coupling->leader : joint;
      if (std::find(free_joints.begin(), free_joints.end(), independent) == free_joints.end()) {
        free_joints.push_back(independent);
      }
    }
  }
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  DistanceRange range{std::numeric_limits<double>::infinity(), 0.0};
  std::vector<int> step(free_joints.size(), 0);
  while (true) {
    for (std::size_t i = 0; i < free_joints.size(); ++i) {
      const hands::Joint& joint = hand.joints[free_joints[i]];
      const double share = static_cast<double>(step[i]) / (samples - 1);
      configuration.q[free_joints[i]] = joint.lower + share * (joint.upper - joint.lower);
    }
    // The search starts from the coupled position, not from a breakaway left behind by the step
    // before.
    for (std::size_t i = 0; i < hand.joints.size(); ++i) {
      if (const auto& coupling = hand.joints[i].coupling) {
        configuration.q[i] =
            std::clamp(coupling->ratio * configuration.q[coupling->leader] + coupling->offset,
                       hand.joints[i].lower, hand.joints[i].upper);
      }
    }
    const auto X_OL = hands::forward_kinematics(hand, configuration);
    const double distance =
        (hands::pad_pose(hand, *hand.fingers[finger_a].tip_pad, X_OL).translation() -
         hands::pad_pose(hand, *hand.fingers[finger_b].tip_pad, X_OL).translation())
            .norm();
    range.smallest = std::min(range.smallest, distance);
    range.largest = std::max(range.largest, distance);
    std::size_t i = 0;
    while (i < step.size() && ++step[i] == samples) step[i++] = 0;
    if (i == step.size()) return range;
  }
}

TEST_CASE("Tip distances of the Barrett hand are those of its kinematics",
          "[hands][hand_workspace]") {
  const HandModel hand = hands::find_hand("barrett");
  const TipDistances distances = hands::tip_distances(hand);
  REQUIRE(distances.size() == hand.fingers.size());
  const int thumb = hand.thumb();
  for (std::size_t a = 0; a < hand.fingers.size(); ++a) {
    REQUIRE(distances[a].size() == hand.fingers.size());
    CHECK(distances[a][a] == DistanceRange{});
    for (std::size_t b = a + 1; b < hand.fingers.size(); ++b) {
      const DistanceRange range = distances[a][b];
      INFO(hand.fingers[a].name << " and " << hand.fingers[b].name << ": " << range.smallest
                                << " to " << range.largest);
      CHECK(range == distances[b][a]);

      // The result is bit by bit what all configurations of the grid give, as planned grasps depend
      // on it.
      const DistanceRange searched =
          searched_range(hand, static_cast<int>(a), static_cast<int>(b), 24);
      CHECK(range.smallest == searched.smallest);
      CHECK(range.largest == searched.largest);

      // Opposed tips meet.
      CHECK(range.smallest >= 0.0);
      CHECK(range.smallest < 0.030);

      // By published numbers, at full opening a tip reaches 162.8 mm from the palm's axis, and
      // opposed tips are about 325 mm apart. With the thumb it is sqrt(25² + 325.6²) = 326.6 mm,
      // for fingers 1 and 2, whose bases are 50 mm apart, at spread 90° 375.6 mm. The pad's center
      // lies on the distal link of 56 mm, 26.8 mm from its joint and 6.8 mm off its axis, so within
      // sqrt(29.2² + 6.8²) < 30 mm of the tip point: the pads are at most 60 mm less apart than the
      // tips, and not more, since the pad is on the inner side.
      const bool with_thumb = static_cast<int>(a) == thumb || static_cast<int>(b) == thumb;
      const double tips = with_thumb ? 0.3266 : 0.3756;
      CHECK(range.largest < tips);
      CHECK(range.largest > tips - 0.060);

      // A grid twice as fine holds this one, and finds at most the error beyond.
      const DistanceRange finer =
          searched_range(hand, static_cast<int>(a), static_cast<int>(b), 47);
      CHECK(range.smallest <= finer.smallest + range.error);
      // The widest opening is at joint limits, but for the spread, in which it is stationary: the
      // error is of second order, below 0.14 m · 0.068².
      CHECK(std::abs(range.largest - finer.largest) < 1e-3);
    }
  }
}

TEST_CASE("The Barrett hand's graspable diameters are those of its grid, and a little beyond",
          "[hands][hand_workspace]") {
  const HandModel hand = hands::find_hand("barrett");
  const HandWorkspace workspace = hands::hand_workspace(hand);
  const int thumb = hand.thumb();
  for (const char* name : {"finger_1", "finger_2"}) {
    const int finger = hand.finger_index(name);
    DistanceRange whole{std::numeric_limits<double>::infinity(), 0.0};
    hands::HandConfiguration c = hands::open_configuration(hand);
    for (int i = 0; i < 24 * 24 * 24; ++i) {
      const auto position = [&](const char* joint, int step) {
        const int j = hand.joint_index(joint);
        c.q[j] = hand.joints[j].upper * step / 23;
      };
      for (std::size_t j = 0; j < hand.joints.size(); ++j) c.q[j] = hand.joints[j].lower;
      position("finger_1_spread", i % 24);
      position((std::string(name) + "_proximal").c_str(), i / 24 % 24);
      position("thumb_proximal", i / 24 / 24);
      hands::apply_couplings(hand, c.q);
      const auto X = hands::forward_kinematics(hand, c);
      const RigidTransform X_a = hands::pad_pose(hand, *hand.fingers[thumb].tip_pad, X);
      const RigidTransform X_b = hands::pad_pose(hand, *hand.fingers[finger].tip_pad, X);
      const Vector3d between = X_b.translation() - X_a.translation();
      const auto angle = [&](const Vector3d& normal, const Vector3d& line) {
        return std::acos(std::clamp(normal.dot(line.normalized()), -1.0, 1.0));
      };
      if (angle(X_a.linear().col(2), between) > pi / 4 ||
          angle(X_b.linear().col(2), -between) > pi / 4) {
        continue;
      }
      whole.smallest = std::min(whole.smallest, between.norm());
      whole.largest = std::max(whole.largest, between.norm());
    }
    // Facing each other, the fingers are far apart, and no configuration of these touches itself.
    // In the plane of a finger, its link is at 40° + 4/3 q and its pad looks at the axis within 45°
    // for q up to 71°; there the pad's center is 52 mm from it, less what turning the other finger
    // gives.
    const DistanceRange& range = workspace.graspable_diameter[finger];
    CAPTURE(name, range.smallest, range.largest, whole.smallest, whole.largest);
    CHECK(range.smallest <= whole.smallest);
    CHECK(range.largest >= whole.largest);
    // They differ by half a step (3° of two proximal joints at 0.12 m) either way.
    CHECK(range.smallest >= whole.smallest - 0.015);
    CHECK(range.largest <= whole.largest + 0.015);
  }
}

TEST_CASE("A finer sampling of the joints only widens the tip distances",
          "[hands][hand_workspace]") {
  // 2n − 1 samples between the same limits hold the n samples.
  const HandModel hand = hands::find_hand("barrett");
  const TipDistances coarse = hands::tip_distances(hand, {.samples_per_joint = 9});
  const TipDistances fine = hands::tip_distances(hand, {.samples_per_joint = 17});
  for (std::size_t a = 0; a < hand.fingers.size(); ++a) {
    for (std::size_t b = 0; b < hand.fingers.size(); ++b) {
      CHECK(fine[a][b].smallest <= coarse[a][b].smallest + 1e-12);
      CHECK(fine[a][b].largest >= coarse[a][b].largest - 1e-12);
    }
  }
}

TEST_CASE("A human thumb meets every finger, and spans what a hand of its length spans",
          "[hands][hand_workspace]") {
  // Pads that face each other come within a few millimeters of touching, at the index and middle
  // finger, where thumbs are opposed. The widest distance is less than what thumb and little finger
  // span stretched out, about the length of the hand (212 mm, GraspIt!'s size) and a half.
  const HandModel hand = hands::find_hand("human_hand");
  const HandWorkspace workspace = hands::hand_workspace(hand);
  for (const char* name : {"index", "middle"}) {
    CAPTURE(name, workspace.graspable_diameter[hand.finger_index(name)].smallest);
    CHECK(workspace.graspable_diameter[hand.finger_index(name)].smallest < 0.010);
  }
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
    if (static_cast<int>(f) == hand.thumb()) continue;
    const DistanceRange& range = workspace.graspable_diameter[f];
    CHECK(range.largest > 0.100);
    CHECK(range.largest <= workspace.tip_to_tip[f][hand.thumb()].largest);
    CHECK(range.largest < 1.5 * 0.212);
  }
}

TEST_CASE("Grippers grasp from nothing to their stroke", "[hands][hand_workspace]") {
  // The Robotiq 2F-85 has a stroke of 85 mm, the Franka hand 2 × 40 mm.
  for (const auto& [name, stroke] :
       {std::pair{"parallel_gripper", 0.085}, std::pair{"franka_gripper", 0.080}}) {
    CAPTURE(name);
    const HandWorkspace workspace = hands::hand_workspace(hands::find_hand(name));
    for (const DistanceRange& range :
         {workspace.tip_to_tip[0][1], workspace.any_graspable_diameter}) {
      CHECK(range.smallest == Approx(0.0).margin(1e-9));
      CHECK(range.largest == Approx(stroke).margin(1e-9));
    }
  }
}

TEST_CASE("Ranges of every shipped hand hold the distances of 1000 random configurations",
          "[hands][hand_workspace]") {
  for (const std::string& name : hands::shipped_hands()) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const TipDistances tips = hands::tip_distances(hand);
    base::Random random(23);
    double beyond = 0.0;
    for (int k = 0; k < 1000; ++k) {
      hands::HandConfiguration c = hands::open_configuration(hand);
      for (std::size_t j = 0; j < hand.joints.size(); ++j) {
        const hands::Joint& joint = hand.joints[j];
        c.q[j] = joint.coupling ? (joint.closing_sign < 0 ? joint.upper : joint.lower)
                                : random.uniform(joint.lower, joint.upper);
      }
      hands::apply_couplings(hand, c.q);
      const auto X_OL = hands::forward_kinematics(hand, c);
      for (std::size_t a = 0; a < hand.fingers.size(); ++a) {
        for (std::size_t b = a + 1; b < hand.fingers.size(); ++b) {
          const auto contact_point = [&](std::size_t finger) -> Vector3d {
            const int pad = *hand.fingers[finger].tip_pad;
            const double height = -hands::height_over_pad(hand.pads[pad], Vector3d::Zero());
            return hands::pad_pose(hand, pad, X_OL) * Vector3d(0, 0, height);
          };
          const double distance = (contact_point(a) - contact_point(b)).norm();
          const DistanceRange& range = tips[a][b];
          const double out = std::max(range.smallest - distance, distance - range.largest);
          beyond = std::max(beyond, out);
          CHECK(out <= range.error + 1e-12);
        }
      }
    }
    // The bound is far from what happens, as no configuration is more than 5 mm beyond.
    CHECK(beyond < 0.005);
  }
}

TEST_CASE("More joints than the grid has room for are sampled at random",
          "[hands][hand_workspace]") {
  const HandModel hand = planar_hand(0.05, {0.03, 0.03, 0.03}, 1.0);
  const WorkspaceOptions options{.max_configurations = 32};  // 2^6 would be 64.
  const DistanceRange range = hands::tip_distances(hand, options)[0][1];
  const DistanceRange whole = hands::tip_distances(hand)[0][1];
  CHECK(range.largest == Approx(whole.largest).margin(1e-6));  // It is moved on to the limits.
  CHECK(range.smallest == Approx(whole.smallest).margin(1e-4));
  CHECK(range.error > whole.error);
  CHECK(hands::tip_distances(hand, options)[0][1] == range);
}

TEST_CASE("Fingers without a tip pad have no ranges; options and models are checked",
          "[hands][hand_workspace]") {
  HandModel hand = planar_hand(0.05, {0.07, 0.05}, 1.5);
  hand.fingers[1].tip_pad.reset();
  const HandWorkspace workspace = hands::hand_workspace(hand, {.samples_per_joint = 5});
  CHECK(workspace.tip_to_tip[0][1] == DistanceRange{});
  CHECK(workspace.palm_to_tip[1] == DistanceRange{});
  CHECK(workspace.palm_to_tip[0].largest > 0.0);
  CHECK(workspace.any_graspable_diameter == DistanceRange{});

  CHECK_THROWS_WITH(hands::tip_distances(hand, {.samples_per_joint = 1}),
                    "WorkspaceOptions: samples_per_joint = 1, must be >= 2");
  CHECK_THROWS_WITH(hands::hand_workspace(hand, {.max_configurations = 3}),
                    "WorkspaceOptions: max_configurations = 3, must be >= 4");
  CHECK_THROWS_WITH(hands::cached_hand_workspace(hand, {.facing_angle = 2.0}),
                    "WorkspaceOptions: facing_angle = 2, must be in (0, pi/2) rad");
  hand.joints[0].lower = 2.0;
  CHECK_THROWS_AS(hands::tip_distances(hand), base::InvalidInput);
}

TEST_CASE("A hand's workspace is kept by all that it depends on", "[hands][hand_workspace]") {
  namespace fs = std::filesystem;
  const testing::TemporaryFolder folder;
  const base::ContentCache cache{.folder = folder.path()};
  const HandModel hand = planar_hand(0.05, {0.07, 0.05}, 1.5);
  const WorkspaceOptions options{.samples_per_joint = 5};
  const auto num_kept = [&] {
    return std::distance(fs::directory_iterator(folder.path() / "hand_workspace"), {});
  };
  const HandWorkspace found = hands::hand_workspace(hand, options);
  CHECK(hands::cached_hand_workspace(hand, options, cache) == found);
  REQUIRE(num_kept() == 1);
  // Another value, sealed, shows that the entry is what is read.
  const fs::path file = fs::directory_iterator(folder.path() / "hand_workspace")->path();
  const std::string key = file.stem().string();
  std::string text = *cache.read("hand_workspace", key);
  const std::string largest = base::shortest_decimal(found.any_graspable_diameter.largest);
  REQUIRE(text.rfind(largest) != std::string::npos);
  cache.write("hand_workspace", key, text.replace(text.rfind(largest), largest.size(), "7.5"));
  CHECK(hands::cached_hand_workspace(hand, options, cache).any_graspable_diameter.largest == 7.5);
  cache.write("hand_workspace", key, text + " 1");
  CHECK(hands::cached_hand_workspace(hand, options, cache) == found);

  // Names do not matter; everything else does.
  HandModel same = hand;
  same.name = "another";
  same.links[1].name = "another";
  hands::cached_hand_workspace(same, options, cache);
  CHECK(num_kept() == 1);
  std::vector<HandModel> others(8, hand);
  others[0].joints[2].upper = 1.6;
  others[1].pads[1].X_LC.translation().x() += 1e-3;
  others[2].links[2].mesh_L = geometry::box({0.01, 0.01, 0.01});
  others[3].joints[3].coupling = hands::Coupling{.leader = 2};
  others[4].palm.center_H.z() = 0.01;
  others[5].exclusions = {{1, 3}};
  others[6].fingers[1].is_thumb = true;
  others[7].joints[0].X_PJ.translation().y() = 0.01;
  for (std::size_t i = 0; i < others.size(); ++i) {
    CAPTURE(i);
    hands::cached_hand_workspace(others[i], options, cache);
    CHECK(num_kept() == static_cast<std::ptrdiff_t>(i) + 2);
  }
  const auto before = num_kept();
  hands::cached_hand_workspace(hand, {.samples_per_joint = 6}, cache);
  hands::cached_hand_workspace(hand, {.samples_per_joint = 5, .facing_angle = 0.5}, cache);
  CHECK(num_kept() == before + 2);
}

}  // namespace

}  // namespace test_hand_workspace
