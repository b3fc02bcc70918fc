#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "grasp/target_scenes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/ranked_targets.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_palm_targets {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using grasp::TargetFailure;

/// Returns two fingers whose tips are anywhere, and a palm pad of radius 0.2.
PartDistances reach_with_palm(double smallest, double largest) {
  PartDistances distances = equal_reach(2, 0.1, 3.0);
  distances.palm_to_tip.assign(2, {smallest, largest});
  distances.palm = grasp::PalmReach{Vector3d::Zero(), Vector3d::UnitZ(), 0.2, {}};
  return distances;
}

/// Returns two opposite places on the unit circle, and one for the palm, with its normal, that is
/// too steep for a pair with either.
std::vector<Place> pair_and(const Vector3d& point, const Vector3d& normal) {
  std::vector<Place> places = on_unit_circle({0, 180});
  places.push_back({point, normal});
  return places;
}

bool has_palm_target(const std::vector<Place>& places, const PartDistances& distances) {
  const RequestedParts parts{{0, 1}, true};
  const grasp::ObjectModel object = object_of(places);
  for (int seed = 1; seed <= 10; ++seed) {
    const TargetSelection selection = select(object, distances, parts, {}, seed);
    if (!selection.targets) {
      CHECK(selection.failure == TargetFailure::NoPalm);
      continue;
    }
    CHECK(broken_requirements(object, distances, parts, {}, *selection.targets).empty());
    CHECK(selection.targets->contacts.back().patch == 2);
    CHECK(selection.targets->contacts.back().is_palm);
    CHECK(!selection.targets->contacts.front().is_palm);
    CHECK(!selection.targets->contacts.front().finger);
    // The fingers have their own center, without the palm's target.
    CHECK(selection.targets->centroid().norm() < 1e-15);
    return true;
  }
  return false;
}

TEST_CASE("The palm's target lies behind the fingers', seen along the palm, and within their reach",
          "[grasp][target_contacts][palm_targets]") {
  const Vector3d up = Vector3d::UnitZ();
  // The palm is at height 0.5 over the line between the fingers' targets, sqrt(1.25) = 1.118 from
  // both.
  const std::vector<Place> above = pair_and(0.5 * up, up);
  CHECK(has_palm_target(above, reach_with_palm(0.1, 1.119)));
  CHECK_FALSE(has_palm_target(above, reach_with_palm(0.1, 1.117)));
  CHECK_FALSE(has_palm_target(above, reach_with_palm(1.119, 3.0)));
  // The palm looks away from the fingers' targets, or is level with them.
  CHECK_FALSE(has_palm_target(pair_and(0.5 * up, -up), reach_with_palm(0.1, 3.0)));
  CHECK_FALSE(has_palm_target(pair_and(Vector3d::Zero(), up), reach_with_palm(0.1, 3.0)));
}

TEST_CASE("Nothing stands in the way of the palm's pad", "[grasp][target_contacts][palm_targets]") {
  const Vector3d up = Vector3d::UnitZ();
  const PartDistances distances = reach_with_palm(0.1, 3.0);
  // These objects are a box of 4 m at 30 voxels.
  const double voxel = 4.0 / 30.0;
  const auto with_obstacle = [&](double beside, double height) {
    std::vector<Place> places = pair_and(0.5 * up, up);
    places.push_back({Vector3d(0.0, beside, 0.5 + height), Vector3d::UnitY(), 0.1});
    return has_palm_target(places, distances);
  };
  CHECK_FALSE(with_obstacle(0.2 - 1e-9, voxel + 1e-9));
  CHECK_FALSE(with_obstacle(0.0, 1.0));
  CHECK(with_obstacle(0.2 + 1e-9, 1.0));
  CHECK(with_obstacle(0.1, voxel - 1e-9));
}

