// Walls so thin that both of their sides are in one voxel: their places, and grasps of them.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "grasp/reach_options.hpp"
#include "grasp/sample_pose.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/kinematic_chain.hpp"
#include "graspfit/hands/pad_samples.hpp"
#include "methods/finger_bones.hpp"
#include "object/nearest_places.hpp"
#include "object/surface_places.hpp"
#include "support/catch.hpp"
#include "targets/target_places.hpp"

namespace test_thin_walls {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using internal::SurfacePlace;

constexpr double kThickness = 0.001;

/// A plate across z of which voxels are about three times as thick.
ObjectModel plate() {
  return build_object_model(geometry::box(Vector3d(0.1, 0.08, kThickness)), {.resolution = 30});
}

bool is_at_rim(const Vector3d& point) {
  return std::abs(point.x()) > 0.045 || std::abs(point.y()) > 0.035;
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Vector3d& shift) {
  for (Vector3d& vertex : mesh.vertices) vertex += shift;
  return mesh;
}

geometry::TriangleMesh joined(geometry::TriangleMesh a, const geometry::TriangleMesh& b) {
  const auto first = static_cast<std::int32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto face : b.faces) {
    for (std::int32_t& vertex : face) vertex += first;
    a.faces.push_back(face);
  }
  return a;
}

std::size_t num_sides(const std::vector<SurfacePlace>& places) {
  return static_cast<std::size_t>(
      std::count_if(places.begin(), places.end(),
                    [](const SurfacePlace& place) { return place.other_side >= 0; }));
}

}  // namespace

TEST_CASE("Both sides of a plate thinner than a voxel are places", "[grasp][surface_places]") {
  const ObjectModel object = plate();
  const std::vector<SurfacePlace> places = internal::surface_places(object, true);
  const std::size_t num_patches = object.patches.size();
  REQUIRE(places.size() > num_patches);
  CHECK(num_sides(places) == 2 * (places.size() - num_patches));
  int num_inner = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SurfacePlace& place = places[i];
    if (i < num_patches) CHECK(place.patch == static_cast<std::int32_t>(i));
    if (is_at_rim(object.patches[place.patch].area_centroid)) continue;
    ++num_inner;
    CHECK_FALSE(object.patches[place.patch].has_normal);
    REQUIRE(place.other_side >= 0);
    const SurfacePlace& other = places[place.other_side];
    CHECK(other.other_side == static_cast<std::int32_t>(i));
    CHECK(other.patch == place.patch);
    CHECK(place.has_normal);
    CHECK((place.outward_normal_O + other.outward_normal_O).norm() < 1e-12);
    const double side = place.outward_normal_O.z();
    CHECK(std::abs(side) == Approx(1.0));
    const Vector3d middle = object.patches[place.patch].area_centroid;
    CHECK((place.point_O - middle - Vector3d(0, 0, side * 0.5 * kThickness)).norm() < 1e-9);
  }
  CHECK(num_inner > 1000);
}

TEST_CASE("Where no wall is thin, places are the patches", "[grasp][surface_places]") {
  for (const geometry::TriangleMesh& mesh :
       {geometry::ball(0.03), geometry::box(Vector3d(0.05, 0.06, 0.07)),
        geometry::torus(0.05, 0.012)}) {
    const ObjectModel object = build_object_model(mesh, {.resolution = 30});
    const std::vector<SurfacePlace> places = internal::surface_places(object, true);
    REQUIRE(places.size() == object.patches.size());
    CHECK(num_sides(places) == 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
      CHECK(places[i].point_O == object.patches[i].centroid);
      CHECK(places[i].outward_normal_O == object.patches[i].outward_normal);
      CHECK(places[i].has_normal == object.patches[i].has_normal);
    }
  }
  CHECK(internal::surface_places(plate(), false).size() == plate().patches.size());
}

TEST_CASE("A thin rim on a block is no wall", "[grasp][surface_places]") {
  // A fin as thin as the plate, one and a half voxels high, along the middle of a block's top.
  const geometry::TriangleMesh block = geometry::box(Vector3d(0.09, 0.09, 0.03));
  const geometry::TriangleMesh fin = geometry::box(Vector3d(0.08, kThickness, 0.0055));
  const ObjectModel object = build_object_model(
      joined(block, moved(fin, Vector3d(0.0, 0.0015, 0.015 + 0.00225))), {.resolution = 30});
  const auto num_of_fin =
      std::count_if(object.patches.begin(), object.patches.end(), [](const auto& patch) {
        return patch.area_centroid.z() > 0.0155 && patch.area_weighted_normal.norm() < 0.7;
      });
  CHECK(num_of_fin > 20);
  CHECK(num_sides(internal::surface_places(object, true)) == 0);
}

