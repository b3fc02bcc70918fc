#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "approach/checked_pre_grasp.hpp"
#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "scene/straight_way.hpp"
#include "support/catch.hpp"

namespace test_pre_grasp {

using namespace graspfit;
using namespace graspfit::grasp;
using base::InvalidInput;
using base::Random;
using Eigen::AngleAxisd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::MeshQuery;
using geometry::RigidTransform;
using geometry::TriangleMesh;
using grasp::internal::are_apart_on_way;
using hands::HandConfiguration;
using hands::HandModel;
using testing::Contains;

namespace {

TriangleMesh box_at(const Vector3d& size, const Vector3d& center) {
  TriangleMesh mesh = geometry::box(size);
  for (Vector3d& vertex : mesh.vertices) vertex += center;
  return mesh;
}

/// The parallel gripper around a box of 40 x 20 x 30 mm at the origin, with its pads `gap` beside
/// it.
struct Pinch {
  explicit Pinch(double gap) : hand(hands::find_hand("parallel_gripper")), collision(hand) {
    grasp = hands::open_configuration(hand);
    grasp.q.setConstant(0.02 + gap);
    // The middle between the pads is at the origin.
    grasp.X_OH.translation().z() = -0.062;
  }
  std::optional<PreGrasp> find(const PreGraspOptions& options, Surroundings around = {}) const {
    const SurroundingsCollision surroundings(hand, std::move(around));
    return find_pre_grasp({hand, collision, object, surroundings}, grasp, options);
  }
  HandModel hand;
  hands::HandCollision collision;
  MeshQuery object{geometry::box({0.04, 0.02, 0.03})};
  HandConfiguration grasp;
};

HandConfiguration random_configuration(const HandModel& hand, Random& random) {
  HandConfiguration configuration = hands::open_configuration(hand);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    configuration.q[static_cast<Eigen::Index>(j)] =
        random.uniform(hand.joints[j].lower, hand.joints[j].upper);
  }
  configuration.X_OH.linear() =
      AngleAxisd(random.uniform(0.0, 3.0), testing::random_direction(random)).toRotationMatrix();
  configuration.X_OH.translation() = 0.2 * testing::random_direction(random);
  return configuration;
}

/// What a hand may touch; exact tests decide.
struct Scene {
  HandModel hand;
  hands::HandCollision collision;
  MeshQuery object;
  SurroundingsCollision surroundings;

  bool is_clear(const HandConfiguration& at) const {
    const auto X_OL = hands::forward_kinematics(hand, at);
    for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
      const RigidTransform& X = X_OL[static_cast<std::size_t>(link)];
      if (collision.link_intersects(object, link, X)) return false;
      if (surroundings.touches(collision, link, X)) return false;
    }
    return !collision.against_self(X_OL).intersects;
  }

  double clearance(const HandConfiguration& at) const {
    const auto X_OL = hands::forward_kinematics(hand, at);
    double nearest = std::numeric_limits<double>::infinity();
    for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
      const RigidTransform& X = X_OL[static_cast<std::size_t>(link)];
      if (!collision.link_solid(link)) continue;
      nearest =
          std::min({nearest, geometry::distance(object, *collision.link_solid(link), X).distance,
                    surroundings.distance(collision, link, X, 1.0).distance});
    }
    return nearest;
  }
};

/// Returns the hand closed around what it holds: every finger's closing joints move together, one
/// finger after the other, as far as exact tests let them, to within 1e-5 of their range.
HandConfiguration closed_onto(const Scene& scene, HandConfiguration at) {
  const HandConfiguration start = at;
  for (const hands::Finger& finger : scene.hand.fingers) {
    const auto closed = [&](double share) {
      HandConfiguration moved = at;
      for (const int joint : finger.joints) {
        const hands::Joint& j = scene.hand.joints[static_cast<std::size_t>(joint)];
        if (j.closing_sign == 0) continue;
        const double limit = j.closing_sign > 0 ? j.upper : j.lower;
        moved.q[joint] = (1.0 - share) * start.q[joint] + share * limit;
      }
      hands::apply_couplings(scene.hand, moved.q);
      return moved;
    };
    double low = 0.0;
    while (low < 0.97 && scene.is_clear(closed(low + 0.02))) low += 0.02;
    double high = low + 0.02;
    while (high - low > 1e-5) {
      const double middle = 0.5 * (low + high);
      (scene.is_clear(closed(middle)) ? low : high) = middle;
    }
    at =
        // The hand is not so near that no proof could tell it from a touch.
        closed(std::max(0.0, low - 0.002));
  }
  return at;
}

