#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "fitting/target_posture.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/finger_assignment.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_planner_approach {

namespace {

using namespace graspfit;
using Eigen::Vector3d;

TEST_CASE("Every grasp comes from within the cone of approach, refined or not",
          "[grasp][grasp_planner][approach]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  grasp::PlannerOptions options;
  options.approach_O = Vector3d(0.0, 1.0, -2.0);
  options.approach_angle = 12.0 * std::numbers::pi / 180.0;
  options.weak.reset();
  options.pre_grasps = false;
  options.max_attempts = 12;
  options.count = 12;
  const auto object = grasp::prepare_object(geometry::ball(0.05, 3), hand, options);
  for (const bool refine : {true, false}) {
    options.refine = refine;
    options.acceptance = refine ? grasp::Acceptance::Valid : grasp::Acceptance::Usable;
    const grasp::PlannerResult result =
        grasp::plan_grasps(object, hand, options, {}, {.num_threads = 1});
    REQUIRE_FALSE(result.grasps.empty());
    for (const grasp::Grasp& grasp : result.grasps) {
      const Vector3d palm = grasp.configuration.X_OH.linear() * hand.palm.direction_H;
      CHECK(palm.dot(options.approach_O->normalized()) >= std::cos(options.approach_angle) - 1e-12);
    }
  }
}

TEST_CASE("Jaws always look at each other, so that nothing adds to how far they lean",
          "[grasp][hand_fitting][approach]") {
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const grasp::RequestedParts parts{{0, 1}};
  grasp::PalmPlacement placement;
  placement.direction_O = -Vector3d::UnitZ();
  for (const double lean : {0.0, 0.3, 0.6}) {
    INFO(lean);
    grasp::TargetContacts targets;
    targets.contacts.resize(2);
    for (const int side : {0, 1}) {
      const double sign = side == 0 ? 1.0 : -1.0;
      targets.contacts[side].point_O = sign * 0.02 * Vector3d::UnitX();
      targets.contacts[side].outward_normal_O = Vector3d(sign * std::cos(lean), 0, std::sin(lean));
    }
    const auto assigned = grasp::assign_fingers(hand, targets, parts, placement);
    const grasp::internal::TargetPosture posture =
        grasp::internal::posture_for(hand, assigned, placement);
    // Pads of a gripper look at each other, so that no pair's angle is left.
    CHECK(grasp::internal::reach_misfit(hand, assigned, posture) ==
          Approx(posture.largest_tilt + posture.largest_miss / 0.015).margin(1e-6));
  }
}

}  // namespace

}  // namespace test_planner_approach
