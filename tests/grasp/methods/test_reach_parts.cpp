// What targets by reach are made of: nearest patches, pairs of pads, postures, weakest loads.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "fitting/surface_posture.hpp"
#include "grasp/fitting_scene.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "methods/hand_grips.hpp"
#include "methods/weakest_load.hpp"
#include "object/nearest_patches.hpp"
#include "support/catch.hpp"

namespace test_reach_parts {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;

contact::Contact contact_at(const Vector3d& point, const Vector3d& inward) {
  contact::Contact contact;
  contact.point_O = point;
  contact.inward_normal_O = inward.normalized();
  return contact;
}

}  // namespace

TEST_CASE("The patch of a voxel is nearly the nearest one, and its own where it has one",
          "[grasp][nearest_patches]") {
  const testing::Scene scene(geometry::capsule(0.03, 0.06));
  const ObjectModel& object = scene.object;
  std::vector<bool> is_meant(object.patches.size(), true);
  for (std::size_t i = 0; i < is_meant.size(); ++i) is_meant[i] = i % 3 != 0;
  const internal::NearestPatches nearest(object, is_meant);
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  base::Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    Eigen::Vector3i voxel;
    for (int axis = 0; axis < 3; ++axis) {
      voxel[axis] =
          static_cast<int>(random.index(static_cast<std::uint64_t>(lattice.counts[axis])));
    }
    const Vector3d center =
        lattice.origin + lattice.voxel_size * (voxel.cast<double>().array() + 0.5).matrix();
    const std::int32_t found = nearest.at(center);
    REQUIRE(found >= 0);
    CHECK(is_meant[static_cast<std::size_t>(found)]);
    const std::int32_t own = object.patch_of_voxel[static_cast<std::size_t>(lattice.index(voxel))];
    if (own >= 0 && is_meant[static_cast<std::size_t>(own)]) {
      CHECK(found == own);
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < object.patches.size(); ++i) {
      if (is_meant[i]) least = std::min(least, (object.patches[i].centroid - center).norm());
    }
    CHECK((object.patches[found].centroid - center).norm() <= least + lattice.voxel_size);
  }
}

TEST_CASE("A pair of pads from the table is as far apart and leans as it was asked for",
          "[grasp][hand_grips]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const RequestedParts parts{{hand.thumb(), hand.thumb() == 0 ? 1 : 0}};
  const internal::HandGrips grips(hand, parts, internal::GripChoice::Requested);
  REQUIRE(grips.grips().size() == 1);
  REQUIRE(grips.pinches().size() == 1);
  const internal::HandGrips::Pinch& pinch = grips.pinches().front();
  const hands::PadSamples& a = grips.parts()[pinch.part_a].samples;
  const hands::PadSamples& b = grips.parts()[pinch.part_b].samples;
  constexpr double kClass = 9.0 * 3.14159265358979 / 180.0;
  base::Random random(3);
  int num_found = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double distance = random.uniform(0.0, 0.2);
    const double lean_a = random.uniform(0.0, 1.2);
    const double lean_b = random.uniform(0.0, 1.2);
    const auto pair = pinch.table.draw(distance, lean_a, lean_b, random);
    if (!pair) continue;
    ++num_found;
    const Vector3d line = b.points_H.col(pair->second) - a.points_H.col(pair->first);
    CHECK(std::abs(line.norm() - distance) <= 0.005);
    CHECK(std::abs(internal::angle_between(a.normals_H.col(pair->first), line) - lean_a) <= kClass);
    CHECK(std::abs(internal::angle_between(b.normals_H.col(pair->second), -line) - lean_b) <=
          kClass);
  }
  CHECK(num_found > 100);
  CHECK_FALSE(pinch.table.draw(5.0, 0.0, 0.0, random));
  CHECK_FALSE(pinch.table.draw(0.05, 3.0, 0.0, random));
}

