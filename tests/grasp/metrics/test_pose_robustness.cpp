#include <cmath>
#include <numbers>

#include "contact/known_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_metric.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_pose_robustness {

using namespace graspfit;
using namespace graspfit::contact;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using testing::Contacts;

namespace {

/// Returns the query of a unit ball that contacts hold at its surface.
const geometry::MeshQuery& ball() {
  static const geometry::MeshQuery query(geometry::ball(1.0, 5));
  return query;
}

GraspMetricFacts on_ball(const Contacts& contacts, double friction) {
  return {.contacts = contacts,
          .object = testing::unit_ball(),
          .friction = friction,
          .surface = &ball()};
}

double share_within(double limit, double deviation) {
  return std::erf(limit / (deviation * std::numbers::sqrt2));
}

}  // namespace

TEST_CASE("Without noise every pose is the grasp itself", "[grasp][pose_robustness]") {
  const GraspMetricFacts facts = on_ball(testing::on_cube(), 0.5);
  const PoseRobustness still = *pose_robustness(
      facts,
      {.num_samples = 3, .translation_deviation = 0.0, .rotation_deviation = 0.0, .reach = 0.2});
  CHECK(still.closed_share == 1.0);
  CHECK(still.mean_num_contacts == 6.0);
  CHECK_FALSE(still.usable_share.has_value());
  // The ball's faces are up to 1.5 degrees off its normals.
  CHECK(still.mean_epsilon == Approx(0.5 * std::sqrt(2.0 / 3.0)).epsilon(0.1));

  // Two contacts are closed only as their normals are rounded; three beside each other never are.
  const Contacts beside = testing::on_sphere({{1, 0.3, 0}, {1, -0.3, 0.2}, {1, 0, -0.4}});
  const PoseRobustness open = *pose_robustness(on_ball(beside, 0.2), {.num_samples = 3});
  CHECK(open.closed_share == 0.0);
  CHECK(open.mean_epsilon == 0.0);
}

TEST_CASE("A ball that turns about its center is held all the same", "[grasp][pose_robustness]") {
  const PoseRobustness turned = *pose_robustness(
      on_ball(testing::on_tetrahedron(), 0.8),
      {.num_samples = 20, .translation_deviation = 0.0, .rotation_deviation = 0.7, .reach = 0.2});
  CHECK(turned.closed_share == 1.0);
  CHECK(turned.mean_num_contacts == 4.0);
  const PoseRobustness far =
      *pose_robustness(on_ball(testing::on_tetrahedron(), 0.8),
                       {.num_samples = 20, .translation_deviation = 50.0, .reach = 0.2});
  CHECK(far.closed_share == 0.0);
  CHECK(far.mean_num_contacts < 0.2);
}

TEST_CASE("A pad meets a face as often as Gaussian noise leaves it over that face and in reach",
          "[grasp][pose_robustness]") {
  const geometry::MeshQuery box(geometry::box({0.04, 0.06, 0.5}));
  const Contacts on_top = {testing::contact_at({0, 0, 0.25}, -Vector3d::UnitZ())};
  const GraspMetricFacts facts = {
      .contacts = on_top, .object = testing::unit_ball(), .surface = &box};
  constexpr int kSamples = 20000;
  const double deviation = 0.02;
  const PoseRobustness found = *pose_robustness(facts, {.num_samples = kSamples,
                                                        .translation_deviation = deviation,
                                                        .rotation_deviation = 0.0,
                                                        .reach = 0.025});
  const double expected = share_within(0.02, deviation) * share_within(0.03, deviation) *
                          share_within(0.025, deviation);
  // The margin is four standard errors.
  CHECK(found.mean_num_contacts ==
        Approx(expected).margin(4.0 * std::sqrt(expected * (1.0 - expected) / kSamples)));
  CHECK(found.closed_share == 0.0);
}

