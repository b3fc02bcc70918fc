#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "grasp/guidance_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/medial_symmetry.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "support/catch.hpp"

namespace test_medial_symmetry {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using geometry::MedialBall;
using grasp::MedialCandidate;
using grasp::MedialSymmetry;
using grasp::SymmetryKind;
using testing::at_voxel_level;
using testing::chi_square;
using testing::Guided;

std::vector<MedialBall> balls_at(const std::vector<Vector3d>& centers) {
  std::vector<MedialBall> balls;
  for (const Vector3d& center : centers) {
    balls.emplace_back();
    balls.back().center = center;
    balls.back().radius = 0.01;
  }
  return balls;
}

std::vector<MedialCandidate> candidates_of(const std::vector<MedialCandidate>& all, std::size_t i) {
  std::vector<MedialCandidate> own;
  for (const MedialCandidate& candidate : all) {
    if (candidate.symmetry == static_cast<std::int32_t>(i)) own.push_back(candidate);
  }
  return own;
}

/// Returns `count` × `count` centers in a square of the x-y plane with a corner at the origin.
std::vector<Vector3d> square_of_centers(int count, double spacing) {
  std::vector<Vector3d> centers;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) centers.emplace_back(i * spacing, j * spacing, 0.0);
  }
  return centers;
}

TEST_CASE("Centers on a line are an axis with eight candidates", "[grasp][medial_symmetry]") {
  const Vector3d along = Vector3d(1, 2, -2) / 3.0;
  std::vector<Vector3d> centers;
  for (int i = 0; i < 41; ++i) centers.push_back(Vector3d(1, 2, 3) + 0.002 * i * along);
  const auto symmetries = grasp::medial_symmetries(balls_at(centers), 0.0101, 0.08, {});
  const auto candidates = grasp::medial_candidates(symmetries, 1);
  REQUIRE(candidates.size() == 8 * centers.size());
  CHECK(symmetries[20].neighbors == 10);
  CHECK(symmetries[0].neighbors == 5);
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    CHECK(symmetries[i].kind == SymmetryKind::Axis);
    CHECK(symmetries[i].ratio < 1e-12);
    CHECK(std::abs(symmetries[i].first_axis_O.dot(along)) > 1.0 - 1e-12);
    // There are four directions a right angle apart, each with both orientations along the line.
    const auto own = candidates_of(candidates, i);
    REQUIRE(own.size() == 8);
    for (std::size_t k = 0; k < 8; ++k) {
      CHECK(own[k].center_O == centers[i]);
      CHECK(std::abs(own[k].outward_O.dot(along)) < 1e-9);
      CHECK(std::abs(std::abs(own[k].axis_O.dot(along)) - 1.0) < 1e-9);
      int same = 0, across = 0, opposite = 0;
      for (std::size_t l = 0; l < 8; ++l) {
        const double cosine = own[k].outward_O.dot(own[l].outward_O);
        if (cosine > 1.0 - 1e-9) {
          ++same;
          if (l != k) CHECK(own[l].axis_O == Vector3d(-own[k].axis_O));
        }
        if (std::abs(cosine) < 1e-9) ++across;
        if (cosine < -1.0 + 1e-9) ++opposite;
      }
      CHECK(same == 2);
      CHECK(across == 4);
      CHECK(opposite == 2);
    }
  }
}

TEST_CASE("The border of a plane of centers is a rim, its inside nothing",
          "[grasp][medial_symmetry]") {
  // The second moments of a half disk of radius 1 are 1/4 along its straight side and 1/4 − (4/3π)²
  // across, so that the ratio is 0.279; that of a disk is 1. The ratio is that of a fine grid of
  // centers to some percent.
  const int n = 61;
  const double spacing = 0.001;
  const auto centers = square_of_centers(n, spacing);
  const auto symmetries = grasp::medial_symmetries(balls_at(centers), 0.0155, 0.06, {});
  const auto candidates = grasp::medial_candidates(symmetries, 1);
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * n + j); };

  const std::size_t middle = at(n / 2, n / 2);
  CHECK(symmetries[middle].kind == SymmetryKind::Interior);
  CHECK(symmetries[middle].ratio == Approx(1.0).epsilon(0.01));
  CHECK(candidates_of(candidates, middle).empty());

  const double half_disk = 1.0 - 4.0 * std::pow(4.0 / (3.0 * std::numbers::pi), 2);
  struct Side {
    std::size_t index;
    Vector3d outward;
  };
  for (const Side& side :
       {Side{at(0, n / 2), -Vector3d::UnitX()}, Side{at(n - 1, n / 2), Vector3d::UnitX()},
        Side{at(n / 2, 0), -Vector3d::UnitY()}, Side{at(n / 2, n - 1), Vector3d::UnitY()}}) {
    const MedialSymmetry& rim = symmetries[side.index];
    CHECK(rim.kind == SymmetryKind::Rim);
    CHECK(rim.ratio == Approx(half_disk).epsilon(0.15));
    const auto own = candidates_of(candidates, side.index);
    REQUIRE(own.size() == 2);
    CHECK(own[0].axis_O == Vector3d(-own[1].axis_O));
    for (const MedialCandidate& candidate : own) {
      CHECK((candidate.outward_O - side.outward).norm() < 1e-9);
      CHECK(std::abs(candidate.axis_O.dot(side.outward)) < 1e-9);
      CHECK(std::abs(candidate.axis_O.z()) < 1e-9);
    }
  }
}