TEST_CASE("The sides of a gap are no sides of a wall", "[grasp][surface_places]") {
  // Two blocks with a slit between them, both of whose sides are in one layer of voxels.
  const geometry::TriangleMesh block = geometry::box(Vector3d(0.05, 0.05, 0.030));
  const Vector3d shift(0.0, 0.0, 0.015 + 0.5 * kThickness);
  const ObjectModel object =
      build_object_model(joined(moved(block, shift), moved(block, -shift)), {.resolution = 31});
  const auto num_slit =
      std::count_if(object.patches.begin(), object.patches.end(), [](const auto& patch) {
        return std::abs(patch.area_centroid.z()) < 1e-9 && !patch.has_normal;
      });
  CHECK(num_slit > 100);
  CHECK(num_sides(internal::surface_places(object, true)) == 0);
}

TEST_CASE("Of a thin wall the nearest place for a pad is the side on which it is",
          "[grasp][nearest_places]") {
  const ObjectModel object = plate();
  const std::vector<SurfacePlace> places = internal::surface_places(object, true);
  const internal::NearestPlaces nearest(object, places, std::vector<bool>(places.size(), true));
  std::vector<bool> is_lower(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    is_lower[i] = places[i].outward_normal_O.z() < -0.5;
  }
  const internal::NearestPlaces lower(object, places, is_lower);
  for (const double x : {-0.02, 0.0, 0.0123}) {
    for (const double z : {-0.004, -0.0008, 0.0, 0.0002, 0.0008, 0.004}) {
      for (const double inward : {-1.0, 1.0}) {
        CAPTURE(x, z, inward);
        const Vector3d point(x, 0.011, z);
        // A pad that presses down is meant for the upper side, unless it is surely below the plate,
        // where it faces away from it.
        const double side = std::abs(z) > 0.001 ? z : -inward;
        const auto place = static_cast<std::size_t>(nearest.at(point, inward * Vector3d::UnitZ()));
        CHECK(places[place].outward_normal_O.z() * side > 0.0);
        // Where only one side is meant, it is the one.
        const std::int32_t only = lower.at(point, inward * Vector3d::UnitZ());
        CHECK(is_lower[static_cast<std::size_t>(only)]);
        CHECK(lower.other_side(only) < 0);
      }
    }
  }
}

TEST_CASE("Sides of thin walls may be targets whatever the voxel's mean normal scores",
          "[grasp][target_places]") {
  ObjectModel object = plate();
  const std::vector<SurfacePlace> places = internal::surface_places(object, true);
  TargetOptions options;
  for (const internal::PoolPoint& point : internal::pool_of(object, options)) {
    CHECK(is_at_rim(object.patches[*point.patch].area_centroid));
  }
  const std::vector<internal::PoolPoint> pool = internal::pool_of(object, places, options);
  REQUIRE(pool.size() >= num_sides(places));
  for (const internal::PoolPoint& point : pool) {
    const SurfacePlace& place = places[static_cast<std::size_t>(point.place)];
    CHECK(point.point_O == place.point_O);
    CHECK(point.inward_normal_O == -place.outward_normal_O);
    CHECK(point.patch == place.patch);
  }
  // Unless they are fragile.
  object.is_weak_patch.assign(object.patches.size(), true);
  CHECK(internal::pool_of(object, places, options).empty());
  options.exclude_weak = false;
  CHECK(internal::pool_of(object, places, options).size() == pool.size());
}

TEST_CASE("Lines in fingers tell where these go through a wall", "[grasp][finger_bones]") {
  // Lines that end 3 mm under pads against a box, by the interval of each line that is in its
  // slabs.
  const Vector3d half(0.05, 0.04, 0.01);
  const geometry::MeshQuery box(geometry::box(2.0 * half));
  const auto crosses = [&](const Vector3d& from, const Vector3d& to) {
    double enter = -1.0;
    double leave = 2.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double way = to[axis] - from[axis];
      const double a = (-half[axis] - from[axis]) / way;
      const double b = (half[axis] - from[axis]) / way;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    const auto is_between = [](double share) { return share >= 0.0 && share <= 1.0; };
    return enter <= leave && (is_between(enter) || is_between(leave));
  };
  base::Random random(8);
  int num_free = 0;
  int num_trials = 0;
  for (const char* const name : {"parallel_gripper", "barrett", "human_hand"}) {
    const hands::HandModel hand = hands::find_hand(name);
    const int pad = *hand.fingers[1].tip_pad;
    const std::vector<hands::PadSamples> samples = hands::pad_samples(hand, {pad}, 64);
    const internal::FingerBones bones(hand, box, {&samples[0]});
    for (int trial = 0; trial < 300; ++trial) {
      const auto sample = static_cast<std::int32_t>(random.index(samples[0].size()));
      hands::HandConfiguration configuration =
          testing::turned_sample(hand, samples[0], sample, random);
      for (double& x : configuration.X_OH.translation()) x = random.uniform(-0.06, 0.06);
      const auto X_OL = hands::forward_kinematics(hand, configuration);
      bool is_free = true;
      std::vector<Vector3d> line;
      for (const int link : hands::links_to(hand, hand.pads[pad].link)) {
        if (!hands::joints_to(hand, link).empty()) line.emplace_back(X_OL[link].translation());
      }
      line.emplace_back(hands::pad_contact_point(hand, pad, X_OL) -
                        0.003 * hands::pad_pose(hand, pad, X_OL).linear().col(2));
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        is_free = is_free && !crosses(line[i], line[i + 1]);
      }
      CAPTURE(name, trial);
      CHECK(bones.is_free(0, sample, configuration.X_OH) == is_free);
      CHECK(bones.are_free({pad}, X_OL) == is_free);
      num_free += is_free ? 1 : 0;
      ++num_trials;
    }
  }
  CHECK(num_free > num_trials / 3);
  CHECK(num_free < num_trials * 9 / 10);
}

