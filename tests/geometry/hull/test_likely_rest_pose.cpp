#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "geometry/hull/random_solid.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/angle.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/likely_rest_pose.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_likely_rest_pose {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Vector3d;
using graspfit::testing::random_solid;
using graspfit::testing::random_unit;

namespace {

double sum_of(const std::vector<LikelyRestPose>& poses) {
  return std::accumulate(poses.begin(), poses.end(), 0.0,
                         [](double sum, const auto& pose) { return sum + pose.probability; });
}

/// The share of all directions under which a rectangle of these sides is seen from a point at this
/// distance over its middle.
double share_of_rectangle(double a, double b, double distance) {
  const double ra = std::hypot(a, 2.0 * distance);
  const double rb = std::hypot(b, 2.0 * distance);
  return std::asin(a * b / (ra * rb)) / std::numbers::pi;
}

Vector3d outward_normal(const TriangleMesh& mesh, const Face& face) {
  const Vector3d& a = mesh.vertices[face[0]];
  return (mesh.vertices[face[1]] - a).cross(mesh.vertices[face[2]] - a).normalized();
}

/// Rolls a convex solid that falls with `down` below its center until it rests, from face to face,
/// by barycentric coordinates of the center's projection; returns the normal of the last face.
Vector3d rolled(const TriangleMesh& mesh, const Vector3d& center, const Vector3d& down) {
  std::size_t at = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vector3d normal = outward_normal(mesh, mesh.faces[f]);
    const double speed = normal.dot(down);
    if (speed <= 0.0) continue;
    const double time = normal.dot(mesh.vertices[mesh.faces[f][0]] - center) / speed;
    if (time >= nearest) continue;
    nearest = time;
    at = f;
  }
  for (;;) {
    const Face& face = mesh.faces[at];
    const Vector3d normal = outward_normal(mesh, face);
    double farthest = 0.0;
    std::size_t next = at;
    for (int k = 0; k < 3; ++k) {
      const Vector3d& a = mesh.vertices[face[k]];
      const Vector3d& b = mesh.vertices[face[(k + 1) % 3]];
      const double inside = (b - a).cross(center - a).dot(normal) / (b - a).norm();
      if (-inside <= farthest) continue;
      farthest = -inside;
      for (std::size_t g = 0; g < mesh.faces.size(); ++g) {
        const auto has = [&](std::int32_t vertex) {
          return std::find(mesh.faces[g].begin(), mesh.faces[g].end(), vertex) !=
                 mesh.faces[g].end();
        };
        if (g != at && has(face[k]) && has(face[(k + 1) % 3])) next = g;
      }
    }
    if (next == at) return normal;
    at = next;
  }
}

}  // namespace

