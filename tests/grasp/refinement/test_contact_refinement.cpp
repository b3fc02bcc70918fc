#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "contact/pad_hand.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/contact_refinement.hpp"
#include "graspfit/hands/hand_closing.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/pad_surface.hpp"
#include "support/catch.hpp"

namespace test_contact_refinement {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using geometry::RigidTransform;
using grasp::RefinementOptions;
using grasp::RefinementResult;
using grasp::RefinementStop;
using hands::HandConfiguration;

/// A hand at an object.
struct Scene {
  Scene(const hands::HandModel& the_hand, const geometry::TriangleMesh& mesh,
        const grasp::Surroundings& around = {})
      : hand(the_hand),
        object(grasp::build_object_model(mesh, {.resolution = 16})),
        fitting_hand(hand, 0.002),
        surroundings(hand, around) {
    contact_options.clip_thickness = 0.002;
  }

  RefinementResult refine(const HandConfiguration& start, const std::vector<int>& pads,
                          const RefinementOptions& options = {}) const {
    return grasp::refine_contacts({fitting_hand, object, surroundings, contact_options}, pads,
                                  nullptr, start, options);
  }

  std::vector<int> tip_pads() const {
    std::vector<int> pads;
    for (const hands::Finger& finger : hand.fingers) pads.push_back(*finger.tip_pad);
    return pads;
  }

  bool cuts(const HandConfiguration& configuration) const {
    const auto X_OL = hands::forward_kinematics(hand, configuration);
    for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
      if (fitting_hand.collision().link_intersects(object.query, link, X_OL[link])) return true;
    }
    return false;
  }

  /// Returns the hand with the palm center `height` before the origin of O, looking along
  /// `direction`, and the fingers closed until just before the first link enters the object: some
  /// pads are millimeters away.
  HandConfiguration nearly_closed(const Vector3d& direction, double height) const {
    HandConfiguration last = hands::open_configuration(hand);
    last.X_OH.linear() =
        Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, direction).toRotationMatrix();
    last.X_OH.translation() =
        -height * direction.normalized() - last.X_OH.linear() * hand.palm.center_H;
    for (int percent = 1; percent <= 100; ++percent) {
      HandConfiguration next = last;
      next.q = hands::closed_configuration(hand, 0.01 * percent).q;
      if (cuts(next)) break;
      last = next;
    }
    return last;
  }

  hands::HandModel hand;
  grasp::ObjectModel object;
  grasp::FittingHand fitting_hand;
  grasp::SurroundingsCollision surroundings;
  contact::ContactEstimationOptions contact_options;
};

/// Returns the smallest distance of densely laid points of a pad's surface from the object: an
/// upper bound of the gap that needs no search for nearest points of two meshes.
double sampled_gap(const Scene& scene, int pad, const HandConfiguration& configuration) {
  const auto X_OL = hands::forward_kinematics(scene.hand, configuration);
  const RigidTransform& X = X_OL[scene.hand.pads[pad].link];
  const geometry::TriangleMesh surface = hands::pad_surface_L(scene.hand, pad);
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t face = 0; face < surface.faces.size(); ++face) {
    const auto [a, b, c] = geometry::corners(surface, face);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = static_cast<int>(std::ceil(longest / 0.0005));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vector3d point = X * Vector3d(a + (b - a) * (1.0 * i / n) + (c - a) * (1.0 * j / n));
        smallest = std::min(smallest, scene.object.query.closest_point(point).squared_distance);
      }
    }
  }
  return std::sqrt(smallest);
}

