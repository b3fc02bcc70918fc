#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "support/catch.hpp"

namespace test_convex_decomposition {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

using Eigen::Vector3d;

constexpr double kWanted = 0.001;

TriangleMesh moved(const TriangleMesh& mesh, const Vector3d& by) {
  return transformed(mesh, RigidTransform(Eigen::Translation3d(by)));
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Face& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

TriangleMesh l_shape() {
  return solid_boundary(
      concatenated({box({0.09, 0.03, 0.03}), moved(box({0.03, 0.03, 0.06}), {-0.03, 0.0, 0.03})}));
}

/// Returns a ball of 40 mm with a cavity of 30 mm.
TriangleMesh hollow_ball() { return concatenated({ball(0.04, 3), inside_out(ball(0.03, 3))}); }

/// Returns a slot of 30 mm, open at the top, in a block of 90 × 60 × 60 mm: three boxes.
TriangleMesh slotted_block() {
  return solid_boundary(
      concatenated({box({0.09, 0.06, 0.03}), moved(box({0.03, 0.06, 0.06}), {-0.03, 0.0, 0.015}),
                    moved(box({0.03, 0.06, 0.06}), {0.03, 0.0, 0.015})}));
}

struct Union {
  std::vector<ConvexPolytope> pieces;
  MeshQuery surface;

  explicit Union(const ConvexDecomposition& result) : surface(concatenated(result.pieces)) {
    for (const TriangleMesh& piece : result.pieces) {
      Eigen::Matrix3Xd points(3, piece.vertices.size());
      for (std::size_t i = 0; i < piece.vertices.size(); ++i) {
        points.col(static_cast<Eigen::Index>(i)) = piece.vertices[i];
      }
      pieces.emplace_back(points);
    }
  }
  bool holds(const Vector3d& point) const {
    return std::any_of(pieces.begin(), pieces.end(), [&](const ConvexPolytope& piece) {
      return piece.containment(point) != Containment::Outside;
    });
  }
  /// Returns the distance from the pieces, zero inside [m].
  double distance(const Vector3d& point) const {
    return holds(point) ? 0.0 : std::sqrt(surface.closest_point(point).squared_distance);
  }
};

/// Checks what must be true of any result, by independent queries.
void check(const TriangleMesh& mesh, const ConvexDecomposition& result) {
  const MeshQuery solid(mesh);
  const Union pieces(result);
  for (std::size_t i = 0; i < result.pieces.size(); ++i) {
    const TriangleMesh& piece = result.pieces[i];
    const MeshAnalysis analysis = analyze(piece);
    CHECK(analysis.is_outward);
    CHECK(analysis.is_manifold);
    CHECK(analysis.num_parts == 1);
    // All vertices are extreme, so that the piece is convex.
    CHECK(pieces.pieces[i].vertices().size() == piece.vertices.size());
    CHECK(mass_properties(piece).volume == Approx(pieces.pieces[i].volume()).epsilon(1e-9));
  }
  const Eigen::AlignedBox3d box = solid.box();
  const Vector3d room = 0.05 * box.sizes();
  Random random(5);
  double outward = 0.0;
  double inward = 0.0;
  int num_in_union = 0;
  for (int i = 0; i < 4000; ++i) {
    Vector3d point;
    for (int k = 0; k < 3; ++k) {
      point[k] = random.uniform(box.min()[k] - room[k], box.max()[k] + room[k]);
    }
    const double depth = solid.signed_distance(point);
    if (pieces.holds(point)) {
      ++num_in_union;
      outward = std::max(outward, depth);
    } else if (depth < 0.0) {
      inward = std::max(inward, pieces.distance(point));
    }
  }
  for (std::size_t i = 0; i < mesh.faces.size(); i += 1 + mesh.faces.size() / 2000) {
    const auto p = corners(mesh, i);
    inward = std::max(inward, pieces.distance((p[0] + p[1] + p[2]) / 3.0));
  }
  const double rounding = 1e-12;  // The unit is m, of coordinates below 1 m.
  CHECK(num_in_union > 0);
  CHECK(outward <= result.outward_deviation + rounding);
  CHECK(inward <= result.inward_deviation + rounding);
  CHECK(result.is_within_deviation == (result.outward_deviation <= kWanted));
}

}  // namespace

TEST_CASE("A convex solid is one piece, itself", "[geometry][convex_decomposition]") {
  const TriangleMesh solid = GENERATE(box({0.1, 0.05, 0.02}), cylinder(0.03, 0.1, 24));
  const ConvexDecomposition result = convex_decomposition(solid);
  REQUIRE(result.pieces.size() == 1);
  CHECK(result.pieces[0].vertices.size() == (solid.faces.size() == 12 ? 8 : 48));
  CHECK(result.outward_deviation == 0.0);
  CHECK(result.inward_deviation == 0.0);
  CHECK(std::abs(result.volume_error) < 1e-12);
  check(solid, result);
}

TEST_CASE("Solids of boxes are cut along their own planes", "[geometry][convex_decomposition]") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    std::size_t num_pieces;
  };
  const std::vector<Case> cases = {{"L", l_shape(), 2}, {"slot", slotted_block(), 3}};
  for (const Case& c : cases) {
    INFO(c.name);
    const ConvexDecomposition result = convex_decomposition(c.mesh);
    CHECK(result.pieces.size() == c.num_pieces);
    CHECK(result.outward_deviation == 0.0);
    CHECK(std::abs(result.volume_error) < 1e-12);
    check(c.mesh, result);
  }
}

