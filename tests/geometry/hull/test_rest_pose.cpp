#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/hull/random_solid.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rest_pose.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_rest_pose {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Vector3d;
using graspfit::testing::random_solid;
using graspfit::testing::random_unit;

namespace {

/// Returns the height of the center over the plane that touches the solid from below when `up` is
/// up. By definition its local minima over all directions are the rest poses; no hull is needed.
double height_of_center(const TriangleMesh& mesh, const Vector3d& center, const Vector3d& up) {
  double height = -std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : mesh.vertices) height = std::max(height, up.dot(center - vertex));
  return height;
}

/// Returns a prism over the triangle (0, 0), (0.1, 0), (0, 0.1), leaning by `lean` along x over its
/// height of 0.1.
TriangleMesh leaning_prism(double lean) {
  TriangleMesh mesh;
  for (const double z : {0.0, 0.1}) {
    const double x = z * lean / 0.1;
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, z}, {x + 0.1, 0, z}, {x, 0.1, z}});
  }
  mesh.faces = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

}  // namespace

TEST_CASE("A box rests on each of its six faces, the largest first", "[geometry][rest_pose]") {
  const std::vector<RestPose> poses =
      rest_poses(box({0.2, 0.1, 0.06}), Vector3d::Zero(), {.same_up = 1e-6});
  REQUIRE(poses.size() == 6);
  // The height is half the edge that stands, the margin half the shorter of the two others.
  const double heights[] = {0.03, 0.03, 0.05, 0.05, 0.1, 0.1};
  const double margins[] = {0.05, 0.05, 0.03, 0.03, 0.03, 0.03};
  const int axes[] = {2, 2, 1, 1, 0, 0};
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(poses[i].height == Approx(heights[i]).epsilon(1e-12));
    CHECK(poses[i].margin == Approx(margins[i]).epsilon(1e-12));
    CHECK(std::abs(poses[i].up_O[axes[i]]) == Approx(1.0));
  }
  CHECK(poses[0].up_O.dot(poses[1].up_O) == Approx(-1.0));
}

TEST_CASE("A leaning prism does not stand once its center is beyond its base",
          "[geometry][rest_pose]") {
  const auto stands = [](double lean) {
    const TriangleMesh mesh = leaning_prism(lean);
    const auto poses = rest_poses(mesh, mass_properties(mesh).center_of_mass);
    return std::any_of(poses.begin(), poses.end(),
                       [](const RestPose& pose) { return pose.up_O.z() > 0.999; });
  };
  // The center of mass is at x = 1/30 + lean/2, y = 1/30; the base's border there is at x = 2/30.
  CHECK(stands(0.0));
  CHECK(stands(0.063));
  CHECK_FALSE(stands(0.07));
  // Nearer to the border than the wanted margin, 1 mm, it counts as falling: the border x + y = 0.1
  // is (1/30 - lean/2) / √2 away, 1.08 mm and 0.94 mm here.
  CHECK(stands(0.0636));
  CHECK_FALSE(stands(0.0640));
}

TEST_CASE("A cylinder rests on its ends and on each facet of its side", "[geometry][rest_pose]") {
  const auto poses = rest_poses(cylinder(0.05, 0.06, 12), Vector3d::Zero(), {.least_margin = 0.0});
  CHECK(poses.size() == 14);
  CHECK(poses[0].height == Approx(0.03).epsilon(1e-9));
  // The end is a regular polygon of 12 corners; its inscribed circle is cos 15° of the radius.
  CHECK(poses[0].margin == Approx(0.05 * std::cos(std::numbers::pi / 12)).epsilon(1e-9));
}

TEST_CASE("Rest poses are the local minima of the center's height", "[geometry][rest_pose]") {
  Random random(7);
  int num_facets = 0;
  int num_rests = 0;
  for (int solid = 0; solid < 8; ++solid) {
    const TriangleMesh mesh = random_solid(random);
    const Vector3d center = mass_properties(mesh).center_of_mass;
    const auto poses =
        rest_poses(mesh, center, {.flatness = 0.0, .same_up = 0.0, .least_margin = 0.0});
    REQUIRE(poses.size() >= 2);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const Vector3d up = -face_normal(mesh, f);
      const bool is_rest = std::any_of(poses.begin(), poses.end(), [&](const RestPose& pose) {
        return (pose.up_O - up).norm() < 1e-9;
      });
      const double height = height_of_center(mesh, center, up);
      // Where the height falls at all, it falls toward the point of the facet nearest to the plumb
      // point, and in a cone around that, however narrow.
      const Vector3d plumb = center - height * up;
      const TriangleMesh facet{{mesh.vertices[static_cast<std::size_t>(mesh.faces[f][0])],
                                mesh.vertices[static_cast<std::size_t>(mesh.faces[f][1])],
                                mesh.vertices[static_cast<std::size_t>(mesh.faces[f][2])]},
                               {{0, 1, 2}}};
      const Vector3d nearest = MeshQuery(facet).closest_point(plumb).point;
      // A tilt by k toward it, at a distance d, lowers the center by k d, here by d² / 1000.
      const Vector3d toward = nearest - plumb;
      const double fall = std::max(0.5e-3 * toward.squaredNorm(), 1e-15);
      const Vector3d tilted = (up + 1e-3 * toward).normalized();
      bool is_minimum = height_of_center(mesh, center, tilted) > height - fall;
      for (int i = 0; i < 100; ++i) {
        const Vector3d anyhow = (up + 1e-4 * random_unit(random)).normalized();
        is_minimum = is_minimum && height_of_center(mesh, center, anyhow) > height - 1e-12;
      }
      CHECK(is_rest == is_minimum);
      ++num_facets;
      num_rests += is_rest ? 1 : 0;
    }
  }
  CHECK(num_rests > 16);
  CHECK(num_facets > 4 * num_rests);
}

