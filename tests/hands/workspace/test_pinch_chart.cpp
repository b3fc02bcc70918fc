#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/pinch_chart.hpp"
#include "hands/workspace/planar_hand.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"
#include "support/wide_finger_hand.hpp"

namespace test_pinch_chart {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using Eigen::Vector3d;
using hands::HandModel;
using hands::OpeningRange;
using hands::Pinch;
using hands::PinchChart;
using hands::PinchKind;
using std::numbers::pi;

constexpr double kDegree = pi / 180.0;

/// The opening of a pinch of two pads, and the larger angle of their normals with the line, by the
/// kinematics of its configuration.
std::pair<double, double> opening_and_lean(const HandModel& hand, const Pinch& pinch) {
  const auto X_HL = hands::forward_kinematics(hand, {hands::RigidTransform::Identity(), pinch.q});
  Vector3d b = Vector3d::Zero();
  for (std::size_t i = 1; i < pinch.pads.size(); ++i) {
    b += hands::pad_contact_point(hand, pinch.pads[i], X_HL) /
         static_cast<double>(pinch.pads.size() - 1);
  }
  const Vector3d line = b - hands::pad_contact_point(hand, pinch.pads.front(), X_HL);
  double lean = 0.0;
  for (std::size_t i = 0; i < pinch.pads.size(); ++i) {
    const Vector3d normal = hands::pad_pose(hand, pinch.pads[i], X_HL).linear().col(2);
    const Vector3d to_other = i == 0 ? line : Vector3d(-line);
    lean = std::max(lean, std::atan2(normal.cross(to_other).norm(), normal.dot(to_other)));
  }
  return {line.norm(), lean};
}

/// The lean of the class of an opening.
double lean_at(const PinchChart& chart, double opening) {
  const auto number = static_cast<std::size_t>(opening / chart.step);
  REQUIRE(number < chart.pinches.size());
  REQUIRE(chart.pinches[number]);
  return chart.pinches[number]->lean;
}

/// Checks that two charts are the same to the last bit.
void check_same(const PinchChart& chart, const PinchChart& expected) {
  CHECK(chart.kind == expected.kind);
  CHECK(chart.step == expected.step);
  CHECK(chart.num_sets == expected.num_sets);
  REQUIRE(chart.pinches.size() == expected.pinches.size());
  for (std::size_t k = 0; k < expected.pinches.size(); ++k) {
    REQUIRE(chart.pinches[k].has_value() == expected.pinches[k].has_value());
    if (!expected.pinches[k]) continue;
    CHECK(chart.pinches[k]->opening == expected.pinches[k]->opening);
    CHECK(chart.pinches[k]->lean == expected.pinches[k]->lean);
    CHECK(chart.pinches[k]->pads == expected.pinches[k]->pads);
    CHECK(chart.pinches[k]->q == expected.pinches[k]->q);
  }
}

/// How many charts a cache in this folder holds.
std::ptrdiff_t num_kept(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path() / "pinch_chart"), {});
}

}  // namespace

TEST_CASE("Pads on arms that turn lean by the angle that the arms are raised beyond upright",
          "[hands][pinch_chart]") {
  // Arms of length l at ±b, both raised by s, are 2 (b + l cos s) apart, and their pads lean by |s
  // − 90°|; raised differently the larger lean is larger (see test_hand_workspace). So at an
  // opening of d the least lean is asin(|d/2 − b| / l).
  const double base = 0.06;
  const double length = 0.08;
  const HandModel hand = planar_hand(base, {length}, pi);
  const PinchChart chart = hands::pinch_chart(hand, PinchKind::Tips, {.step = 0.004});
  CHECK(chart.pinches.size() == 70);  // up to a lean of 80 degrees: 2 (b + l sin 80°) = 277.6 mm
  for (std::size_t k = 0; k < chart.pinches.size(); ++k) {
    CAPTURE(k);
    REQUIRE(chart.pinches[k]);
    const Pinch& pinch = *chart.pinches[k];
    const auto [opening, lean] = opening_and_lean(hand, pinch);
    CHECK(pinch.opening == Approx(opening).margin(1e-12));
    CHECK(pinch.lean == Approx(lean).margin(1e-7));
    CHECK(pinch.opening >= static_cast<double>(k) * chart.step);
    CHECK(pinch.opening < static_cast<double>(k + 1) * chart.step);
    // The least lean of the class is at the end that is nearer to 2 b.
    const double first = static_cast<double>(k) * chart.step;
    const double nearest = std::clamp(2.0 * base, first, first + chart.step);
    const double least = std::asin(std::min(1.0, std::abs(0.5 * nearest - base) / length));
    CHECK(pinch.lean >= least - 1e-9);
    CHECK(pinch.lean <= least + 0.3 * kDegree);
  }
  // Where d/2 − b is at most l sin 20°: from 120 − 54.7 to 120 + 54.7 mm, in whole classes.
  const std::vector<OpeningRange> widths = hands::square_widths(chart, std::tan(20.0 * kDegree));
  REQUIRE(widths.size() == 1);
  CHECK(widths[0].smallest == Approx(0.0653).margin(0.004));
  CHECK(widths[0].largest == Approx(0.1747).margin(0.004));
  CHECK(widths[0].smallest >= 0.0652);
  CHECK(widths[0].largest <= 0.1748);
  // There is one other finger, no palm pad, and no proximal pad.
  for (const PinchKind kind : {PinchKind::TwoFingers, PinchKind::Palm, PinchKind::Proximal}) {
    CHECK(hands::pinch_chart(hand, kind).pinches.empty());
    CHECK(hands::pinch_chart(hand, kind).num_sets == 0);
  }
  CHECK(chart.num_sets == 1);
}

