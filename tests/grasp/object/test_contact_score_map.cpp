#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/contact_score_map.hpp"
#include "support/catch.hpp"

namespace test_contact_score_map {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using Eigen::Vector3i;
using geometry::SurfacePatch;
using geometry::VoxelLattice;
using testing::Contains;

namespace {

// Sums are of at most a hundred numbers near one.
constexpr double kRounding = 1e-12;

/// Returns a lattice of voxels of half a meter, all of whose planes are doubles without rounding.
VoxelLattice half_meter_lattice(int count) {
  return {.origin = Vector3d::Zero(), .voxel_size = 0.5, .counts = Vector3i::Constant(count)};
}

/// Returns a patch with its centroid at `offset` voxels from the low corner of its voxel.
SurfacePatch patch(const VoxelLattice& lattice, const Vector3i& voxel, const Vector3d& offset,
                   const Vector3d& normal) {
  SurfacePatch result;
  result.voxel = lattice.index(voxel);
  result.area = lattice.voxel_size * lattice.voxel_size;
  result.centroid = lattice.origin + lattice.voxel_size * (voxel.cast<double>() + offset);
  result.outward_normal = normal;
  result.has_normal = true;
  return result;
}

const ScoreOptions kUnfilteredRaw{.normalization = ScoreNormalization::Raw,
                                  .mean_filter_passes = 0};

/// An object on its lattice of 30 voxels along the longest extent.
struct VoxelizedObject {
  VoxelLattice lattice;
  std::vector<SurfacePatch> patches;

