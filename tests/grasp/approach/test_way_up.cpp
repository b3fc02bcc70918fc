#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "approach/way_up.hpp"
#include "grasp/posed_box.hpp"
#include "grasp/reach_options.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

// These tests are about going up with the object after a grasp.
namespace test_way_up {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using geometry::TriangleMesh;

TriangleMesh box_at(const Vector3d& size, const Vector3d& center) {
  TriangleMesh mesh = geometry::box(size);
  for (Vector3d& vertex : mesh.vertices) vertex += center;
  return mesh;
}

/// The parallel gripper from above around a box of 40 x 20 x 30 mm at the origin.
struct Pinch {
  Pinch() {
    grasp = hands::open_configuration(hand);
    grasp.q.setConstant(0.021);
    grasp.X_OH.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
    grasp.X_OH.translation().z() = 0.072;  // above what it stands on
  }
  double top() const { return testing::posed_box(hand, grasp).max().z(); }
  bool is_free(const std::vector<TriangleMesh>& obstacles) const {
    Surroundings around;
    around.table_z_O = -0.015;
    for (const TriangleMesh& obstacle : obstacles) around.obstacles.emplace_back(obstacle);
    const SurroundingsCollision surroundings(hand, around);
    const auto X_OL = hands::forward_kinematics(hand, grasp);
    return internal::is_way_up_free({hand, collision, object, surroundings}, {grasp, X_OL});
  }
  hands::HandModel hand = hands::find_hand("parallel_gripper");
  hands::HandCollision collision{hand};
  geometry::MeshQuery object{geometry::box({0.04, 0.02, 0.03})};
  hands::HandConfiguration grasp;
};

}  // namespace

TEST_CASE("A hand goes up by 0.1 m unless something is above it", "[grasp][way_up]") {
  const Pinch pinch;
  CHECK(pinch.is_free({}));
  const auto ceiling = [&](double height) {
    return box_at({0.5, 0.5, 0.01}, {0.0, 0.0, pinch.top() + height + 0.005});
  };
  CHECK(pinch.is_free({ceiling(0.101)}));
  CHECK_FALSE(pinch.is_free({ceiling(0.099)}));
  CHECK_FALSE(pinch.is_free({ceiling(0.5), ceiling(0.02)}));
}

TEST_CASE("The object goes up with the hand, past what is above it and off what it stands on",
          "[grasp][way_up]") {
  const Pinch pinch;
  // A ledge 5 mm above it, beside the fingers.
  const TriangleMesh ledge = box_at({0.02, 0.03, 0.01}, {0.0, 0.02, 0.025});
  CHECK_FALSE(pinch.is_free({ledge}));
  CHECK(pinch.is_free({box_at({0.02, 0.03, 0.01}, {0.0, 0.026, 0.025})}));
  // A floor, and a wall on which it leans.
  const TriangleMesh floor = box_at({0.5, 0.5, 0.01}, {0.0, 0.0, -0.02});
  const TriangleMesh wall = box_at({0.02, 0.02, 0.1}, {0.0, -0.02, 0.0});
  CHECK(pinch.is_free({floor}));
  CHECK(pinch.is_free({wall}));
  CHECK(pinch.is_free({floor, wall}));
  CHECK_FALSE(pinch.is_free({floor, wall, ledge}));
}

TEST_CASE("What is planned under a shelf comes out from below it", "[grasp][way_up]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  PlannerOptions options = testing::reach_options(GraspStyle::Auto, 6);
  TriangleMesh ball = geometry::ball(0.035, 3);
  for (Vector3d& vertex : ball.vertices) vertex.z() += 0.035;
  const ObjectModel object = prepare_object(ball, hand, options);
  Surroundings around;
  around.table_z_O = 0.0;
  const auto num_found = [&] {
    return plan_grasps(object, hand, options, around, {.num_threads = 1})
        .statistics.outcomes.at(AttemptOutcome::Valid);
  };
  CHECK(num_found() >= 4);
  // It covers the ball, so that none can go up with it.
  around.obstacles.emplace_back(box_at({0.06, 0.06, 0.01}, {0.0, 0.0, 0.12}));
  CHECK(num_found() == 0);
}

}  // namespace test_way_up
