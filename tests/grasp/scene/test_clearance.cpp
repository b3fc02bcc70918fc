#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "grasp/fitting_scene.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "scene/clearance.hpp"
#include "support/catch.hpp"

namespace test_clearance {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using internal::NearPoints;

/// The same near points by a search for every piece and pair, without bounds from earlier ones.
std::vector<NearPoints> all_near(const testing::Scene& scene, const internal::LinkPoses& X_OL,
                                 double enough) {
  std::vector<NearPoints> near;
  const int num_links = static_cast<int>(X_OL.size());
  for (int link = 0; link < num_links; ++link) {
    for (const FittingHand::Piece& piece : scene.fitting_hand.pieces(link)) {
      const auto found =
          geometry::nearest_points(scene.object.query, piece.surface_L, X_OL[link], enough);
      if (found) near.push_back({found->distance, link, std::nullopt, {}, {}, {}});
    }
  }
  for (int a = 0; a < num_links; ++a) {
    for (int b = a + 1; b < num_links; ++b) {
      const auto& solid_a = scene.collision.link_solid(a);
      const auto& solid_b = scene.collision.link_solid(b);
      if (!solid_a || !solid_b || scene.hand.is_excluded(a, b)) continue;
      const auto found =
          geometry::nearest_points(*solid_a, *solid_b, X_OL[a].inverse() * X_OL[b], enough);
      if (found) near.push_back({found->distance, b, a, {}, {}, {}});
    }
  }
  return near;
}

/// Small steps around a pose beside the object, a long one now and then, and back.
std::vector<hands::HandConfiguration> walk(const testing::Scene& scene, base::Random& random) {
  std::vector<hands::HandConfiguration> steps;
  hands::HandConfiguration at = hands::open_configuration(scene.hand);
  at.X_OH.linear() =
      Eigen::Quaterniond::FromTwoVectors(scene.hand.palm.direction_H, -Vector3d::UnitX())
          .toRotationMatrix();
  at.X_OH.translation() = Vector3d(0.07, 0.0, 0.0) - at.X_OH.linear() * scene.hand.palm.center_H;
  for (int step = 0; step < 25; ++step) {
    const double size = step % 8 == 7 ? 0.05 : 0.004;
    const auto drawn = [&] {
      return Vector3d(random.uniform(-size, size), random.uniform(-size, size),
                      random.uniform(-size, size));
    };
    const Vector3d turn = 5.0 * drawn();
    at.X_OH.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    at.X_OH.translation() += drawn();
    for (double& q : at.q) q += random.uniform(-5.0 * size, 8.0 * size);
    hands::clamp_to_limits(scene.hand, at.q);
    hands::apply_couplings(scene.hand, at.q);
    steps.push_back(at);
  }
  return steps;
}

}  // namespace

TEST_CASE("Bounds from earlier poses leave out nothing that is near", "[grasp][clearance]") {
  for (const char* hand : {"barrett", "human_hand"}) {
    CAPTURE(hand);
    const testing::Scene scene(geometry::torus(0.04, 0.02), hand);
    internal::Clearance clearance(scene.fitting_hand, scene.object, scene.nothing);
    base::Random random(7);
    std::size_t num_near = 0;
    for (const hands::HandConfiguration& configuration : walk(scene, random)) {
      const internal::LinkPoses X_OL = hands::forward_kinematics(scene.hand, configuration);
      const double enough = random.uniform(0.0005, 0.01);
      const std::vector<NearPoints> found = clearance.find(X_OL, enough);
      const std::vector<NearPoints> expected = all_near(scene, X_OL, enough);
      REQUIRE(found.size() == expected.size());
      double nearest = 1.0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(found[i].link == expected[i].link);
        CHECK(found[i].other_link == expected[i].other_link);
        CHECK(std::abs(found[i].distance - expected[i].distance) <= 1e-12);
        nearest = std::min(nearest, expected[i].distance);
      }
      num_near += found.size();
      // By the bounds that this search has left.
      if (nearest > 0.0) CHECK(clearance.is_apart(X_OL, 0.5 * std::min(nearest, enough)));
      if (nearest < enough) CHECK_FALSE(clearance.is_apart(X_OL, 1.01 * nearest + 1e-6));
    }
    CHECK(num_near > 50);
  }
}

}  // namespace test_clearance
