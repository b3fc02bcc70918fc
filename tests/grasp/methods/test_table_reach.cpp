#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "fitting/surface_posture.hpp"
#include "grasp/posed_box.hpp"
#include "grasp/reach_options.hpp"
#include "grasp/sample_pose.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/kinematic_chain.hpp"
#include "graspfit/hands/pad_samples.hpp"
#include "methods/table_reach.hpp"
#include "support/catch.hpp"

// These tests are about hands above a table on which a low object lies.
namespace test_table_reach {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using internal::PoolPoint;
using testing::reach_options;

/// Returns a bar of 34 x 160 x 36 mm that lies on z = 0.
geometry::TriangleMesh bar() {
  geometry::TriangleMesh mesh = geometry::box({0.034, 0.16, 0.036});
  for (Vector3d& vertex : mesh.vertices) vertex.z() += 0.018;
  return mesh;
}

Surroundings table() {
  Surroundings surroundings;
  surroundings.table_z_O = 0.0;
  surroundings.table_clearance = 0.001;
  return surroundings;
}

double lowest_of(const hands::HandModel& hand, const hands::HandConfiguration& configuration) {
  return testing::posed_box(hand, configuration).min().z();
}

/// That the first two points of a pool are left of it.
void require_first_two(const std::vector<PoolPoint>& left, const std::vector<PoolPoint>& pool) {
  REQUIRE(left.size() == 2);
  CHECK(left[0].point_O == pool[0].point_O);
  CHECK(left[1].point_O == pool[1].point_O);
}

}  // namespace

TEST_CASE("Hands pick up a low bar from a table, with room below them", "[grasp][table_reach]") {
  // The gripper's palm does not get so low: without pairs of jaws alone no attempt is valid.
  for (const char* const name : {"parallel_gripper", "human_hand"}) {
    CAPTURE(name);
    const hands::HandModel hand = hands::find_hand(name);
    PlannerOptions options = reach_options(GraspStyle::Auto, 8);
    options.num_contacts = std::min(3, static_cast<int>(hand.fingers.size()));
    const ObjectModel object = prepare_object(bar(), hand, options);
    const PlannerResult result = plan_grasps(object, hand, options, table(), {.num_threads = 1});
    CHECK(result.statistics.outcomes.at(AttemptOutcome::Valid) >= 7);
    for (const Grasp& grasp : result.grasps) {
      CHECK(lowest_of(hand, grasp.configuration) > 0.001);
      REQUIRE(grasp.pre_grasp);
      CHECK(lowest_of(hand, grasp.pre_grasp->configuration) > 0.001);
    }
  }
}

TEST_CASE("Auto may use a finger less than asked over a table", "[grasp][table_reach]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const auto sizes = [&](const Surroundings& surroundings) {
    PlannerOptions options = reach_options(GraspStyle::Auto, 8);
    options.num_contacts = 5;
    options.palm = false;
    const ObjectModel object = prepare_object(bar(), hand, options);
    std::set<std::size_t> found;
    for (const Grasp& grasp :
         plan_grasps(object, hand, options, surroundings, {.num_threads = 1}).grasps) {
      CHECK(std::isfinite(grasp.targets.rank));
      found.insert(grasp.targets.contacts.size());
    }
    return found;
  };
  CHECK(sizes(table()).contains(4));
  CHECK(sizes({}) == std::set<std::size_t>{5});
}

TEST_CASE("Places that no pad reaches above the table are no targets", "[grasp][table_reach]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const SurroundingsCollision above(hand, table());
  const auto place = [](const Vector3d& point, const Vector3d& inward_normal) {
    return PoolPoint{point, inward_normal, 0};
  };
  const std::vector<PoolPoint> pool = {place({0.0, 0.0, 0.036}, {0.0, 0.0, -1.0}),  // the top
                                       place({0.017, 0.0, 0.018}, {-1.0, 0.0, 0.0}),
                                       place({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}),  // the bottom
                                       place({0.017, 0.0, 0.001}, {-1.0, 0.0, 0.0})};
  require_first_two(internal::touchable_above_table(pool, hand, above), pool);
  const SurroundingsCollision nothing(hand, {});
  CHECK(internal::touchable_above_table(pool, hand, nothing).size() == pool.size());
}

TEST_CASE("What is long is carried near its center of mass", "[grasp][table_reach]") {
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const SurroundingsCollision above(hand, table());
  // A frame whose center is empty: along the table the nearest point is 0.1 m away.
  const Vector3d center(0.4, 0.0, 0.05);
  std::vector<PoolPoint> pool;
  for (const double x : {0.4 + 0.1, 0.4 - 0.21, 0.4 + 0.23, 0.4 - 1.0}) {
    pool.push_back({Vector3d(x, 0.0, 2.0), -Vector3d::UnitZ(), 0});
  }
  require_first_two(internal::carrying_above_table(pool, center, above), pool);
  const SurroundingsCollision nothing(hand, {});
  CHECK(internal::carrying_above_table(pool, center, nothing).size() == pool.size());
  CHECK(internal::carrying_above_table({}, center, above).empty());
}