TEST_CASE("Two fingers close alike, whichever way their joints turn", "[hands][pinch_chart]") {
  // The second finger twice, beside each other, one of them described with its joint mirrored.
  HandModel hand = planar_hand(0.06, {0.08}, pi);
  hand.fingers.front().is_thumb = true;
  const int joint = static_cast<int>(hand.joints.size());
  const int link = add_link(hand, 0, hand.joints[1].X_PJ, 0.0, pi);
  add_finger(hand, 1, hand.pads[1].X_LC);
  hand.joints[joint].axis_J = -hand.joints[joint].axis_J;
  hand.joints[joint].lower = -pi;
  hand.joints[joint].upper = 0.0;
  hand.joints[joint].closing_sign = -1;
  REQUIRE(hand.links[link].parent_joint == joint);
  const PinchChart one = hands::pinch_chart(hand, PinchKind::Tips, {.step = 0.01});
  const PinchChart two = hands::pinch_chart(hand, PinchKind::TwoFingers, {.step = 0.01});
  REQUIRE(two.pinches.size() == one.pinches.size());
  for (std::size_t k = 0; k < two.pinches.size(); ++k) {
    CAPTURE(k);
    REQUIRE(two.pinches[k]);
    CHECK(two.pinches[k]->q[joint] == Approx(-two.pinches[k]->q[1]).margin(1e-12));
    CHECK(two.pinches[k]->lean == Approx(one.pinches[k]->lean).margin(0.3 * kDegree));
  }
}

TEST_CASE("Two fingers swing alike, also where their joints are written as mirror images",
          "[hands][pinch_chart]") {
  // The spread of the Barrett hand as two independent joints, one about a turned axis.
  const HandModel coupled = hands::find_hand("barrett");
  HandModel hand = coupled;
  const int swing = *hand.fingers[1].swing_joint;
  hands::Joint& joint = hand.joints[swing];
  REQUIRE(joint.closing_sign == 0);
  REQUIRE(joint.coupling.has_value());
  joint.coupling.reset();
  joint.axis_J = -joint.axis_J;
  joint.lower = -hand.joints[*hand.fingers[0].swing_joint].upper;
  joint.upper = 0.0;
  const PinchChart one = hands::pinch_chart(coupled, PinchKind::TwoFingers, {.step = 0.01});
  const PinchChart two = hands::pinch_chart(hand, PinchKind::TwoFingers, {.step = 0.01});
  constexpr std::size_t kFirst = 15;  // where they pinch squarely
  constexpr std::size_t kEnd = 23;
  REQUIRE(std::min(one.pinches.size(), two.pinches.size()) >= kEnd);
  for (std::size_t k = kFirst; k < kEnd; ++k) {
    CAPTURE(k);
    REQUIRE(one.pinches[k]);
    REQUIRE(two.pinches[k]);
    CHECK(two.pinches[k]->lean == Approx(one.pinches[k]->lean).margin(1.0 * kDegree));
    CHECK(two.pinches[k]->q[swing] ==
          Approx(-two.pinches[k]->q[*hand.fingers[0].swing_joint]).margin(1e-12));
  }
}

TEST_CASE("Joints that cannot turn cost no samples", "[hands][pinch_chart]") {
  const HandModel hand = planar_hand(0.06, {0.08}, pi);
  HandModel stiff = planar_hand(0.06, {0.04, 0.04}, pi);
  for (const int fixed : {1, 3}) stiff.joints[fixed].upper = 0.0;
  const PinchChart free = hands::pinch_chart(hand, PinchKind::Tips);
  const PinchChart same = hands::pinch_chart(stiff, PinchKind::Tips);
  REQUIRE(same.pinches.size() == free.pinches.size());
  for (std::size_t k = 0; k < free.pinches.size(); ++k) {
    REQUIRE(free.pinches[k]);
    REQUIRE(same.pinches[k]);
    CHECK(same.pinches[k]->lean == Approx(free.pinches[k]->lean).margin(1e-9));
  }
}

