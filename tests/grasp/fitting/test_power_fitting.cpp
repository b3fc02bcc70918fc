#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "fitting/target_posture.hpp"
#include "grasp/fitting_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "support/catch.hpp"

namespace test_power_fitting {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::FittingOptions;
using grasp::FittingResult;
using grasp::FittingStop;
using grasp::GraspStyle;
using grasp::PalmPlacement;
using grasp::TargetContacts;
using std::numbers::pi;
using testing::angle_between;
using testing::Scene;
using testing::targets_at;

FittingOptions paper_loop() {
  FittingOptions options;
  options.guard = grasp::PenetrationGuard::Voxels;
  options.contact_state = grasp::ContactState::FirstGraze;
  return options;
}

/// Returns three targets around the z axis at `radius` and one for the palm on top, at `height`.
TargetContacts power_targets(double radius, double height) {
  std::vector<Vector3d> points, normals;
  for (int i = 0; i < 3; ++i) {
    const double angle = i * 2.0 * pi / 3.0;
    normals.push_back({std::cos(angle), std::sin(angle), 0.0});
    points.push_back(radius * normals.back());
  }
  normals.push_back(Vector3d::UnitZ());
  points.push_back({0.0, 0.0, height});
  TargetContacts targets = targets_at(points, normals);
  targets.contacts.back().is_palm = true;
  return targets;
}

grasp::PlannerOptions power_options() {
  grasp::PlannerOptions options;
  options.style = GraspStyle::Power;
  return options;
}

TEST_CASE("A power grasp has the palm on the object, looking against its target's normal",
          "[grasp][power_fitting]") {
  struct Case {
    const char* name;
    geometry::TriangleMesh mesh;
    double radius, height;
  };
  const std::vector<Case> cases = {
      {"ball", geometry::ball(0.045), 0.045, 0.045},
      {"box", geometry::box({0.05, 0.05, 0.08}), 0.025, 0.04},
      {"capsule", geometry::capsule(0.035, 0.05), 0.035, 0.06},
  };
  for (const Case& shape : cases) {
    INFO(shape.name);
    const Scene scene(shape.mesh, "barrett", power_options());
    const TargetContacts open_targets = power_targets(shape.radius, shape.height);
    const auto placements = grasp::palm_placements(scene.object, open_targets, std::nullopt, pi);
    REQUIRE(placements.size() == 1);  // The seed is off the palm's axis.
    CHECK(placements[0].direction_O == Vector3d(0, 0, -1));
    CHECK_FALSE(placements[0].palm_distance);
    const TargetContacts targets = scene.assigned(open_targets, placements[0]);
    const FittingResult result = scene.fit(targets, placements[0], paper_loop(), GraspStyle::Power);
    CHECK(result.smallest_distance == 0.0);
    const Vector3d palm_direction =
        result.configuration.X_OH.linear() * scene.hand.palm.direction_H;
    CHECK(angle_between(palm_direction, Vector3d(0, 0, -1)) < 1e-9);
    const auto is_palm = [](const contact::Contact& c) { return !c.finger; };
    const std::vector<contact::Contact> contacts = scene.contacts(result);
    REQUIRE(std::count_if(contacts.begin(), contacts.end(), is_palm) == 1);
    const auto palm = std::find_if(contacts.begin(), contacts.end(), is_palm);
    CHECK(palm->is_target);
    CHECK(angle_between(palm->inward_normal_O, Vector3d(0, 0, -1)) < 0.2);
    // Something else holds the object against the palm.
    CHECK(scene.contacts(result).size() > 1);
  }
}

TEST_CASE("Fingers of a power grasp close whether or not they have targets",
          "[grasp][power_fitting]") {
  grasp::PlannerOptions options = power_options();
  options.num_contacts = 2;
  const Scene scene(geometry::ball(0.045), "barrett", options);
  TargetContacts targets = power_targets(0.045, 0.045);
  targets.contacts.erase(targets.contacts.begin() + 1);
  const PalmPlacement placement{Vector3d(0, 0, -1)};
  targets = scene.assigned(targets, placement);
  const FittingResult power = scene.fit(targets, placement, paper_loop(), GraspStyle::Power);
  const FittingResult precision = scene.fit(targets, placement, paper_loop());
  for (const hands::Finger& finger : scene.hand.fingers) {
    const bool has_target =
        std::any_of(targets.contacts.begin(), targets.contacts.end(), [&](const auto& target) {
          return target.finger && &scene.hand.fingers[*target.finger] == &finger;
        });
    for (const int joint : finger.joints) {
      if (scene.hand.joints[joint].closing_sign == 0) continue;
      INFO(scene.hand.joints[joint].name);
      CHECK(power.configuration.q[joint] > power.initial.q[joint]);
      if (!has_target) CHECK(precision.configuration.q[joint] == precision.initial.q[joint]);
    }
  }
}

TEST_CASE("Fingers that are kept from each other end apart, others have closed through each other",
          "[grasp][power_fitting]") {
  int num_guarded = 0;
  int num_crossed = 0;
  for (const double radius : {0.015, 0.02, 0.025, 0.03, 0.035}) {
    const Scene scene(geometry::capsule(radius, 0.06), "human_hand", power_options());
    const TargetContacts open_targets = power_targets(radius, radius + 0.03);
    const PalmPlacement placement{Vector3d(0, 0, -1)};
    const TargetContacts targets = scene.assigned(open_targets, placement);
    const auto meets_itself = [&](const hands::HandConfiguration& configuration) {
      return scene.collision.against_self(hands::forward_kinematics(scene.hand, configuration))
          .intersects;
    };
    FittingOptions options;
    options.give_up_distance = 1.0;  // All fingers close as far as they can.
    const FittingResult through = scene.fit(targets, placement, options, GraspStyle::Power);
    options.guard_self = true;
    const FittingResult guarded = scene.fit(targets, placement, options, GraspStyle::Power);
    INFO("radius " << radius);
    if (meets_itself(guarded.initial)) continue;  // There is nothing to be kept.
    ++num_guarded;
    CHECK_FALSE(meets_itself(guarded.configuration));
    num_crossed += meets_itself(through.configuration) ? 1 : 0;
  }
  CHECK(num_guarded > 0);
  CHECK(num_crossed > 0);
}

TEST_CASE("No configuration of a fit touches the table", "[grasp][power_fitting]") {
  const Scene scene(geometry::ball(0.05));
  FittingOptions options = paper_loop();
  // With the palm frozen, no finger was lower than where it ends.
  options.palm_after_contact = grasp::PalmAfterContact::Frozen;
  const TargetContacts open_targets = testing::equilateral_targets(0.05, 0.2);
  const PalmPlacement from_above{Vector3d(0, 0, -1)}, from_below{Vector3d(0, 0, 1)};
  const TargetContacts targets = scene.assigned(open_targets, from_above);
  const FittingResult free = scene.fit(targets, from_above, options);
  REQUIRE(free.stop == FittingStop::Contact);
  const auto lowest_point = [&](const hands::HandConfiguration& configuration) {
    const auto X_OL = hands::forward_kinematics(scene.hand, configuration);
    double lowest = 1.0;
    for (std::size_t link = 0; link < scene.hand.links.size(); ++link) {
      for (const Vector3d& vertex : scene.hand.links[link].mesh_L.vertices) {
        lowest = std::min(lowest, (X_OL[link] * vertex).z());
      }
    }
    return lowest;
  };
  const double reached = lowest_point(free.configuration);
  for (const double table : {reached - 0.02, reached + 0.005, reached + 0.02}) {
    CAPTURE(table, reached);
    const grasp::SurroundingsCollision surroundings(scene.hand, {table, {}});
    const FittingResult result =
        grasp::fit_hand({scene.fitting_hand, scene.object, surroundings, scene.contact_options},
                        GraspStyle::Precision, targets, from_above, options);
    CHECK(lowest_point(result.initial) > table);
    CHECK(lowest_point(result.configuration) > table);
    if (table < reached - 0.01) CHECK(result.stop == FittingStop::Contact);
    const FittingResult below = grasp::fit_hand(
        {scene.fitting_hand, scene.object, surroundings, scene.contact_options},
        GraspStyle::Precision, scene.assigned(open_targets, from_below), from_below, options);
    CHECK(below.stop == FittingStop::InitialCollision);
  }
}

TEST_CASE("A palm's target is assigned to the palm and refused where it cannot be",
          "[grasp][power_fitting]") {
  const Scene scene(geometry::ball(0.045), "barrett", power_options());
  const PalmPlacement placement{Vector3d(0, 0, -1)};
  const TargetContacts targets = power_targets(0.045, 0.045);
  const TargetContacts assigned = scene.assigned(targets, placement);
  CHECK(assigned.contacts.back().is_palm);
  CHECK(!assigned.contacts.back().finger);
  CHECK(assigned.contacts.front().finger == scene.hand.thumb());
  grasp::RequestedParts without_palm = scene.parts;
  without_palm.palm = false;
  CHECK_THROWS_AS(grasp::assign_fingers(scene.hand, targets, without_palm, placement),
                  base::InvalidInput);
  TargetContacts palm_first = assigned;
  std::swap(palm_first.contacts.front(), palm_first.contacts.back());
  CHECK_THROWS_AS(scene.fit(palm_first, placement), base::InvalidInput);
  TargetContacts behind_tip = assigned;
  behind_tip.contacts.front().pad = scene.hand.pad_index("thumb_proximal_pad");
  CHECK_THROWS_WITH(scene.fit(behind_tip, placement),
                    testing::Contains("only fingertips' pads can be fitted"));
}

TEST_CASE("A seed on the palm's axis leaves eight turns open", "[grasp][power_fitting]") {
  const Scene scene(geometry::ball(0.045), "barrett", power_options());
  for (const double off_axis : {0.0, 0.009, 0.011}) {
    TargetContacts targets = power_targets(0.045, 0.045);
    targets.contacts.front().point_O = {off_axis, 0.0, -0.045};
    const auto placements = grasp::palm_placements(scene.object, targets, std::nullopt, pi);
    REQUIRE(placements.size() == (off_axis < 0.01 ? 8 : 1));
    for (std::size_t k = 0; k < placements.size(); ++k) {
      CHECK(placements[k].turn == Approx(2.0 * pi * static_cast<double>(k) / 8.0));
    }
  }
}

TEST_CASE("An approach cone keeps the directions inside it", "[grasp][power_fitting]") {
  // There are sixteen directions, 22.5° apart: those within an angle of one of them are 1 + 2
  // floor(a / 22.5°).
  const Scene scene(geometry::ball(0.05));
  const TargetContacts targets = targets_at({{0.05, 0, 0}, {-0.05, 0, 0}}, {{1, 0, 0}, {-1, 0, 0}});
  const Vector3d approach =
      grasp::palm_placements(scene.object, targets, std::nullopt, pi).front().direction_O;
  for (const double angle : {0.1, 0.5, 1.0, pi / 2.0 - 0.01, pi}) {
    const auto inside = grasp::palm_placements(scene.object, targets, 3.0 * approach, angle);
    CHECK(inside.size() == std::min(16.0, 1.0 + 2.0 * std::floor(angle / (pi / 8.0) + 1e-9)));
    for (const PalmPlacement& placement : inside) {
      CHECK(angle_between(placement.direction_O, approach) <= angle + 1e-9);
    }
  }
}

TEST_CASE("Pads that must lean tell by how much", "[grasp][power_fitting]") {
  // A gripper's pads face each other whatever it does. Target normals that both lean by `lean`
  // toward the palm leave exactly that; what the pads miss, were the box too wide, counts besides.
  grasp::PlannerOptions options;
  options.num_contacts = 2;
  const Scene scene(geometry::box({0.04, 0.08, 0.03}), "parallel_gripper", options);
  const PalmPlacement placement{-Vector3d::UnitZ()};
  for (const double lean : {0.0, 0.2, 0.5}) {
    const double c = std::cos(lean), s = std::sin(lean);
    const TargetContacts targets = scene.assigned(
        targets_at({{0.02, 0, 0}, {-0.02, 0, 0}}, {{c, 0, s}, {-c, 0, s}}), placement);
    const grasp::internal::TargetPosture posture =
        grasp::internal::posture_for(scene.hand, targets, placement);
    CHECK(posture.largest_tilt + posture.largest_miss / 0.015 == Approx(lean).margin(0.02));
  }
}

}  // namespace

}  // namespace test_power_fitting
