#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/cgal/cgal_oracle.hpp"
#include "geometry/changed_meshes.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/cgal.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "solid/crossing_faces.hpp"
#include "support/catch.hpp"

namespace graspfit::test_solids_against_cgal {

using base::Random;
using Eigen::Vector3d;
using geometry::Containment;
using geometry::Face;
using geometry::MeshQuery;
using geometry::TriangleMesh;
using testing::drawn_pose;
namespace adapter = geometry::cgal;
namespace pmp = CGAL::Polygon_mesh_processing;

using Epick = adapter::Kernel;
using Epeck = CGAL::Exact_predicates_exact_constructions_kernel;
using Graph = CGAL::Surface_mesh<Epick::Point_3>;
using ExactGraph = CGAL::Surface_mesh<Epeck::Point_3>;

namespace {

using FacePairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Returns pairs of different faces that CGAL finds crossing, (lower, higher), ascending.
FacePairs crossing_faces_by_cgal(const TriangleMesh& mesh) {
  const Graph graph = adapter::face_graph(mesh);
  std::vector<std::pair<Graph::Face_index, Graph::Face_index>> found;
  pmp::self_intersections(graph, std::back_inserter(found));
  FacePairs pairs;
  for (const auto& [f, g] : found) {
    const auto first = static_cast<std::int32_t>(f.idx());
    const auto second = static_cast<std::int32_t>(g.idx());
    // It pairs a face without area with itself.
    if (first != second) pairs.emplace_back(std::min(first, second), std::max(first, second));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Removes pairs of faces that have two vertices at one place: these are a common corner for us,
/// whereas for CGAL two faces touch there.
void leave_out_equal_corners(const TriangleMesh& mesh, FacePairs& pairs) {
  std::erase_if(pairs, [&](const auto& pair) {
    for (const std::int32_t v : mesh.faces[pair.first]) {
      for (const std::int32_t w : mesh.faces[pair.second]) {
        if (v != w && mesh.vertices[v] == mesh.vertices[w]) return true;
      }
    }
    return false;
  });
}

int num_common_vertices(const TriangleMesh& mesh, const std::pair<std::int32_t, std::int32_t>& of) {
  const Face& other = mesh.faces[of.second];
  int count = 0;
  for (const std::int32_t v : mesh.faces[of.first]) {
    count += std::count(other.begin(), other.end(), v) > 0;
  }
  return count;
}

/// Returns an open sheet of 2 n² triangles whose vertices, on a square lattice of step 2, are moved
/// within its plane by up to 2 and some of them out of it by 1, all in whole steps of 1.
TriangleMesh crumpled_sheet(Random& random, std::int32_t n) {
  TriangleMesh mesh;
  const auto offset = [&] { return static_cast<double>(random.index(5)) - 2.0; };
  for (std::int32_t i = 0; i <= n; ++i) {
    for (std::int32_t j = 0; j <= n; ++j) {
      Vector3d vertex(2.0 * i, 2.0 * j, random.index(4) == 0 ? 1.0 : 0.0);
      vertex.x() += offset();
      vertex.y() += offset();
      mesh.vertices.push_back(vertex);
    }
  }
  for (std::int32_t i = 0; i < n; ++i) {
    for (std::int32_t j = 0; j < n; ++j) {
      const std::int32_t a = i * (n + 1) + j;
      const std::int32_t b = a + n + 1;
      mesh.faces.push_back({a, b, b + 1});
      mesh.faces.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

/// Returns the mesh with every vertex moved by up to `most` along each axis, in whole steps if
/// there is one.
TriangleMesh shaken(TriangleMesh mesh, Random& random, double most, double step = 0.0) {
  for (Vector3d& vertex : mesh.vertices) {
    for (double& x : vertex) x += random.uniform(-most, most);
    if (step > 0.0) vertex = step * (vertex / step).array().round();
  }
  return mesh;
}

}  // namespace

TEST_CASE("Crossing faces are CGAL's self-intersections, in general position and on a lattice",
          "[geometry][cgal_oracle]") {
  Random random(107);
  std::vector<TriangleMesh> meshes;
  for (int i = 0; i < 4; ++i) {
    const TriangleMesh other =
        geometry::transformed(geometry::ball(0.8, 1), drawn_pose(random, 0.8));
    meshes.push_back(geometry::concatenated({geometry::ball(1.0, 1), other}));
    meshes.push_back(shaken(geometry::torus(1.0, 0.4, 24, 12), random, 0.15));
    meshes.push_back(shaken(geometry::ball(1.0, 2), random, 0.1, 0.125));
    meshes.push_back(shaken(geometry::box({1, 2, 3}), random, 1.5, 0.5));
    meshes.push_back(crumpled_sheet(random, 10));
  }
  std::array<int, 3> num_pairs{};  // By the number of common corners.
  for (const TriangleMesh& mesh : meshes) {
    FacePairs ours = geometry::internal::crossing_faces(mesh);
    FacePairs theirs = crossing_faces_by_cgal(mesh);
    leave_out_equal_corners(mesh, ours);
    leave_out_equal_corners(mesh, theirs);
    CHECK(ours == theirs);
    for (const auto& pair : ours) {
      const int common = num_common_vertices(mesh, pair);
      REQUIRE(common < 3);
      ++num_pairs[common];
    }
  }
  CHECK(num_pairs[0] > 500);
  CHECK(num_pairs[1] > 100);
  CHECK(num_pairs[2] > 30);
}

namespace {

/// Returns the union of solids by CGAL's corefinement with exact points, rounded at the end; empty
/// where CGAL refuses it because its surface would not be manifold.
std::optional<TriangleMesh> united_by_cgal(const std::vector<TriangleMesh>& parts) {
  auto all = adapter::face_graph<ExactGraph>(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    auto next = adapter::face_graph<ExactGraph>(parts[i]);
    ExactGraph both;
    if (!pmp::corefine_and_compute_union(all, next, both)) return std::nullopt;
    all = both;
  }
  return adapter::triangle_mesh(all);
}

struct UnionCounts {
  int united = 0;
  int overlapping = 0;
  testing::ContainmentCounts answers;
};

void compare_unions(const std::vector<TriangleMesh>& parts, Random& random, UnionCounts& counts) {
  const std::optional<TriangleMesh> theirs = united_by_cgal(parts);
  if (!theirs) return;
  const Graph graph = adapter::face_graph(*theirs);
  const TriangleMesh ours = geometry::solid_boundary(geometry::concatenated(parts));
  const double volume = CGAL::to_double(pmp::volume(graph));
  CHECK(geometry::signed_volume(ours) == Approx(volume).epsilon(1e-10));
  CHECK(geometry::surface_area(ours) == Approx(CGAL::to_double(pmp::area(graph))).epsilon(1e-10));
  double sum = 0.0;
  for (const TriangleMesh& part : parts) sum += geometry::signed_volume(part);
  ++counts.united;
  counts.overlapping += volume < (1.0 - 1e-6) * sum;
  // The corners of both are rounded, which moves the surface by an ulp: points drawn anyhow are
  // farther from it.
  const MeshQuery query(ours);
  const CGAL::Side_of_triangle_mesh<Graph, Epick> side_of(graph);
  for (int i = 0; i < 100; ++i) {
    const Vector3d point = testing::drawn_point(random, query.box());
    const Containment containment = query.containment(point);
    CHECK(containment == testing::containment_of(side_of(adapter::point(point))));
    counts.answers.add(containment);
  }
}

}  // namespace

TEST_CASE("The boundary of overlapping solids is that of their union by CGAL's corefinement",
          "[geometry][cgal_oracle]") {
  using geometry::transformed;
  Random random(108);
  UnionCounts counts;
  for (int i = 0; i < 5; ++i) {
    compare_unions(
        {geometry::ball(0.05, 2), transformed(geometry::ball(0.04, 2), drawn_pose(random, 0.04))},
        random, counts);
    compare_unions({geometry::torus(0.05, 0.02, 24, 12),
                    transformed(geometry::torus(0.04, 0.015, 20, 10), drawn_pose(random, 0.03))},
                   random, counts);
    compare_unions({transformed(geometry::ball(0.04, 1), drawn_pose(random, 0.02)),
                    transformed(geometry::box({0.1, 0.04, 0.05}), drawn_pose(random, 0.02)),
                    transformed(geometry::torus(0.05, 0.02, 16, 8), drawn_pose(random, 0.02))},
                   random, counts);
  }
  CHECK(counts.united >= 14);
  CHECK(counts.overlapping >= 12);
  CHECK(counts.answers.inside > 200);
  CHECK(counts.answers.outside > 200);
}

TEST_CASE("The boundary of boxes with faces in common planes is that of their union by CGAL",
          "[geometry][cgal_oracle]") {
  // The corners are on a lattice of step 1/64, so that planes coincide, faces touch from both sides
  // and boxes are within others. CGAL refuses what touches at edges and corners only.
  Random random(109);
  UnionCounts counts;
  for (int i = 0; i < 30; ++i) {
    std::vector<TriangleMesh> boxes;
    for (int part = 0; part < (i % 3 == 0 ? 3 : 2); ++part) {
      Vector3d size;
      Vector3d by;
      for (int axis = 0; axis < 3; ++axis) {
        // An even number of steps, so that the box's middle is on the lattice.
        size[axis] = static_cast<double>(2 * (random.index(3) + 1)) / 64.0;
        by[axis] = (static_cast<double>(random.index(5)) - 2.0) / 64.0;
      }
      boxes.push_back(testing::moved(geometry::box(size), by));
    }
    compare_unions(boxes, random, counts);
  }
  CHECK(counts.united >= 15);
  CHECK(counts.overlapping >= 10);
  CHECK(counts.answers.inside > 500);
  CHECK(counts.answers.outside > 100);
}

}  // namespace graspfit::test_solids_against_cgal
