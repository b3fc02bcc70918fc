// What it measures: questions about meshes and points beside the same questions to CGAL, on the
// bunny (75 408 faces) of 0.15 m: nearest points, containment, rays, boxes, distance from and
// collisions with a body of a finger's size, crossing faces; then hulls in space and the union of
// two balls.
//
// How to read it: times are processor times per question, medians of repetitions that are
// interleaved, so that whatever else the machine does hits both sides. "ratio" is ours over CGAL's,
// below 1 is faster; "by wall time" is the same ratio of wall times, which should differ little:
// both use one thread. What both answer is compared, too. The two do not always do the same: ours
// names the first of equally near faces, sorts hits and says how they cross, gives hulls whose form
// does not depend on memory, rounds a union from exact points, and `analyze` counts more than
// crossing faces; CGAL's tree decides for a box which triangles meet it, ours which boxes of
// triangles do; the distance of two surfaces, which CGAL does not have, is beside those of one's
// corners from the other, which bound it from above.
//
// "[union_of_pieces]": the union of the pieces of a convex decomposition of the duck (0.15 m),
// their faces subdivided to about 36 000 in all, beside CGAL's corefinement of one after the other.
//
// Run: build/unity/bin/graspfit_benchmarks "[queries]".
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "queries_by_cgal.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"
#include "timing.hpp"

namespace {

using namespace graspfit;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using geometry::MeshQuery;
using geometry::RigidTransform;
using geometry::TriangleMesh;
using testing::median;
using testing::seconds_of;

constexpr double kMicro = 1e6;
constexpr int kRuns = 11;

struct Times {
  std::vector<double> processor;
  std::vector<double> wall;

  void add(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    wall.push_back(seconds_of(work));
    processor.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
};

/// What both sides answered, added up over the questions.
struct Sums {
  double ours = 0.0;
  double theirs = 0.0;
};

/// Asks both sides in turns and prints a row. Each side asks `count` questions and returns the sum
/// of the answers.
Sums compare(const std::string& name, std::size_t count, const std::function<double()>& ours,
             const std::function<double()>& theirs, int runs = kRuns) {
  Times our_times, their_times;
  Sums sums;
  for (int run = 0; run < runs; ++run) {
    our_times.add([&] { sums.ours = ours(); });
    their_times.add([&] { sums.theirs = theirs(); });
  }
  const double per_question = kMicro / static_cast<double>(count);
  const double our_time = median(our_times.processor);
  const double their_time = median(their_times.processor);
  std::printf("  %-44s %12.2f us %12.2f us %7.2f %12.2f\n", name.c_str(), our_time * per_question,
              their_time * per_question, our_time / their_time,
              median(our_times.wall) / median(their_times.wall));
  return sums;
}

template <class Item, class Answer>
double sum_over(const std::vector<Item>& items, const Answer& answer) {
  return std::accumulate(items.begin(), items.end(), 0.0, [&](double sum, const Item& item) {
    return sum + static_cast<double>(answer(item));
  });
}

Vector3d drawn_point(base::Random& random, const AlignedBox3d& box) {
  Vector3d point;
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] = random.uniform(box.min()[axis], box.max()[axis]);
  }
  return point;
}

AlignedBox3d cube_around(const Vector3d& center, double half_edge) {
  return {center - Vector3d::Constant(half_edge), center + Vector3d::Constant(half_edge)};
}

/// Returns a point that is at most `distance` off the surface along each axis.
Vector3d drawn_near(base::Random& random, const TriangleMesh& mesh, double distance) {
  const auto [a, b, c] = geometry::corners(mesh, random.index(mesh.faces.size()));
  const double u = std::sqrt(random.uniform());
  const double v = random.uniform();
  const Vector3d on_face = a + u * (1.0 - v) * (b - a) + u * v * (c - a);
  return on_face + drawn_point(random, cube_around(Vector3d::Zero(), distance));
}

RigidTransform drawn_turn(base::Random& random) {
  Eigen::Vector4d q;
  for (double& x : q) x = random.uniform(-1.0, 1.0);
  return RigidTransform(Eigen::Quaterniond(q).normalized());
}

struct Ray {
  Vector3d origin;
  Vector3d direction;
};