/// Checks what every result promises, whatever its stop.
void check_promises(const Scene& scene, const HandConfiguration& start,
                    const std::vector<int>& pads, const RefinementOptions& options,
                    const RefinementResult& result) {
  CHECK_NOTHROW(hands::validate(scene.hand, result.configuration));
  const HandConfiguration& end = result.configuration;
  const Vector3d center = scene.hand.palm.center_H;
  CHECK((end.X_OH * center - start.X_OH * center).norm() <= options.largest_shift + 1e-9);
  const Eigen::AngleAxisd turned(
      Eigen::Matrix3d(end.X_OH.linear() * start.X_OH.linear().transpose()));
  CHECK(std::abs(turned.angle()) <= options.largest_turn + 1e-6);
  if (result.stop == RefinementStop::Intersecting || result.stop == RefinementStop::SelfCollision) {
    return;
  }
  const auto X_OL = hands::forward_kinematics(scene.hand, end);
  CHECK_FALSE(scene.cuts(end));
  CHECK_FALSE(scene.fitting_hand.collision().against_self(X_OL).intersects);
  for (int link = 0; link < static_cast<int>(X_OL.size()); ++link) {
    CHECK_FALSE(scene.surroundings.touches(scene.fitting_hand.collision(), link, X_OL[link]));
  }
  if (result.stop != RefinementStop::Contact) return;
  CHECK(result.largest_gap <= options.largest_gap);
  const std::vector<contact::Contact> contacts =
      contact::estimate_contacts(scene.hand, X_OL, scene.object.query, scene.contact_options);
  for (const int pad : pads) {
    const auto contact = std::find_if(contacts.begin(), contacts.end(),
                                      [&](const contact::Contact& c) { return c.pad == pad; });
    REQUIRE(contact != contacts.end());
    // The gap was searched for with a seed and without.
    CHECK(contact->gap <= result.largest_gap + 1e-12);
    // The nearest sample is at most 0.3 mm along the pad from the nearest point, and the coarse
    // objects here have edges whose faces turn away by less than a tenth.
    const double sampled = sampled_gap(scene, pad, end);
    CHECK(sampled >= contact->gap - 1e-9);
    CHECK(sampled <= contact->gap + 3e-5);
  }
}

bool same_bytes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

/// Returns the gripper around a box 3 cm wide along the jaws' way, `aside` from the middle between
/// them.
HandConfiguration around_box(const hands::HandModel& hand, double aside, double opening) {
  HandConfiguration start = hands::open_configuration(hand);
  const auto X_HL = hands::forward_kinematics(hand, start);
  const Vector3d left = hands::pad_contact_point(hand, *hand.fingers[0].tip_pad, X_HL);
  const Vector3d right = hands::pad_contact_point(hand, *hand.fingers[1].tip_pad, X_HL);
  const Vector3d along = (right - left).normalized();
  start.X_OH.translation() = -0.5 * (left + right) + aside * along;
  const double width = 0.03 + 2 * opening;
  const double each = 0.5 * ((right - left).norm() - width);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    start.q[static_cast<Eigen::Index>(j)] += hand.joints[j].closing_sign * each;
  }
  hands::apply_couplings(hand, start.q);
  return start;
}

}  // namespace

TEST_CASE("A gripper beside the middle of a box moves its palm until both pads touch",
          "[grasp][contact_refinement]") {
  const Scene scene(hands::find_hand("parallel_gripper"), geometry::box({0.03, 0.03, 0.03}));
  const std::vector<int> pads = scene.tip_pads();
  for (const double aside : {0.0, 0.001, -0.0025}) {
    const HandConfiguration start = around_box(scene.hand, aside, 0.004);
    REQUIRE_FALSE(scene.cuts(start));
    const RefinementResult result = scene.refine(start, pads);
    REQUIRE(result.stop == RefinementStop::Contact);
    check_promises(scene, start, pads, {}, result);
    // One joint drives both jaws, so that their middle must come to that of the box.
    const Vector3d shift = result.configuration.X_OH.translation() - start.X_OH.translation();
    CHECK(shift.norm() == Approx(std::abs(aside)).margin(2e-4));
    // A second refinement changes nothing.
    const RefinementResult again = scene.refine(result.configuration, pads);
    CHECK(again.iterations == 0);
    CHECK(same_bytes(again.configuration.q, result.configuration.q));
    CHECK(same_bytes(again.configuration.X_OH.matrix(), result.configuration.X_OH.matrix()));
  }
}

TEST_CASE("A gripper whose palm must stay leaves the gap that its one joint cannot close",
          "[grasp][contact_refinement]") {
  const Scene scene(hands::find_hand("parallel_gripper"), geometry::box({0.03, 0.03, 0.03}));
  const double aside = 0.002;
  const HandConfiguration start = around_box(scene.hand, aside, 0.004);
  RefinementOptions options;
  options.largest_shift = 0.0;
  options.largest_turn = 0.0;
  const RefinementResult result = scene.refine(start, scene.tip_pads(), options);
  CHECK(result.stop == RefinementStop::GapLeft);
  check_promises(scene, start, scene.tip_pads(), options, result);
  // The gap is twice `aside`, and what is kept before the nearer jaw (at most 0.3 mm).
  CHECK(result.largest_gap >= 2 * aside);
  CHECK(result.largest_gap <= 2 * aside + 4e-4);
}

