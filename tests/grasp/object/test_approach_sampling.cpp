#include <array>
#include <cmath>
#include <numbers>

#include "grasp/guidance_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/approach_sampling.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "support/catch.hpp"

namespace test_approach_sampling {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::ApproachSource;
using testing::at_voxel_level;
using testing::chi_square;
using testing::Guided;

// Chi squares exceed these values with probability 0.001.
constexpr double kChiSquare3 = 16.27;
constexpr double kChiSquare5 = 20.52;
constexpr double kChiSquare9 = 27.88;

const Vector3d kSizes(0.11, 0.07, 0.09);

/// Returns 0 to 5: the side of a box through which a direction leaves.
int side_of(const Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<int>(axis) + (normal[axis] > 0.0 ? 1 : 0);
}

std::array<double, 6> share_of_sides() {
  std::array<double, 6> shares{};
  const double all = 2.0 * (kSizes[0] * kSizes[1] + kSizes[1] * kSizes[2] + kSizes[2] * kSizes[0]);
  for (int axis = 0; axis < 3; ++axis) {
    shares[2 * axis] = shares[2 * axis + 1] = kSizes[(axis + 1) % 3] * kSizes[(axis + 2) % 3] / all;
  }
  return shares;
}

grasp::ObjectModel model_of(const geometry::TriangleMesh& mesh) {
  return grasp::build_object_model(mesh, {.resolution = 16});
}

TEST_CASE("Surface samples fall on the sides of a box in proportion to area",
          "[grasp][approach_sampling]") {
  const auto samples = grasp::approach_samples(model_of(geometry::box(kSizes)), {}, 5);
  REQUIRE(samples.size() == 1000);
  std::array<int, 6> counts{};
  for (const auto& sample : samples) ++counts[side_of(sample.normal)];
  std::array<double, 6> expected = share_of_sides();
  for (double& count : expected) count *= 1000.0;
  CHECK(chi_square(counts, expected) < kChiSquare5);
}

TEST_CASE("Rays from a box around a box hit it where they are aimed",
          "[grasp][approach_sampling]") {
  // A face of the surrounding box has a ray every 2 cm from its middle: 7, 5 and 5 of them along
  // its 13, 9 and 11 cm, of which 5, 3 and 5 meet the box of 11, 7 and 9 cm.
  const grasp::ObjectModel object = model_of(geometry::box(kSizes));
  const auto hits = grasp::approach_samples(object, {.source = ApproachSource::BoxRays}, 5);
  std::array<int, 6> counts{};
  for (const auto& hit : hits) {
    const int side = side_of(hit.normal);
    ++counts[side];
    const int axis = side / 2;
    CHECK(std::abs(hit.point[axis]) == Approx(0.5 * kSizes[axis]).epsilon(1e-12));
    CHECK(hit.normal[axis] * hit.point[axis] > 0.0);
    for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
      const double steps = hit.point[other] / 0.02;
      CHECK(std::abs(steps - std::round(steps)) < 1e-9);
    }
  }
  CHECK(counts == std::array<int, 6>{15, 15, 25, 25, 15, 15});
}

TEST_CASE("Rays from a box see little of a hole's wall, surface samples all of it",
          "[grasp][approach_sampling]") {
  // The part of a torus where the normal looks to the axis within 11.5 degrees is 4 % of the area,
  // but 0.8 % of the torus' picture along the axis, the only one that it is in.
  const grasp::ObjectModel ring = model_of(geometry::torus(0.05, 0.018));
  const auto share_of_inner = [](const std::vector<geometry::SurfaceSample>& samples) {
    double count = 0.0;
    for (const auto& sample : samples) {
      const Vector3d across(sample.point.x(), sample.point.y(), 0.0);
      if (sample.normal.dot(across.normalized()) < -0.98) count += 1.0;
    }
    return count / static_cast<double>(samples.size());
  };
  CHECK(share_of_inner(grasp::approach_samples(ring, {}, 1)) > 0.025);
  CHECK(share_of_inner(grasp::approach_samples(
            ring, {.source = ApproachSource::BoxRays, .box_spacing = 0.005}, 1)) < 0.01);
}

