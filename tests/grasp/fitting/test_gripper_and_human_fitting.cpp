#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "grasp/fitting_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_gripper_and_human_fitting {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::FittingResult;
using grasp::FittingStop;
using grasp::PalmPlacement;
using grasp::TargetContacts;
using std::numbers::pi;
using testing::targets_at;

grasp::PlannerOptions with_contacts(int number) {
  grasp::PlannerOptions options;
  options.num_contacts = number;
  return options;
}

/// An object prepared for a hand, and the hand for it.
struct Scene : testing::Scene {
  Scene(const geometry::TriangleMesh& mesh, const std::string& hand_name, int num_contacts)
      : testing::Scene(mesh, hand_name, with_contacts(num_contacts)) {}
};

TEST_CASE(
    "A gripper whose targets are off the object's middle moves over and touches on both sides",
    "[grasp][hand_fitting]") {
  // The middle of the targets is `off` beside the middle of a box 40 mm wide: one jaw meets the box
  // 2 `off` before the other, and the hand has to give way by `off`.
  const Scene scene(geometry::box({0.04, 0.08, 0.03}), "parallel_gripper", 2);
  for (const double off : {0.0, 0.004, -0.004, 0.012}) {
    CAPTURE(off);
    const PalmPlacement placement{-Vector3d::UnitZ()};
    const TargetContacts targets = scene.assigned(
        targets_at({{0.02 + off, 0, 0}, {-0.02 + off, 0, 0}}, {{1, 0, 0}, {-1, 0, 0}}), placement);
    const FittingResult result = scene.fit(targets, placement);
    CHECK(result.stop == FittingStop::Contact);
    CHECK(result.initial.X_OH.translation().x() == Approx(off).margin(1e-9));
    // Both jaws rest on the box within the tolerance of closing, so that the gripper is in its
    // middle.
    const double settled = grasp::FittingOptions{}.closing_tolerance;
    CHECK(result.configuration.X_OH.translation().x() == Approx(0.0).margin(2 * settled));
    CHECK(result.configuration.q[0] == Approx(0.02).margin(2 * settled));
    CHECK(result.configuration.q[0] == result.configuration.q[1]);
    for (const contact::Contact& contact : scene.contacts(result)) {
      if (!contact.finger) continue;
      CHECK(contact.is_target);
      CHECK(contact.gap < 4 * settled);
    }
    const std::vector<contact::Contact> contacts = scene.contacts(result);
    CHECK(std::count_if(contacts.begin(), contacts.end(),
                        [](const contact::Contact& c) { return c.is_target; }) == 2);
  }
}

TEST_CASE("A gripper that meets nothing closes to its limit and says what it missed",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::box({0.04, 0.08, 0.03}), "parallel_gripper", 2);
  const PalmPlacement placement{-Vector3d::UnitZ()};
  const TargetContacts targets = scene.assigned(
      targets_at({{0.02, 0.5, 0}, {-0.02, 0.5, 0}}, {{1, 0, 0}, {-1, 0, 0}}), placement);
  const FittingResult result = scene.fit(targets, placement);
  CHECK(result.stop == FittingStop::MissedContact);
  CHECK(result.configuration.q[0] == 0.0);
  CHECK(scene.contacts(result).empty());
}