TEST_CASE("A further pad that nearly touches is brought to touch, or given up soon",
          "[grasp][contact_refinement]") {
  const Scene scene(hands::find_hand("parallel_gripper"), geometry::box({0.03, 0.03, 0.03}));
  const HandConfiguration start = around_box(scene.hand, 0.0005, 0.001);
  const auto pads = scene.tip_pads();
  // The jaw that is nearer is asked for; the other is left a millimeter away.
  const std::vector<int> asked = {
      sampled_gap(scene, pads[0], start) < sampled_gap(scene, pads[1], start) ? pads[0] : pads[1]};
  const int further = asked[0] == pads[0] ? pads[1] : pads[0];
  RefinementOptions options;
  const auto refined = [&](int near_pad_steps) {
    options.near_pad_steps = near_pad_steps;
    const RefinementResult result = scene.refine(start, asked, options);
    REQUIRE(result.stop == RefinementStop::Contact);
    check_promises(scene, start, asked, options, result);
    return result;
  };
  const double largest = options.largest_gap + 3e-5;  // `sampled_gap` is an upper bound.
  CHECK(sampled_gap(scene, further, refined(0).configuration) > largest);
  CHECK(sampled_gap(scene, further, refined(12).configuration) <= largest);
  // A palm that must stay lets one joint not close both gaps: after few steps that hardly gain
  // anything, not all twelve, the hand is where it was before them.
  options.largest_shift = options.largest_turn = 0.0;
  const RefinementResult without = refined(0);
  const RefinementResult with = refined(12);
  CHECK(with.iterations > without.iterations);
  CHECK(with.iterations <= without.iterations + 4);
  CHECK(same_bytes(with.configuration.q, without.configuration.q));
}

TEST_CASE("Pads that touch slide along a box to their targets, and stay without sliding",
          "[grasp][contact_refinement]") {
  const Scene scene(hands::find_hand("parallel_gripper"), geometry::box({0.03, 0.03, 0.03}));
  const std::vector<int> pads = scene.tip_pads();
  const HandConfiguration start = around_box(scene.hand, 0.0, 0.004);
  const auto X_OL = hands::forward_kinematics(scene.hand, start);
  const auto tip = [&](int i, const std::vector<RigidTransform>& poses) {
    return hands::pad_contact_point(scene.hand, pads[static_cast<std::size_t>(i)], poses);
  };
  const Vector3d across = (tip(1, X_OL) - tip(0, X_OL)).normalized();
  const Vector3d aside = 0.006 * across.cross(start.X_OH.linear() * scene.hand.palm.direction_H);
  grasp::TargetContacts targets;
  for (const int i : {0, 1}) {
    const Vector3d outward = i == 0 ? Vector3d(-across) : across;
    targets.contacts.push_back({.point_O = 0.015 * outward + aside,
                                .outward_normal_O = outward,
                                .patch = 0,
                                .score = 1.0,
                                .finger = i});
  }
  const auto farthest = [&](const RefinementOptions& options) {
    const RefinementResult result = grasp::refine_contacts(
        {scene.fitting_hand, scene.object, scene.surroundings, scene.contact_options}, pads,
        &targets, start, options);
    REQUIRE(result.stop == RefinementStop::Contact);
    check_promises(scene, start, pads, options, result);
    const auto poses = hands::forward_kinematics(scene.hand, result.configuration);
    return std::max((tip(0, poses) - targets.contacts[0].point_O).norm(),
                    (tip(1, poses) - targets.contacts[1].point_O).norm());
  };
  RefinementOptions sliding;
  sliding.slide_steps = 20;
  CHECK(farthest({}) > 0.004);
  CHECK(farthest(sliding) < 0.0005);
}

TEST_CASE("A three-fingered hand comes to touch a ball with every fingertip pad",
          "[grasp][contact_refinement]") {
  const Scene scene(hands::find_hand("barrett"), geometry::ball(0.04, 3));
  for (const Vector3d& direction :
       {Vector3d(0, 0, -1), Vector3d(0.3, -0.2, 1.0), Vector3d(1, 0.1, 0)}) {
    const HandConfiguration start = scene.nearly_closed(direction, 0.075);
    const RefinementResult result = scene.refine(start, scene.tip_pads());
    CHECK(result.stop == RefinementStop::Contact);
    check_promises(scene, start, scene.tip_pads(), {}, result);
    // A second run gives the same bytes.
    const RefinementResult again = scene.refine(start, scene.tip_pads());
    CHECK(same_bytes(again.configuration.q, result.configuration.q));
    CHECK(same_bytes(again.configuration.X_OH.matrix(), result.configuration.X_OH.matrix()));
    // This start cuts the ball.
    HandConfiguration cutting = start;
    for (std::size_t j = 0; j < scene.hand.joints.size(); ++j) {
      cutting.q[static_cast<Eigen::Index>(j)] += 0.05 * scene.hand.joints[j].closing_sign;
    }
    hands::clamp_to_limits(scene.hand, cutting.q);
    hands::apply_couplings(scene.hand, cutting.q);
    REQUIRE(scene.cuts(cutting));
    const RefinementResult cleared = scene.refine(cutting, scene.tip_pads());
    CHECK(cleared.stop == RefinementStop::Contact);
    check_promises(scene, cutting, scene.tip_pads(), {}, cleared);
  }
}