TEST_CASE("Parallel jaws pinch squarely as far as they open", "[hands][pinch_chart]") {
  const HandModel hand = hands::find_hand("parallel_gripper");
  const PinchChart chart = hands::pinch_chart(hand, PinchKind::Tips);
  REQUIRE(!chart.pinches.empty());
  for (const std::optional<Pinch>& pinch : chart.pinches) {
    REQUIRE(pinch);
    CHECK(pinch->lean < 1e-7);
  }
  const std::vector<OpeningRange> widths = hands::square_widths(chart, 1e-6);
  REQUIRE(widths.size() == 1);
  CHECK(widths[0].smallest < 0.005);
  CHECK(widths[0].largest == Approx(0.085).margin(1e-6));  // the stroke
}

TEST_CASE("A Barrett hand's fingertips lean as measured by hand", "[hands][pinch_chart]") {
  // Its three fingers closed alike with the spread at zero, so that the two face the thumb: 29
  // degrees at 242 mm, 3 at 194, 11 at 166, 24 at 137, 31 at 122, 37 at 107, 51 at 78, 64 at 51.
  const HandModel hand = hands::find_hand("barrett");
  const PinchChart chart = hands::pinch_chart(hand, PinchKind::TwoFingers);
  for (const auto& [opening_mm, lean_deg] :
       {std::pair(242, 29), std::pair(194, 3), std::pair(166, 11), std::pair(137, 24),
        std::pair(122, 31), std::pair(107, 37), std::pair(78, 51), std::pair(51, 64)}) {
    CAPTURE(opening_mm);
    const double lean = lean_at(chart, 1e-3 * opening_mm) / kDegree;
    CHECK(lean == Approx(lean_deg).margin(3.5));
  }
}

TEST_CASE("No configuration that random search finds is much squarer", "[hands][pinch_chart]") {
  for (const char* name : {"barrett", "human_hand"}) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const PinchChart chart = hands::pinch_chart(hand, PinchKind::Tips);
    const hands::HandCollision collision(hand);
    base::Random random(3);
    const int thumb = *hand.fingers[hand.thumb()].tip_pad;
    int num_compared = 0;
    for (int round = 0; round < 20000; ++round) {
      for (const hands::Finger& finger : hand.fingers) {
        if (!finger.tip_pad || *finger.tip_pad == thumb) continue;
        // The other fingers are open, as in the chart.
        hands::HandConfiguration configuration = hands::open_configuration(hand);
        for (const hands::Finger* const moved : {&finger, &hand.fingers[hand.thumb()]}) {
          for (const int j : moved->joints) {
            const hands::Joint& joint = hand.joints[j];
            if (!joint.coupling) configuration.q[j] = random.uniform(joint.lower, joint.upper);
          }
        }
        hands::apply_couplings(hand, configuration.q);
        const Pinch found{0.0, 0.0, {thumb, *finger.tip_pad}, configuration.q};
        const auto [opening, lean] = opening_and_lean(hand, found);
        if (lean > 60.0 * kDegree) continue;
        const auto number = static_cast<std::size_t>(opening / chart.step);
        const std::optional<Pinch> best =
            number < chart.pinches.size() ? chart.pinches[number] : std::nullopt;
        if (best && best->lean <= lean + 2.0 * kDegree) {
          ++num_compared;
          continue;
        }
        const auto X_HL =
            hands::forward_kinematics(hand, {hands::RigidTransform::Identity(), configuration.q});
        CAPTURE(opening, lean / kDegree);
        CHECK(collision.overlaps_self(X_HL, 1e-4));
      }
    }
    CHECK(num_compared > 100);
  }
}

TEST_CASE("Pinches bring no links into each other, and are the same each time",
          "[hands][pinch_chart]") {
  const HandModel hand = hands::find_hand("human_hand");
  const hands::HandCollision collision(hand);
  for (const PinchKind kind : hands::kPinchKinds) {
    const PinchChart chart = hands::pinch_chart(hand, kind, {.max_configurations = 1 << 14});
    const PinchChart again = hands::pinch_chart(hand, kind, {.max_configurations = 1 << 14});
    REQUIRE(chart.pinches.size() == again.pinches.size());
    CHECK(!chart.pinches.empty());
    for (std::size_t k = 0; k < chart.pinches.size(); ++k) {
      REQUIRE(chart.pinches[k].has_value() == again.pinches[k].has_value());
      if (!chart.pinches[k]) continue;
      CHECK(chart.pinches[k]->q == again.pinches[k]->q);
      const auto [opening, lean] = opening_and_lean(hand, *chart.pinches[k]);
      CHECK(chart.pinches[k]->opening == Approx(opening).margin(1e-12));
      CHECK(chart.pinches[k]->lean == Approx(lean).margin(1e-7));
      CHECK_FALSE(collision.overlaps_self(
          hands::forward_kinematics(hand, {hands::RigidTransform::Identity(), chart.pinches[k]->q}),
          1e-4));
    }
  }
}