TEST_CASE("Pieces follow the solid within the deviations that they state",
          "[geometry][convex_decomposition]") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
  };
  const std::vector<Case> cases = {
      {"torus", torus(0.04, 0.015, 32, 16)},
      {"two balls that overlap",
       concatenated({ball(0.03, 2), moved(ball(0.03, 2), {0.035, 0.0, 0.0})})}};
  for (const Case& c : cases) {
    INFO(c.name);
    const ConvexDecomposition result =
        convex_decomposition(c.mesh, {.largest_deviation = kWanted, .max_pieces = 16});
    CHECK(result.pieces.size() <= 16);
    check(c.mesh, result);
  }
}

TEST_CASE("A mug is empty inside and behind its handle", "[geometry][convex_decomposition][full]") {
  const TriangleMesh mesh = mug();
  const ConvexDecomposition result = convex_decomposition(mesh);
  check(mesh, result);
  const Union pieces(result);
  const MeshQuery solid(mesh);
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  Random random(7);
  int num_deep = 0;
  for (int i = 0; i < 4000; ++i) {
    Vector3d point;
    for (int k = 0; k < 3; ++k) point[k] = random.uniform(box.min()[k], box.max()[k]);
    if (solid.signed_distance(point) <= result.outward_deviation) continue;
    ++num_deep;
    CHECK_FALSE(pieces.holds(point));
  }
  CHECK(num_deep > 1000);
}

TEST_CASE("The volume error is that of the closed form", "[geometry][convex_decomposition]") {
  const TriangleMesh block = slotted_block();
  const ConvexDecomposition one = convex_decomposition(block, {.max_pieces = 1});
  REQUIRE(one.pieces.size() == 1);
  // The hull is the block of 90 × 60 × 60 mm, the solid is the block without the slot of 30 × 60 ×
  // 30 mm, in which the farthest point is 15 mm from both walls and from the floor or more.
  const double hull = 0.09 * 0.06 * 0.06;
  const double slot = 0.03 * 0.06 * 0.03;
  // It is integrated along 128 lines.
  CHECK(one.volume_error == Approx(slot / (hull - slot)).epsilon(0.02));
  CHECK(one.outward_deviation >= 0.015);
  CHECK(one.outward_deviation <= 1.05 * 0.015 + 1e-12);
  CHECK_FALSE(one.is_within_deviation);
}

TEST_CASE("Slivers of a turned bottle do not keep the cutting from its end",
          "[geometry][convex_decomposition]") {
  // The planes of the faces shave layers of micrometers off parts that stay as deep as they are,
  // which must not go on for ever. Corners are moved by up to 0.1 mm, as in scanned or converted
  // files.
  TriangleMesh mesh = scaled(bottle(), 0.32 / longest_extent(bottle()));
  Random random(3);
  for (Vector3d& vertex : mesh.vertices) {
    for (double& x : vertex) x += random.uniform(-1e-4, 1e-4);
  }
  const ConvexDecomposition result = convex_decomposition(mesh, {.max_pieces = 8});
  CHECK(result.pieces.size() <= 8);
  check(mesh, result);
}