TEST_CASE("A hand holds an upturned bowl from outside", "[grasp][reach_targets]") {
  // Half a hollow ball, its wall of 1.2 mm in voxels of about 5 mm.
  constexpr double kRadius = 0.075;
  constexpr double kWall = 0.0012;
  constexpr int kSteps = 24;
  std::vector<Eigen::Vector2d> profile;
  const auto add_arc = [&](double radius, int from, int to) {
    for (int i = from; i != to + (to > from ? 1 : -1); i += to > from ? 1 : -1) {
      const double angle = 0.5 * std::numbers::pi * i / kSteps;
      profile.emplace_back(i == kSteps ? 0.0 : radius * std::cos(angle), radius * std::sin(angle));
    }
  };
  add_arc(kRadius - kWall, kSteps, 0);
  add_arc(kRadius, 0, kSteps);
  const geometry::TriangleMesh bowl = geometry::solid_of_revolution(profile);
  const hands::HandModel hand = hands::find_hand("human_hand");
  PlannerOptions options = testing::reach_options(GraspStyle::Auto, 6);
  options.num_contacts = 4;
  options.kept = KeptCandidate::Firmest;
  options.max_redraws = 5;
  options.contact_faces = contact::ContactFaces::Facing;
  const ObjectModel object = prepare_object(bowl, hand, options);
  Surroundings table;
  table.table_z_O = 0.0;
  const PlannerResult result = plan_grasps(object, hand, options, table, {.num_threads = 1});
  CHECK(result.statistics.outcomes.at(AttemptOutcome::Valid) == 6);
  for (const Grasp& grasp : result.grasps) {
    CHECK(grasp.is_valid());
    for (const contact::Contact& contact : grasp.contacts) {
      if (contact.is_target) CHECK(contact.inward_normal_O.dot(contact.point_O) < 0.0);
    }
  }
}

TEST_CASE("A gripper takes an open box by a wall thinner than a voxel", "[grasp][reach_targets]") {
  // Wider than the gripper spans, 85 mm; walls of 1.2 mm, voxels of about 5 mm.
  const double wall = 0.0012;
  const geometry::TriangleMesh box = geometry::bin(
      {.inner_length = 0.15, .inner_width = 0.13, .inner_height = 0.06, .wall_thickness = wall});
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  PlannerOptions options = testing::reach_options(GraspStyle::Auto, 10);
  options.num_contacts = 2;
  options.kept = KeptCandidate::Firmest;
  options.max_redraws = 5;
  const ObjectModel object = prepare_object(box, hand, options);
  Surroundings table;
  table.table_z_O = -wall;
  const auto planned = [&](contact::ContactFaces faces) {
    options.contact_faces = faces;
    return plan_grasps(object, hand, options, table, {.num_threads = 1});
  };
  const PlannerResult result = planned(contact::ContactFaces::Facing);
  CHECK(result.statistics.outcomes.at(AttemptOutcome::Valid) >= 5);
  for (const Grasp& grasp : result.grasps) {
    CHECK(grasp.is_valid());
    std::vector<contact::Contact> pads;
    std::copy_if(grasp.contacts.begin(), grasp.contacts.end(), std::back_inserter(pads),
                 [](const contact::Contact& contact) { return contact.is_target; });
    REQUIRE(pads.size() == 2);
    // On both sides of one wall.
    CHECK(pads[0].inward_normal_O.dot(pads[1].inward_normal_O) < -0.97);
    CHECK(std::abs((pads[0].point_O - pads[1].point_O).dot(pads[0].inward_normal_O)) ==
          Approx(wall).margin(1e-4));
  }
  // With the far side in the mean of both pads' contacts there is no normal.
  CHECK(planned(contact::ContactFaces::All).grasps.empty());
}

}  // namespace test_thin_walls
