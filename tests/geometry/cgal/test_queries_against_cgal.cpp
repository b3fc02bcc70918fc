#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/cgal/cgal_oracle.hpp"
#include "geometry/changed_meshes.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/cgal.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "query/indexed_triangle.hpp"
#include "solid/intersection_part.hpp"
#include "support/catch.hpp"

namespace graspfit::test_queries_against_cgal {

using base::Random;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using geometry::ClosestPoint;
using geometry::Containment;
using geometry::Face;
using geometry::MeshQuery;
using geometry::RigidTransform;
using geometry::TriangleMesh;
using testing::drawn_point;
using testing::drawn_pose;
namespace adapter = geometry::cgal;

using Epick = adapter::Kernel;
using Graph = CGAL::Surface_mesh<Epick::Point_3>;

namespace {

struct Shape {
  std::string name;
  TriangleMesh mesh;
};

// The sizes are powers of two, so that lattice points on the faces and distances between them are
// not rounded.
const Vector3d kBoxSize(0.125, 0.0625, 0.25);

/// Returns closed surfaces of one part each.
std::vector<Shape> closed_shapes() {
  return {{"ball", geometry::ball(0.04, 3)},
          {"torus", geometry::torus(0.05, 0.015, 48, 24)},
          {"box", geometry::box(kBoxSize)},
          {"mug", geometry::named_shape("mug")}};
}

/// Returns a ball without its upper cap.
TriangleMesh bowl() {
  TriangleMesh mesh = geometry::ball(0.05, 3);
  std::erase_if(mesh.faces, [&](const Face& face) { return mesh.vertices[face[0]].z() > 0.02; });
  return mesh;
}

std::vector<Shape> closed_and_open_shapes() {
  std::vector<Shape> shapes = closed_shapes();
  shapes.push_back({"bowl", bowl()});
  return shapes;
}

AlignedBox3d grown(const AlignedBox3d& box, double by) {
  return {box.min() - Vector3d::Constant(by), box.max() + Vector3d::Constant(by)};
}

/// Returns one of the 24 turns that take axes to axes; its entries are 0 and ±1.
Eigen::Matrix3d drawn_quarter_turns(Random& random) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d quarter = Eigen::Matrix3d::Zero();
    quarter(axis, axis) = 1.0;
    quarter((axis + 2) % 3, (axis + 1) % 3) = 1.0;
    quarter((axis + 1) % 3, (axis + 2) % 3) = -1.0;
    for (std::uint64_t times = random.index(4); times > 0; --times) turn = quarter * turn;
  }
  return turn;
}

/// Returns the points that are −6/8, −5/8, …, 6/8 of the box's size from its center along each
/// axis; the box ends at ±4/8.
std::vector<Vector3d> lattice_around_box() {
  std::vector<Vector3d> points;
  for (int x = -6; x <= 6; ++x) {
    for (int y = -6; y <= 6; ++y) {
      for (int z = -6; z <= 6; ++z) {
        points.push_back(kBoxSize.cwiseProduct(Vector3d(x, y, z)) / 8.0);
      }
    }
  }
  return points;
}

std::int32_t face_of(const adapter::FaceTree& tree, adapter::FaceTree::Tree::Primitive_id id) {
  return static_cast<std::int32_t>(tree.face(id));
}

/// Returns all faces at the least distance, ascending, by looking at every face.
std::vector<std::int32_t> nearest_faces(const TriangleMesh& mesh, const Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::int32_t> nearest;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Vector3d on_face =
        geometry::internal::closest_on_triangle(point, geometry::corners(mesh, face));
    const double squared = (on_face - point).squaredNorm();
    if (squared < least) nearest.clear();
    if (squared <= least) nearest.push_back(static_cast<std::int32_t>(face));
    least = std::min(least, squared);
  }
  return nearest;
}

/// Returns the faces that CGAL's ray or line meets in a point, each with the distance from `origin`
/// along `direction`.
template <class Query>
std::map<std::int32_t, double> hits_by_cgal(const adapter::FaceTree& tree, const Query& query,
                                            const Vector3d& origin, const Vector3d& direction) {
  using Tree = adapter::FaceTree::Tree;
  std::vector<typename Tree::template Intersection_and_primitive_id<Query>::Type> hits;
  tree.tree().all_intersections(query, std::back_inserter(hits));
  std::map<std::int32_t, double> distances;
  for (const auto& [common, id] : hits) {
    const auto* point = geometry::internal::intersection_part<Epick::Point_3>(&common);
    if (point == nullptr) continue;
    distances.emplace(face_of(tree, id),
                      direction.normalized().dot(adapter::vector(*point) - origin));
  }
  return distances;
}

}  // namespace

