#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "grasp/fitting_scene.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/epsilon_bound.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "methods/firmness.hpp"
#include "methods/place_firmness.hpp"
#include "support/catch.hpp"

namespace test_place_firmness {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<internal::SurfacePlace> places_of(const ObjectModel& object) {
  return internal::surface_places(object, false);
}

/// Every patch that has a normal.
std::vector<internal::PoolPoint> all_patches(const ObjectModel& object) {
  return internal::pool_of(object, TargetOptions{.score_threshold = -1.0, .exclude_weak = false});
}

/// The pool's patch that is nearest to a point and faces about so.
std::int32_t patch_at(const std::vector<internal::PoolPoint>& pool, const Vector3d& point,
                      const Vector3d& outward) {
  std::int32_t best = -1;
  double least = kInfinity;
  for (const internal::PoolPoint& candidate : pool) {
    const double distance = (candidate.point_O - point).norm();
    if (-candidate.inward_normal_O.dot(outward) < 0.99 || distance >= least) continue;
    least = distance;
    best = *candidate.patch;
  }
  return best;
}

}  // namespace

TEST_CASE("Contacts beside two opposite places lean by no more than their shifts",
          "[grasp][place_firmness]") {
  constexpr double kWidth = 0.06;
  constexpr double kFriction = 0.3;
  const testing::Scene scene(geometry::box(Vector3d(kWidth, 0.09, 0.12)));
  const std::vector<internal::PoolPoint> pool = all_patches(scene.object);
  const std::vector<internal::SurfacePlace> all = places_of(scene.object);
  const internal::PlaceFirmness firmness(scene.object, all, pool, kFriction);
  const Vector3d side(0.5 * kWidth, 0.0, 0.0);
  const std::vector<std::int32_t> patches = {patch_at(pool, side, Vector3d::UnitX()),
                                             patch_at(pool, -side, -Vector3d::UnitX())};
  const double nominal = firmness.nominal(patches, -kInfinity);
  CHECK(nominal == Approx(kFriction).margin(scene.voxel_size() / kWidth));
  // Patches about a place are at most 1.6 voxels from it: the line leans by twice that at most.
  const double expected = firmness.expected(patches, -kInfinity);
  CHECK(expected < nominal);
  CHECK(expected >= nominal - 3.2 * scene.voxel_size() / kWidth);
  CHECK(firmness.expected(patches, -kInfinity) == expected);
  CHECK(firmness.expected(patches, nominal) == nominal);
}

TEST_CASE("Places where the surface turns count for less than flat ones",
          "[grasp][place_firmness]") {
  // Three faces of a hexagonal prism: in their middles, and nearer to the edges, where patches
  // about them face 60 degrees elsewhere.
  const double inner = 0.03 * std::cos(std::acos(-1.0) / 6.0);
  const testing::Scene scene(geometry::cylinder(0.03, 0.10, 6));
  const std::vector<internal::PoolPoint> pool = all_patches(scene.object);
  const std::vector<internal::SurfacePlace> all = places_of(scene.object);
  const internal::PlaceFirmness firmness(scene.object, all, pool, 0.9);
  const auto places = [&](double beside) {
    std::vector<std::int32_t> patches;
    for (int k = 0; k < 3; ++k) {
      const double angle = std::acos(-1.0) * (1.0 / 6.0 + 2.0 * k / 3.0);
      const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
      const Vector3d along(-out.y(), out.x(), 0.0);
      patches.push_back(patch_at(pool, inner * out + (k == 0 ? beside : 0.0) * along, out));
    }
    return patches;
  };
  const auto share_left = [&](const std::vector<std::int32_t>& patches) {
    REQUIRE(std::all_of(patches.begin(), patches.end(), [](std::int32_t p) { return p >= 0; }));
    const double nominal = firmness.nominal(patches, -kInfinity);
    REQUIRE(nominal > 0.0);
    return firmness.expected(patches, -kInfinity) / nominal;
  };
  const double in_middles = share_left(places(0.0));
  CHECK(in_middles > 0.6);
  CHECK(share_left(places(0.013)) < in_middles);
}

