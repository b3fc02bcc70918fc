#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "grasp/fitting_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/palm_placement.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "support/catch.hpp"

namespace test_palm_placement {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using geometry::RigidTransform;
using grasp::PalmPlacement;
using grasp::TargetContacts;
using testing::equilateral_targets;
using testing::Scene;
using testing::targets_at;

constexpr double kPi = std::numbers::pi;

TEST_CASE("A target triangle has two palm directions, opposite and along its normal",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  base::Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vector3d> points, normals;
    for (int i = 0; i < 3; ++i) {
      points.push_back(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
                           .normalized() *
                       0.05);
      normals.push_back(points.back());
    }
    const TargetContacts targets = targets_at(points, normals);
    const auto placements = grasp::palm_placements(scene.object, targets, std::nullopt, kPi);
    REQUIRE(placements.size() == 2);
    CHECK((placements[0].direction_O + placements[1].direction_O).norm() < 1e-12);
    for (const PalmPlacement& placement : placements) {
      CHECK(placement.direction_O.norm() == Approx(1.0).epsilon(1e-12));
      for (int i = 0; i < 3; ++i) {
        const Vector3d edge = points[(i + 1) % 3] - points[i];
        // A cross product of edges loses accuracy as the triangle gets thin.
        const double thinness =
            (points[1] - points[0]).cross(points[2] - points[0]).norm() / (0.05 * 0.05);
        CHECK(std::abs(placement.direction_O.dot(edge)) < 1e-14 / thinness);
      }
    }

    // With an approach only the nearer one is left.
    const Vector3d approach =
        3.0 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto approached = grasp::palm_placements(scene.object, targets, approach, kPi / 2.0);
    REQUIRE(approached.size() == 1);
    CHECK(approached[0].direction_O.dot(approach) > 0.0);
    CHECK(std::min((approached[0].direction_O - placements[0].direction_O).norm(),
                   (approached[0].direction_O - placements[1].direction_O).norm()) < 1e-12);
  }
}

TEST_CASE("The palm direction with more room comes first", "[grasp][hand_fitting]") {
  // The box is tall and has targets around its upper end: the palm has 5 cm of object to clear
  // above them, 25 cm below.
  const Scene scene(geometry::box(Vector3d(0.06, 0.06, 0.30)));
  for (const double end : {1.0, -1.0}) {
    const double z = end * 0.10;
    for (const bool is_reversed : {false, true}) {
      std::vector<Vector3d> points = {{0.03, 0.0, z}, {-0.03, 0.02, z}, {-0.03, -0.02, z}};
      std::vector<Vector3d> normals = {{1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}};
      if (is_reversed) std::swap(points[1], points[2]);
      const auto placements =
          grasp::palm_placements(scene.object, targets_at(points, normals), std::nullopt, kPi);
      REQUIRE(placements.size() == 2);
      CHECK((placements[0].direction_O - Vector3d(0, 0, -end)).norm() < 1e-9);
    }
  }
}

TEST_CASE("Two targets have sixteen palm directions around their axis", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  base::Random random(9);
  for (int trial = 0; trial < 10; ++trial) {
    // Trial 0 is along z, trials 1 and 2 along the other axes, where a helper axis could be
    // parallel.
    Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (trial < 3) axis = Vector3d::Unit((trial + 2) % 3);
    axis.normalize();
    const TargetContacts targets = targets_at({0.05 * axis, -0.05 * axis}, {axis, -axis});
    const auto placements = grasp::palm_placements(scene.object, targets, std::nullopt, kPi);
    REQUIRE(placements.size() == 16);
    const Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
    std::vector<double> angles;
    for (const PalmPlacement& placement : placements) {
      CHECK(placement.direction_O.norm() == Approx(1.0).epsilon(1e-12));
      CHECK(std::abs(placement.direction_O.dot(axis)) < 1e-12);
      angles.push_back(std::atan2(placement.direction_O.dot(y), placement.direction_O.dot(x)));
    }
    std::sort(angles.begin(), angles.end());
    for (int i = 0; i < 15; ++i) {
      CHECK(angles[i + 1] - angles[i] == Approx(2.0 * kPi / 16.0).epsilon(1e-9));
    }

    // With an approach, those nearest to it come first.
    const Vector3d approach(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto approached = grasp::palm_placements(scene.object, targets, approach, kPi / 2.0);
    REQUIRE_FALSE(approached.empty());
    for (const PalmPlacement& placement : approached) {
      CHECK(std::abs(placement.direction_O.dot(axis)) < 1e-12);
      CHECK(placement.direction_O.dot(approach) <= approached[0].direction_O.dot(approach) + 1e-12);
    }
  }
}

TEST_CASE("More than three targets have the normals of their least-squares plane",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  base::Random random(3);
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<Vector3d> points, normals;
    Eigen::MatrixXd rows(5, 3);
    for (int i = 0; i < 5; ++i) {
      const double angle = i * 2.0 * kPi / 5.0;
      points.push_back(
          Vector3d(0.04 * std::cos(angle), 0.05 * std::sin(angle), random.uniform(-0.01, 0.01)));
      normals.push_back(points.back());
      rows.row(i) = points.back();
    }
    rows.rowwise() -= rows.colwise().mean().eval();
    const Vector3d expected =
        Eigen::JacobiSVD<Eigen::MatrixXd>(rows, Eigen::ComputeThinV).matrixV().col(2);
    const auto placements =
        grasp::palm_placements(scene.object, targets_at(points, normals), std::nullopt, kPi);
    REQUIRE(placements.size() == 2);
    CHECK((placements[0].direction_O + placements[1].direction_O).norm() < 1e-12);
    CHECK(std::abs(std::abs(placements[0].direction_O.dot(expected)) - 1.0) < 1e-12);
  }
}