/// Returns poses of `b` in the frame of `a` that are `gap` beyond the place where, drawn out of the
/// middle of `a` along some line, it lets go of `a`; overlapping if `gap` is negative.
std::vector<RigidTransform> poses_near_touch(base::Random& random, const MeshQuery& a,
                                             const MeshQuery& b, double gap, int count) {
  std::vector<RigidTransform> poses;
  for (int i = 0; i < count; ++i) {
    RigidTransform X_AB = drawn_turn(random);
    const Vector3d direction = drawn_turn(random).linear().col(0);
    const auto place = [&](double way) { X_AB.translation() = a.box().center() + way * direction; };
    double inside = 0.0;
    double outside = a.box().diagonal().norm() + b.box().diagonal().norm();
    while (outside - inside > 1e-6) {
      const double middle = 0.5 * (inside + outside);
      place(middle);
      (geometry::do_intersect(a, b, X_AB) ? inside : outside) = middle;
    }
    place(outside + gap);
    poses.push_back(X_AB);
  }
  return poses;
}

void compare_questions_to_tree(const TriangleMesh& mesh, base::Random& random) {
  std::optional<MeshQuery> query;
  testing::QueriesByCgal cgal(mesh);
  const auto build = [&] {
    query.emplace(mesh);
    // The first question builds the tree.
    return query->containment(query->box().min() - Vector3d::Ones()) ==
           geometry::Containment::Inside;
  };
  for (const bool for_distances : {false, true}) {
    compare(for_distances ? "tree, CGAL's with its tree of hints" : "tree", 1, build, [&] {
      cgal.build_tree(mesh, for_distances);
      return 0.0;
    });
  }

  std::vector<Vector3d> near, anywhere;
  std::vector<Ray> rays;
  std::vector<AlignedBox3d> boxes;
  for (int i = 0; i < 2000; ++i) {
    near.push_back(drawn_near(random, mesh, 0.005));
    anywhere.push_back(drawn_point(random, query->box()));
    const Vector3d origin = drawn_point(random, query->box());
    rays.push_back({origin, drawn_point(random, query->box()) - origin});
    boxes.push_back(cube_around(drawn_near(random, mesh, 0.005), 0.005));
  }
  const auto compare_points = [&](const std::string& where, const std::vector<Vector3d>& points) {
    const Sums distances = compare(
        "closest_point, " + where, points.size(),
        [&] {
          return sum_over(points, [&](const Vector3d& point) {
            return std::sqrt(query->closest_point(point).squared_distance);
          });
        },
        [&] {
          return sum_over(points, [&](const Vector3d& point) { return cgal.distance(point); });
        });
    CHECK(distances.ours == Approx(distances.theirs).epsilon(1e-9));
    const Sums inside = compare(
        "containment, " + where, points.size(),
        [&] {
          return sum_over(points, [&](const Vector3d& point) {
            return query->containment(point) == geometry::Containment::Inside;
          });
        },
        [&] {
          return sum_over(points, [&](const Vector3d& point) { return cgal.is_inside(point); });
        });
    CHECK(inside.ours == inside.theirs);
  };
  compare_points("within 5 mm of the surface", near);
  compare_points("anywhere in the box", anywhere);

  const Sums hits = compare(
      "first_hit", rays.size(),
      [&] {
        return sum_over(rays, [&](const Ray& ray) {
          return query->first_hit(ray.origin, ray.direction).has_value();
        });
      },
      [&] {
        return sum_over(rays,
                        [&](const Ray& ray) { return cgal.does_hit(ray.origin, ray.direction); });
      });
  CHECK(hits.ours == hits.theirs);
  const Sums all_hits = compare(
      "all_hits", rays.size(),
      [&] {
        return sum_over(rays, [&](const Ray& ray) {
          return query->all_hits(ray.origin, ray.direction).size();
        });
      },
      [&] {
        return sum_over(rays,
                        [&](const Ray& ray) { return cgal.num_hits(ray.origin, ray.direction); });
      });
  CHECK(all_hits.ours == all_hits.theirs);
  const Sums faces = compare(
      "faces_near, boxes of 10 mm", boxes.size(),
      [&] {
        return sum_over(boxes,
                        [&](const AlignedBox3d& box) { return query->faces_near(box).size(); });
      },
      [&] {
        return sum_over(boxes, [&](const AlignedBox3d& box) { return cgal.num_faces_in(box); });
      });
  CHECK(faces.ours >= faces.theirs);

  const Sums crossings = compare(
      "crossing faces, by analyze", 1,
      [&] {
        return static_cast<double>(
            *geometry::analyze(mesh, {.count_self_intersections = true}).num_self_intersections);
      },
      [&] { return static_cast<double>(cgal.num_self_intersections()); }, 5);
  CHECK(crossings.ours == crossings.theirs);
}