TEST_CASE("The closest point is as near as CGAL's, and its face the first of all as near",
          "[geometry][cgal_oracle]") {
  Random random(101);
  int num_ties = 0;
  for (const Shape& shape : closed_and_open_shapes()) {
    INFO(shape.name);
    const MeshQuery query(shape.mesh);
    const adapter::FaceTree tree(shape.mesh);
    const double extent = geometry::longest_extent(shape.mesh);
    std::vector<Vector3d> points;
    for (int i = 0; i < 200; ++i)
      points.push_back(drawn_point(random, grown(query.box(), extent / 2)));
    if (shape.name == "box") {
      for (const Vector3d& point : lattice_around_box()) points.push_back(point);
    }
    for (const Vector3d& point : points) {
      const ClosestPoint ours = query.closest_point(point);
      const auto theirs = adapter::vector(tree.tree().closest_point(adapter::point(point)));
      // Both construct points in doubles, with errors of some ulps of the coordinates.
      const double difference = std::sqrt(ours.squared_distance) - (theirs - point).norm();
      CHECK(std::abs(difference) <= 1e-12 * extent);
      const std::vector<std::int32_t> nearest = nearest_faces(shape.mesh, point);
      CHECK(ours.face == nearest.front());
      num_ties += nearest.size() > 1;
    }
  }
  CHECK(num_ties > 500);
}

TEST_CASE("Rays and lines in general position hit the faces that CGAL's hit",
          "[geometry][cgal_oracle]") {
  Random random(102);
  int num_misses = 0;
  int num_single = 0;
  int num_many = 0;
  int num_behind = 0;
  for (const Shape& shape : closed_and_open_shapes()) {
    INFO(shape.name);
    const MeshQuery query(shape.mesh);
    const adapter::FaceTree tree(shape.mesh);
    const double extent = geometry::longest_extent(shape.mesh);
    for (int i = 0; i < 300; ++i) {
      const Vector3d origin = drawn_point(random, grown(query.box(), extent / 4));
      const Vector3d direction = drawn_point(random, grown(query.box(), extent / 8)) - origin;
      const auto check_hits = [&](const auto& cgal_query, geometry::LineKind kind) {
        const auto theirs = hits_by_cgal(tree, cgal_query, origin, direction);
        const auto ours = query.all_hits(origin, direction, kind);
        CHECK(ours.size() == theirs.size());
        for (const geometry::RayHit& hit : ours) {
          const auto found = theirs.find(hit.face);
          REQUIRE(found != theirs.end());
          // The error grows with 1 / sin of the angle between line and face. No angle of these is
          // below 1e-6, so that 1e-16 becomes at most 1e-10.
          CHECK(std::abs(hit.distance - found->second) <= 1e-9 * extent);
          num_behind += hit.distance < 0.0;
        }
        num_misses += ours.empty();
        num_single += ours.size() == 1;
        num_many += ours.size() >= 4;
        return ours;
      };
      const Epick::Vector_3 along(direction.x(), direction.y(), direction.z());
      check_hits(Epick::Line_3(adapter::point(origin), along), geometry::LineKind::Line);
      const Epick::Ray_3 ray(adapter::point(origin), along);
      const auto all = check_hits(ray, geometry::LineKind::Ray);
      const auto first = query.first_hit(origin, direction);
      const auto their_first = tree.tree().first_intersection(ray);
      REQUIRE(first.has_value() == !all.empty());
      REQUIRE(static_cast<bool>(their_first) == !all.empty());
      if (!first) continue;
      CHECK(first->face == all.front().face);
      CHECK(first->face == face_of(tree, their_first->second));
    }
  }
  CHECK(num_misses > 100);
  CHECK(num_single > 60);
  CHECK(num_many > 100);
  CHECK(num_behind > 100);
}