  explicit VoxelizedObject(const geometry::TriangleMesh& mesh)
      : lattice(geometry::lattice_around(geometry::bounding_box(mesh), {.resolution = 30})),
        patches(geometry::surface_patches(mesh, lattice)) {}
};

geometry::TriangleMesh ellipsoid(const Vector3d& half_axes) {
  geometry::TriangleMesh mesh = geometry::ball(1.0, 6);
  for (Vector3d& vertex : mesh.vertices) vertex = half_axes.cwiseProduct(vertex);
  return mesh;
}

/// The shape is a ball with four round legs of diameter 2.4 below it, 30 high in all, with about
/// the surface area of an independent implementation's shape (1488). Seen from its center the
/// surface is a graph over directions, so that nothing is inside the ball: along a direction phi
/// off a leg's axis, the leg's wall is at 1.2 / sin(phi) and its end at 22.2 / cos(phi).
constexpr double kBallRadius = 9.63;
constexpr double kLegRadius = 1.2;
constexpr double kLegEnd = 22.2;

std::array<Vector3d, 4> leg_axes() {
  std::array<Vector3d, 4> axes;
  for (int i = 0; i < 4; ++i) {
    axes[i] = Vector3d(i & 1 ? 0.35 : -0.35, i & 2 ? 0.35 : -0.35, -1).normalized();
  }
  return axes;
}

geometry::TriangleMesh ball_with_legs() {
  // Directions are drawn toward the nearest leg's axis, so that the legs' thin walls get enough
  // triangles.
  geometry::TriangleMesh mesh = geometry::ball(1.0, 6);
  for (Vector3d& vertex : mesh.vertices) {
    Vector3d direction = vertex.normalized();
    for (const Vector3d& axis : leg_axes()) {
      const double phi = std::acos(std::clamp(axis.dot(direction), -1.0, 1.0));
      // The reach is in radians and less than half the angle between two legs.
      constexpr double kReach = 0.3;
      if (phi >= kReach || phi == 0.0) continue;
      const double drawn = kReach * std::pow(phi / kReach, 2.0);
      const Vector3d across = (direction - std::cos(phi) * axis).normalized();
      direction = std::cos(drawn) * axis + std::sin(drawn) * across;
      break;
    }
    double distance = kBallRadius;
    for (const Vector3d& axis : leg_axes()) {
      const double cosine = axis.dot(direction);
      const double sine = axis.cross(direction).norm();
      if (cosine <= 0.0) continue;
      distance = std::max(distance, std::min(kLegRadius / sine, kLegEnd / cosine));
    }
    vertex = distance * direction;
  }
  return mesh;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

double share_above(const std::vector<double>& scores, double threshold) {
  return static_cast<double>(std::count_if(scores.begin(), scores.end(),
                                           [&](double score) { return score > threshold; })) /
         static_cast<double>(scores.size());
}

}  // namespace

TEST_CASE("Two patches have the score of their distance and angle", "[grasp][contact_score_map]") {
  // A faces z, B faces x. B's centroid is 0.3 voxels from A's plane, A's is 1 from B's plane; the
  // angle is 90 degrees for both. The score is 1 / (C_d / 5 + 90 / 180).
  const VoxelLattice lattice = half_meter_lattice(4);
  const std::vector<SurfacePatch> patches = {
      patch(lattice, {1, 1, 1}, {0.5, 0.5, 0.5}, Vector3d::UnitZ()),
      patch(lattice, {2, 1, 1}, {0.5, 0.5, 0.2}, Vector3d::UnitX())};
  const ContactScoreMap map = contact_score_map(patches, lattice, kUnfilteredRaw);
  CHECK(map.mean_plane_distance[0] == Approx(0.3).epsilon(kRounding));
  CHECK(map.mean_plane_distance[1] == Approx(1.0).epsilon(kRounding));
  CHECK(map.mean_normal_angle_deg[0] == Approx(90).epsilon(kRounding));
  CHECK(map.mean_normal_angle_deg[1] == Approx(90).epsilon(kRounding));
  CHECK(map.scores[0] == Approx(1 / (0.06 + 0.5)).epsilon(kRounding));
  CHECK(map.scores[1] == Approx(1 / (0.2 + 0.5)).epsilon(kRounding));

  SECTION("L and gamma divide distance and angle") {
    ScoreOptions options = kUnfilteredRaw;
    options.length_voxels = 2.0;
    options.gamma_deg = 90.0;
    CHECK(contact_score_map(patches, lattice, options).scores[0] ==
          Approx(1 / (0.15 + 1.0)).epsilon(kRounding));
  }
  SECTION("the mean filter averages the two, radius 0 keeps them apart") {
    ScoreOptions options = kUnfilteredRaw;
    options.mean_filter_passes = 1;
    const double mean = (map.scores[0] + map.scores[1]) / 2;
    CHECK(contact_score_map(patches, lattice, options).scores[0] ==
          Approx(mean).epsilon(kRounding));
    options.mean_filter_radius = 0;
    CHECK(contact_score_map(patches, lattice, options).scores == map.scores);
  }
  SECTION("max: the larger score becomes 1") {
    ScoreOptions options = kUnfilteredRaw;
    options.normalization = ScoreNormalization::Max;
    const ContactScoreMap by_max = contact_score_map(patches, lattice, options);
    CHECK(by_max.scores[0] == 1.0);
    CHECK(by_max.scores[1] == Approx(0.56 / 0.7).epsilon(kRounding));
  }
  SECTION("floor-median: over 1.25 times the median, the mean of two values") {
    ScoreOptions options = kUnfilteredRaw;
    options.normalization = ScoreNormalization::FloorMedian;
    const double median = (map.scores[0] + map.scores[1]) / 2;
    CHECK(contact_score_map(patches, lattice, options).scores[1] ==
          Approx(map.scores[1] / (1.25 * median)).epsilon(kRounding));
  }
}

TEST_CASE("A plane is perfectly smooth: infinite raw, 0.8 by floor-median, 1 by max",
          "[grasp][contact_score_map]") {
  // All raw scores are equal, and so is their median, so that scores are 1 / 1.25.
  const VoxelLattice lattice = half_meter_lattice(8);
  // The oblique unit normal has components that are not doubles, the same in all patches.
  const Vector3d normal = Vector3d(0.1, -0.2, 1).normalized();
  std::vector<SurfacePatch> patches;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      patches.push_back(patch(lattice, {x, y, 3}, {0.5, 0.5, 0.0}, Vector3d::UnitZ()));
    }
  }
  const ContactScoreMap raw = contact_score_map(patches, lattice, kUnfilteredRaw);
  for (const double score : raw.scores) CHECK(std::isinf(score));
  for (const double score : contact_score_map(patches, lattice).scores) {
    CHECK(score == Approx(0.8).epsilon(kRounding));
  }
  for (const double score :
       contact_score_map(patches, lattice, {.normalization = ScoreNormalization::Max}).scores) {
    CHECK(score == Approx(1.0).epsilon(kRounding));
  }
  // Equal normals are at 0 degrees, and not at the 1e-8 rad that a cosine would leave.
  for (SurfacePatch& tilted : patches) tilted.outward_normal = normal;
  const ContactScoreMap tilted = contact_score_map(patches, lattice, kUnfilteredRaw);
  for (const double angle : tilted.mean_normal_angle_deg) CHECK(angle == 0.0);
}

