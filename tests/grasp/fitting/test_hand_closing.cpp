#include <algorithm>
#include <cmath>

#include "grasp/guidance_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "support/catch.hpp"

namespace test_hand_closing {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::FittingResult;
using grasp::FittingStop;
using grasp::RetreatRule;
using testing::Scene;
using testing::unsaid;

/// Returns the Barrett hand above a ball, palm down, its center `height` over the ball's.
hands::HandConfiguration above(const Scene& scene, double height) {
  const hands::HandModel& hand = scene.hand;
  hands::HandConfiguration start = hands::open_configuration(hand);
  start.X_OH = hands::palm_pose(hand, hands::closing_axis_H(hand), hand.palm.center_H,
                                -Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d(0, 0, height));
  return start;
}

grasp::FittingOptions options_at(grasp::PenetrationGuard guard) {
  grasp::FittingOptions options;
  options.guard = guard;
  options.contact_state = grasp::ContactState::FirstGraze;
  return options;
}

FittingResult closed(const Scene& scene, const hands::HandConfiguration& start,
                     const RetreatRule& retreat = {},
                     grasp::PenetrationGuard guard = grasp::PenetrationGuard::Voxels) {
  return grasp::close_hand(scene.grasp_scene(), grasp::GraspStyle::Precision, scene.parts, start,
                           retreat, options_at(guard));
}

/// Returns d_min over all links at a configuration, from all their samples.
float least_distance(const Scene& scene, const hands::HandConfiguration& configuration) {
  const auto X_OL = hands::forward_kinematics(scene.hand, configuration);
  float least = 1e9F;
  for (std::size_t link = 0; link < scene.hand.links.size(); ++link) {
    for (const Vector3d& point : scene.fitting_hand.samples(static_cast<int>(link)).points_L) {
      least = std::min(least, scene.object.distance.at(Vector3d(X_OL[link] * point)));
    }
  }
  return least;
}

TEST_CASE("A hand over a ball closes on it with all fingers and its palm stays",
          "[grasp][hand_closing]") {
  const Scene scene(geometry::ball(0.045));
  for (const auto guard : {grasp::PenetrationGuard::Voxels, grasp::PenetrationGuard::Meshes}) {
    const hands::HandConfiguration start = above(scene, 0.075);
    const FittingResult result = closed(scene, start, {}, guard);
    CHECK(result.stop == FittingStop::Contact);
    CHECK(result.initial.X_OH.matrix() == start.X_OH.matrix());
    CHECK(result.configuration.X_OH.matrix() == start.X_OH.matrix());
    CHECK(least_distance(scene, result.configuration) >= 0.0F);
    CHECK(scene.contacts(result).size() >= 3);
    // The hand is symmetric, and so is its posture: fingers 1 and 2 mirror each other.
    const auto closing = [&](const char* finger) {
      return result.configuration.q[scene.hand.fingers[scene.hand.finger_index(finger)].joints[1]];
    };
    CHECK(std::abs(closing("finger_1") - closing("finger_2")) < 0.05);
    if (guard == grasp::PenetrationGuard::Meshes) {
      CHECK_FALSE(scene.collision
                      .against_object(scene.object.query,
                                      hands::forward_kinematics(scene.hand, result.configuration))
                      .intersects);
    }
  }
}

TEST_CASE("A colliding hand backs off to the first clear place along its direction",
          "[grasp][hand_closing]") {
  const Scene scene(geometry::ball(0.045));
  const double step = 0.003;
  const FittingResult result = closed(scene, above(scene, 0.02), {.step = step});
  const double back =
      result.initial.X_OH.translation().z() - above(scene, 0.02).X_OH.translation().z();
  const double steps = back / step;
  CHECK(std::abs(steps - std::round(steps)) < 1e-6);
  CHECK(steps > 5.0);
  CHECK(least_distance(scene, result.initial) > 0.0F);
  hands::HandConfiguration before = result.initial;
  before.X_OH.pretranslate(Vector3d(0, 0, -step));
  CHECK(least_distance(scene, before) <= 0.0F);
  CHECK(result.stop == FittingStop::Contact);
}

TEST_CASE("A hand that has backed off may go back until its palm touches",
          "[grasp][hand_closing]") {
  const Scene scene(geometry::ball(0.045));
  const hands::HandConfiguration start = above(scene, 0.043);  // The palm is at the pole.
  const double step = 2.0 * scene.voxel_size();
  const auto has_palm = [&](const FittingResult& result) {
    const std::vector<contact::Contact> contacts = scene.contacts(result);
    return std::any_of(contacts.begin(), contacts.end(),
                       [](const contact::Contact& contact) { return !contact.finger; });
  };
  const FittingResult away = closed(scene, start, {.step = step});
  CHECK_FALSE(has_palm(away));
  const FittingResult touching = closed(scene, start, {.step = step, .palm_may_touch = true});
  CHECK(has_palm(touching));
  CHECK(touching.smallest_distance >= 0.0);
  // It is between where the hand was clear and where it started.
  const double height = touching.configuration.X_OH.translation().z();
  CHECK(height < away.configuration.X_OH.translation().z());
  CHECK(height >= start.X_OH.translation().z() - 1e-12);
  // From a start that is clear the hand does not go on.
  const FittingResult clear = closed(scene, above(scene, 0.075), {.palm_may_touch = true});
  CHECK(clear.configuration.X_OH.matrix() == above(scene, 0.075).X_OH.matrix());
}

TEST_CASE("Of a bounded retreat the rule says whether a hand in collision closes",
          "[grasp][hand_closing]") {
  const Scene scene(geometry::ball(0.045));
  const hands::HandConfiguration start = above(scene, 0.02);
  const FittingResult refused = closed(scene, start, {.step = 0.003, .most_steps = 5});
  CHECK(refused.stop == FittingStop::InitialCollision);
  CHECK(refused.iterations == 0);
  const FittingResult forced =
      closed(scene, start, {.step = 0.003, .most_steps = 5, .closes_in_collision = true});
  CHECK(forced.stop != FittingStop::InitialCollision);
  CHECK(forced.iterations > 0);
  for (const FittingResult& result : {refused, forced}) {
    CHECK(
        (result.configuration.X_OH.translation() - start.X_OH.translation() - Vector3d(0, 0, 0.015))
            .norm() < 1e-12);
  }
  CHECK(forced.smallest_distance < 0.0);
}

TEST_CASE("With the guard on voxels no link ends deeper in the object than a voxel's edge",
          "[grasp][hand_closing]") {
  // Edges of a turned box are the hard case: by d_min alone links stop up to a diagonal deep.
  for (int i = 0; i < 12; ++i) {
    const geometry::RigidTransform X_OB(Eigen::AngleAxisd(0.5 * i, Vector3d(1, 2, 3).normalized()));
    const Scene scene(geometry::transformed(geometry::box(Vector3d(0.08, 0.06, 0.07)), X_OB));
    grasp::FittingOptions options;
    options.guard = grasp::PenetrationGuard::Voxels;
    const FittingResult result =
        grasp::close_hand(scene.grasp_scene(), grasp::GraspStyle::Precision, scene.parts,
                          above(scene, 0.07), {}, options);
    INFO("turned by " << 0.5 * i << " rad");
    const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
    CHECK(least_distance(scene, result.configuration) >= 0.0F);
    CHECK(scene.collision.against_object(scene.object.query, X_OL).depth <= scene.voxel_size());
  }
}

TEST_CASE("Fingers that meet nothing close to their limits", "[grasp][hand_closing]") {
  const Scene scene(geometry::ball(0.045));
  const FittingResult result = closed(scene, above(scene, 0.5));
  CHECK(result.stop == FittingStop::MissedContact);
  CHECK(scene.contacts(result).empty());
}

TEST_CASE("A palm that is requested moves on to the surface", "[grasp][hand_closing]") {
  grasp::PlannerOptions options;
  options.style = grasp::GraspStyle::Power;
  const Scene scene(geometry::ball(0.045), "barrett", options);
  REQUIRE(scene.parts.palm);
  // The start is one to three voxels of 3 mm over the ball.
  const hands::HandConfiguration start = above(scene, 0.045 + 0.008);
  const FittingResult result =
      grasp::close_hand(scene.grasp_scene(), grasp::GraspStyle::Power, scene.parts, start, {},
                        options_at(grasp::PenetrationGuard::Meshes));
  const double down =
      result.initial.X_OH.translation().z() - result.configuration.X_OH.translation().z();
  CHECK(down > 0.0);
  const std::vector<contact::Contact> contacts = scene.contacts(result);
  CHECK(std::any_of(contacts.begin(), contacts.end(),
                    [&](const auto& contact) { return contact.pad == scene.hand.palm.pad; }));
}

TEST_CASE("A palm that is requested goes on by four voxels at most", "[grasp][hand_closing]") {
  grasp::PlannerOptions options;
  options.palm = true;
  const Scene scene(geometry::ball(0.045), "barrett", options);
  const hands::HandConfiguration start = above(scene, 0.045 + 10.0 * scene.voxel_size());
  const FittingResult result =
      grasp::close_hand(scene.grasp_scene(), grasp::GraspStyle::Power, scene.parts, start, {},
                        options_at(grasp::PenetrationGuard::Meshes));
  const double down =
      result.initial.X_OH.translation().z() - result.configuration.X_OH.translation().z();
  CHECK(down == Approx(4.0 * scene.voxel_size()).epsilon(0.02));
}

TEST_CASE("Closing a hand refuses what makes no sense", "[grasp][hand_closing]") {
  const Scene scene(geometry::ball(0.045));
  const auto message = [&](const grasp::RequestedParts& parts, const RetreatRule& retreat) {
    try {
      grasp::close_hand(scene.grasp_scene(), grasp::GraspStyle::Precision, parts, above(scene, 0.1),
                        retreat, {});
    } catch (const base::InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  CHECK(unsaid(message({}, {}), "finger", "no") == "");
  CHECK(unsaid(message({{7}, false}, {}), "finger", "7") == "");
  grasp::RequestedParts other = scene.parts;
  other.other_pads = {scene.hand.pad_index("finger_1_proximal_pad")};
  CHECK(unsaid(message(other, {}), "pad", "only fingertips") == "");
  CHECK(unsaid(message(scene.parts, {.step = 0.0}), "step", "0") == "");
  CHECK(unsaid(message(scene.parts, {.most_steps = -2}), "steps", "-2") == "");
}

}  // namespace

}  // namespace test_hand_closing