TEST_CASE("A point is in a closed part where CGAL says so, on the surface and an ulp beside it too",
          "[geometry][cgal_oracle]") {
  Random random(103);
  testing::ContainmentCounts counts;
  for (const Shape& shape : closed_shapes()) {
    INFO(shape.name);
    const TriangleMesh& mesh = shape.mesh;
    const MeshQuery query(mesh);
    const Graph graph = adapter::face_graph(mesh);
    const CGAL::Side_of_triangle_mesh<Graph, Epick> side_of(graph);
    std::vector<Vector3d> points;
    for (int i = 0; i < 500; ++i) points.push_back(drawn_point(random, grown(query.box(), 0.005)));
    for (int i = 0; i < 200; ++i) {
      const auto [a, b, c] = geometry::corners(mesh, random.index(mesh.faces.size()));
      // The middles are rounded, so that many are beside the face, by an ulp or less.
      points.insert(points.end(), {a, 0.5 * (a + b), (a + b + c) / 3.0});
    }
    if (shape.name == "box") {
      for (const Vector3d& point : lattice_around_box()) points.push_back(point);
    }
    for (const Vector3d& point : points) {
      const Containment ours = query.containment(point);
      CHECK(ours == testing::containment_of(side_of(adapter::point(point))));
      counts.add(ours);
    }
  }
  CHECK(counts.inside > 500);
  CHECK(counts.on_surface > 1000);
  CHECK(counts.outside > 500);
}

TEST_CASE("Faces near a box are those whose boxes meet it, and all that CGAL's tree finds in it",
          "[geometry][cgal_oracle]") {
  Random random(104);
  std::size_t num_near = 0;
  std::size_t num_in_box = 0;
  int num_empty = 0;
  for (const Shape& shape : closed_and_open_shapes()) {
    INFO(shape.name);
    const TriangleMesh& mesh = shape.mesh;
    const MeshQuery query(mesh);
    const adapter::FaceTree tree(mesh);
    const double extent = geometry::longest_extent(mesh);
    for (int i = 0; i < 100; ++i) {
      Vector3d corner = drawn_point(random, grown(query.box(), extent / 10));
      // Every other box begins at a vertex, which it touches.
      if (i % 2 == 0) corner = mesh.vertices[random.index(mesh.vertices.size())];
      const double size = extent * std::pow(10.0, random.uniform(-3.0, -0.5));
      const AlignedBox3d box(
          corner, corner + drawn_point(random, {Vector3d::Zero(), Vector3d::Constant(size)}));
      std::vector<std::int32_t> expected;
      for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        if (box.intersects(geometry::internal::box_of(geometry::corners(mesh, face)))) {
          expected.push_back(static_cast<std::int32_t>(face));
        }
      }
      const std::vector<std::int32_t> ours = query.faces_near(box);
      CHECK(ours == expected);
      std::vector<adapter::FaceTree::Tree::Primitive_id> ids;
      tree.tree().all_intersected_primitives(
          Epick::Iso_cuboid_3(adapter::point(box.min()), adapter::point(box.max())),
          std::back_inserter(ids));
      std::vector<std::int32_t> in_box;
      for (const auto id : ids) in_box.push_back(face_of(tree, id));
      std::sort(in_box.begin(), in_box.end());
      CHECK(std::includes(ours.begin(), ours.end(), in_box.begin(), in_box.end()));
      num_near += ours.size();
      num_in_box += in_box.size();
      num_empty += ours.empty();
    }
  }
  CHECK(num_empty > 20);
  CHECK(num_in_box > 1000);
  CHECK(num_near > num_in_box);
}

namespace {

enum class Meeting { Apart, Crossing, Nested };

/// CGAL's detection of collisions of one mesh with others. It could move them itself, but would
/// round in another way than `do_intersect`; here it is given meshes that are where they should be.
class CollisionsByCgal {
 public:
  explicit CollisionsByCgal(const TriangleMesh& mesh)
      : graph_(adapter::face_graph(mesh)), id_(detection_.add_mesh(graph_)) {}
  CollisionsByCgal(const CollisionsByCgal&) = delete;
  CollisionsByCgal& operator=(const CollisionsByCgal&) = delete;

  Meeting with(const TriangleMesh& mesh) {
    const Graph other = adapter::face_graph(mesh);
    const std::size_t other_id = detection_.add_mesh(other);
    const auto found = detection_.get_all_intersections_and_inclusions(id_);
    detection_.remove_mesh(other_id);
    if (found.empty()) return Meeting::Apart;
    return found.front().second ? Meeting::Nested : Meeting::Crossing;
  }

 private:
  Graph graph_;
  CGAL::Rigid_triangle_mesh_collision_detection<Graph> detection_;
  std::size_t id_;
};

struct MeetingCounts {
  int apart = 0;
  int crossing = 0;
  int nested = 0;