TEST_CASE("Neighbors are the other patches with a normal in the 5 x 5 x 5 window",
          "[grasp][contact_score_map]") {
  const VoxelLattice lattice = half_meter_lattice(9);
  const Vector3i center(4, 4, 4);
  const SurfacePatch seed = patch(lattice, center, {0.5, 0.5, 0.5}, Vector3d::UnitZ());
  const auto score_beside = [&](const Vector3i& offset) {
    const SurfacePatch other =
        patch(lattice, center + offset, {0.5, 0.5, 0.5}, Vector3d(0.6, 0, 0.8));
    return contact_score_map({seed, other}, lattice, kUnfilteredRaw).scores[0];
  };
  SECTION("two voxels away in every direction is in, three is out") {
    for (int x = -3; x <= 3; ++x) {
      for (int y = -3; y <= 3; ++y) {
        for (int z = -3; z <= 3; ++z) {
          const Vector3i offset(x, y, z);
          if (offset.isZero()) continue;
          const bool is_inside = offset.cwiseAbs().maxCoeff() <= 2;
          CHECK((score_beside(offset) > 0.0) == is_inside);
        }
      }
    }
  }
  SECTION("alone it scores 0") {
    CHECK(contact_score_map({seed}, lattice, kUnfilteredRaw).scores == std::vector{0.0});
    CHECK(contact_score_map({seed}, lattice).scores == std::vector{0.0});
  }
  SECTION("a patch without a normal scores 0 and is nobody's neighbor") {
    SurfacePatch without = patch(lattice, {5, 4, 4}, {0.5, 0.5, 0.9}, Vector3d::Zero());
    without.has_normal = false;
    const SurfacePatch other = patch(lattice, {3, 4, 4}, {0.5, 0.5, 0.5}, Vector3d(0.6, 0, 0.8));
    const ContactScoreMap with = contact_score_map({seed, other, without}, lattice, kUnfilteredRaw);
    const ContactScoreMap alone = contact_score_map({seed, other}, lattice, kUnfilteredRaw);
    CHECK(with.scores[0] == alone.scores[0]);
    CHECK(with.scores[2] == 0.0);
    // The mean filter counts it as a 0, but does not lift it.
    ScoreOptions filtered = kUnfilteredRaw;
    filtered.mean_filter_passes = 1;
    const ContactScoreMap smooth = contact_score_map({seed, other, without}, lattice, filtered);
    CHECK(smooth.scores[0] == Approx((alone.scores[0] + alone.scores[1]) / 3).epsilon(kRounding));
    CHECK(smooth.scores[2] == 0.0);
  }
  SECTION("no patches, no scores") {
    CHECK(contact_score_map({}, lattice).scores.empty());
    CHECK(
        contact_score_map({}, lattice, {.normalization = ScoreNormalization::Max}).scores.empty());
  }
}

