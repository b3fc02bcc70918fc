#include <CGAL/Gmpq.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include "geometry/changed_meshes.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "solid/intersection_part.hpp"
#include "support/catch.hpp"

namespace test_mesh_analysis {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::inward;
using graspfit::testing::moved;
using graspfit::testing::turn;

TEST_CASE("Shapes are closed, manifold and outward", "[geometry][mesh_analysis]") {
  for (const TriangleMesh& mesh :
       {ball(1, 2), box({1, 2, 3}), torus(2, 1, 12, 8), cylinder(1, 2, 12), capsule(1, 2, 12)}) {
    const MeshAnalysis analysis = analyze(mesh, {.count_self_intersections = true});
    CHECK(analysis.is_closed);
    CHECK(analysis.is_manifold);
    CHECK(analysis.is_outward);
    CHECK(analysis.num_parts == 1);
    CHECK(analysis.num_vertices == mesh.vertices.size());
    CHECK(analysis.num_faces == mesh.faces.size());
    CHECK(analysis.num_unused_vertices + analysis.num_degenerate_faces +
              analysis.num_doubled_faces + analysis.num_boundary_edges +
              analysis.num_nonmanifold_edges + analysis.num_inconsistent_edges +
              analysis.num_inward_parts ==
          0);
    CHECK(analysis.num_self_intersections == 0);
    CHECK(analysis.box.isApprox(bounding_box(mesh)));
  }
}

TEST_CASE("Each defect of a box is counted", "[geometry][mesh_analysis]") {
  const TriangleMesh cube = box({1, 1, 1});
  TriangleMesh mesh = cube;
  mesh.faces.pop_back();
  CHECK(analyze(mesh).num_boundary_edges == 3);
  CHECK_FALSE(analyze(mesh).is_closed);
  CHECK(analyze(mesh).is_manifold);

  mesh = cube;
  turn(mesh, 4);
  CHECK(analyze(mesh).num_inconsistent_edges == 3);
  CHECK_FALSE(analyze(mesh).is_closed);

  mesh = cube;
  mesh.faces.push_back({mesh.faces[3][1], mesh.faces[3][0], mesh.faces[3][2]});
  CHECK(analyze(mesh).num_doubled_faces == 1);
  CHECK(analyze(mesh).num_nonmanifold_edges == 3);
  CHECK_FALSE(analyze(mesh).is_manifold);

  mesh = cube;
  mesh.faces.push_back({0, 1, 1});
  mesh.vertices.push_back({0, 0, 0});
  CHECK(analyze(mesh).num_degenerate_faces == 1);
  CHECK(analyze(mesh).num_unused_vertices == 1);

  CHECK(analyze(inward(cube)).num_inward_parts == 1);
  CHECK(analyze(inward(cube)).is_closed);
  CHECK_FALSE(analyze(inward(cube)).is_outward);
}

TEST_CASE("Collinear corners are degenerate however far apart", "[geometry][mesh_analysis]") {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.4, 0.8, 1.2}};
  mesh.faces = {{0, 1, 2}};
  CHECK(analyze(mesh).num_degenerate_faces == 1);
  mesh.vertices[1][0] = std::nextafter(mesh.vertices[1][0], 1.0);
  CHECK(analyze(mesh).num_degenerate_faces == 0);
}

TEST_CASE("An inward part is right as a cavity and wrong elsewhere", "[geometry][mesh_analysis]") {
  const TriangleMesh outer = box({4, 4, 4});
  const TriangleMesh inner = inward(box({1, 1, 1}));
  const MeshAnalysis hollow = analyze(concatenated({outer, inner}));
  CHECK(hollow.num_parts == 2);
  CHECK(hollow.num_inward_parts == 0);
  CHECK(hollow.is_outward);
  CHECK(analyze(concatenated({outer, moved(inner, {5, 0, 0})})).num_inward_parts == 1);
}

TEST_CASE("Two boxes with a common vertex are pinched there", "[geometry][mesh_analysis]") {
  TriangleMesh both = concatenated({box({1, 1, 1}), moved(box({1, 1, 1}), {1, 1, 1})});
  CHECK(analyze(both).is_manifold);  // Two vertices at one position are two.
  for (Face& f : both.faces) {
    for (std::int32_t& vertex : f) vertex = vertex == 8 ? 7 : vertex;
  }
  const MeshAnalysis pinched = analyze(both);
  CHECK(pinched.is_closed);
  CHECK_FALSE(pinched.is_manifold);
  CHECK(pinched.num_nonmanifold_edges == 0);
}

TEST_CASE("Crossing parts are counted as self-intersections only when asked",
          "[geometry][mesh_analysis]") {
  const TriangleMesh crossing =
      concatenated({box({2, 2, 2}), moved(box({2, 2, 2}), {1, 0.5, 0.25})});
  CHECK_FALSE(analyze(crossing).num_self_intersections.has_value());
  CHECK(*analyze(crossing, {.count_self_intersections = true}).num_self_intersections > 0);
  const TriangleMesh apart = concatenated({box({2, 2, 2}), moved(box({2, 2, 2}), {3, 0, 0})});
  CHECK(*analyze(apart, {.count_self_intersections = true}).num_self_intersections == 0);
}

