// What targets by reach are made of: nearest places, pairs of pads, grips, postures.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "fitting/surface_posture.hpp"
#include "grasp/fitting_scene.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/angle.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "methods/hand_grips.hpp"
#include "methods/hand_proposals.hpp"
#include "methods/table_reach.hpp"
#include "object/nearest_places.hpp"
#include "object/surface_places.hpp"
#include "support/catch.hpp"

namespace test_reach_parts {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;

}  // namespace

TEST_CASE("The place of a voxel is nearly the nearest one, and its own where it has one",
          "[grasp][nearest_places]") {
  const testing::Scene scene(geometry::capsule(0.03, 0.06));
  const ObjectModel& object = scene.object;
  std::vector<bool> is_meant(object.patches.size(), true);
  for (std::size_t i = 0; i < is_meant.size(); ++i) is_meant[i] = i % 3 != 0;
  const std::vector<internal::SurfacePlace> places = internal::surface_places(object, false);
  const internal::NearestPlaces nearest(object, places, is_meant);
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
  const internal::HandGrips grips(hand, parts, internal::GripRule());
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
    CHECK(std::abs(geometry::angle_between(a.normals_H.col(pair->first), line) - lean_a) <= kClass);
    CHECK(std::abs(geometry::angle_between(b.normals_H.col(pair->second), -line) - lean_b) <=
          kClass);
  }
  CHECK(num_found > 100);
  CHECK_FALSE(pinch.table.draw(5.0, 0.0, 0.0, random));
  CHECK_FALSE(pinch.table.draw(0.05, 3.0, 0.0, random));
}

TEST_CASE("Jaws may lean where that is allowed, fingers face what they pinch",
          "[grasp][hand_grips]") {
  const hands::HandModel gripper = hands::find_hand("parallel_gripper");
  const internal::HandGrips jaws(gripper, {{0, 1}, false}, {});
  const internal::PinchTable& table = jaws.pinches().at(0).table;
  base::Random random(1);
  const double step = 9.0 * std::numbers::pi / 180.0;
  CHECK(table.draw(0.03, 0.0, 0.0, random));
  for (const auto& [lean_a, lean_b] :
       {std::pair(1.5, 0.5), {0.5, 1.5}, {1.5, 1.5}, {2.5, 0.5}, {2.5, 2.5}}) {
    CHECK_FALSE(table.draw(0.03, lean_a * step, lean_b * step, random));
    CHECK(table.draw(0.03, lean_a * step, lean_b * step, random, true));
  }
  CHECK_FALSE(table.draw(0.03, 3.5 * step, 0.0, random, true));
  // Two fingers of the Barrett hand find the same with and without.
  const hands::HandModel barrett = hands::find_hand("barrett");
  const internal::HandGrips fingers(barrett, {{0, 1}, false}, {});
  const internal::PinchTable& pinch = fingers.pinches().at(0).table;
  for (int lean = 0; lean < 7; ++lean) {
    const auto found = [&](bool may_lean) {
      base::Random own(1);
      return pinch.draw(0.08, (lean + 0.5) * step, 0.5 * step, own, may_lean);
    };
    CHECK(found(true) == found(false));
  }
}

TEST_CASE("The cheapest hand is found with or without knowing what another costs",
          "[grasp][hand_proposals]") {
  const testing::Scene scene(geometry::capsule(0.03, 0.06));
  const std::vector<internal::SurfacePlace> places = internal::surface_places(scene.object, false);
  const internal::NearestPlaces nearest(scene.object, places,
                                        std::vector<bool>(places.size(), true));
  const internal::TargetPlaces targets(scene.object, scene.parts, TargetOptions(),
                                       internal::pool_of(scene.object, TargetOptions()));
  const internal::HandGrips grips(scene.hand, scene.parts, internal::GripRule());
  const SurroundingsCollision nothing(scene.hand, {});
  const internal::TableReach table(scene.hand, nothing, {});
  const internal::HandProposals proposals(scene.hand, places, targets, grips, nearest, table);
  const internal::HandGrips::Grip& grip = grips.grips().front();
  base::Random random(4);
  int num_drawn = 0;
  for (int trial = 0; trial < 4000 && num_drawn < 60; ++trial) {
    const std::optional<internal::HandProposal> drawn = proposals.draw(grip, random);
    if (!drawn) continue;
    ++num_drawn;
    const std::optional<internal::HandProposal> whole =
        proposals.completed(grip, std::numeric_limits<double>::infinity(), *drawn);
    REQUIRE(whole);
    const std::optional<internal::HandProposal> again =
        proposals.completed(grip, whole->largest_cost + 1e-9, *drawn);
    REQUIRE(again);
    CHECK(again->configuration.q == whole->configuration.q);
    CHECK(again->largest_cost == whole->largest_cost);
    CHECK_FALSE(proposals.completed(grip, whole->largest_cost, *drawn));
  }
  CHECK(num_drawn == 60);
}

