#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "grasp/fitting_scene.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "support/catch.hpp"

namespace test_fitting_hand {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using geometry::RigidTransform;
using testing::Contains;
using testing::dense_points;
using testing::Scene;

/// Walks the tree of balls from `ball` down. Returns how far any point is outside a ball that
/// should hold it [m], and counts for each point the leaves that hold it.
double farthest_outside(const grasp::FittingHand::LinkSamples& samples, std::int32_t ball,
                        std::vector<std::int32_t> ancestors, std::vector<int>& times_held) {
  ancestors.push_back(ball);
  const grasp::FittingHand::Ball& node = samples.balls[ball];
  if (node.count == 0) {
    return std::max(farthest_outside(samples, ball + 1, ancestors, times_held),
                    farthest_outside(samples, node.first, ancestors, times_held));
  }
  double outside = 0.0;
  for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
    ++times_held[i];
    for (const std::int32_t ancestor : ancestors) {
      const grasp::FittingHand::Ball& holder = samples.balls[ancestor];
      outside = std::max(outside, (samples.points_L[i] - holder.center_L).norm() - holder.radius);
    }
  }
  return outside;
}

TEST_CASE("The points of a fitting hand lie on its links and leave no gap wider than the spacing",
          "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  constexpr double kSpacing = 0.003;
  const grasp::FittingHand fitting_hand(hand, kSpacing);
  for (std::size_t i = 0; i < hand.links.size(); ++i) {
    const int link = static_cast<int>(i);
    INFO(hand.links[i].name);
    const grasp::FittingHand::LinkSamples& samples = fitting_hand.samples(link);
    const std::vector<Vector3d>& points = samples.points_L;
    if (hand.links[i].mesh_L.faces.empty()) {
      CHECK(points.empty());
      CHECK(samples.balls.empty());
      continue;
    }
    const geometry::MeshQuery surface(hand.links[i].mesh_L);
    double farthest = 0.0, off_surface = 0.0;
    for (const Vector3d& point : points) {
      farthest = std::max(farthest, point.norm());
      off_surface = std::max(off_surface, std::sqrt(surface.closest_point(point).squared_distance));
    }
    CHECK(off_surface < 1e-12);
    CHECK(samples.reach == Approx(farthest).epsilon(1e-12));
    std::vector<int> times_held(points.size(), 0);
    CHECK(farthest_outside(samples, 0, {}, times_held) < 1e-12);
    CHECK(std::all_of(times_held.begin(), times_held.end(), [](int times) { return times == 1; }));

    double widest_gap = 0.0;
    base::Random random(1);
    const auto probes = dense_points(hand.links[i].mesh_L, 0.5 * kSpacing);
    for (int k = 0; k < 300; ++k) {
      const Vector3d& probe = probes[random.index(probes.size())];
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vector3d& point : points) nearest = std::min(nearest, (point - probe).norm());
      widest_gap = std::max(widest_gap, nearest);
    }
    CHECK(widest_gap <= kSpacing);
  }
}

TEST_CASE("A fitting hand needs a positive spacing", "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  for (const double spacing : {0.0, -0.001, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(grasp::FittingHand(hand, spacing), base::InvalidInput);
  }
}

TEST_CASE("A hand that is thousands of times its points' spacing is refused by name",
          "[grasp][hand_fitting]") {
  hands::HandModel hand;
  hand.name = "giant";
  hand.links.resize(1);
  hand.links[0].name = "palm";
  for (const double size : {90.0, 1e12, 1e100}) {
    CAPTURE(size);
    hand.links[0].mesh_L = geometry::box({size, size, size});
    CHECK_THROWS_WITH(grasp::FittingHand(hand, 0.002),
                      Contains("hand giant: link palm is ") && Contains("in another unit"));
  }
}

TEST_CASE("The smallest distance is that of a search over all points, up to what is enough",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::torus(0.05, 0.018));
  base::Random random(2);
  int num_below = 0, num_above = 0;
  for (int trial = 0; trial < 200; ++trial) {
    RigidTransform X_OL = RigidTransform::Identity();
    X_OL.linear() = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                       random.uniform(-1, 1), random.uniform(-1, 1))
                        .normalized()
                        .toRotationMatrix();
    // Some poses are far outside the lattice.
    const double away = trial % 10 == 0 ? 2.0 : 0.12;
    X_OL.translation() =
        away * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const int link = static_cast<int>(random.index(scene.hand.links.size()));
    const std::vector<Vector3d>& points = scene.fitting_hand.samples(link).points_L;
    if (points.empty()) continue;
    float expected = std::numeric_limits<float>::infinity();
    for (const Vector3d& point : points) {
      const Vector3d point_O = X_OL * point;
      expected = std::min(expected, scene.object.distance.at(point_O));
    }
    for (const float enough : {-1.0F, 0.0F, 2.0F, 5.0F, 1e6F}) {
      const float found =
          grasp::smallest_distance(scene.fitting_hand, link, X_OL, scene.object.distance, enough);
      if (expected <= enough) {
        ++num_below;
        CHECK(found == expected);
      } else {
        ++num_above;
        CHECK(found > enough);
      }
    }
  }
  CHECK(num_below > 100);
  CHECK(num_above > 100);
}

}  // namespace

}  // namespace test_fitting_hand