// The following tests are about the assignment of targets to fingers.

/// Returns the fingers in the order of the targets: by the permutation of the further targets to
/// the further fingers with the least squared angular error around the palm axis, where the thumb's
/// pad is turned to the seed and the shared spread is free. It is brute force over the spread.
std::vector<int> best_assignment(const hands::HandModel& hand, const TargetContacts& targets,
                                 const std::vector<int>& fingers, const Vector3d& direction) {
  const Vector3d center = targets.centroid();
  const auto azimuth = [](const Vector3d& vector, const Vector3d& zero, const Vector3d& axis) {
    return std::atan2(axis.dot(zero.cross(vector)),
                      zero.dot(vector) - zero.dot(axis) * vector.dot(axis));
  };
  std::vector<int> order(fingers.begin() + 1, fingers.end());
  std::sort(order.begin(), order.end());
  std::vector<int> best;
  double least = std::numeric_limits<double>::infinity();
  do {
    const int spread = hand.joint_index("finger_1_spread");
    for (int step = 0; step <= 180; ++step) {
      hands::HandConfiguration configuration = hands::open_configuration(hand);
      configuration.q[spread] = step * kPi / 180.0;
      hands::apply_couplings(hand, configuration.q);
      const auto X_HL = hands::forward_kinematics(hand, configuration);
      const auto pad_at = [&](int finger) -> Vector3d {
        return hands::pad_pose(hand, *hand.fingers[finger].tip_pad, X_HL).translation() -
               hand.palm.center_H;
      };
      double error = 0.0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const double of_target = azimuth(targets.contacts[i + 1].point_O - center,
                                         targets.contacts[0].point_O - center, direction);
        const double of_finger =
            azimuth(pad_at(order[i]), pad_at(fingers[0]), hand.palm.direction_H);
        error += std::pow(std::remainder(of_target - of_finger, 2.0 * kPi), 2);
      }
      if (error < least) {
        least = error;
        best = order;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  best.insert(best.begin(), fingers[0]);
  return best;
}

std::vector<int> fingers_of(const TargetContacts& targets) {
  std::vector<int> fingers;
  for (const auto& target : targets.contacts) fingers.push_back(target.finger.value());
  return fingers;
}

TEST_CASE("The seed gets the first finger and the others the fingers on their sides",
          "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const grasp::RequestedParts parts = grasp::requested_parts(hand, {});
  const std::vector<int>& fingers = parts.fingers;
  REQUIRE(fingers.size() == 3);
  REQUIRE(fingers[0] == hand.thumb());
  base::Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    RigidTransform X_OT = RigidTransform::Identity();
    X_OT.linear() = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                       random.uniform(-1, 1), random.uniform(-1, 1))
                        .normalized()
                        .toRotationMatrix();
    X_OT.translation() = Vector3d(random.uniform(), random.uniform(), random.uniform());
    const TargetContacts targets = equilateral_targets(0.05, random.uniform(-3, 3), X_OT);
    TargetContacts swapped = targets;
    std::swap(swapped.contacts[1], swapped.contacts[2]);
    for (const double side : {1.0, -1.0}) {
      const PalmPlacement placement{side * X_OT.linear().col(2)};
      const TargetContacts assigned = grasp::assign_fingers(hand, targets, parts, placement);
      REQUIRE(assigned.contacts.size() == 3);
      for (int i = 0; i < 3; ++i) {
        CHECK(assigned.contacts[i].point_O == targets.contacts[i].point_O);
        CHECK(assigned.contacts[i].outward_normal_O == targets.contacts[i].outward_normal_O);
        CHECK(assigned.contacts[i].patch == targets.contacts[i].patch);
      }
      const std::vector<int> result = fingers_of(assigned);
      CHECK(result[0] == fingers[0]);
      CHECK(std::is_permutation(result.begin(), result.end(), fingers.begin(), fingers.end()));
      CHECK(result == best_assignment(hand, targets, fingers, placement.direction_O));

      // The order of the targets does not matter, only where they are.
      const std::vector<int> after_swap =
          fingers_of(grasp::assign_fingers(hand, swapped, parts, placement));
      CHECK(after_swap == std::vector<int>{result[0], result[2], result[1]});

      // Seen from the other side of the triangle, left and right are exchanged.
      const PalmPlacement opposite{-placement.direction_O};
      const std::vector<int> from_behind =
          fingers_of(grasp::assign_fingers(hand, targets, parts, opposite));
      CHECK(from_behind == std::vector<int>{result[0], result[2], result[1]});
    }
  }
}

TEST_CASE("Without the thumb the seed gets the first finger that is asked for",
          "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const int finger_1 = hand.finger_index("finger_1"), finger_2 = hand.finger_index("finger_2");
  const TargetContacts targets = targets_at({{0.03, 0, 0}, {-0.03, 0, 0}}, {{1, 0, 0}, {-1, 0, 0}});
  const PalmPlacement placement{Vector3d(0, 0, -1)};
  CHECK(fingers_of(grasp::assign_fingers(hand, targets, {{finger_1, finger_2}}, placement)) ==
        std::vector<int>{finger_1, finger_2});
  CHECK(fingers_of(grasp::assign_fingers(hand, targets, {{finger_2, finger_1}}, placement)) ==
        std::vector<int>{finger_2, finger_1});
}

}  // namespace

}  // namespace test_palm_placement