TEST_CASE("Lone balls and balls at one point are told apart", "[grasp][medial_symmetry]") {
  std::vector<Vector3d> centers = {{0, 0, 0}, {1, 0, 0}, {1, 1e-7, 0}, {1, 0, 1e-7}};
  const auto symmetries = grasp::medial_symmetries(balls_at(centers), 0.01, 0.1, {});
  CHECK(symmetries[0].kind == SymmetryKind::Alone);
  CHECK(symmetries[0].neighbors == 0);
  for (int i = 1; i < 4; ++i) CHECK(symmetries[i].kind == SymmetryKind::Point);
  const auto candidates = grasp::medial_candidates(symmetries, 1);
  CHECK(candidates_of(candidates, 0).empty());
  for (std::size_t i = 1; i < 4; ++i) CHECK(candidates_of(candidates, i).size() == 8);
}

TEST_CASE("Random directions at one point are evenly spread and repeatable",
          "[grasp][medial_symmetry]") {
  const std::vector<Vector3d> centers(400, Vector3d(0.1, 0.2, 0.3));
  const auto symmetries = grasp::medial_symmetries(balls_at(centers), 0.01, 0.1, {});
  const auto candidates = grasp::medial_candidates(symmetries, 7);
  REQUIRE(candidates.size() == 3200);
  std::array<int, 8> octants{};
  std::array<int, 10> heights{};
  for (const MedialCandidate& candidate : candidates) {
    const Vector3d& d = candidate.outward_O;
    CHECK(d.norm() == Approx(1.0).epsilon(1e-12));
    CHECK(std::abs(candidate.axis_O.dot(d)) < 1e-12);
    ++octants[(d.x() > 0) + 2 * (d.y() > 0) + 4 * (d.z() > 0)];
    // Heights are even, by Archimedes.
    ++heights[std::min(9, static_cast<int>(5.0 * (d.z() + 1.0)))];
  }
  std::array<double, 8> eighths;
  eighths.fill(400.0);
  std::array<double, 10> tenths;
  tenths.fill(320.0);
  CHECK(chi_square(octants, eighths) < 24.3);  // This has 7 degrees of freedom, 0.001.
  CHECK(chi_square(heights, tenths) < 27.9);   // This has 9.
  const auto again = grasp::medial_candidates(symmetries, 7);
  CHECK(again[1234].outward_O == candidates[1234].outward_O);
  CHECK(grasp::medial_candidates(symmetries, 8)[1234].outward_O != candidates[1234].outward_O);
}

/// Returns the number of candidates of a ball.
std::size_t count_of(const std::vector<MedialCandidate>& candidates, std::size_t i) {
  return candidates_of(candidates, i).size();
}

TEST_CASE("A long cylinder has an axis all along and eight candidates per ball",
          "[grasp][medial_symmetry]") {
  const double radius = 0.02;
  const double length = 0.3;
  const grasp::ObjectModel object =
      grasp::build_object_model(geometry::cylinder(radius, length, 96), {});
  const auto symmetries = grasp::medial_symmetries(object, {}, 3);
  const auto candidates = grasp::medial_candidates(symmetries, 3);
  CHECK(symmetries.size() > 800);
  const double r_s = grasp::search_radius(object.mesh(), {});
  CHECK(r_s == Approx(0.05 * length));
  int inside = 0, wrong = 0;
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    const MedialSymmetry& symmetry = symmetries[i];
    // Balls of the two end faces have other centers, near the ends.
    if (std::abs(symmetry.ball.center.z()) > length / 2 - radius - r_s) continue;
    ++inside;
    if (symmetry.kind != SymmetryKind::Axis || count_of(candidates, i) != 8) ++wrong;
    CHECK(symmetry.ratio < 0.02);
    CHECK(std::abs(symmetry.first_axis_O.z()) > 0.99);
  }
  CHECK(inside > 500);
  CHECK(wrong == 0);
}