TEST_CASE("A solid that stands touches the table under its center", "[geometry][rest_pose]") {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const TriangleMesh mesh = random_solid(random);
    const Vector3d center = mass_properties(mesh).center_of_mass;
    const auto poses = rest_poses(mesh, center);
    const RestPose& pose = poses[static_cast<std::size_t>(i) % poses.size()];
    const RigidTransform X_WO =
        standing_pose(mesh, pose.up_O, random.uniform(-3.0, 3.0), center, {0.3, -0.2});
    CHECK(bounding_box(transformed(mesh, X_WO)).min().z() == Approx(0.0).margin(1e-15));
    CHECK(((X_WO * center) - Vector3d(0.3, -0.2, pose.height)).norm() < 1e-12);
    CHECK((X_WO.linear() * pose.up_O - Vector3d::UnitZ()).norm() < 1e-12);
  }
}

TEST_CASE("A pose upside down turns about x, and turns about z add up", "[geometry][rest_pose]") {
  const TriangleMesh mesh = box({0.2, 0.1, 0.06});
  const RigidTransform over =
      standing_pose(mesh, -Vector3d::UnitZ(), 0.0, Vector3d::Zero(), {0.0, 0.0});
  CHECK(over.linear().isApprox(Vector3d(1, -1, -1).asDiagonal().toDenseMatrix(), 1e-12));
  const RigidTransform turned =
      standing_pose(mesh, Vector3d::UnitZ(), 0.4, Vector3d::Zero(), {0.0, 0.0});
  CHECK(turned.linear().isApprox(Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix(),
                                 1e-14));
}

TEST_CASE("The rest pose nearest to a direction is found, impossible requests are refused",
          "[geometry][rest_pose]") {
  const auto poses = rest_poses(box({0.2, 0.1, 0.06}), Vector3d::Zero());
  CHECK(nearest_rest_pose(poses, {0.9, 0.2, -0.4}).up_O.x() == Approx(1.0));
  CHECK_THROWS_AS(nearest_rest_pose(poses, Vector3d::Zero()), InvalidInput);
  CHECK_THROWS_AS(nearest_rest_pose({}, Vector3d::UnitX()), InvalidInput);
  CHECK_THROWS_AS(rest_poses({}, Vector3d::Zero()), InvalidInput);
  CHECK_THROWS_AS(rest_poses(box({1, 1, 1}), Vector3d::Zero(), {.least_margin = -1.0}),
                  InvalidInput);
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.faces = {{0, 1, 2}, {0, 2, 1}};
  CHECK_THROWS_AS(rest_poses(flat, Vector3d::Zero()), DegenerateGeometry);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(rest_poses(box({1, 1, 1}), {0, nan, 0}),
                    graspfit::testing::Contains("center_of_mass = (0, nan, 0)"));
}

TEST_CASE("Nothing stands without a face, a finite place or an up with a length",
          "[geometry][rest_pose]") {
  const TriangleMesh mesh = box({1, 1, 1});
  const Vector3d zero = Vector3d::Zero();
  const Vector3d up = Vector3d::UnitZ();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(standing_pose(mesh, 3.0 * up, 0.0, zero, {0, 0}));
  CHECK_THROWS_WITH(standing_pose(mesh, zero, 0.0, zero, {0, 0}),
                    graspfit::testing::Contains("up_O"));
  CHECK_THROWS_AS(standing_pose({}, up, 0.0, zero, {0, 0}), InvalidInput);
  CHECK_THROWS_AS(standing_pose(mesh, {0, nan, 1}, 0.0, zero, {0, 0}), InvalidInput);
  CHECK_THROWS_AS(standing_pose(mesh, up, nan, zero, {0, 0}), InvalidInput);
  CHECK_THROWS_AS(standing_pose(mesh, up, 0.0, {nan, 0, 0}, {0, 0}), InvalidInput);
  CHECK_THROWS_AS(standing_pose(mesh, up, 0.0, zero, {0, nan}), InvalidInput);
}

TEST_CASE("A vertex of no face neither stands nor supports", "[geometry][rest_pose]") {
  const TriangleMesh mesh = box({0.2, 0.1, 0.06});
  TriangleMesh stray = mesh;
  stray.vertices.insert(stray.vertices.begin(), {0.0, 0.0, -1.0});
  for (Face& face : stray.faces) {
    for (std::int32_t& vertex : face) ++vertex;
  }
  const auto plain = rest_poses(mesh, Vector3d::Zero());
  const auto poses = rest_poses(stray, Vector3d::Zero());
  REQUIRE(poses.size() == plain.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CHECK(poses[i].up_O == plain[i].up_O);
    CHECK(poses[i].height == plain[i].height);
    CHECK(poses[i].margin == plain[i].margin);
  }
  const RigidTransform X_WO =
      standing_pose(stray, Vector3d::UnitZ(), 0.0, Vector3d::Zero(), {0.0, 0.0});
  CHECK(X_WO.translation().z() == Approx(0.03));
}

}  // namespace test_rest_pose