TEST_CASE("A hole stays open and a hollow stays empty", "[geometry][convex_decomposition]") {
  const auto few = ConvexDecompositionOptions{.max_pieces = 16};
  const ConvexDecomposition ring = convex_decomposition(torus(0.04, 0.015, 32, 16), few);
  CHECK_FALSE(Union(ring).holds(Vector3d::Zero()));
  const TriangleMesh inner = box({0.06, 0.06, 0.06});
  const TriangleMesh hollow = concatenated({box({0.1, 0.1, 0.1}), inside_out(inner)});
  const ConvexDecomposition walls = convex_decomposition(hollow, few);
  CHECK_FALSE(Union(walls).holds(Vector3d::Zero()));
  check(hollow, walls);
  // The boxes are united, not hollow.
  const TriangleMesh solid = concatenated({box({0.1, 0.1, 0.1}), inner});
  CHECK(convex_decomposition(solid, few).pieces.size() == 1);
}

TEST_CASE("A hollow ball is empty, and its shell as it says",
          "[geometry][convex_decomposition][full]") {
  const TriangleMesh mesh = hollow_ball();
  const ConvexDecomposition result = convex_decomposition(mesh);
  CHECK_FALSE(Union(result).holds(Vector3d::Zero()));
  check(mesh, result);
}

TEST_CASE("A decomposition repeated is the same, and found again in the cache, to the bit",
          "[geometry][convex_decomposition]") {
  const auto folder = std::filesystem::temp_directory_path() / "graspfit_convex_decomposition";
  std::filesystem::remove_all(folder);
  const ContentCache cache{.folder = folder};
  const TriangleMesh mesh = torus(0.04, 0.015, 24, 12);
  const ConvexDecompositionOptions options{.max_pieces = 8};
  const ConvexDecomposition found = convex_decomposition(mesh, options);
  CHECK(cached_convex_decomposition(mesh, options, cache) == found);  // It is computed anew.
  CHECK(cached_convex_decomposition(mesh, options, cache) == found);
  CHECK(cache.read(kConvexDecompositionKind, convex_decomposition_key(mesh, options)));
  CHECK(convex_decomposition_key(mesh, {}) != convex_decomposition_key(mesh, options));
  std::filesystem::remove_all(folder);
}

TEST_CASE("Whoever finds a decomposition being made waits for it and takes it",
          "[geometry][convex_decomposition]") {
  const auto folder = std::filesystem::temp_directory_path() / "graspfit_convex_decomposition_lock";
  std::filesystem::remove_all(folder);
  const ContentCache cache{.folder = folder};
  const TriangleMesh mesh = torus(0.04, 0.015, 32, 16);
  const ConvexDecompositionOptions options{.max_pieces = 8};
  const std::string key = convex_decomposition_key(mesh, options);
  // The other one finds something that nobody would compute from this mesh.
  const TriangleMesh other = box({0.1, 0.05, 0.02});
  const ConvexDecomposition expected = cached_convex_decomposition(other, {}, cache);
  const auto text = cache.read(kConvexDecompositionKind, convex_decomposition_key(other, {}));
  REQUIRE(text);

  const std::string lock = cache.file_of(kConvexDecompositionKind, key)->string() + ".lock";
  const int descriptor = open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  REQUIRE(descriptor >= 0);
  REQUIRE(flock(descriptor, LOCK_EX) == 0);
  auto waiting = std::async(std::launch::async,
                            [&] { return cached_convex_decomposition(mesh, options, cache); });
  // Without a lock it would be done by then, or would have found nothing and be at work.
  const auto while_locked = waiting.wait_for(std::chrono::milliseconds(500));
  CHECK(while_locked == std::future_status::timeout);
  cache.write(kConvexDecompositionKind, key, *text);
  close(descriptor);
  CHECK(waiting.get() == expected);
  CHECK_FALSE(std::filesystem::exists(lock));
  std::filesystem::remove_all(folder);
}

TEST_CASE("What is no solid and bad options are refused", "[geometry][convex_decomposition]") {
  TriangleMesh open = box({0.1, 0.1, 0.1});
  open.faces.pop_back();
  CHECK_THROWS_AS(convex_decomposition(open), DegenerateGeometry);
  CHECK_THROWS_AS(convex_decomposition({}), DegenerateGeometry);
  CHECK_THROWS_AS(convex_decomposition(inside_out(box({0.1, 0.1, 0.1}))), DegenerateGeometry);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ConvexDecompositionOptions& bad :
       {ConvexDecompositionOptions{.largest_deviation = 0.0},
        ConvexDecompositionOptions{.largest_deviation = nan},
        ConvexDecompositionOptions{.max_pieces = 0},
        ConvexDecompositionOptions{.max_piece_vertices = 31}}) {
    CHECK_THROWS_AS(convex_decomposition(box({0.1, 0.1, 0.1}), bad), InvalidInput);
  }
}

}  // namespace test_convex_decomposition