TEST_CASE("Attempts of GS take samples, turns and spreads evenly", "[grasp][approach_sampling]") {
  // The test observes where the palm looks, how it is turned and how the fingers are spread where
  // each attempt starts. The hand may have backed off, but only along its direction.
  constexpr int kAttempts = 600;
  const Guided guided(geometry::box(kSizes), at_voxel_level("gs"));
  const hands::HandModel& hand = guided.scene.hand;
  const int spread = *hand.fingers[hand.finger_index("finger_1")].swing_joint;
  std::array<int, 6> sides{};
  std::array<int, 10> turns{};
  std::array<int, 4> spreads{};
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const grasp::GuidedStarts starts = guided.guidance->starts(attempt);
    REQUIRE(starts.starts.size() == 1);
    CHECK(starts.starts[0].targets.contacts.empty());
    const hands::HandConfiguration at = starts.starts[0].close().initial;
    const Vector3d direction = at.X_OH.linear() * hand.palm.direction_H;
    const int side = side_of(-direction);
    ++sides[side];
    // The turn is measured against a direction fixed to the side.
    const Vector3d u = Vector3d::Unit((side / 2 + 1) % 3);
    const Vector3d x = at.X_OH.linear().col(0);
    const double turn = std::atan2(u.cross(x).dot(direction), u.dot(x)) / (2.0 * std::numbers::pi);
    ++turns[std::min(9, static_cast<int>(10.0 * (turn - std::floor(turn))))];
    // The share is 0, 1, 1.5 or 3.
    const double share = at.q[spread] / (std::numbers::pi / 3.0);
    CHECK(std::abs(2.0 * share - std::round(2.0 * share)) < 1e-9);
    ++spreads[share < 0.5 ? 0 : share < 1.25 ? 1 : share < 2.0 ? 2 : 3];
  }
  std::array<double, 6> expected = share_of_sides();
  for (double& count : expected) count *= kAttempts;
  // The 1000 samples themselves are drawn, too, so that the variance of counts is 1 + 600 / 1000
  // times that of a direct draw.
  CHECK(chi_square(sides, expected) < 1.6 * kChiSquare5);
  CHECK(chi_square(turns, std::array<double, 10>{60, 60, 60, 60, 60, 60, 60, 60, 60, 60}) <
        kChiSquare9);
  CHECK(chi_square(spreads, std::array<double, 4>{150, 150, 150, 150}) < kChiSquare3);
}

TEST_CASE("Attempts of GS keep to the cone of approach", "[grasp][approach_sampling]") {
  grasp::PlannerOptions options = at_voxel_level("gs");
  options.approach_O = Vector3d(0, 0, -2);
  options.approach_angle = 0.3;
  const Guided guided(geometry::ball(0.04), options);
  for (int attempt = 0; attempt < 50; ++attempt) {
    const hands::HandConfiguration at =
        guided.guidance->starts(attempt).starts.at(0).close().initial;
    const Vector3d direction = at.X_OH.linear() * guided.scene.hand.palm.direction_H;
    CHECK(testing::angle_between(direction, Vector3d(0, 0, -1)) < 0.3 + 1e-12);
  }
  options.approach_angle = 1e-6;  // The direction is between the normals of the ball's facets.
  const Guided none(geometry::ball(0.04), options);
  CHECK(none.guidance->starts(0).starts.empty());
  CHECK(none.guidance->starts(0).failure == "no sample");
  CHECK(none.guidance->starts(0).is_exhausted);
  CHECK_FALSE(guided.guidance->starts(0).is_exhausted);
}

TEST_CASE("A box of too many rays is refused", "[grasp][approach_sampling]") {
  CHECK_THROWS_AS(
      grasp::approach_samples(model_of(geometry::box(kSizes)),
                              {.source = ApproachSource::BoxRays, .box_spacing = 1e-5}, 1),
      base::InvalidInput);
}

}  // namespace

}  // namespace test_approach_sampling