TEST_CASE("Signed distances cancel on uneven ground, unsigned ones do not",
          "[grasp][contact_score_map]") {
  // One neighbor is 0.4 voxels above the plane, one 0.4 below.
  const VoxelLattice lattice = half_meter_lattice(5);
  const std::vector<SurfacePatch> patches = {
      patch(lattice, {2, 2, 2}, {0.5, 0.5, 0.5}, Vector3d::UnitZ()),
      patch(lattice, {1, 2, 2}, {0.5, 0.5, 0.9}, Vector3d::UnitZ()),
      patch(lattice, {3, 2, 2}, {0.5, 0.5, 0.1}, Vector3d::UnitZ())};
  ScoreOptions options = kUnfilteredRaw;
  options.plane_distance = PlaneDistance::Unsigned;
  CHECK(contact_score_map(patches, lattice, options).mean_plane_distance[0] ==
        Approx(0.4).epsilon(kRounding));
  options.plane_distance = PlaneDistance::SignedMean;
  // This is 0.4 - 0.4 up to the rounding of coordinates near one.
  CHECK(contact_score_map(patches, lattice, options).mean_plane_distance[0] < 1e-15);
  CHECK(contact_score_map(patches, lattice, options).mean_plane_distance[1] ==
        Approx(0.6).epsilon(kRounding));  // It is (0.4 + 0.8) / 2, both below.
}

TEST_CASE("Turning the lattice by 90 degrees permutes the scores", "[grasp][contact_score_map]") {
  constexpr int kCount = 12;
  const VoxelLattice lattice = half_meter_lattice(kCount);
  base::Random random(7);
  std::vector<SurfacePatch> patches;
  std::vector<SurfacePatch> turned;
  for (int z = 0; z < kCount; ++z) {
    for (int y = 0; y < kCount; ++y) {
      for (int x = 0; x < kCount; ++x) {
        if (random.uniform(0.0, 1.0) > 0.3) continue;
        const Vector3d offset(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0),
                              random.uniform(0.0, 1.0));
        const Vector3d normal = Vector3d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                                         random.uniform(-1.0, 1.0))
                                    .normalized();
        patches.push_back(patch(lattice, {x, y, z}, offset, normal));
        // A quarter turn about the middle of the lattice takes (x, y, z) to (count - y, x, z).
        turned.push_back(patch(lattice, {kCount - 1 - y, x, z},
                               {1 - offset.y(), offset.x(), offset.z()},
                               {-normal.y(), normal.x(), normal.z()}));
      }
    }
  }
  const auto normalization =
      GENERATE(ScoreNormalization::FloorMedian, ScoreNormalization::Max, ScoreNormalization::Raw);
  const ScoreOptions options{.normalization = normalization};
  const std::vector<double> scores = contact_score_map(patches, lattice, options).scores;
  const std::vector<double> scores_turned = contact_score_map(turned, lattice, options).scores;
  REQUIRE(patches.size() > 400);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    CHECK(scores_turned[i] == Approx(scores[i]).epsilon(kRounding));
  }
  // The order of patches does not matter either.
  std::reverse(patches.begin(), patches.end());
  std::vector<double> reversed = contact_score_map(patches, lattice, options).scores;
  std::reverse(reversed.begin(), reversed.end());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    CHECK(reversed[i] == Approx(scores[i]).epsilon(kRounding));
  }
}

TEST_CASE("Turning an object by 90 degrees turns its scores", "[grasp][contact_score_map]") {
  // Voxels are half a meter wide again, so that the turned planes are the same doubles; the
  // object's vertices avoid them, so that no tie rule decides.
  geometry::TriangleMesh mesh = ellipsoid({5.03, 3.02, 2.51});
  geometry::TriangleMesh mesh_turned = mesh;
  for (Vector3d& v : mesh_turned.vertices) v = Vector3d(-v.y(), v.x(), v.z());
  VoxelLattice lattice = half_meter_lattice(24);
  lattice.origin = Vector3d::Constant(-6.0);
  const auto patches = geometry::surface_patches(mesh, lattice);
  const auto patches_turned = geometry::surface_patches(mesh_turned, lattice);
  REQUIRE(patches.size() == patches_turned.size());
  const ContactScoreMap map = contact_score_map(patches, lattice);
  const ContactScoreMap map_turned = contact_score_map(patches_turned, lattice);
  std::vector<std::int64_t> patch_of_voxel(lattice.num_voxels(), -1);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Vector3i voxel = lattice.voxel(patches[i].voxel);
    patch_of_voxel[lattice.index({23 - voxel.y(), voxel.x(), voxel.z()})] =
        static_cast<std::int64_t>(i);
  }
  for (std::size_t i = 0; i < patches_turned.size(); ++i) {
    const std::int64_t original = patch_of_voxel[patches_turned[i].voxel];
    REQUIRE(original >= 0);
    // Areas of slivers are differences of rounded products, so weights agree to about 1e-9 only.
    CHECK(map_turned.scores[i] == Approx(map.scores[original]).epsilon(1e-7));
  }
}