TEST_CASE("A chart is kept by all that it depends on", "[hands][pinch_chart]") {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const base::ContentCache cache{.folder = folder.path()};
  const HandModel hand = planar_hand(0.06, {0.08}, 1.0);
  const hands::PinchChartOptions options{.step = 0.02};
  const PinchChart found = hands::pinch_chart(hand, PinchKind::Tips, options);
  check_same(hands::cached_pinch_chart(hand, PinchKind::Tips, options, cache), found);
  REQUIRE(num_kept(folder) == 1);
  check_same(hands::cached_pinch_chart(hand, PinchKind::Tips, options, cache), found);
  // Another number of sets, sealed, shows that the entry is what is read; more text is no chart.
  const std::string key = fs::directory_iterator(folder.path() / "pinch_chart")->path().stem();
  const std::string text = *cache.read("pinch_chart", key);
  REQUIRE(text.starts_with("1 "));
  cache.write("pinch_chart", key, "7" + text.substr(1));
  CHECK(hands::cached_pinch_chart(hand, PinchKind::Tips, options, cache).num_sets == 7);
  cache.write("pinch_chart", key, text + " 1");
  check_same(hands::cached_pinch_chart(hand, PinchKind::Tips, options, cache), found);
  // Names do not matter; kind, options and hand do.
  HandModel other = hand;
  other.name = "another";
  hands::cached_pinch_chart(other, PinchKind::Tips, options, cache);
  CHECK(num_kept(folder) == 1);
  hands::cached_pinch_chart(hand, PinchKind::Palm, options, cache);
  hands::cached_pinch_chart(hand, PinchKind::Tips, {.step = 0.025}, cache);
  other.joints[0].upper = 1.1;
  hands::cached_pinch_chart(other, PinchKind::Tips, options, cache);
  CHECK(num_kept(folder) == 4);
}

TEST_CASE("The chart of a hand from a file is kept by what the file describes",
          "[hands][pinch_chart]") {
  const TemporaryFolder folder;
  const base::ContentCache cache{.folder = folder.path()};
  const hands::PinchChartOptions options{.step = 0.02, .max_configurations = 1 << 12};
  const std::string description = wide_finger_hand_urdf();
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string text = description;
    REQUIRE(text.find(part) != std::string::npos);
    return text.replace(text.find(part), part.size(), other);
  };
  const auto chart_of = [&](const std::string& file, const std::string& text) {
    const HandModel hand = hands::read_hand_model(folder.write(file, text));
    const PinchChart chart = hands::cached_pinch_chart(hand, PinchKind::Tips, options, cache);
    check_same(chart, hands::pinch_chart(hand, PinchKind::Tips, options));
    return chart;
  };
  const PinchChart found = chart_of("hand.urdf", description);
  CHECK(found.num_sets == 3);  // the thumb with each of three fingers
  REQUIRE(hands::squarest(found));
  REQUIRE(num_kept(folder) == 1);
  // Read again, and from a file of another name, it is the same hand, whose chart is read.
  check_same(chart_of("hand.urdf", description), found);
  check_same(chart_of("again/other.urdf", description), found);
  CHECK(num_kept(folder) == 1);
  // Wider fingertips or a joint that turns less far make another hand.
  chart_of("wider.urdf", with("0.030 0.040 0.018", "0.034 0.040 0.018"));
  CHECK(num_kept(folder) == 2);
  chart_of("stiffer.urdf", with("upper=\"1.9\"", "upper=\"1.5\""));
  CHECK(num_kept(folder) == 3);
}

TEST_CASE("Options of a chart are checked", "[hands][pinch_chart]") {
  const HandModel hand = planar_hand(0.06, {0.08}, pi);
  const auto chart = [&](const hands::PinchChartOptions& options) {
    return hands::pinch_chart(hand, PinchKind::Tips, options);
  };
  CHECK_THROWS_AS(chart({.step = 0.0}), base::InvalidInput);
  CHECK_THROWS_AS(chart({.step = std::numeric_limits<double>::quiet_NaN()}), base::InvalidInput);
  CHECK_THROWS_AS(chart({.max_configurations = 1}), base::InvalidInput);
  CHECK_THROWS_AS(chart({.touch_depth = 0.0}), base::InvalidInput);
  CHECK_THROWS_WITH(chart({.step = 1e-9}), Contains("too far for a step of 1e-09 m"));
}

}  // namespace test_pinch_chart