/// The hand's configurations from which ways to a grasp are tried while neutral joints stay, in
/// their order.
std::vector<HandConfiguration> openings_and_retreats(const HandModel& hand,
                                                     const HandConfiguration& grasp,
                                                     const PreGraspOptions& options) {
  const HandConfiguration open = hands::open_configuration(hand);
  const auto num_retreats = std::lround(options.largest_retreat / options.retreat_step);
  std::vector<HandConfiguration> all;
  for (int step = 1; step <= options.opening_steps; ++step) {
    for (int i = 0; i <= num_retreats; ++i) {
      HandConfiguration from = grasp;
      for (std::size_t j = 0; j < hand.joints.size(); ++j) {
        const auto index = static_cast<Eigen::Index>(j);
        if (hand.joints[j].closing_sign == 0) continue;
        from.q[index] +=
            static_cast<double>(step) / options.opening_steps * (open.q[index] - grasp.q[index]);
      }
      hands::apply_couplings(hand, from.q);
      from.X_OH.translation() -=
          options.retreat_step * i * (grasp.X_OH.linear() * hand.palm.direction_H);
      all.push_back(from);
    }
  }
  return all;
}

bool is_found_there(const std::optional<PreGrasp>& found, const HandConfiguration& at) {
  return found && (found->configuration.q - at.q).norm() < 1e-12 &&
         found->configuration.X_OH.isApprox(at.X_OH, 1e-12);
}

}  // namespace