TEST_CASE("A plate has candidates along its rim only", "[grasp][medial_symmetry]") {
  const Vector3d half(0.10, 0.075, 0.005);
  const grasp::ObjectModel object =
      grasp::build_object_model(geometry::box(Vector3d(2.0 * half)), {});
  const auto symmetries = grasp::medial_symmetries(object, {.samples = 4000}, 3);
  const auto candidates = grasp::medial_candidates(symmetries, 3);
  const double r_s = grasp::search_radius(object.mesh(), {});  // It is 10 mm.
  CHECK(r_s == Approx(0.01));
  // The middle plane ends half a thickness from the sides.
  int inside = 0, wrong_inside = 0, rim = 0, wrong_rim = 0;
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    const MedialSymmetry& symmetry = symmetries[i];
    const Vector3d& c = symmetry.ball.center;
    const double to_x = half.x() - half.z() - std::abs(c.x());
    const double to_y = half.y() - half.z() - std::abs(c.y());
    if (std::min(to_x, to_y) > r_s) {
      ++inside;
      // There are some 40 centers in a disk, and by chance a few look longer than wide.
      if (count_of(candidates, i) != 0) ++wrong_inside;
    } else if (std::abs(to_x) < 0.1 * r_s && to_y > r_s) {
      ++rim;
      const auto own = candidates_of(candidates, i);
      const Vector3d outward(c.x() > 0.0 ? 1.0 : -1.0, 0.0, 0.0);
      if (own.size() != 2 || own[0].outward_O.dot(outward) < 0.8) ++wrong_rim;
    }
  }
  INFO(wrong_inside << " of " << inside << " inside, " << wrong_rim << " of " << rim
                    << " on the rim");
  CHECK(inside > 2000);
  CHECK(wrong_inside < inside / 10);
  CHECK(rim > 20);
  CHECK(wrong_rim < rim / 3);  // There are some 20 centers in half a disk.
}

TEST_CASE("A ball is tried from random directions, and the planner says so",
          "[grasp][medial_symmetry]") {
  const Guided guided(geometry::ball(0.04, 5), at_voxel_level("ma"));
  const auto counts = guided.guidance->counts();
  CHECK(counts.at("balls at one point, tried from random directions") > 900);
  CHECK(counts.at("candidates") ==
        8 * counts.at("balls at one point, tried from random directions") +
            8 * counts.at("balls on an axis") + 2 * counts.at("balls on a rim"));
}

TEST_CASE("The Barrett hand closes about the line through its spreading fingers' bases",
          "[grasp][medial_symmetry]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const Vector3d axis = hands::closing_axis_H(hand);
  CHECK(std::abs(axis.dot(hand.palm.direction_H)) < 1e-12);
  CHECK(axis.norm() == Approx(1.0));
  const hands::Finger& first = hand.fingers[hand.finger_index("finger_1")];
  const hands::Finger& second = hand.fingers[hand.finger_index("finger_2")];
  const Vector3d line = hand.joints[first.joints[0]].X_PJ.translation() -
                        hand.joints[second.joints[0]].X_PJ.translation();
  // The thumb stands 0.8 mm aside.
  CHECK(std::abs(axis.dot(line.normalized())) > 1.0 - 1e-4);
  const Vector3d center = hands::grasp_center_H(hand);
  const double before = (center - hand.palm.center_H).dot(hand.palm.direction_H);
  // A manufacturer's model puts its grasp frame 40 mm before the palm.
  CHECK(before > 0.03);
  CHECK(before < 0.06);
}

TEST_CASE("A palm is put where it is wanted", "[grasp][medial_symmetry]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const Vector3d axis_H = hands::closing_axis_H(hand);
  const Vector3d direction = Vector3d(1, -2, 0.5).normalized();
  const Vector3d axis = hands::turned_axis(hands::any_normal(direction), direction, 0.7);
  const Vector3d point(0.1, 0.2, 0.3);
  const auto X_OH = hands::palm_pose(hand, axis_H, hand.palm.center_H, direction, axis, point);
  CHECK((X_OH.linear() * X_OH.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(X_OH.linear().determinant() == Approx(1.0));
  CHECK((X_OH.linear() * hand.palm.direction_H - direction).norm() < 1e-12);
  CHECK((X_OH.linear() * axis_H - axis).norm() < 1e-12);
  CHECK((X_OH * hand.palm.center_H - point).norm() < 1e-12);
}

}  // namespace

}  // namespace test_medial_symmetry