  void count(Meeting meeting) {
    apart += meeting == Meeting::Apart;
    crossing += meeting == Meeting::Crossing;
    nested += meeting == Meeting::Nested;
  }
};

}  // namespace

TEST_CASE("Solids intersect where CGAL detects a collision, down to the last bit of a touch",
          "[geometry][cgal_oracle]") {
  using testing::inward;
  const TriangleMesh hollow = geometry::concatenated(
      {geometry::box({0.12, 0.1, 0.08}), inward(geometry::box({0.09, 0.07, 0.05}))});
  const std::vector<std::pair<TriangleMesh, TriangleMesh>> solids = {
      {geometry::ball(0.04, 2), geometry::box({0.05, 0.03, 0.08})},
      {geometry::torus(0.05, 0.015, 32, 16), geometry::torus(0.04, 0.01, 24, 12)},
      {geometry::box({0.1, 0.08, 0.06}), geometry::ball(0.01, 1)},
      {hollow, geometry::ball(0.015, 1)}};
  Random random(105);
  MeetingCounts counts;
  int num_touches = 0;
  for (const auto& [mesh_a, mesh_b] : solids) {
    const MeshQuery a(mesh_a);
    const MeshQuery b(mesh_b);
    CollisionsByCgal by_cgal(mesh_a);
    for (int pose = 0; pose < 8; ++pose) {
      RigidTransform X = drawn_pose(random, 0.0);
      const Vector3d direction = drawn_pose(random, 0.0).linear().col(0);
      const auto intersects = [&](double way) {
        X.translation() = way * direction;
        return geometry::do_intersect(a, b, X);
      };
      const auto check_at = [&](double way) {
        const bool ours = intersects(way);
        const Meeting theirs = by_cgal.with(geometry::transformed(b.mesh(), X));
        CHECK(ours == (theirs != Meeting::Apart));
        counts.count(theirs);
      };
      // The second solid moves outward; where the answer changes, two neighboring doubles are
      // found.
      constexpr double kStep = 0.16 / 16;
      for (int step = 0; step < 16; ++step) {
        double before = step * kStep;
        double after = (step + 1) * kStep;
        check_at(before);
        const bool met_before = intersects(before);
        if (intersects(after) == met_before) continue;
        for (double middle = 0.5 * (before + after); before < middle && middle < after;
             middle = 0.5 * (before + after)) {
          (intersects(middle) == met_before ? before : after) = middle;
        }
        for (const double way : {before, after, before - 1e-15, after + 1e-15}) check_at(way);
        ++num_touches;
      }
    }
  }
  CHECK(num_touches > 32);
  CHECK(counts.apart > 60);
  CHECK(counts.crossing > 60);
  CHECK(counts.nested > 10);
}

TEST_CASE("Boxes on a lattice intersect where CGAL detects a collision, also where they only touch",
          "[geometry][cgal_oracle]") {
  // All coordinates are multiples of 1/4 and turns are by right angles, so that every fourth pair
  // has corners, edges or faces in common and nothing else.
  const TriangleMesh mesh_a = geometry::box({1.0, 1.5, 2.0});
  const TriangleMesh mesh_b = geometry::box({0.5, 1.0, 1.5});
  const MeshQuery a(mesh_a);
  const MeshQuery b(mesh_b);
  CollisionsByCgal by_cgal(mesh_a);
  Random random(106);
  MeetingCounts counts;
  int num_touches = 0;
  for (int i = 0; i < 400; ++i) {
    RigidTransform X = RigidTransform::Identity();
    X.linear() = drawn_quarter_turns(random);
    for (double& x : X.translation()) x = (static_cast<double>(random.index(13)) - 6.0) / 4.0;
    const TriangleMesh moved = geometry::transformed(mesh_b, X);
    const Meeting theirs = by_cgal.with(moved);
    CHECK(geometry::do_intersect(a, b, X) == (theirs != Meeting::Apart));
    counts.count(theirs);
    const AlignedBox3d common =
        geometry::bounding_box(mesh_a).intersection(geometry::bounding_box(moved));
    num_touches += common.sizes().minCoeff() == 0.0;
  }
  CHECK(num_touches > 60);
  CHECK(counts.apart > 60);
  CHECK(counts.crossing > 60);
}

}  // namespace graspfit::test_queries_against_cgal