TEST_CASE("Grips: the requested parts alone, one part more, or any fingers",
          "[grasp][hand_grips]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  using Parts = std::vector<std::size_t>;
  const auto grips = [&](const RequestedParts& parts, const internal::GripRule& rule) {
    return internal::HandGrips(hand, parts, rule).grips();
  };
  const RequestedParts three{{0, 1, 2}};
  REQUIRE(grips(three, {}).size() == 1);
  CHECK(grips(three, {}).front().parts == Parts{0, 1, 2});
  CHECK_FALSE(grips(three, {}).front().has_palm);
  REQUIRE(grips({{0, 1, 2}, true}, {}).size() == 1);
  CHECK(grips({{0, 1, 2}, true}, {}).front().parts == Parts{0, 1, 2, 3});
  CHECK(grips({{0, 1, 2}, true}, {}).front().has_palm);
  // The fingers, with the palm, and with each of the two further fingers.
  internal::GripRule rule = {.may_add_finger = true, .may_add_palm = true};
  REQUIRE(grips(three, rule).size() == 4);
  CHECK(grips(three, rule)[1].has_palm);
  rule.may_add_palm = false;
  REQUIRE(grips(three, rule).size() == 3);
  // Two of four fingers beside the thumb, the same with the palm, three of four.
  rule = {.may_add_finger = true, .may_add_palm = true, .may_exchange = true};
  const auto all = grips(three, rule);
  REQUIRE(all.size() == 6 + 6 + 4);
  std::set<Parts> different;
  for (const internal::HandGrips::Grip& grip : all) {
    CHECK(grip.parts.front() == 0);
    different.insert(grip.parts);
  }
  CHECK(different.size() == all.size());
  // Two fingers alone cannot close: with the palm, or with one of three further ones.
  rule = {.may_add_finger = true, .may_add_palm = true};
  for (const internal::HandGrips::Grip& grip : grips({{0, 1}}, rule)) CHECK(grip.parts.size() == 3);
  CHECK(grips({{0, 1}}, rule).size() == 1 + 3);
  CHECK(grips({{0, 1}}, {}).front().parts == Parts{0, 1});
  rule.may_exchange = true;
  // At most six parts: all five fingers, and with the palm.
  const auto most = grips({{0, 1, 2, 3, 4}}, rule);
  REQUIRE(most.size() == 2);
  CHECK(most.back().parts.size() == 6);
}

TEST_CASE("Grips with a finger less keep the first and at least three", "[grasp][hand_grips]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const internal::GripRule rule = {.may_drop_finger = true};
  const auto grips = internal::HandGrips(hand, {{0, 1, 2, 3}}, rule).grips();
  REQUIRE(grips.size() == 1 + 3);
  for (std::size_t i = 1; i < grips.size(); ++i) {
    CHECK(grips[i].parts.size() == 3);
    CHECK(grips[i].parts.front() == 0);
  }
  CHECK(internal::HandGrips(hand, {{0, 1, 2}}, rule).grips().size() == 1);
  const auto with_palm = internal::HandGrips(hand, {{0, 1, 2, 3}, true}, rule).grips();
  REQUIRE(with_palm.size() == 1 + 3);
  CHECK(std::all_of(with_palm.begin(), with_palm.end(), [](const auto& g) { return g.has_palm; }));
}