TEST_CASE("The firmness of places is that of point contacts there", "[grasp][place_firmness]") {
  const testing::Scene scene(geometry::capsule(0.03, 0.06));
  const std::vector<internal::PoolPoint> pool = all_patches(scene.object);
  const std::vector<internal::SurfacePlace> all = places_of(scene.object);
  const internal::PlaceFirmness firmness(scene.object, all, pool, 0.4);
  const contact::WrenchObject object =
      contact::wrench_object(scene.object.mesh(), scene.object.mass.center_of_mass);
  base::Random random(2);
  int num_closed = 0;
  int num_by_force = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<std::int32_t> patches;
    std::vector<contact::Contact> contacts;
    for (int i = 0; i < 4; ++i) {
      const internal::PoolPoint& point = pool[random.index(pool.size())];
      patches.push_back(*point.patch);
      contact::Contact& contact = contacts.emplace_back();
      contact.point_O = point.point_O;
      contact.inward_normal_O = point.inward_normal_O;
    }
    const double nominal = firmness.nominal(patches, -kInfinity);
    const double epsilon = contact::signed_epsilon(contacts, object, 0.4);
    // As firm as point contacts: by epsilon, or by 0.3 of the least force.
    const double force = contact::least_force(contact::contact_wrenches(
        contacts,
        contact::wrench_convention(contact::WrenchTool::Graspfit, object, contacts, 0.4)));
    const double firm = std::min(epsilon, 0.3 * force);
    CHECK(internal::firmness(contacts, object, 0.4) == Approx(nominal).margin(1e-12));
    if (epsilon > 0.0) {
      ++num_closed;
      num_by_force += firm < epsilon ? 1 : 0;
      CHECK(nominal >= firm - 1e-9);
      CHECK(nominal <= 1.5 * firm + 1e-3);
    } else {
      CHECK(nominal <= 1e-9);
    }
    CHECK(firmness.expected(patches, -kInfinity) <= nominal);
  }
  CHECK(num_closed > 5);
  CHECK(num_by_force > 0);
  CHECK(num_by_force < num_closed);
}

TEST_CASE("What is expected ends early only where it is no more than what is asked",
          "[grasp][place_firmness]") {
  const testing::Scene scene(geometry::capsule(0.03, 0.06));
  const std::vector<internal::PoolPoint> pool = all_patches(scene.object);
  const std::vector<internal::SurfacePlace> all = places_of(scene.object);
  const internal::PlaceFirmness firmness(scene.object, all, pool, 0.6);
  base::Random random(7);
  int num_exceeding = 0;
  int num_early = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::int32_t> patches;
    for (int i = 0; i < 4; ++i) patches.push_back(*pool[random.index(pool.size())].patch);
    const double full = firmness.expected(patches, -kInfinity);
    if (full <= 0.0) continue;
    for (const double share : {0.2, 0.5, 1.001, 1.1, 2.0}) {
      const double asked = share * full;
      const double found = firmness.expected(patches, asked);
      // A draw that is firmer than all before it may come too late; where the mean is twice what
      // is asked, it is seldom.
      if (found > asked) {
        CHECK(found == full);
        CHECK(share < 1.0);
        ++num_exceeding;
      } else {
        num_early += share < 1.0 ? 1 : 0;
      }
    }
  }
  CHECK(num_exceeding > 100);
  CHECK(num_early <= num_exceeding / 50);
}

TEST_CASE("Two contacts at one place have the least firmness", "[grasp][place_firmness]") {
  const testing::Scene scene(geometry::ball(0.03));
  const std::vector<internal::PoolPoint> pool = all_patches(scene.object);
  const std::vector<internal::SurfacePlace> all = places_of(scene.object);
  const internal::PlaceFirmness firmness(scene.object, all, pool, 0.6);
  const std::int32_t first = *pool.front().patch;
  const double twice = firmness.nominal({first, first}, -kInfinity);
  for (const internal::PoolPoint& point : pool) {
    if (*point.patch == first) continue;
    CHECK(firmness.nominal({first, *point.patch}, -kInfinity) > twice);
  }
}

}  // namespace test_place_firmness