TEST_CASE("Whether samples of a hand are above the table is known to 5 mm",
          "[grasp][table_reach]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const SurroundingsCollision above(hand, table());
  const int pad = *hand.fingers[0].tip_pad;
  const std::vector<hands::PadSamples> samples = hands::pad_samples(hand, {pad}, 64);
  const internal::TableReach reach(hand, above, {&samples[0]});
  const std::vector<int> chain = hands::links_to(hand, hand.pads[pad].link);
  // The lowest vertex of some links, by kinematics of the whole hand.
  const auto lowest = [&](const hands::HandConfiguration& configuration, bool is_palm) {
    const auto counts = [&](int link) {
      const bool is_fixed = hands::joints_to(hand, link).empty();
      return is_palm ? is_fixed : !is_fixed && std::count(chain.begin(), chain.end(), link) > 0;
    };
    return testing::posed_box(hand, configuration, counts).min().z();
  };
  base::Random random(3);
  constexpr double kSeen = 0.005 - 0.001;  // below the table and its clearance [m]
  constexpr double kUnseen = 0.003;        // by which the corners that are looked at may miss
  int num_above = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const auto sample = static_cast<std::int32_t>(random.index(samples[0].size()));
    hands::HandConfiguration configuration =
        testing::turned_sample(hand, samples[0], sample, random);
    configuration.X_OH.translation().z() = random.uniform(0.0, 0.15);
    const double finger = lowest(configuration, false);
    const double palm = lowest(configuration, true);
    CAPTURE(trial, finger, palm);
    const bool is_above = reach.is_above(0, sample, configuration.X_OH);
    if (is_above) CHECK(finger > -kSeen - kUnseen);
    if (finger > -kSeen) CHECK(is_above);
    if (reach.is_palm_above(configuration.X_OH)) CHECK(palm > -kSeen - kUnseen);
    if (palm > -kSeen) CHECK(reach.is_palm_above(configuration.X_OH));
    num_above += is_above ? 1 : 0;
  }
  CHECK(num_above > 40);
  CHECK(num_above < 360);
  geometry::RigidTransform low = geometry::RigidTransform::Identity();
  low.translation().z() = -1.0;
  CHECK_FALSE(reach.is_above(0, 0, low));
  const SurroundingsCollision nothing(hand, {});
  CHECK(internal::TableReach(hand, nothing, {&samples[0]}).is_above(0, 0, low));
  CHECK(internal::TableReach(hand, nothing, {&samples[0]}).is_palm_above(low));
}

TEST_CASE("Links leave the table while pads are laid", "[grasp][surface_posture]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const PlannerOptions options = reach_options(GraspStyle::Precision, 1);
  const ObjectModel object = prepare_object(bar(), hand, options);
  const FittingHand fitting_hand(hand, 0.5 * object.grid.lattice.voxel_size);
  const std::vector<internal::SurfacePlace> places = internal::surface_places(object, false);
  const internal::NearestPlaces nearest(object, places, std::vector<bool>(places.size(), true));
  const SurroundingsCollision nothing(hand, {});
  const SurroundingsCollision above(hand, table());
  const internal::SurfaceSearch free_search(fitting_hand, object, places, nearest, nearest,
                                            nothing);
  const internal::SurfaceSearch search(fitting_hand, object, places, nearest, nearest, above);
  const std::vector<int> pads = {*hand.fingers[0].tip_pad, *hand.fingers[1].tip_pad};
  base::Random random(1);
  int num_free_below = 0;
  int num_below = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    // From above, with the tips a little below the table.
    hands::HandConfiguration start = hands::open_configuration(hand);
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      const hands::Joint& joint = hand.joints[j];
      if (joint.closing_sign == 0 || joint.coupling) continue;
      start.q[static_cast<Eigen::Index>(j)] =
          joint.open_limit() + 0.5 * (joint.closed_limit() - joint.open_limit());
    }
    hands::apply_couplings(hand, start.q);
    start.X_OH.linear() =
        (Eigen::AngleAxisd(random.uniform(-3.0, 3.0), Vector3d::UnitZ()) *
         Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, -Vector3d::UnitZ()))
            .toRotationMatrix();
    start.X_OH.translation().z() -= lowest_of(hand, start) + 0.004;
    num_free_below += lowest_of(hand, free_search.lay(pads, start).configuration) < 0.001 ? 1 : 0;
    num_below += lowest_of(hand, search.lay(pads, start).configuration) < 0.001 ? 1 : 0;
  }
  CAPTURE(num_free_below, num_below);
  CHECK(num_free_below > kTrials / 2);
  CHECK(3 * num_below < 2 * num_free_below);
}

}  // namespace test_table_reach