void compare_collisions(const TriangleMesh& mesh, base::Random& random) {
  const TriangleMesh finger = geometry::capsule(0.008, 0.03);
  const MeshQuery a(mesh);
  const MeshQuery b(finger);
  testing::CollisionByCgal cgal(mesh, finger);
  for (const double gap : {1e-4, -1e-4}) {
    const std::vector<RigidTransform> poses = poses_near_touch(random, a, b, gap, 200);
    const Sums met = compare(
        gap > 0.0 ? "do_intersect, a finger 0.1 mm off" : "do_intersect, a finger 0.1 mm deep",
        poses.size(),
        [&] {
          return sum_over(poses,
                          [&](const RigidTransform& X) { return geometry::do_intersect(a, b, X); });
        },
        [&] {
          return sum_over(poses, [&](const RigidTransform& X) { return cgal.do_intersect(X); });
        });
    CHECK(met.ours == met.theirs);
  }
}

/// CGAL has no distance of two surfaces. The distances of one's corners from the other bound it
/// from above.
void compare_distances(const TriangleMesh& mesh, base::Random& random) {
  const TriangleMesh finger = geometry::capsule(0.008, 0.03);
  const MeshQuery a(mesh);
  const MeshQuery b(finger);
  testing::QueriesByCgal cgal(mesh);
  cgal.build_tree(mesh, true);
  for (const double gap : {1e-3, 5e-3}) {
    const std::vector<RigidTransform> poses = poses_near_touch(random, a, b, gap, 200);
    std::vector<geometry::ProximitySeed> seeds;
    for (RigidTransform X : poses) {
      X.translation() += drawn_point(random, cube_around(Vector3d::Zero(), 1e-3));
      const auto before =
          geometry::nearest_points(a, b, X, std::numeric_limits<double>::infinity());
      seeds.push_back({before->face_a, before->face_b});
    }
    for (const bool is_seeded : {false, true}) {
      const Sums distances = compare(
          std::string("nearest_points, a finger ") + (gap < 2e-3 ? "1" : "5") + " mm off" +
              (is_seeded ? ", seeded" : ""),
          poses.size(),
          [&] {
            double sum = 0.0;
            for (std::size_t i = 0; i < poses.size(); ++i) {
              sum +=
                  geometry::nearest_points(a, b, poses[i], std::numeric_limits<double>::infinity(),
                                           is_seeded ? std::optional(seeds[i]) : std::nullopt)
                      ->distance;
            }
            return sum;
          },
          [&] {
            return sum_over(poses, [&](const RigidTransform& X) {
              double least = std::numeric_limits<double>::infinity();
              for (const Vector3d& vertex : finger.vertices) {
                least = std::min(least, cgal.distance(X * vertex));
              }
              return least;
            });
          });
      CHECK(distances.ours <= distances.theirs);
      CHECK(distances.ours >= 0.5 * distances.theirs);
    }
  }
}

void compare_hulls(base::Random& random) {
  for (const std::size_t size : {16, 200}) {
    std::vector<std::vector<Vector3d>> sets(400);
    for (std::vector<Vector3d>& points : sets) {
      while (points.size() < size) {
        points.push_back(drawn_point(random, cube_around(Vector3d::Zero(), 1.0)));
      }
    }
    const Sums facets = compare(
        "convex_hull, " + std::to_string(size) + " points", sets.size(),
        [&] {
          return sum_over(sets, [](const std::vector<Vector3d>& points) {
            return geometry::convex_hull(points).facets.size();
          });
        },
        [&] {
          return sum_over(sets, [](const std::vector<Vector3d>& points) {
            return testing::num_hull_facets_by_cgal(points);
          });
        });
    CHECK(facets.ours == facets.theirs);
  }
}

void compare_unions() {
  RigidTransform beside = RigidTransform::Identity();
  beside.translation() = Vector3d(0.031, 0.022, 0.013);
  const TriangleMesh ball = geometry::ball(0.05, 5);
  const std::vector<TriangleMesh> balls = {ball, geometry::transformed(ball, beside)};
  const TriangleMesh two = geometry::concatenated(balls);
  testing::UnionByCgal cgal(balls);
  TriangleMesh boundary;
  compare(
      "union of two balls of 20 480 faces", 1,
      [&] {
        boundary = geometry::solid_boundary(two);
        return static_cast<double>(boundary.faces.size());
      },
      [&] { return static_cast<double>(cgal.unite()); }, 5);
  CHECK(geometry::signed_volume(boundary) == Approx(cgal.volume()).epsilon(1e-9));
}