TEST_CASE("A human hand brings its fingertips near their targets on a ball",
          "[grasp][hand_fitting]") {
  // Two to five fingers, the thumb against the others, come within one voxel and a pad's half width
  // (8 mm) of the targets. By proximal joints alone they would end 25 mm away.
  const double radius = 0.035;
  for (const int number : {2, 3, 4, 5}) {
    const Scene scene(geometry::ball(radius), "human_hand", number);
    const PalmPlacement placement{-Vector3d::UnitZ()};
    std::vector<Vector3d> points = {{radius, 0, 0}}, normals = {Vector3d::UnitX()};
    for (int k = 0; k < number - 1; ++k) {
      const double angle = pi + 0.65 * (k - 0.5 * (number - 2));
      normals.push_back({std::cos(angle), std::sin(angle), 0.0});
      points.push_back(radius * normals.back());
    }
    const TargetContacts targets = scene.assigned(targets_at(points, normals), placement);
    std::vector<int> served;
    for (const auto& target : targets.contacts) served.push_back(target.finger.value_or(-1));
    CHECK(std::is_permutation(served.begin(), served.end(), scene.parts.fingers.begin()));
    grasp::FittingOptions options;
    options.guard = grasp::PenetrationGuard::Voxels;
    options.contact_state = grasp::ContactState::FirstGraze;
    const FittingResult result = scene.fit(targets, placement, options);
    const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
    for (const grasp::TargetContact& target : targets.contacts) {
      CAPTURE(number, scene.hand.fingers[*target.finger].name, static_cast<int>(result.stop));
      const int pad = *scene.hand.fingers[*target.finger].tip_pad;
      const Vector3d tip = hands::pad_contact_point(scene.hand, pad, X_OL);
      CHECK((tip - target.point_O).norm() < 0.012);
    }
  }
}

TEST_CASE("The human hand closes before its fingers, which do not cross", "[grasp][hand_fitting]") {
  // The palm of this hand is beside its fingertips. With the palm center before the targets, as the
  // paper places it, they would be behind the bases of index and middle finger, which then cross.
  const double radius = 0.035;
  const Scene scene(geometry::ball(radius), "human_hand", 3);
  const PalmPlacement placement{-Vector3d::UnitZ()};
  for (const double spread : {0.6, 1.0}) {
    for (const double turn : {0.0, 2.0}) {
      CAPTURE(spread, turn);
      std::vector<Vector3d> points, normals;
      for (const double angle : {turn, turn + pi - spread, turn + pi + spread}) {
        normals.push_back({std::cos(angle), std::sin(angle), 0.0});
        points.push_back(radius * normals.back());
      }
      const TargetContacts targets = scene.assigned(targets_at(points, normals), placement);
      const FittingResult result = scene.fit(targets, placement);
      CHECK(result.stop == FittingStop::Contact);
      const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
      CHECK_FALSE(
          scene.fitting_hand.collision().against_object(scene.object.query, X_OL).intersects);
      CHECK_FALSE(scene.fitting_hand.collision().against_self(X_OL).intersects);
    }
  }
}

TEST_CASE("The fingertips that pinch are points of the skin, not of the bone behind it",
          "[grasp][hand_fitting]") {
  // Where both tips rest on the ball, their contact points are at its surface or, where a pad
  // leans, a little above it; the frames of the pads are 3 mm behind.
  const double radius = 0.02;
  const Scene scene(geometry::ball(radius, 5), "human_hand", 2);
  const PalmPlacement placement{-Vector3d::UnitZ()};
  const TargetContacts targets = scene.assigned(
      targets_at({{radius, 0, 0}, {-radius, 0, 0}}, {{1, 0, 0}, {-1, 0, 0}}), placement);
  const FittingResult result = scene.fit(targets, placement);
  REQUIRE(result.stop == FittingStop::Contact);
  const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
  for (const int finger : scene.parts.fingers) {
    const int pad = *scene.hand.fingers[finger].tip_pad;
    const Vector3d point = hands::pad_contact_point(scene.hand, pad, X_OL);
    const Vector3d origin = hands::pad_pose(scene.hand, pad, X_OL).translation();
    CHECK((point - origin).norm() == Approx(hands::pad_height(scene.hand.pads[pad])).epsilon(0.1));
    // The skin's facets are a little below the pad's.
    CHECK(point.norm() > radius - 0.2e-3);
    CHECK(origin.norm() > point.norm() + 1e-3);
  }
}

}  // namespace

}  // namespace test_gripper_and_human_fitting