TEST_CASE("Poses are usable where the paper's measure of what is met is positive",
          "[grasp][pose_robustness]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  Contacts contacts = testing::on_cube();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].finger = static_cast<int>(i % 2);  // Opposite contacts are of different fingers.
    contacts[i].pad = *hand.fingers[i % 2].tip_pad;
    contacts[i].area = 1e-4;
    contacts[i].pad_boundary_distance = 0.004;
  }
  GraspMetricFacts facts = on_ball(contacts, 0.5);
  facts.quality_context = QualityContext{
      .center_of_mass_O = Vector3d::Zero(), .normalizing_radius = 1.0, .hand = &hand};
  const auto share = [&](double deviation) {
    const auto found = pose_robustness(facts, {.num_samples = 40,
                                               .translation_deviation = deviation,
                                               .rotation_deviation = 0.0,
                                               .reach = 0.2});
    return found->usable_share.value();
  };
  CHECK(share(0.0) == 1.0);
  CHECK(share(50.0) == 0.0);  // Nothing meets the ball.
  // In between some poses lose their stable pairs: half a radius aside, normals are 30 degrees off.
  const double some = share(0.5);
  CHECK(some > 0.0);
  CHECK(some < 1.0);
  const GraspMetricInput input(facts);
  CHECK(*evaluate(grasp_metrics().at("robust_usable_share"), input).value ==
        *pose_robustness(facts)->usable_share);
}

TEST_CASE("The same seed gives the same numbers, and noise costs closure",
          "[grasp][pose_robustness]") {
  const GraspMetricFacts facts = on_ball(testing::on_tetrahedron(), 0.3);
  const auto with = [&](double deviation, std::uint64_t seed) {
    return *pose_robustness(facts, {.num_samples = 60,
                                    .translation_deviation = deviation,
                                    .rotation_deviation = 0.0,
                                    .reach = 0.5,
                                    .seed = seed});
  };
  const PoseRobustness once = with(0.2, 1);
  CHECK(once.mean_epsilon == with(0.2, 1).mean_epsilon);
  CHECK(once.mean_epsilon != with(0.2, 2).mean_epsilon);
  CHECK(with(0.01, 1).mean_epsilon > once.mean_epsilon);
  CHECK(with(0.01, 1).closed_share == 1.0);
  CHECK(once.closed_share < 1.0);
}

TEST_CASE("Metrics of robustness are these numbers at the default noise",
          "[grasp][pose_robustness]") {
  const GraspMetricFacts facts = on_ball(testing::on_tetrahedron(), 0.3);
  const GraspMetricInput input(facts);
  const PoseRobustness found = *pose_robustness(facts);
  CHECK(*evaluate(grasp_metrics().at("robust_closed_share"), input).value == found.closed_share);
  const GraspMetricValue epsilon = evaluate(grasp_metrics().at("robust_epsilon"), input);
  CHECK(*epsilon.value == found.mean_epsilon);
  CHECK_THAT(
      epsilon.convention,
      testing::StartsWith("100 poses, seed 1, Gaussian: 0.005 m and 0.08726646259971647 rad"));
  CHECK_THAT(epsilon.convention, testing::Contains("graspfit: torques about"));
  CHECK_FALSE(evaluate(grasp_metrics().at("robust_usable_share"), input).value.has_value());
}

TEST_CASE("Robustness needs contacts, a surface and sound options", "[grasp][pose_robustness]") {
  GraspMetricFacts facts = on_ball({}, 0.3);
  CHECK_FALSE(pose_robustness(facts).has_value());
  facts.contacts = testing::on_cube();
  facts.surface = nullptr;
  CHECK_FALSE(pose_robustness(facts).has_value());
  facts.surface = &ball();
  CHECK_THROWS_WITH(pose_robustness(facts, {.num_samples = 0}),
                    testing::Contains("num_samples = 0"));
  CHECK_THROWS_WITH(pose_robustness(facts, {.translation_deviation = -1.0}),
                    testing::Contains("translation_deviation = -1"));
  CHECK_THROWS_WITH(pose_robustness(facts, {.rotation_deviation = std::nan("")}),
                    testing::Contains("rotation_deviation"));
  CHECK_THROWS_WITH(pose_robustness(facts, {.reach = 0.0}), testing::Contains("reach = 0"));
}

}  // namespace test_pose_robustness