/// Every face in n² of its shape; neighbors share their vertices.
TriangleMesh subdivided(const TriangleMesh& mesh, int n) {
  TriangleMesh fine;
  std::map<std::array<double, 3>, int> known;
  const auto vertex = [&](const Vector3d& point) {
    const auto [at, is_new] = known.try_emplace({point.x(), point.y(), point.z()},
                                                static_cast<int>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(point);
    return at->second;
  };
  for (const geometry::Face& face : mesh.faces) {
    // The sum of terms in the order of the indices is the same from both sides of an edge.
    const auto point = [&](int i, int j) {
      std::array<std::pair<int, int>, 3> terms = {
          {{face[0], n - i - j}, {face[1], i}, {face[2], j}}};
      std::sort(terms.begin(), terms.end());
      Vector3d sum = Vector3d::Zero();
      for (const auto& [index, weight] : terms) {
        if (weight > 0) sum += (static_cast<double>(weight) / n) * mesh.vertices[index];
      }
      return vertex(sum);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        fine.faces.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
        if (i + j + 1 == n) continue;
        fine.faces.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
      }
    }
  }
  return fine;
}

TEST_CASE("The union of a solid's convex pieces", "[!benchmark][union_of_pieces]") {
  const auto file = testing::find_data("meshes/paper/duck.obj");
  if (!file) GRASPFIT_SKIP_TEST("meshes/paper/duck.obj is not in the data folder");
  const TriangleMesh read = geometry::repair_mesh(geometry::read_mesh(*file).mesh).mesh;
  const TriangleMesh duck = geometry::scaled(read, 0.15 / geometry::longest_extent(read));
  const geometry::ConvexDecomposition cut = geometry::convex_decomposition(duck, {.max_pieces = 8});
  std::vector<TriangleMesh> pieces = cut.pieces;
  std::size_t num_coarse = 0;
  for (const TriangleMesh& piece : pieces) num_coarse += piece.faces.size();
  const int n = static_cast<int>(std::lround(std::sqrt(36000.0 / static_cast<double>(num_coarse))));
  for (TriangleMesh& piece : pieces) piece = subdivided(piece, n);
  const TriangleMesh all = geometry::concatenated(pieces);
  TriangleMesh boundary;
  const double seconds = seconds_of([&] { boundary = geometry::solid_boundary(all); });
  std::printf("\n  union of %zu pieces of the duck, %zu faces: %.2f s, %zu faces, %.6g m3\n",
              pieces.size(), all.faces.size(), seconds, boundary.faces.size(),
              geometry::signed_volume(boundary));
  const double solid = geometry::mass_properties(duck).volume;
  // That of the pieces is known from 128 x 128 lines.
  CHECK(geometry::signed_volume(boundary) ==
        Approx((1.0 + cut.volume_error) * solid).epsilon(1e-3));
  testing::UnionByCgal cgal(pieces);
  try {
    const double theirs = seconds_of([&] { cgal.unite(); });
    std::printf("  CGAL, one after the other: %.2f s, %.6g m3\n", theirs, cgal.volume());
  } catch (const base::DegenerateGeometry&) {
    std::printf("  CGAL's corefinement refuses them\n");
  }
}

TEST_CASE("The union of overlapping parts", "[!benchmark][union_of_pieces]") {
  const auto file = testing::find_data("meshes/paper/cage.obj");
  if (!file) GRASPFIT_SKIP_TEST("meshes/paper/cage.obj is not in the data folder");
  const TriangleMesh read = geometry::repair_mesh(geometry::read_mesh(*file).mesh).mesh;
  const TriangleMesh cage = geometry::scaled(read, 0.15 / geometry::longest_extent(read));
  TriangleMesh boundary;
  const double seconds = seconds_of([&] { boundary = geometry::solid_boundary(cage); });
  std::printf("\n  union of a bird cage's parts, %zu faces: %.2f s, %zu faces, %.6g m3\n",
              cage.faces.size(), seconds, boundary.faces.size(), geometry::signed_volume(boundary));
  // Where parts overlap they count once.
  CHECK(geometry::signed_volume(boundary) < geometry::signed_volume(cage));
}

TEST_CASE("Questions about meshes and points beside CGAL", "[!benchmark][queries]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  const TriangleMesh read = geometry::repair_mesh(geometry::read_mesh(*file).mesh).mesh;
  const TriangleMesh mesh = geometry::scaled(read, 0.15 / geometry::longest_extent(read));
  base::Random random(17);
  std::printf("\nQuestions to a mesh of %zu faces, hulls and unions (one thread)\n",
              mesh.faces.size());
  std::printf("  %-44s %15s %15s %7s %12s\n", "", "ours", "CGAL's", "ratio", "by wall time");
  compare_questions_to_tree(mesh, random);
  compare_distances(mesh, random);
  compare_collisions(mesh, random);
  compare_hulls(random);
  compare_unions();
}

}  // namespace