TEST_CASE("Faces that share corners cross only beyond them", "[geometry][mesh_analysis]") {
  // A case has the corners of a triangle, and whether it crosses the triangle (0,0,0) (4,0,0)
  // (0,4,0).
  const std::vector<std::pair<std::vector<Eigen::Vector3d>, bool>> cases = {
      {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, true},      // the same
      {{{0, 0, 0}, {4, 0, 0}, {0, -4, 0}}, false},    // beyond the common edge, in the plane
      {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}}, true},      // folded onto it
      {{{0, 0, 0}, {4, 0, 0}, {1, 1, 1e-9}}, false},  // nearly
      {{{0, 0, 0}, {-4, 0, 0}, {0, -4, 1}}, false},   // a common corner
      {{{0, 0, 0}, {2, 2, 1}, {2, 2, -1}}, true},     // through it from that corner
      {{{0, 0, 0}, {2, 0, 0}, {0, 0, 3}}, true},      // along half an edge
      {{{0, 0, 0}, {-2, 0, 0}, {0, 0, 3}}, false},
      {{{1, 1, 0}, {1, 1, 3}, {2, 1, 3}}, true},  // touching with a corner
      {{{1, 1, 1e-9}, {1, 1, 3}, {2, 1, 3}}, false},
      {{{2, 2, 0}, {4, 4, 1}, {4, 4, -1}}, true},  // touching the long edge
      {{{5, 0, 0}, {5, 4, 0}, {9, 0, 0}}, false}};
  for (const auto& [other, is_crossing] : cases) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    mesh.vertices.insert(mesh.vertices.end(), other.begin(), other.end());
    // Equal coordinates are a common corner whether or not they have one index.
    for (std::int32_t turn = 0; turn < 3; ++turn) {
      mesh.faces = {{0, 1, 2}, {3 + turn, 3 + (turn + 1) % 3, 3 + (turn + 2) % 3}};
      CHECK(*analyze(mesh, {.count_self_intersections = true}).num_self_intersections ==
            (is_crossing ? 1 : 0));
    }
  }
}

TEST_CASE("Crossings in triangles on a small grid are those of exact arithmetic",
          "[geometry][mesh_analysis]") {
  using Exact = CGAL::Simple_cartesian<CGAL::Gmpq>;
  Random random(41);
  for (int round = 0; round < 20; ++round) {
    TriangleMesh mesh;
    for (int i = 0; i < 90; ++i) {
      const auto coordinate = [&] { return static_cast<double>(random.index(4)); };
      mesh.vertices.emplace_back(coordinate(), coordinate(), coordinate());
    }
    for (std::int32_t i = 0; i < 30; ++i) mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    std::vector<Exact::Triangle_3> triangles;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const auto [a, b, c] = corners(mesh, i);
      const Exact::Triangle_3 triangle({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]});
      if (!triangle.is_degenerate()) triangles.push_back(triangle);
    }
    std::size_t crossings = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto is_corner_of_both = [&](const Exact::Point_3& p) {
          const auto is_corner = [&](const Exact::Triangle_3& t) {
            return p == t[0] || p == t[1] || p == t[2];
          };
          return is_corner(triangles[i]) && is_corner(triangles[j]);
        };
        const auto common = CGAL::intersection(triangles[i], triangles[j]);
        if (!common) continue;
        const auto* point = internal::intersection_part<Exact::Point_3>(common);
        const auto* segment = internal::intersection_part<Exact::Segment_3>(common);
        const bool is_regular = (point != nullptr && is_corner_of_both(*point)) ||
                                (segment != nullptr && is_corner_of_both(segment->source()) &&
                                 is_corner_of_both(segment->target()));
        if (!is_regular) ++crossings;
      }
    }
    CHECK(*analyze(mesh, {.count_self_intersections = true}).num_self_intersections == crossings);
  }
}

TEST_CASE("Parts that cross and parts that lie in another are counted when asked",
          "[geometry][mesh_analysis]") {
  const TriangleMesh cube = box({2, 2, 2});
  struct Case {
    std::vector<TriangleMesh> parts;
    std::size_t overlapping;
    std::size_t nested;
  };
  const std::vector<Case> cases = {
      {{cube}, 0, 0},
      {{cube, moved(cube, {5, 0, 0})}, 0, 0},
      {{cube, moved(cube, {1, 0.5, 0.25})}, 1, 0},
      {{cube, moved(cube, {1, 0.5, 0.25}), moved(cube, {2.5, 1, 0.5})}, 2, 0},
      {{cube, box({1, 1, 1})}, 0, 1},
      {{box({4, 4, 4}), inward(cube), box({1, 1, 1}), moved(cube, {9, 0, 0})}, 0, 2},
      {{ball(1, 2), moved(ball(1, 2), {1.5, 1.5, 0})}, 0, 0}  // Only their boxes meet.
  };
  for (const auto& [parts, overlapping, nested] : cases) {
    const MeshAnalysis analysis = analyze(concatenated(parts), {.count_part_overlaps = true});
    CHECK(analysis.num_overlapping_part_pairs == overlapping);
    CHECK(analysis.num_nested_parts == nested);
  }
  CHECK_FALSE(analyze(cube).num_nested_parts.has_value());
  CHECK_FALSE(analyze(cube).num_overlapping_part_pairs.has_value());
}

TEST_CASE("A mesh of nothing is not closed", "[geometry][mesh_analysis]") {
  const MeshAnalysis analysis = analyze(TriangleMesh{});
  CHECK(analysis.num_parts == 0);
  CHECK_FALSE(analysis.is_closed);
  CHECK_FALSE(analysis.is_outward);
  CHECK(analysis.box.isEmpty());
}

}  // namespace test_mesh_analysis