TEST_CASE("Flat faces score at least as high as curved surface", "[grasp][contact_score_map]") {
  // The cylinder is as thick as long, and interiors of the caps are compared with the wall.
  const double half_height = 0.05;
  const VoxelizedObject object(geometry::cylinder(0.05, 2 * half_height));
  const auto normalization =
      GENERATE(ScoreNormalization::FloorMedian, ScoreNormalization::Max, ScoreNormalization::Raw);
  const ContactScoreMap map =
      contact_score_map(object.patches, object.lattice, {.normalization = normalization});
  const double h = object.lattice.voxel_size;
  double lowest_flat = std::numeric_limits<double>::infinity();
  double highest_curved = 0.0;
  for (std::size_t i = 0; i < object.patches.size(); ++i) {
    const Vector3d& c = object.patches[i].centroid;
    // In the interior no neighbor of a neighbor in the mean filter sees the rim.
    if (c.head<2>().norm() < 0.05 - 4 * std::sqrt(2.0) * h) {
      lowest_flat = std::min(lowest_flat, map.scores[i]);
    } else if (std::abs(c.z()) < half_height - 4 * h) {
      highest_curved = std::max(highest_curved, map.scores[i]);
    }
  }
  CHECK(highest_curved > 0.0);
  CHECK(lowest_flat >= highest_curved);
}

TEST_CASE("Scores of round shapes agree with an independent experiment",
          "[grasp][contact_score_map]") {
  // The values are of an independent implementation. They depend on where the shape lies in the
  // grid and are good to about 10 %. They are raw percentiles without the mean filter, and the
  // share of voxels above 0.6 with it, normalized by the median.
  struct Row {
    std::string name;
    geometry::TriangleMesh mesh;
    double raw_5, raw_50, raw_95;
    double share;
  };
  const std::vector<Row> rows = {
      {"sphere", geometry::ball(0.05, 6), 12.1, 12.9, 14.0, 1.00},
      {"ellipsoid", ellipsoid({0.05, 0.03, 0.0265}), 5.6, 8.8, 12.2, 0.86},
      {"torus", geometry::torus(0.05, 0.35 * 0.05), 4.4, 5.1, 6.6, 1.00}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    const VoxelizedObject object(row.mesh);
    const std::vector<double> raw =
        contact_score_map(object.patches, object.lattice, kUnfilteredRaw).scores;
    CHECK(percentile(raw, 0.05) == Approx(row.raw_5).epsilon(0.1));
    CHECK(percentile(raw, 0.50) == Approx(row.raw_50).epsilon(0.1));
    CHECK(percentile(raw, 0.95) == Approx(row.raw_95).epsilon(0.1));
    CHECK(share_above(raw, 0.6) == 1.0);
    const std::vector<double> scores = contact_score_map(object.patches, object.lattice).scores;
    CHECK(share_above(scores, 0.6) == Approx(row.share).epsilon(0.1));
    CHECK(*std::max_element(scores.begin(), scores.end()) <= 1.0);
  }
}

TEST_CASE(
    "Shares above the threshold agree with an independent experiment on flat and mixed shapes",
    "[grasp][contact_score_map]") {
  // The shares are of an independent implementation, normalized by the median: edges and rims are
  // rejected, faces and walls are not.
  std::vector<Eigen::Vector2d> half_disk = {{0.0, 1.0}};
  for (int i = 1; i < 48; ++i) {
    const double angle = std::numbers::pi / 2 * i / 48;
    half_disk.emplace_back(std::sin(angle), std::cos(angle));
  }
  half_disk.insert(half_disk.end(), {{1.0, 0.0}, {0.0, 0.0}});
  struct Row {
    std::string name;
    geometry::TriangleMesh mesh;
    double share;
  };
  const std::vector<Row> rows = {{"box", geometry::box({0.30, 0.20, 0.15}), 0.59},
                                 {"half ball", geometry::solid_of_revolution(half_disk), 0.81},
                                 {"cylinder", geometry::cylinder(0.225, 1.0), 0.75}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    const VoxelizedObject object(row.mesh);
    const std::vector<double> scores = contact_score_map(object.patches, object.lattice).scores;
    CHECK(share_above(scores, 0.6) == Approx(row.share).epsilon(0.1));
  }
}