TEST_CASE("Grips with the ends of fingers, where tips' links have a second pad",
          "[grasp][hand_grips]") {
  const hands::HandModel hand = hands::find_hand("barrett_ends");
  const RequestedParts three{
      {hand.thumb(), hand.finger_index("finger_1"), hand.finger_index("finger_2")}};
  const internal::HandGrips grips(hand, three, {.may_use_ends = true});
  REQUIRE(grips.grips().size() == 2);
  const internal::HandGrips::Grip& ends = grips.grips()[1];
  CHECK_FALSE(ends.wraps);
  REQUIRE(ends.pinches.size() == 2);
  std::vector<std::string> names;
  for (const std::size_t part : ends.parts) {
    CHECK(grips.parts()[part].other_pad == grips.parts()[part].samples.pad);
    names.push_back(hand.pads[grips.parts()[part].samples.pad].name);
  }
  CHECK(names == std::vector<std::string>{"thumb_end_pad", "finger_1_end_pad", "finger_2_end_pad"});
  // At 45 mm the thumb and a finger, 26 mm beside it, face each other with their ends within 45
  // degrees, and not at all with their flat pads.
  const auto faces = [&](const internal::HandGrips::Grip& grip) {
    base::Random random(1);
    for (int a = 0; a < 5; ++a) {
      for (int b = 0; b < 5; ++b) {
        const auto lean = [](int i) { return (i + 0.5) * std::numbers::pi / 20.0; };
        const auto& table = grips.pinches()[grip.pinches[0]].table;
        if (table.draw(0.0475, lean(a), lean(b), random)) return true;
      }
    }
    return false;
  };
  CHECK(faces(ends));
  CHECK_FALSE(faces(grips.grips()[0]));
  CHECK(internal::HandGrips(hand, three, {}).grips().size() == 1);
  const hands::HandModel paper = hands::find_hand("barrett");
  CHECK(internal::HandGrips(paper, three, {.may_use_ends = true}).grips().size() == 1);
}

TEST_CASE("Wrapped grips touch with the palm and the pads behind the tips", "[grasp][hand_grips]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const int thumb = hand.thumb();
  const RequestedParts three{{thumb, hand.finger_index("finger_1"), hand.finger_index("finger_2")}};
  internal::GripRule rule = {.may_add_palm = true, .may_wrap = true};
  const internal::HandGrips grips(hand, three, rule);
  const auto names = [&](const internal::HandGrips::Grip& grip) {
    std::vector<std::string> pads;
    for (const std::size_t part : grip.parts) {
      const internal::HandGrips::Part& own = grips.parts()[part];
      const hands::ContactPad& pad = hand.pads[own.samples.pad];
      CHECK(own.finger == pad.finger);
      const bool is_usual = !own.finger || hand.fingers[*own.finger].tip_pad == own.samples.pad;
      CHECK(own.other_pad.has_value() == !is_usual);
      pads.push_back(pad.name);
    }
    return pads;
  };
  using Names = std::vector<std::string>;
  REQUIRE(grips.grips().size() == 3);
  CHECK(names(grips.grips()[0]) ==
        Names{"thumb_distal_pad", "finger_1_distal_pad", "finger_2_distal_pad"});
  CHECK(grips.grips()[1].has_palm);
  CHECK(!grips.grips()[1].wraps);
  CHECK(grips.grips()[2].wraps);
  CHECK(names(grips.grips()[2]) ==
        Names{"thumb_proximal_pad", "finger_1_proximal_pad", "finger_2_proximal_pad", "palm_pad"});
  CHECK(grips.grips()[2].has_palm);
  // What fingertips pinch is what they pinch without the other pads.
  rule.may_wrap = false;
  const internal::HandGrips tips(hand, three, rule);
  CHECK(tips.grips().size() == 2);
  REQUIRE(grips.square_widths(0.4));
  CHECK(grips.square_widths(0.4)->smallest == tips.square_widths(0.4)->smallest);
  CHECK(grips.square_widths(0.4)->largest == tips.square_widths(0.4)->largest);
  // Without the palm nothing is wrapped, and with a palm that must touch anyhow it is.
  CHECK(internal::HandGrips(hand, three, {.may_wrap = true}).grips().size() == 1);
  RequestedParts with_palm = three;
  with_palm.palm = true;
  CHECK(internal::HandGrips(hand, with_palm, {.may_wrap = true}).grips().size() == 2);
  // A gripper has one pad on each finger.
  const hands::HandModel gripper = hands::find_hand("parallel_gripper");
  CHECK(internal::HandGrips(gripper, {{0, 1}, true}, {.may_wrap = true}).grips().size() == 1);
}