TEST_CASE("Grips: the requested parts alone, one part more, or any fingers",
          "[grasp][hand_grips]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const RequestedParts parts{{0, 1, 2}};
  using internal::GripChoice;
  using internal::HandGrips;
  const auto grips = [&](GripChoice choice) { return HandGrips(hand, parts, choice).grips(); };
  REQUIRE(grips(GripChoice::Requested).size() == 1);
  CHECK(grips(GripChoice::Requested).front().parts == std::vector<std::size_t>{0, 1, 2});
  // The fingers, with the palm, and with each of the two further fingers.
  REQUIRE(grips(GripChoice::OneMore).size() == 4);
  CHECK(grips(GripChoice::OneMore)[1].has_palm);
  // Two of four fingers beside the thumb, the same with the palm, three of four.
  const auto all = grips(GripChoice::AnyFingers);
  REQUIRE(all.size() == 6 + 6 + 4);
  std::set<std::vector<std::size_t>> different;
  for (const HandGrips::Grip& grip : all) {
    CHECK(grip.parts.front() == 0);
    different.insert(grip.parts);
  }
  CHECK(different.size() == all.size());
}

TEST_CASE("Pads are laid onto the surface, and links leave it", "[grasp][surface_posture]") {
  const testing::Scene scene(geometry::capsule(0.04, 0.08));
  const std::vector<bool> all(scene.object.patches.size(), true);
  const internal::NearestPatches nearest(scene.object, all);
  const internal::SurfaceSearch search(scene.fitting_hand, scene.object, nearest, nearest);
  const std::vector<int> pads = requested_pads(scene.hand, scene.parts);
  base::Random random(1);
  int num_laid = 0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    // Above the object, fingers half closed around it, turned and shifted a little.
    hands::HandConfiguration start = hands::open_configuration(scene.hand);
    for (std::size_t j = 0; j < scene.hand.joints.size(); ++j) {
      const hands::Joint& joint = scene.hand.joints[j];
      if (joint.closing_sign == 0 || joint.coupling) continue;
      start.q[static_cast<Eigen::Index>(j)] =
          joint.open_limit() + 0.4 * (joint.closed_limit() - joint.open_limit());
    }
    hands::apply_couplings(scene.hand, start.q);
    start.X_OH.linear() =
        (Eigen::AngleAxisd(random.uniform(-3.0, 3.0), Vector3d::UnitZ()) *
         Eigen::Quaterniond::FromTwoVectors(scene.hand.palm.direction_H, -Vector3d::UnitX()))
            .toRotationMatrix();
    start.X_OH.translation() =
        Vector3d(0.13, 0.0, 0.0) +
        0.01 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const internal::SurfacePosture posture = search.lay(pads, start);
    REQUIRE(posture.patches.size() == pads.size());
    if (posture.largest_gap > 0.5 * scene.voxel_size() || posture.largest_depth > 0.002) continue;
    ++num_laid;
    // By the true meshes: every pad is near the surface.
    for (const int pad : pads) {
      const auto distance =
          geometry::nearest_points(scene.object.query, scene.fitting_hand.pad_surface(pad),
                                   posture.X_OL[scene.hand.pads[pad].link], 1.0, {});
      REQUIRE(distance);
      CHECK(distance->distance <= 1.5 * scene.voxel_size());
    }
  }
  CHECK(num_laid >= kTrials / 8);
}

TEST_CASE("The weakest load bounds epsilon of contacts that close", "[grasp][weakest_load]") {
  const geometry::TriangleMesh mesh = geometry::ball(0.05, 3);
  const Vector3d center = geometry::mass_properties(mesh).center_of_mass;
  const contact::WrenchObject object = contact::wrench_object(mesh, center);
  const internal::WeakestLoad weakest;
  base::Random random(2);
  int num_closed = 0;
  double largest_slack = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<contact::Contact> contacts;
    for (int i = 0; i < 3 + trial % 3; ++i) {
      Vector3d u;
      do {
        u = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      } while (u.norm() > 1.0 || u.norm() < 0.1);
      u.normalize();
      contacts.push_back(contact_at(0.05 * u, -u));
    }
    constexpr double kFriction = 0.5;
    contact::WrenchSpaceOptions options;
    options.friction = kFriction;
    options.torque_scale = object.largest_radius;
    const double bound = weakest.withstood(
        contact::contact_wrenches(contacts, {.reference_point_O = center, .options = options}));
    const double epsilon = contact::signed_epsilon(contacts, object, kFriction);
    if (epsilon > 0.0) {
      ++num_closed;
      CHECK(bound >= epsilon * (1.0 - 1e-9));
      largest_slack = std::max(largest_slack, bound - epsilon);
    }
    if (bound < -1e-9) CHECK(epsilon <= 0.0);
  }
  CHECK(num_closed > 20);
  CHECK(largest_slack < 0.3);
}

}  // namespace test_reach_parts
