// These tests are about the baseline gs-targets, which draws targets at random from surface
// samples.
#include <algorithm>
#include <array>
#include <cmath>

#include "grasp/guidance_scene.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/approach_sampling.hpp"
#include "support/catch.hpp"

namespace test_sample_targets {

using namespace graspfit;
using Eigen::Vector3d;
using testing::at_voxel_level;
using testing::chi_square;
using testing::Guided;

namespace {

// With seven degrees of freedom one in a thousand is above.
constexpr double kChiSquare7 = 24.3;

/// Returns the targets of the attempt, of the side tried first.
grasp::TargetContacts targets_of(const Guided& guided, int attempt) {
  const grasp::GuidedStarts starts = guided.guidance->starts(attempt);
  REQUIRE_FALSE(starts.starts.empty());
  return starts.starts.front().targets;
}

}  // namespace

TEST_CASE("Random targets are samples of the surface that the fingers can have",
          "[grasp][sample_targets]") {
  const grasp::PlannerOptions options = at_voxel_level("gs-targets");
  for (const auto& mesh : {geometry::ball(0.05), geometry::box({0.12, 0.06, 0.04})}) {
    const Guided guided(mesh, options);
    const auto samples =
        grasp::approach_samples(guided.scene.object, options.sampling, options.seed);
    const grasp::PartDistances distances = grasp::part_distances(guided.scene.hand);
    for (int attempt = 0; attempt < 40; ++attempt) {
      CAPTURE(attempt);
      const grasp::TargetContacts targets = targets_of(guided, attempt);
      REQUIRE(targets.contacts.size() == 3);
      const grasp::TargetContact& seed = targets.contacts.front();
      CHECK(seed.finger == guided.scene.hand.thumb());
      for (std::size_t i = 0; i < targets.contacts.size(); ++i) {
        const grasp::TargetContact& target = targets.contacts[i];
        CHECK(!target.patch);
        CHECK(std::any_of(samples.begin(), samples.end(), [&](const auto& sample) {
          return sample.point == target.point_O && sample.normal == target.outward_normal_O;
        }));
        if (i == 0) continue;
        CHECK(contact::stable_pair_angle(seed.point_O, -seed.outward_normal_O, target.point_O,
                                         -target.outward_normal_O, options.targets.theta_max));
        for (std::size_t k = 0; k < i; ++k) {
          const hands::DistanceRange& range =
              distances.tip_to_tip[target.finger.value()][targets.contacts[k].finger.value()];
          const double distance = (target.point_O - targets.contacts[k].point_O).norm();
          CHECK(distance >= range.smallest);
          CHECK(distance <= range.largest);
        }
      }
    }
  }
}

TEST_CASE("Seeds of random targets fall evenly on a ball", "[grasp][sample_targets]") {
  // Every point of a ball can be a seed with the same chance, and so can its octants.
  constexpr int kAttempts = 400;
  const Guided guided(geometry::ball(0.05), at_voxel_level("gs-targets"));
  std::array<int, 8> octants{};
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Vector3d seed = targets_of(guided, attempt).contacts.front().point_O;
    ++octants[(seed.x() > 0) + 2 * (seed.y() > 0) + 4 * (seed.z() > 0)];
  }
  std::array<double, 8> expected{};
  expected.fill(kAttempts / 8.0);
  // The 1000 samples themselves are drawn, too, so that the variance of counts is 1 + 400 / 1000
  // times that of a direct draw.
  CHECK(chi_square(octants, expected) < 1.4 * kChiSquare7);
}

TEST_CASE("Where no set suits the fingers the attempt says so", "[grasp][sample_targets]") {
  // No two of a thousand samples look at each other that squarely.
  grasp::PlannerOptions options = at_voxel_level("gs-targets");
  options.targets.theta_max = 1e-6;
  options.targets.max_seeds = 3;
  const Guided guided(geometry::ball(0.05), options);
  const grasp::GuidedStarts starts = guided.guidance->starts(0);
  CHECK(starts.starts.empty());
  CHECK(starts.failure == "no set");
  CHECK(starts.seeds_tried == 3);
  CHECK_FALSE(starts.is_exhausted);
}

TEST_CASE("What guides random targets is the sampled surface", "[grasp][sample_targets]") {
  const Guided guided(geometry::ball(0.05), at_voxel_level("gs-targets"));
  const Guided of_normals(geometry::ball(0.05), at_voxel_level("gs"));
  CHECK(guided.guidance->model().rows == of_normals.guidance->model().rows);
  CHECK(guided.guidance->counts().at("samples") == 1000);
}

}  // namespace test_sample_targets