TEST_CASE("Tips' reach decides with the hand turned about the palm's direction",
          "[grasp][target_contacts][palm_targets]") {
  // The tip of the first finger is at `ahead` of the palm and to +x of it, that of the second to
  // −x. Whatever the azimuth of the pair of targets, the hand can be turned to it; two targets on
  // one side cannot be reached, nor such as are farther ahead.
  PartDistances distances = reach_with_palm(0.1, 3.0);
  const double ahead = 0.5;
  const Vector3d x = Vector3d::UnitX();
  const Vector3d tip = x + ahead * Vector3d::UnitZ();
  const Vector3d opposite = -x + ahead * Vector3d::UnitZ();
  distances.palm->tips = {hands::TipReach({{tip, -x}}, 0.02),
                          hands::TipReach({{opposite, x}}, 0.02)};
  const RequestedParts parts{{0, 1}, true};
  TargetOptions options;
  // The tolerance is half a turn of 5 degrees at 1 m, and a cell's diagonal.
  options.palm_reach_tolerance = 0.044 + 0.035;
  const auto is_found = [&](double azimuth_deg, double height, double offset) {
    std::vector<Place> places = on_unit_circle({azimuth_deg, azimuth_deg + 180.0});
    places.push_back({Vector3d(0, 0, height) + offset * places[0].point, Vector3d::UnitZ()});
    return select(object_of(places), distances, parts, options, 1).targets.has_value();
  };
  for (const double azimuth_deg : {0.0, 33.0, 121.7, 250.0}) {
    INFO(azimuth_deg);
    CHECK(is_found(azimuth_deg, ahead, 0.0));
    CHECK_FALSE(is_found(azimuth_deg, ahead + 0.12, 0.0));
    CHECK_FALSE(is_found(azimuth_deg, ahead, 0.12));
  }
  // Pads that look outward there cannot touch.
  distances.palm->tips = {hands::TipReach({{tip, x}}, 0.02),
                          hands::TipReach({{opposite, -x}}, 0.02)};
  CHECK_FALSE(is_found(0.0, ahead, 0.0));
}

TEST_CASE("Every requirement holds for power grasps of shipped hands, and sets come out",
          "[grasp][target_contacts][palm_targets]") {
  struct HandCase {
    std::string hand;
    std::vector<std::string> fingers;
    double min_separation;
  };
  const std::vector<HandCase> hand_cases = {{"barrett", {"thumb", "finger_1", "finger_2"}, 0.023},
                                            {"human_hand", {"thumb", "index", "middle"}, 0.016}};
  // The human hand does not reach around the ball.
  const NamedMesh ball{"ball of 15 cm", geometry::ball(0.075, 3)};
  const NamedMesh can{"can", geometry::cylinder(0.035, 0.15)};
  for (const HandCase& c : hand_cases) {
    const hands::HandModel hand = hands::find_hand(c.hand);
    const PartDistances distances = grasp::part_distances(hand);
    RequestedParts parts;
    parts.palm = true;
    for (const std::string& name : c.fingers) parts.fingers.push_back(hand.finger_index(name));
    TargetOptions options;
    options.min_separation = c.min_separation;
    for (const NamedMesh& named :
         c.hand == "barrett" ? std::vector<NamedMesh>{ball, can} : std::vector<NamedMesh>{can}) {
      INFO(c.hand << ", " << named.name);
      const grasp::ObjectModel object = object_of(named.mesh);
      CHECK(check_selections(object, distances, parts, options, 3) == 3);
    }
  }
}

TEST_CASE("Parts that a hand does not have are refused in one line",
          "[grasp][target_contacts][palm_targets]") {
  const grasp::ObjectModel object = object_of(on_unit_circle({0, 180}));
  PartDistances distances = equal_reach(7, 0.1, 3.0);
  distances.tip_to_tip[6].assign(7, {});
  for (auto& row : distances.tip_to_tip) row[6] = {};
  const auto message_of = [&](const RequestedParts& parts, const TargetOptions& options) {
    std::string random_message, ranked_message;
    try {
      select(object, distances, parts, options, 1);
    } catch (const base::InvalidInput& error) {
      random_message = error.what();
    }
    try {
      grasp::RankedTargets(object, distances, parts, options);
    } catch (const base::InvalidInput& error) {
      ranked_message = error.what();
    }
    CHECK(random_message == ranked_message);
    return random_message;
  };
  grasp::TargetOptions all_pairs;
  all_pairs.pair_rule = grasp::PairRule::AllPairs;
  CHECK(message_of({{0, 1}}, {}).empty());
  CHECK(message_of({{}}, {}).find("0 fingers") != std::string::npos);
  CHECK(message_of({{0}}, {}).find("1 fingers") != std::string::npos);
  CHECK(message_of({{0}, true}, {}).find("1 fingers") != std::string::npos);
  CHECK(message_of({{0, 7}}, {}).find("finger 7 of a hand with 7") != std::string::npos);
  CHECK(message_of({{0, -1}}, {}).find("finger -1") != std::string::npos);
  CHECK(message_of({{0, 1, 0}}, {}).find("finger 0 named twice") != std::string::npos);
  CHECK(message_of({{0, 6}}, {}).find("fingertip pad") != std::string::npos);
  CHECK(message_of({{0, 1}, true}, {}).find("palm pad") != std::string::npos);
  CHECK(message_of({{0, 1, 2, 3, 4, 5, 6}}, {}).find("at most 6") != std::string::npos);
  CHECK(message_of({{0, 1, 2, 3, 4}}, all_pairs).find("pairwise stable") != std::string::npos);
}

}  // namespace

}  // namespace test_palm_targets