TEST_CASE("Coarse distances are those of the map, rounded down", "[grasp][surface_posture]") {
  const testing::Scene scene(geometry::capsule(0.03, 0.06));
  const geometry::SignedDistanceMap& map = scene.object.distance;
  const internal::CoarseDistances coarse(map);
  const Eigen::Array3d counts = map.lattice.counts.array().cast<double>();
  base::Random random(4);
  for (int trial = 0; trial < 5000; ++trial) {
    // Beyond the lattice, too; not near the planes between voxels, where positions are rounded.
    Eigen::Array3d position;
    for (int axis = 0; axis < 3; ++axis) {
      position[axis] = std::floor(random.uniform(-0.5, 1.5) * counts[axis]) + 0.5;
    }
    const float value = map.at_position(position.matrix());
    const int bound = coarse.at(position.cast<float>());
    CHECK(bound >= 0);
    CHECK(static_cast<float>(bound) <= std::max(value, 0.0F));
    if ((position > 0.0).all() && (position < counts).all()) {
      CHECK(static_cast<float>(bound) + 1.0F > value);
    }
  }
}

TEST_CASE("Pads are laid onto the surface, and links leave it", "[grasp][surface_posture]") {
  const testing::Scene scene(geometry::capsule(0.04, 0.08));
  const std::vector<internal::SurfacePlace> places = internal::surface_places(scene.object, false);
  const std::vector<bool> all(places.size(), true);
  const internal::NearestPlaces nearest(scene.object, places, all);
  const SurroundingsCollision nothing(scene.hand, {});
  const internal::SurfaceSearch search(scene.fitting_hand, scene.object, places, nearest, nearest,
                                       nothing);
  const std::vector<int> pads = requested_pads(scene.hand, scene.parts);
  base::Random random(1);
  int num_laid = 0;
  int num_lifted = 0;
  int num_left = 0;
  constexpr int kTrials = 400;
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
    REQUIRE(posture.places.size() == pads.size());
    // What is worth the work is laid as without being asked, what is not is left on the way.
    int num_asked = 0;
    const auto is_worth_it = [&](bool answer) {
      return [&num_asked, &pads, answer](const std::vector<std::int32_t>& on_places) {
        ++num_asked;
        CHECK(on_places.size() == pads.size());
        return answer;
      };
    };
    const auto is_as_laid = [&](const internal::SurfacePosture& other) {
      return other.configuration.q == posture.configuration.q &&
             other.configuration.X_OH.matrix() == posture.configuration.X_OH.matrix();
    };
    CHECK(is_as_laid(search.lay(pads, start, 0.0, is_worth_it(true))));
    const int num_asked_once = num_asked;
    CHECK(num_asked_once <= 1);
    const internal::SurfacePosture left = search.lay(pads, start, 0.0, is_worth_it(false));
    CHECK(num_asked == 2 * num_asked_once);
    if (num_asked_once > 0) ++num_left;
    if (num_asked_once == 0) CHECK(is_as_laid(left));
    if (posture.largest_gap > 0.5 * scene.voxel_size() || posture.largest_depth > 0.002) continue;
    ++num_laid;
    // Lifted by half a voxel, pads and links are so much farther off.
    const double lift = 0.5 * scene.voxel_size();
    const internal::SurfacePosture lifted = search.lay(pads, posture.configuration, lift);
    if (lifted.largest_gap <= 0.25 * scene.voxel_size()) {
      ++num_lifted;
      CHECK(lifted.largest_depth <= std::max(0.0, posture.largest_depth));
      for (const int pad : pads) {
        const auto gap = [&](const internal::SurfacePosture& at) {
          return geometry::nearest_points(scene.object.query, scene.fitting_hand.pad_surface(pad),
                                          at.X_OL[scene.hand.pads[pad].link], 1.0, {})
              ->distance;
        };
        CHECK(gap(lifted) > gap(posture) - 0.25 * scene.voxel_size());
      }
    }
    // By the true meshes: every pad is near the surface.
    for (const int pad : pads) {
      const auto distance =
          geometry::nearest_points(scene.object.query, scene.fitting_hand.pad_surface(pad),
                                   posture.X_OL[scene.hand.pads[pad].link], 1.0, {});
      REQUIRE(distance);
      CHECK(distance->distance <= 1.5 * scene.voxel_size());
    }
  }
  CHECK(num_left > 0);
  CHECK(num_laid >= kTrials / 8);
  CHECK(num_lifted >= num_laid / 2);
}

}  // namespace test_reach_parts
