#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/rest_pose.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/geometry/surface_sampling.hpp"
#include "graspfit/geometry/used_vertices.hpp"
#include "support/catch.hpp"

namespace test_input_check {

using namespace graspfit::geometry;
using Eigen::Vector3d;
using graspfit::base::InvalidInput;

namespace {

using Call = std::pair<std::string, std::function<void()>>;

void check_refused(const std::vector<Call>& calls) {
  for (const auto& [name, call] : calls) {
    INFO(name);
    CHECK_THROWS_AS(call(), InvalidInput);
  }
}

std::vector<Call> calls_with(const TriangleMesh& mesh) {
  const VoxelLattice lattice = lattice_around(bounding_box(box({1, 1, 1})), {});
  return {
      {"MeshQuery", [mesh] { MeshQuery query(mesh); }},
      {"analyze", [mesh] { analyze(mesh); }},
      {"repair_mesh", [mesh] { repair_mesh(mesh); }},
      {"solid_boundary", [mesh] { solid_boundary(mesh); }},
      {"mass_properties", [mesh] { mass_properties(mesh); }},
      {"convex_decomposition", [mesh] { convex_decomposition(mesh, {}); }},
      {"sample_surface", [mesh] { sample_surface(mesh); }},
      {"surface_patches", [mesh, lattice] { surface_patches(mesh, lattice); }},
      {"clip_by_voxels", [mesh, lattice] { clip_by_voxels(mesh, lattice); }},
      {"rest_poses", [mesh] { rest_poses(mesh, Vector3d::Zero()); }},
      {"standing_pose",
       [mesh] {
         standing_pose(mesh, Vector3d::UnitZ(), 0.0, Vector3d::Zero(), Eigen::Vector2d::Zero());
       }},
  };
}

}  // namespace

TEST_CASE("A mesh with a coordinate that is not finite is refused wherever meshes enter",
          "[geometry][input_check]") {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    TriangleMesh mesh = box({1, 1, 1});
    mesh.vertices[5][1] = bad;
    INFO(bad);
    check_refused(calls_with(mesh));
    std::vector<std::int32_t> all(mesh.faces.size());
    std::iota(all.begin(), all.end(), 0);
    const auto touched = std::find_if(mesh.faces.begin(), mesh.faces.end(), [](const Face& face) {
      return std::count(face.begin(), face.end(), 5) > 0;
    });
    const auto face = static_cast<std::size_t>(touched - mesh.faces.begin());
    const ConvexVolume half = {{Vector3d::UnitX(), 0.25}};
    check_refused({{"clip of a triangle", [&] { clip(corners(mesh, face), half); }},
                   {"clip of a mesh", [&] { clip(mesh, all, half); }}});
  }
}

TEST_CASE("A mesh with a face of a vertex that is none is refused wherever meshes enter",
          "[geometry][input_check]") {
  for (const std::int32_t bad : {-1, 8}) {
    TriangleMesh mesh = box({1, 1, 1});
    mesh.faces[3][1] = bad;
    INFO(bad);
    check_refused(calls_with(mesh));
    const std::vector<std::int32_t> third = {3};
    check_refused({{"used_vertices", [&] { used_vertices(mesh); }},
                   {"clip of a mesh", [&] { clip(mesh, third, {}); }}});
  }
  for (const std::int32_t bad : {-1, 12}) {
    const TriangleMesh mesh = box({1, 1, 1});
    const std::vector<std::int32_t> faces = {0, bad};
    INFO(bad);
    check_refused({{"clip of a mesh", [&] { clip(mesh, faces, {}); }}});
  }
  TriangleMesh mesh = box({1, 1, 1});
  mesh.faces[3][1] = 8;
  CHECK_THROWS_WITH(MeshQuery(mesh), "MeshQuery: face 3 has vertex 8 of 8");
}

TEST_CASE("Points, boxes and poses that are not finite are refused by queries",
          "[geometry][input_check]") {
  const MeshQuery query(box({1, 1, 1}));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    INFO(bad);
    const Vector3d point(0.0, bad, 0.0);
    const std::vector<Vector3d> points = {point, Vector3d::Zero()};
    RigidTransform moved = RigidTransform::Identity();
    moved.translation() = point;
    RigidTransform turned = RigidTransform::Identity();
    turned.linear()(1, 2) = bad;
    check_refused({
        {"closest_point", [&] { query.closest_point(point); }},
        {"signed_distance", [&] { query.signed_distance(point); }},
        {"containment", [&] { query.containment(point); }},
        {"first_hit", [&] { query.first_hit(point, Vector3d::UnitX()); }},
        {"all_hits", [&] { query.all_hits(Vector3d::Zero(), point); }},
        {"convex_hull", [&] { convex_hull(points); }},
        {"ConvexPolytope", [&] { ConvexPolytope hull(point); }},
    });
    for (const RigidTransform& X : {moved, turned}) {
      check_refused({
          {"do_intersect", [&] { do_intersect(query, query, X); }},
          {"penetration", [&] { penetration(query, query, X); }},
          {"depth_above", [&] { depth_above(query, query, X, 0.0); }},
          {"distance", [&] { distance(query, query, X); }},
          {"nearest_points", [&] { nearest_points(query, query, X, 1.0); }},
          {"surface_clearance", [&] { surface_clearance(query, query, X, 1.0, 1.0); }},
      });
    }
  }
  const double none = std::nan("");
  const RigidTransform at = RigidTransform::Identity();
  const auto piece = clip({Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()}, {});
  REQUIRE(piece);
  check_refused({
      {"faces_near",
       [&] {
         query.faces_near({Vector3d(0.0, none, 0.0), Vector3d(1.0, 1.0, 1.0)});
       }},
      {"nearest_points", [&] { nearest_points(query, query, at, none); }},
      {"surface_clearance", [&] { surface_clearance(query, query, at, none, 1.0); }},
      {"surface_clearance", [&] { surface_clearance(query, query, at, 1.0, none); }},
      {"surface_clearance", [&] { surface_clearance(query, query, at, 1.0, 0.0); }},
      {"closest_point", [&] { query.closest_point(Vector3d(1e200, 0.0, 0.0)); }},
      {"closest_point of a piece", [&] { closest_point(*piece, Vector3d(none, 0.0, 0.0)); }},
      {"closest_point of a piece without corners", [] { closest_point({}, Vector3d::Zero()); }},
  });
}

}  // namespace test_input_check