TEST_CASE("Thin legs score lowest and are rejected by the threshold",
          "[grasp][contact_score_map]") {
  const VoxelizedObject object(ball_with_legs());
  const double h = object.lattice.voxel_size;
  REQUIRE(2 * kLegRadius / h == Approx(2.4).epsilon(0.02));
  const ContactScoreMap map = contact_score_map(object.patches, object.lattice);
  double highest_leg = 0.0;
  int num_legs = 0;
  std::vector<double> upper_half;
  for (std::size_t i = 0; i < object.patches.size(); ++i) {
    const Vector3d& c = object.patches[i].centroid;
    if (c.norm() > kBallRadius + h) {
      highest_leg = std::max(highest_leg, map.scores[i]);
      ++num_legs;
    } else if (c.z() > 0.0) {
      upper_half.push_back(map.scores[i]);
    }
  }
  REQUIRE(num_legs > 200);
  CHECK(highest_leg < 0.6);
  CHECK(highest_leg < *std::min_element(upper_half.begin(), upper_half.end()));
  CHECK(share_above(upper_half, 0.6) == 1.0);
  // The independent implementation found 63 % for its shape; how far its legs stick out is not
  // known.
  CHECK(share_above(map.scores, 0.6) == Approx(0.63).margin(0.1));
}

TEST_CASE("Score options out of range are refused by field and value",
          "[grasp][contact_score_map]") {
  struct Case {
    std::string field, value;
    std::function<void(ScoreOptions&)> set;
  };
  const std::vector<Case> cases = {
      {"neighborhood", "4", [](ScoreOptions& o) { o.neighborhood = 4; }},
      {"neighborhood", "1", [](ScoreOptions& o) { o.neighborhood = 1; }},
      {"gamma_deg", "0", [](ScoreOptions& o) { o.gamma_deg = 0; }},
      {"length_voxels", "-5", [](ScoreOptions& o) { o.length_voxels = -5; }},
      {"mean_filter_radius", "-1", [](ScoreOptions& o) { o.mean_filter_radius = -1; }},
      {"mean_filter_passes", "-2", [](ScoreOptions& o) { o.mean_filter_passes = -2; }},
      {"floor", "0", [](ScoreOptions& o) { o.floor = 0; }},
      {"median_factor", "nan", [](ScoreOptions& o) { o.median_factor = std::nan(""); }},
  };
  const VoxelLattice lattice = half_meter_lattice(4);
  CHECK_NOTHROW(ScoreOptions{}.validate());
  for (const Case& bad : cases) {
    ScoreOptions options;
    bad.set(options);
    CHECK_THROWS_AS(options.validate(), base::InvalidInput);
    CHECK_THROWS_WITH(options.validate(),
                      Contains("ScoreOptions") && Contains(bad.field + " = " + bad.value));
    CHECK_THROWS_AS(contact_score_map({}, lattice, options), base::InvalidInput);
  }
}

TEST_CASE("A patch outside the lattice is refused", "[grasp][contact_score_map]") {
  const VoxelLattice lattice = half_meter_lattice(4);
  SurfacePatch outside = patch(lattice, {1, 1, 1}, {0.5, 0.5, 0.5}, Vector3d::UnitZ());
  outside.voxel = 64;
  CHECK_THROWS_WITH(contact_score_map({outside}, lattice), Contains("voxel = 64"));
  outside.voxel = -1;
  CHECK_THROWS_AS(contact_score_map({outside}, lattice), base::InvalidInput);
}

}  // namespace test_contact_score_map