TEST_CASE("A box rests on a face as often as the face is seen from its center",
          "[geometry][likely_rest_pose]") {
  const std::vector<LikelyRestPose> poses =
      likely_rest_poses(box({0.2, 0.1, 0.06}), Vector3d::Zero());
  REQUIRE(poses.size() == 6);
  const int axes[] = {2, 2, 1, 1, 0, 0};
  const double shares[] = {share_of_rectangle(0.2, 0.1, 0.03), share_of_rectangle(0.2, 0.06, 0.05),
                           share_of_rectangle(0.1, 0.06, 0.1)};
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(std::abs(poses[i].pose.up_O[axes[i]]) == Approx(1.0));
    CHECK(poses[i].probability == Approx(shares[i / 2]).epsilon(1e-12));
  }
  CHECK(poses[0].pose.height == Approx(0.03));
  CHECK(poses[0].pose.margin == Approx(0.05));
  CHECK(sum_of(poses) == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("A solid that tips from a face counts where it tips to", "[geometry][likely_rest_pose]") {
  // A column whose center of mass lies low: a lift of less than a millimeter takes it from either
  // end to a side, of much less from its upper end.
  const TriangleMesh column = box({0.01, 0.01, 0.2});
  const Vector3d low(0.0, 0.0, -0.08);
  CHECK(likely_rest_poses(column, low, {.least_lift = 0.0}).size() == 6);
  const double lift = std::hypot(0.005, 0.02) - 0.02;        // over an edge of the lower end
  const double upper_lift = std::hypot(0.005, 0.18) - 0.18;  // and of the upper one
  REQUIRE(upper_lift < 0.2 * lift);
  CHECK(likely_rest_poses(column, low, {.least_lift = 0.99 * upper_lift}).size() == 6);
  CHECK(likely_rest_poses(column, low, {.least_lift = 1.01 * upper_lift}).size() == 5);
  CHECK(likely_rest_poses(column, low, {.least_lift = 0.99 * lift}).size() == 5);
  const auto poses = likely_rest_poses(column, low, {.least_lift = 1.01 * lift});
  CHECK(poses.size() == 4);
  CHECK(sum_of(poses) == Approx(1.0).epsilon(1e-12));
  for (const LikelyRestPose& pose : poses) CHECK(pose.probability == Approx(0.25).epsilon(0.3));
}

TEST_CASE("A can rests on its ends and, once, on its side", "[geometry][likely_rest_pose]") {
  const TriangleMesh can = cylinder(0.034, 0.102, 96);
  const std::vector<LikelyRestPose> poses = likely_rest_poses(can, Vector3d::Zero());
  REQUIRE(poses.size() == 3);
  // A disk of radius r at distance d is seen under 2 pi (1 - d / sqrt(d^2 + r^2)).
  const double end = 0.5 * (1.0 - 0.051 / std::hypot(0.051, 0.034));
  CHECK(poses[0].probability == Approx(1.0 - 2.0 * end).epsilon(1e-3));
  CHECK(std::abs(poses[0].pose.up_O.z()) < 1e-9);
  for (const std::size_t i : {1, 2}) {
    CHECK(poses[i].probability == Approx(end).epsilon(5e-3));
    CHECK(std::abs(poses[i].pose.up_O.z()) == Approx(1.0));
    CHECK(poses[i].pose.height == Approx(0.051));
  }
  // Facets that tell themselves apart are many poses.
  CHECK(likely_rest_poses(can, Vector3d::Zero(), {.least_lift = 0.0}).size() == 98);
}

TEST_CASE("A ball rests in one way", "[geometry][likely_rest_pose]") {
  const auto poses = likely_rest_poses(ball(0.04, 3), Vector3d::Zero());
  REQUIRE(poses.size() == 1);
  CHECK(poses[0].probability == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("Solids come to rest where they roll face by face", "[geometry][likely_rest_pose]") {
  Random random(7);
  for (int i = 0; i < 6; ++i) {
    const TriangleMesh mesh = random_solid(random);
    const Vector3d center = mass_properties(mesh).center_of_mass;
    const auto poses = likely_rest_poses(mesh, center, {.least_lift = 0.0});
    CHECK(sum_of(poses) == Approx(1.0).epsilon(1e-12));
    // Rests are the local minima of the center's height, which `rest_poses` finds.
    CHECK(poses.size() ==
          rest_poses(mesh, center, {.flatness = 0.0, .same_up = 0.0, .least_margin = 0.0}).size());
    constexpr int kFalls = 4000;
    std::vector<int> counts(poses.size());
    for (int fall = 0; fall < kFalls; ++fall) {
      const Vector3d up = -rolled(mesh, center, random_unit(random));
      const auto pose = std::min_element(poses.begin(), poses.end(), [&](auto& a, auto& b) {
        return angle_between(a.pose.up_O, up) < angle_between(b.pose.up_O, up);
      });
      CHECK(angle_between(pose->pose.up_O, up) < 1e-6);
      ++counts[pose - poses.begin()];
    }
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const double p = poses[k].probability;
      const double four_sigmas = 4.0 * std::sqrt(p * (1.0 - p) / kFalls) + 1.0 / kFalls;
      CHECK(std::abs(static_cast<double>(counts[k]) / kFalls - p) < four_sigmas);
    }
    // With a lift, those that are left have taken the others' probability over.
    const auto few = likely_rest_poses(mesh, center, {.least_lift = 0.004});
    CHECK(few.size() <= poses.size());
    CHECK(sum_of(few) == Approx(1.0).epsilon(1e-12));
    for (const LikelyRestPose& pose : few) {
      CHECK(std::any_of(poses.begin(), poses.end(), [&](const LikelyRestPose& other) {
        return angle_between(other.pose.up_O, pose.pose.up_O) < 1e-6 &&
               other.probability <= pose.probability + 1e-12;
      }));
    }
  }
}

TEST_CASE("Likely rest poses refuse what has none", "[geometry][likely_rest_pose]") {
  const TriangleMesh cube = box({0.1, 0.1, 0.1});
  CHECK_THROWS_AS(likely_rest_poses(cube, {0.0, 0.0, 0.06}), InvalidInput);
  CHECK_THROWS_AS(likely_rest_poses(cube, {0.0, 0.0, std::nan("")}), InvalidInput);
  CHECK_THROWS_AS(likely_rest_poses(TriangleMesh{}, Vector3d::Zero()), InvalidInput);
  CHECK_THROWS_AS(likely_rest_poses(cube, Vector3d::Zero(), {.least_lift = -1.0}), InvalidInput);
  TriangleMesh flat = cube;
  for (Vector3d& vertex : flat.vertices) vertex.z() = 0.0;
  CHECK_THROWS_AS(likely_rest_poses(flat, Vector3d::Zero()), DegenerateGeometry);
}

}  // namespace test_likely_rest_pose
