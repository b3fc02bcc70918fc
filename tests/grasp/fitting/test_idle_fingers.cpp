#include <algorithm>
#include <vector>

#include "fitting/idle_fingers.hpp"
#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_idle_fingers {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;

PlannerOptions options_with(GraspStyle style) {
  PlannerOptions options;
  options.targets.search = TargetSearch::Reach;
  options.style = style;
  options.max_attempts = 6;
  options.count = 6;
  options.weak.reset();
  return options;
}

struct Scene {
  Scene(const char* hand_name, const geometry::TriangleMesh& mesh, const PlannerOptions& options)
      : hand(hands::find_hand(hand_name)),
        object(prepare_object(mesh, hand, options)),
        fitting_hand(hand, options.fitting.sample_spacing * object.grid.lattice.voxel_size),
        surroundings(hand, {}),
        contact_options(
            contact_estimation(options, clip_thickness(options, object.grid.lattice.voxel_size))) {}

  hands::HandModel hand;
  ObjectModel object;
  FittingHand fitting_hand;
  SurroundingsCollision surroundings;
  contact::ContactEstimationOptions contact_options;
};

/// Whether a fingertip's pad has a contact.
bool has_tip_contact(const Scene& scene, int finger,
                     const std::vector<hands::RigidTransform>& X_OL) {
  const std::vector<contact::Contact> contacts =
      contact::estimate_contacts(scene.hand, X_OL, scene.object.query, scene.contact_options);
  return std::any_of(contacts.begin(), contacts.end(), [&](const contact::Contact& contact) {
    return contact.pad == scene.hand.tip_pad_of(finger);
  });
}

}  // namespace

TEST_CASE("Idle fingers close onto the object and nothing else moves", "[grasp][idle_fingers]") {
  const PlannerOptions options = options_with(GraspStyle::Precision);
  const Scene scene("human_hand", geometry::capsule(0.03, 0.10), options);
  const PlannerResult planned = plan_grasps(scene.object, scene.hand, options);
  REQUIRE(planned.grasps.size() >= 3);
  int num_closed = 0;
  for (const Grasp& grasp : planned.grasps) {
    std::vector<int> used;
    for (const TargetContact& target : grasp.targets.contacts) {
      if (target.finger) used.push_back(*target.finger);
    }
    const hands::HandConfiguration closed = internal::with_idle_fingers_closed(
        {scene.fitting_hand, scene.object, scene.surroundings, scene.contact_options},
        grasp.configuration, used, options.fitting);
    CHECK(closed.X_OH.matrix() == grasp.configuration.X_OH.matrix());
    const auto X_OL = hands::forward_kinematics(scene.hand, closed);
    CHECK_FALSE(scene.fitting_hand.collision().against_object(scene.object.query, X_OL).intersects);
    CHECK_FALSE(scene.fitting_hand.collision().against_self(X_OL).intersects);
    for (int finger = 0; finger < std::ssize(scene.hand.fingers); ++finger) {
      CAPTURE(finger);
      bool has_moved = false;
      for (int joint = 0; joint < std::ssize(scene.hand.joints); ++joint) {
        const std::vector<int>& links = scene.hand.fingers[finger].links;
        const int child = scene.hand.joints[joint].child_link;
        if (std::find(links.begin(), links.end(), child) == links.end()) continue;
        has_moved = has_moved || closed.q[joint] != grasp.configuration.q[joint];
      }
      if (std::find(used.begin(), used.end(), finger) != used.end()) {
        CHECK_FALSE(has_moved);
      } else if (has_moved) {
        ++num_closed;
        CHECK(has_tip_contact(scene, finger, X_OL));
      }
    }
  }
  CHECK(num_closed >= 2);
}

TEST_CASE("A finger that shares its joint with one that holds stays", "[grasp][idle_fingers]") {
  PlannerOptions options = options_with(GraspStyle::Precision);
  options.num_contacts = 2;
  const Scene scene("parallel_gripper", geometry::box({0.03, 0.06, 0.08}), options);
  const PlannerResult planned = plan_grasps(scene.object, scene.hand, options);
  REQUIRE_FALSE(planned.grasps.empty());
  const hands::HandConfiguration& grasp = planned.grasps.front().configuration;
  const hands::HandConfiguration closed = internal::with_idle_fingers_closed(
      {scene.fitting_hand, scene.object, scene.surroundings, scene.contact_options}, grasp, {0},
      options.fitting);
  CHECK(closed.X_OH.matrix() == grasp.X_OH.matrix());
  CHECK(closed.q == grasp.q);
}

TEST_CASE("Planned grasps with idle fingers closed keep every promise and have more contacts",
          "[grasp][idle_fingers]") {
  PlannerOptions options = options_with(GraspStyle::Auto);
  const hands::HandModel hand = hands::find_hand("human_hand");
  const ObjectModel object = prepare_object(geometry::capsule(0.03, 0.10), hand, options);
  const auto num_contacts = [&](IdleFingers idle) {
    options.idle_fingers = idle;
    const PlannerResult result = plan_grasps(object, hand, options, {}, {.num_threads = 1});
    REQUIRE(result.grasps.size() >= 3);
    std::size_t sum = 0;
    for (const Grasp& grasp : result.grasps) {
      CHECK(grasp.is_valid());
      CHECK(grasp.pre_grasp.has_value());
      sum += grasp.contacts.size();
    }
    return static_cast<double>(sum) / static_cast<double>(result.grasps.size());
  };
  CHECK(num_contacts(IdleFingers::Close) > num_contacts(IdleFingers::Stay));
}

}  // namespace test_idle_fingers