TEST_CASE("Every shipped hand keeps its promises on a torus", "[grasp][contact_refinement]") {
  int num_contact = 0;
  for (const std::string name : {"barrett", "parallel_gripper", "human_hand"}) {
    const Scene scene(hands::find_hand(name), geometry::torus(0.03, 0.012, 48, 24));
    const std::vector<int> all = scene.tip_pads();
    const std::vector<int> pads(all.begin(),
                                all.begin() + std::min<std::ptrdiff_t>(3, std::ssize(all)));
    for (const Vector3d& direction : {Vector3d(0, 1, 0), Vector3d(1, 1, -0.5)}) {
      const HandConfiguration start = scene.nearly_closed(direction, 0.08);
      const RefinementResult result = scene.refine(start, pads);
      check_promises(scene, start, pads, {}, result);
      num_contact += result.stop == RefinementStop::Contact ? 1 : 0;
    }
  }
  CHECK(num_contact >= 1);
}

TEST_CASE("A table under the object is not touched", "[grasp][contact_refinement]") {
  const Scene free(hands::find_hand("barrett"), geometry::ball(0.04, 3));
  const HandConfiguration start = free.nearly_closed(Vector3d(0, 0, -1), 0.075);
  const RefinementResult unhindered = free.refine(start, free.tip_pads());
  REQUIRE(unhindered.stop == RefinementStop::Contact);
  const auto lowest = [&](const HandConfiguration& configuration) {
    const auto X_OL = hands::forward_kinematics(free.hand, configuration);
    double z = std::numeric_limits<double>::infinity();
    for (std::size_t link = 0; link < X_OL.size(); ++link) {
      for (const Vector3d& vertex : free.hand.links[link].mesh_L.vertices) {
        z = std::min(z, (X_OL[link] * vertex).z());
      }
    }
    return z;
  };
  // The hand alone at the ball would reach into this table by 1 mm.
  const double table_z = lowest(unhindered.configuration) + 0.001;
  const Scene scene(free.hand, geometry::ball(0.04, 3), {.table_z_O = table_z, .obstacles = {}});
  const RefinementResult result = scene.refine(start, scene.tip_pads());
  check_promises(scene, start, scene.tip_pads(), {}, result);
  CHECK(result.stop != RefinementStop::Intersecting);
  CHECK(lowest(result.configuration) > table_z);
}

TEST_CASE("What cannot be refined says why", "[grasp][contact_refinement]") {
  const Scene scene(hands::find_hand("barrett"), geometry::ball(0.04, 3));
  HandConfiguration far = hands::open_configuration(scene.hand);
  far.X_OH.translation() = Vector3d(0, 0, -0.5);
  const RefinementResult out_of_reach = scene.refine(far, scene.tip_pads());
  CHECK(out_of_reach.stop == RefinementStop::OutOfReach);
  CHECK(out_of_reach.largest_gap > RefinementOptions{}.reach);
  CHECK(same_bytes(out_of_reach.configuration.X_OH.matrix(), far.X_OH.matrix()));

  HandConfiguration inside = hands::open_configuration(scene.hand);
  inside.X_OH.translation() = -scene.hand.palm.center_H;
  CHECK(scene.refine(inside, scene.tip_pads()).stop == RefinementStop::Intersecting);

  // Two fingers without joints share space.
  hands::HandModel stiff = testing::pad_hand(2);
  for (int link = 1; link <= 2; ++link)
    stiff.links[link].mesh_L = geometry::box({0.01, 0.01, 0.01});
  const Scene tangled(stiff, geometry::ball(0.02));
  HandConfiguration beside;
  beside.q.resize(0);
  beside.X_OH.translation() = Vector3d(0.06, 0, 0);
  CHECK(tangled.refine(beside, {1, 2}).stop == RefinementStop::SelfCollision);

  CHECK_THROWS_AS(scene.refine(far, {99}), base::InvalidInput);
  RefinementOptions bad;
  bad.wanted_gap = 1e-3;
  CHECK_THROWS_AS(scene.refine(far, scene.tip_pads(), bad), base::InvalidInput);
  bad = {};
  bad.least_distance = 0.0;
  CHECK_THROWS_AS(bad.validate(), base::InvalidInput);
}

}  // namespace test_contact_refinement