TEST_CASE("Poses between two are linear in place and joints and turn along the shortest arc",
          "[grasp][pre_grasp]") {
  HandConfiguration from;
  HandConfiguration to;
  from.q = VectorXd::LinSpaced(3, 0.1, 0.3);
  to.q = VectorXd::LinSpaced(3, 1.1, -0.5);
  from.X_OH.translation() = Vector3d(1.0, 2.0, 3.0);
  to.X_OH.translation() = Vector3d(2.0, 2.0, -1.0);
  to.X_OH.linear() = AngleAxisd(-1.2, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix();
  const HandConfiguration quarter = interpolated(from, to, 0.25);
  CHECK(quarter.X_OH.translation().isApprox(Vector3d(1.25, 2.0, 2.0), 1e-15));
  CHECK(quarter.X_OH.linear().isApprox(AngleAxisd(-0.3, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix(),
                                       1e-14));
  CHECK(quarter.q.isApprox(Vector3d(0.35, 0.225, 0.1), 1e-14));
  CHECK(interpolated(from, to, 0.0).X_OH.matrix() == from.X_OH.matrix());
  CHECK(interpolated(from, to, 1.0).X_OH.matrix() == to.X_OH.matrix());
  CHECK(interpolated(from, to, 1.0).q == to.q);
  // A turn by 350 degrees one way is one by 10 the other.
  to.X_OH.linear() =
      AngleAxisd(350.0 / 180.0 * std::numbers::pi, Vector3d::UnitY()).toRotationMatrix();
  CHECK(interpolated(from, to, 0.5)
            .X_OH.linear()
            .isApprox(
                AngleAxisd(-5.0 / 180.0 * std::numbers::pi, Vector3d::UnitY()).toRotationMatrix(),
                1e-14));
  to.q.conservativeResize(2);
  CHECK_THROWS_AS(interpolated(from, to, 0.5), InvalidInput);
  CHECK_THROWS_AS(interpolated(from, from, 1.01), InvalidInput);
  CHECK_THROWS_AS(interpolated(from, from, std::nan("")), InvalidInput);
}

TEST_CASE("No point of a link moves faster than the bound of its way", "[grasp][pre_grasp]") {
  Random random(31);
  double tightest = 0.0;
  for (const char* name : {"barrett", "human_hand", "parallel_gripper"}) {
    const HandModel hand = hands::find_hand(name);
    const int num_links = static_cast<int>(hand.links.size());
    for (int trial = 0; trial < 4; ++trial) {
      const HandConfiguration from = random_configuration(hand, random);
      const HandConfiguration to = random_configuration(hand, random);
      const grasp::internal::StraightWay way(hand, from, to);
      constexpr int kSteps = 40;
      auto before = hands::forward_kinematics(hand, from);
      for (int step = 1; step <= kSteps; ++step) {
        const auto now = hands::forward_kinematics(
            hand, interpolated(from, to, static_cast<double>(step) / kSteps));
        for (int a = 0; a < num_links; ++a) {
          const auto ia = static_cast<std::size_t>(a);
          const int b = static_cast<int>(random.index(hand.links.size()));
          const auto ib = static_cast<std::size_t>(b);
          double in_O = 0.0;
          // This is how far points of A move, seen from B, bounded from below.
          double in_B = 0.0;
          for (const Vector3d& p : hand.links[ia].mesh_L.vertices) {
            in_O = std::max(in_O, (now[ia] * p - before[ia] * p).norm());
          }
          // The distance of a point of A and a point of B changes by no more than both move.
          const auto& points_a = hand.links[ia].mesh_L.vertices;
          const auto& points_b = hand.links[ib].mesh_L.vertices;
          for (int i = 0; i < 20 && !points_a.empty() && !points_b.empty(); ++i) {
            const Vector3d& p = points_a[random.index(points_a.size())];
            const Vector3d& q = points_b[random.index(points_b.size())];
            in_B = std::max(in_B, std::abs((now[ia] * p - now[ib] * q).norm() -
                                           (before[ia] * p - before[ib] * q).norm()));
          }
          CHECK(in_O * kSteps <= way.speed(a) * (1.0 + 1e-12));
          CHECK(in_B * kSteps <= way.relative_speed(a, b) * (1.0 + 1e-12) + 1e-12);
          tightest = std::max(tightest, in_O * kSteps / way.speed(a));
        }
        before = now;
      }
      CHECK(way.relative_speed(0, 0) == 0.0);
    }
  }
  CHECK(tightest > 0.8);  // No bound is so wide that nothing could break it.
}

TEST_CASE("A way is proven free by distances alone, and only if it is", "[grasp][pre_grasp]") {
  // These are distances of a body that moves with speed 1, as functions of the share x.
  int num_asked = 0;
  const auto proven = [&](double tolerance, const auto& distance) {
    num_asked = 0;
    return are_apart_on_way(1.0, tolerance, [&](double share, double enough) {
      ++num_asked;
      return std::min(distance(share), enough);
    });
  };
  // It passes a thin wall that stands 1 mm, 2 um and no distance beside the way at 0.3712.
  const auto passing = [](double gap) {
    return [gap](double x) { return std::max(gap, std::hypot(x - 0.3712, gap) - 1e-12); };
  };
  CHECK(proven(1e-5, passing(1e-3)));
  CHECK(proven(1e-5, passing(2e-6)));
  CHECK_FALSE(proven(1e-5, passing(0.0)));
  // It moves toward a touch of gap g at half the speed: to the end if g is there, up to the
  // tolerance if not.
  const auto closing = [](double gap) {
    return [gap](double x) { return std::max(0.0, gap + 0.5 * (1.0 - x)); };
  };
  CHECK(proven(1e-5, closing(2e-5)));
  CHECK(num_asked < 60);
  CHECK(proven(1e-5, closing(1e-6)));
  CHECK(proven(1e-5, closing(0.0)));
  CHECK_FALSE(proven(1e-5, closing(-1e-4)));  // It is cut before the end.
  CHECK(proven(1e-3, closing(-1e-4)));        // It is as deep as the tolerance allows.
  CHECK_FALSE(proven(1e-5, [](double x) { return 0.5 * x; }));  // It starts in touch.
  // A slide at 0.1 um is not free, but it is no endless work either.
  CHECK_FALSE(proven(1e-5, [](double) { return 1e-7; }));
  CHECK(num_asked <= 500);
  CHECK(proven(1e-5, [](double) { return 0.01; }));
  // A touch is found soon: the ends and three middles of what is widest, not everything before it.
  CHECK_FALSE(proven(1e-5, [](double x) { return std::abs(x - 0.75) < 1e-3 ? 0.0 : 1e-3; }));
  CHECK(num_asked <= 5);
  // A body that does not move stays where it is.
  CHECK(are_apart_on_way(0.0, 1e-5, [](double, double) { return 0.0; }));
  // Without a tolerance it has to be apart there, and rounding is no motion.
  for (const double speed : {0.0, 1e-17}) {
    CHECK_FALSE(are_apart_on_way(speed, 0.0, [](double, double) { return 0.0; }));
    CHECK(are_apart_on_way(speed, 0.0, [](double, double enough) { return enough; }));
  }
}

TEST_CASE("Jaws open as little as the clearance asks, by the step", "[grasp][pre_grasp]") {
  const double gap = 2e-5;
  const Pinch scene(gap);
  const double left = 0.0425 - 0.02 - gap;  // This is the way to the limit.
  // Without a retreat 5 mm take 3 of 10 steps of 2.248 mm each.
  const auto opened = scene.find({.largest_retreat = 0.0});
  REQUIRE(opened);
  CHECK(opened->opening == Approx(0.3));
  CHECK(opened->retreat == 0.0);
  CHECK(opened->clearance == Approx(gap + 0.3 * left).epsilon(1e-9));
  CHECK(opened->configuration.q[0] == Approx(0.02 + gap + 0.3 * left));
  CHECK(opened->configuration.q[1] == opened->configuration.q[0]);
  CHECK(opened->configuration.X_OH.matrix() == scene.grasp.X_OH.matrix());
  // Finer steps come nearer to 5 mm, and never stay below.
  const auto fine = scene.find({.largest_retreat = 0.0, .opening_steps = 1000});
  REQUIRE(fine);
  CHECK(fine->clearance >= 0.005);
  CHECK(fine->clearance < 0.005 + left / 1000);
  // With a retreat the first step is enough: the jaws are drawn off the box, whose upper side is 15
  // mm over the middle between the pads, and their lower side far enough below it.
  const auto drawn = scene.find({});
  REQUIRE(drawn);
  CHECK(drawn->opening == Approx(0.1));
  CHECK(drawn->retreat > 0.0);
  CHECK(drawn->clearance >= 0.005);
  CHECK(drawn->configuration.X_OH.translation().z() == Approx(-0.062 - drawn->retreat));
}

TEST_CASE("A grasp that touches has a way in, one that cuts the object has none",
          "[grasp][pre_grasp]") {
  const PreGraspOptions options{.largest_retreat = 0.0};
  CHECK(Pinch(1e-6).find(options));
  CHECK(Pinch(0.0).find(options));
  CHECK(Pinch(-5e-6).find(options));  // It is less than the tolerance.
  // Drawn back at once, the pads slide along the box farther than the tolerance. That they meet
  // there stops no way on which they come as near only within it.
  const auto opened = Pinch(-8e-6).find({});
  REQUIRE(opened);
  CHECK(opened->opening == Approx(0.3));
  CHECK(opened->retreat == 0.0);
  CHECK_FALSE(Pinch(-1e-4).find(options));
}

TEST_CASE("What stands beside the open jaws is not touched", "[grasp][pre_grasp]") {
  const Pinch scene(2e-5);
  // Walls 4 mm behind the fingers' backs leave no opening with 5 mm to both sides.
  double back = 0.0;
  for (const Vector3d& vertex : scene.collision.link_solid(1)->mesh().vertices) {
    if (std::abs(vertex.z()) < 0.03) back = std::max(back, vertex.x());
  }
  const auto wall = [&](double side) {
    return MeshQuery(
        box_at({0.002, 0.2, 0.06}, {side * (0.02 + 2e-5 + back + 0.004 + 0.001), 0.0, 0.0}));
  };
  const Surroundings walls{{}, {wall(1.0), wall(-1.0)}};
  CHECK_FALSE(scene.find({.largest_retreat = 0.0}, walls));
  // A retreat takes the gripper out from between them.
  const PreGraspOptions far{.largest_retreat = 0.3};
  const auto drawn = scene.find(far, walls);
  REQUIRE(drawn);
  CHECK(drawn->retreat > 0.0);
  // There is no way if a sheet thinner than any step of a search by samples stands behind the
  // gripper.
  const double behind =
      scene.grasp.X_OH.translation().z() + scene.collision.link_solid(0)->box().min().z() - 0.01;
  Surroundings closed = walls;
  closed.obstacles.emplace_back(box_at({0.5, 0.5, 1e-5}, {0.0, 0.0, behind}));
  CHECK_FALSE(scene.find(far, closed));
  // Beyond the sheet the gripper would be clear of everything: only the way there is not free.
  HandConfiguration beyond = scene.grasp;
  beyond.X_OH.translation().z() -= 0.3;
  const Scene all{scene.hand, scene.collision, scene.object,
                  SurroundingsCollision(scene.hand, closed)};
  CHECK(all.clearance(beyond) > 0.005);
  CHECK(all.is_clear(beyond));
}

TEST_CASE("A palm in touch is drawn back", "[grasp][pre_grasp]") {
  Pinch scene(2e-5);
  scene.object = MeshQuery(box_at({0.04, 0.02, 0.1}, {0.0, 0.0, -0.012 + 1e-5}));
  const auto found = scene.find({.opening_steps = 1});
  REQUIRE(found);
  CHECK(found->retreat == Approx(0.01));  // It is the first that clears the palm by 5 mm.
  CHECK_FALSE(scene.find({.largest_retreat = 0.0}));
}

TEST_CASE("A search ends where many ways cannot be proven, though a later one could be",
          "[grasp][pre_grasp]") {
  // A block slides 0.1 m, the first quarter of it 0.2 um above a bar, more if the palm retreats:
  // 500 distances prove a way of 5 mm upward free, but none of one of 1 mm.
  HandModel hand;
  hand.name = "slide";
  hand.links.resize(2);
  hand.palm.link = 0;
  hand.palm.direction_H = -Vector3d::UnitY();
  hands::Joint joint;
  joint.name = "slide";
  joint.type = hands::JointType::Prismatic;
  joint.parent_link = 0;
  joint.child_link = 1;
  joint.axis_J = Vector3d::UnitX();
  joint.lower = -0.05;
  joint.upper = 0.05;
  joint.closing_sign = 1;
  hand.joints.push_back(joint);
  hand.links[1].parent_link = 0;
  hand.links[1].parent_joint = 0;
  hand.links[1].mesh_L = geometry::box({0.01, 0.01, 0.01});
  const MeshQuery object(box_at({0.03, 0.01, 0.01}, {0.045, -0.01 - 2e-7, 0.0}));
  const HandConfiguration grasp{RigidTransform::Identity(), VectorXd::Constant(1, 0.05)};
  const auto find = [&](double retreat_step) {
    return find_pre_grasp(
        {hand, hands::HandCollision(hand), object, SurroundingsCollision(hand, {})}, grasp,
        {.largest_retreat = 0.005, .retreat_step = retreat_step, .opening_steps = 1});
  };
  const auto found = find(0.005);
  REQUIRE(found);
  CHECK(found->retreat == Approx(0.005));
  CHECK_FALSE(find(5e-5));  // The same way is among these, the 101st.
}

TEST_CASE("Links do not pass through each other on the way", "[grasp][pre_grasp]") {
  // Two blocks on slides along x change places as they open.
  HandModel hand;
  hand.name = "crossing";
  hand.links.resize(3);
  hand.palm.link = 0;
  for (int i = 0; i < 2; ++i) {
    hands::Link& link = hand.links[static_cast<std::size_t>(i) + 1];
    link.mesh_L = geometry::box({0.01, 0.01, 0.01});
    link.parent_link = 0;
    link.parent_joint = i;
    hands::Joint joint;
    joint.name = i == 0 ? "to_right" : "to_left";
    joint.type = hands::JointType::Prismatic;
    joint.parent_link = 0;
    joint.child_link = i + 1;
    joint.axis_J = i == 0 ? Vector3d::UnitX() : Vector3d(-Vector3d::UnitX());
    joint.lower = -0.05;
    joint.upper = 0.05;
    joint.closing_sign = 1;
    hand.joints.push_back(joint);
  }
  const HandConfiguration grasp{RigidTransform::Identity(), Eigen::Vector2d(0.05, 0.05)};
  const MeshQuery object(box_at({0.01, 0.01, 0.01}, {0.0, 0.0, 0.02}));
  const auto find = [&](const PreGraspOptions& options) {
    return find_pre_grasp(
        {hand, hands::HandCollision(hand), object, SurroundingsCollision(hand, {})}, grasp,
        options);
  };
  const PreGraspOptions at_once{.largest_retreat = 0.0, .opening_steps = 1};
  CHECK_FALSE(find(at_once));
  // A fifth of the way is as far as they can go, and they are not yet past each other.
  const auto part = find({.largest_retreat = 0.0, .opening_steps = 5});
  REQUIRE(part);
  CHECK(part->opening == Approx(0.2));
  // Excluded pairs may pass each other.
  hand.exclusions = {{1, 2}};
  CHECK(find(at_once));
}

namespace {

/// A slide along an axis of its parent, from 50 mm below its origin to `upper` [m].
void add_slide(HandModel& hand, const char* name, int parent, int child, const Vector3d& axis,
               int closing_sign, double upper) {
  hands::Joint joint;
  joint.name = name;
  joint.type = hands::JointType::Prismatic;
  joint.parent_link = parent;
  joint.child_link = child;
  joint.axis_J = axis;
  joint.lower = -0.05;
  joint.upper = upper;
  joint.closing_sign = closing_sign;
  hands::Link& link = hand.links[static_cast<std::size_t>(child)];
  link.parent_link = parent;
  link.parent_joint = static_cast<int>(hand.joints.size());
  hand.joints.push_back(joint);
}

}  // namespace

TEST_CASE("Neutral joints open along where that is allowed and nothing else is free",
          "[grasp][pre_grasp]") {
  // Two blocks on slides along x change places as they open; one of them stands on a slide along y
  // that neither opens nor closes, 30 mm aside when it is at rest.
  HandModel hand;
  hand.name = "passing";
  hand.links.resize(4);
  hand.palm.link = 0;
  const auto slide = [&](const char* name, int parent, int child, const Vector3d& axis, int sign) {
    add_slide(hand, name, parent, child, axis, sign, 0.05);
  };
  slide("to_right", 0, 1, Vector3d::UnitX(), 1);
  slide("aside", 0, 2, Vector3d::UnitY(), 0);
  slide("to_left", 2, 3, -Vector3d::UnitX(), 1);
  hand.joints[1].X_PJ.translation().y() = 0.03;
  for (const std::size_t link : {1, 3}) hand.links[link].mesh_L = geometry::box({0.01, 0.01, 0.01});
  const HandConfiguration grasp{RigidTransform::Identity(), Vector3d(0.05, -0.03, 0.05)};
  const MeshQuery object(box_at({0.01, 0.01, 0.01}, {0.0, 0.0, 0.02}));
  const auto find = [&](const HandConfiguration& at, const PreGraspOptions& options) {
    return find_pre_grasp(
        {hand, hands::HandCollision(hand), object, SurroundingsCollision(hand, {})}, at, options);
  };
  CHECK_FALSE(find(grasp, {.largest_retreat = 0.0, .opening_steps = 1}));
  const PreGraspOptions with_neutral{
      .largest_retreat = 0.0, .opening_steps = 1, .open_neutral = true};
  const auto passing = find(grasp, with_neutral);
  REQUIRE(passing);
  CHECK((passing->configuration.q - Vector3d(-0.05, 0.0, -0.05)).norm() < 1e-15);
  CHECK(passing->opening == 1.0);
  // Where closing joints are enough, the neutral one stays.
  HandConfiguration apart = grasp;
  apart.q[1] = -0.01;
  const auto found = find(apart, with_neutral);
  REQUIRE(found);
  CHECK(found->configuration.q[1] == -0.01);
}

TEST_CASE("A joint whose opening moves a finger onto the object stays", "[grasp][pre_grasp]") {
  // A finger before a wall: the first slide opens away from the wall, the second one, which it
  // carries, opens towards it, and farther.
  HandModel hand;
  hand.name = "slides";
  hand.links.resize(3);
  hand.palm.link = 0;
  const auto slide = [&](const char* name, int parent, int child, const Vector3d& axis, int sign) {
    add_slide(hand, name, parent, child, axis, sign, 0.1);
  };
  slide("away", 0, 1, Vector3d::UnitX(), 1);
  slide("onto", 1, 2, Vector3d::UnitX(), -1);
  HandConfiguration grasp{RigidTransform::Identity(), Eigen::Vector2d(0.0, 0.0149)};
  SECTION("by itself") {}
  const auto follow = [&](bool breakaway) {
    hand.links.resize(4);
    slide("leader", 0, 3, Vector3d::UnitY(), -1);
    hand.joints[1].coupling = hands::Coupling{.leader = 2, .breakaway = breakaway};
    grasp.q = Eigen::Vector3d(0.0, 0.0149, 0.0149);
  };
  SECTION("as it follows a joint that moves nothing near the object") { follow(false); }
  SECTION("as it follows such a joint by a clutch") { follow(true); }
  hand.links[2].mesh_L = geometry::box({0.01, 0.01, 0.01});
  const MeshQuery wall(box_at({0.01, 0.1, 0.1}, {0.025, 0.0, 0.0}));
  const auto find = [&](bool leave_pressing) {
    return find_pre_grasp(
        {hand, hands::HandCollision(hand), wall, SurroundingsCollision(hand, {})}, grasp,
        {.largest_retreat = 0.0, .open_neutral = true, .leave_pressing = leave_pressing});
  };
  CHECK_FALSE(find(false));
  const auto found = find(true);
  REQUIRE(found);
  CHECK(found->configuration.q[0] == Approx(-0.005));
  CHECK(found->configuration.q[1] == 0.0149);
  CHECK(found->clearance == Approx(0.0051));
}

TEST_CASE(
    "Ways of the Barrett and the human hand are clear wherever they are looked at, and no "
    "option before them is",
    "[grasp][pre_grasp]") {
  Random random(11);
  int num_found = 0;
  for (const char* name : {"barrett", "human_hand"}) {
    const HandModel hand = hands::find_hand(name);
    for (int trial = 0; trial < 2; ++trial) {
      Scene scene{hand, hands::HandCollision(hand), MeshQuery(geometry::ball(0.03, 2)),
                  SurroundingsCollision(hand, {-0.034, {}})};
      HandConfiguration start = hands::open_configuration(hand);
      // The palm is above the ball, which lies on the table, and looks down, a little askew.
      start.X_OH.linear() =
          (AngleAxisd(std::numbers::pi, Vector3d::UnitX()) *
           AngleAxisd(random.uniform(0.0, 0.3), testing::random_direction(random)))
              .toRotationMatrix();
      start.X_OH.translation() =
          -(start.X_OH.linear() * (hand.palm.center_H + 0.09 * hand.palm.direction_H));
      if (!scene.is_clear(start)) continue;
      const HandConfiguration grasp = closed_onto(scene, start);
      const PreGraspOptions options{
          .largest_retreat = 0.06, .retreat_step = 0.03, .opening_steps = 3};
      const auto found =
          find_pre_grasp({hand, scene.collision, scene.object, scene.surroundings}, grasp, options);
      // This is what the contract calls free, by exact tests at many poses.
      const auto looks_free = [&](const HandConfiguration& from) {
        for (int i = 0; i < 30; ++i) {
          if (!scene.is_clear(interpolated(from, grasp, i / 30.0))) return false;
        }
        return true;
      };
      INFO(name << " " << trial << " found " << found.has_value());
      bool is_before = true;
      for (const HandConfiguration& option : openings_and_retreats(hand, grasp, options)) {
        const double clearance = scene.clearance(option);
        if (is_found_there(found, option)) {
          is_before = false;
          CHECK(found->clearance == Approx(clearance).epsilon(1e-9));
          CHECK(looks_free(found->configuration));
          ++num_found;
          break;
        }
        CHECK((clearance < options.clearance || !looks_free(option)));
      }
      CHECK(found.has_value() != is_before);
    }
  }
  CHECK(num_found >= 2);
}

TEST_CASE("What stopped one way does not change what is said of another", "[grasp][pre_grasp]") {
  // A search asks first whether bodies meet as they did before; a way that is checked alone has no
  // before.
  PlannerOptions planning;
  planning.targets.search = TargetSearch::Reach;
  planning.style = GraspStyle::Auto;
  planning.max_attempts = 8;
  planning.count = 8;
  planning.pre_grasps = false;
  planning.weak.reset();
  const PreGraspOptions options{.retreat_step = 0.02, .opening_steps = 6};
  int num_after_others = 0;
  int num_found_after_others = 0;
  for (const char* name : {"barrett", "human_hand"}) {
    const HandModel hand = hands::find_hand(name);
    const hands::HandCollision collision(hand);
    const SurroundingsCollision surroundings(hand, {});
    const ObjectModel object = prepare_object(geometry::torus(0.03, 0.015), hand, planning);
    const PreGraspScene scene{hand, collision, object.query, surroundings};
    for (const Grasp& planned :
         plan_grasps(object, hand, planning, {}, {.num_threads = 1}).grasps) {
      const HandConfiguration& grasp = planned.configuration;
      const auto found = find_pre_grasp(scene, grasp, options);
      int num_stopped = 0;
      bool is_there = false;
      for (const HandConfiguration& from : openings_and_retreats(hand, grasp, options)) {
        const auto alone = grasp::internal::checked_pre_grasp(scene, from, grasp, options);
        is_there = is_found_there(found, from);
        CHECK(alone.has_value() == is_there);
        if (is_there) break;
        ++num_stopped;
      }
      CHECK(found.has_value() == is_there);
      num_after_others += std::max(0, num_stopped - 1);
      num_found_after_others += is_there && num_stopped > 0 ? 1 : 0;
    }
  }
  CHECK(num_after_others >= 50);
  CHECK(num_found_after_others >= 5);
}

TEST_CASE("Options and grasps that make no sense are refused", "[grasp][pre_grasp]") {
  const Pinch scene(2e-5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const PreGraspOptions& bad :
       {PreGraspOptions{.clearance = 0.0}, PreGraspOptions{.largest_retreat = -0.1},
        PreGraspOptions{.retreat_step = 0.0}, PreGraspOptions{.retreat_step = 1e-6},
        PreGraspOptions{.retreat_step = nan}, PreGraspOptions{.opening_steps = 0},
        PreGraspOptions{.way_tolerance = 0.0}}) {
    CHECK_THROWS_AS(scene.find(bad), InvalidInput);
  }
  Pinch beyond(0.03);
  CHECK_THROWS_AS(beyond.find({}), InvalidInput);
}

TEST_CASE("Link poses that are known are not computed again", "[grasp][pre_grasp]") {
  const Pinch scene(2e-5);
  const SurroundingsCollision surroundings(scene.hand, {});
  const auto find = [&](const std::vector<RigidTransform>& X_OL) {
    return find_pre_grasp({scene.hand, scene.collision, scene.object, surroundings},
                          hands::PosedConfiguration{scene.grasp, X_OL}, {});
  };
  std::vector<RigidTransform> X_OL = hands::forward_kinematics(scene.hand, scene.grasp);
  const std::optional<PreGrasp> expected = scene.find({});
  const std::optional<PreGrasp> found = find(X_OL);
  REQUIRE(expected);
  REQUIRE(found);
  CHECK(found->configuration.q == expected->configuration.q);
  CHECK(found->configuration.X_OH.matrix() == expected->configuration.X_OH.matrix());
  CHECK(found->clearance == expected->clearance);
  X_OL.pop_back();
  CHECK_THROWS_WITH(find(X_OL), Contains("number of link poses"));
}

}  // namespace test_pre_grasp
