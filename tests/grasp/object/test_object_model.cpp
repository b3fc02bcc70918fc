#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_object_model {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using testing::Contains;

TEST_CASE("An object model's parts belong together", "[grasp][object_model]") {
  geometry::TriangleMesh mesh = geometry::box({0.06, 0.08, 0.10});
  const Vector3d center(0.3, -0.2, 0.1);
  for (Vector3d& vertex : mesh.vertices) vertex += center;
  const ObjectModel object = build_object_model(mesh, {.resolution = 20, .margin = 0.012});

  CHECK(object.mesh() == mesh);
  CHECK((object.mass.center_of_mass - center).norm() < 1e-14);
  CHECK(object.mass.volume == Approx(0.06 * 0.08 * 0.10).epsilon(1e-12));
  // The radius is half of sqrt(6² + 8² + 10²) cm.
  CHECK(object.normalizing_radius == Approx(std::sqrt(0.02) / 2).epsilon(1e-12));

  // There are 20 voxels of 5 mm along z, and the margin of 12 mm is 3 voxels on each side.
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  CHECK(lattice.voxel_size == Approx(0.005).epsilon(1e-12));
  CHECK(lattice.counts.z() == 26);
  CHECK(object.distance.lattice == lattice);

  REQUIRE(object.patch_of_voxel.size() == static_cast<std::size_t>(lattice.num_voxels()));
  REQUIRE(object.scores.scores.size() == object.patches.size());
  std::size_t num_partial = 0;
  for (std::int64_t voxel = 0; voxel < lattice.num_voxels(); ++voxel) {
    const std::int32_t patch = object.patch_of_voxel[voxel];
    const bool is_partial = object.grid.classes[voxel] == geometry::VoxelClass::Partial;
    CHECK((patch >= 0) == is_partial);
    CHECK((object.distance.values[voxel] == 0.0f) == is_partial);
    if (patch < 0) continue;
    ++num_partial;
    CHECK(object.patches[patch].voxel == voxel);
  }
  CHECK(num_partial == object.patches.size());

  CHECK(object.timings.query_s >= 0.0);
  CHECK(object.timings.patches_s > 0.0);
  CHECK(object.timings.voxels_s > 0.0);
  CHECK(object.timings.distance_s > 0.0);
  CHECK(object.timings.scores_s > 0.0);
}

TEST_CASE("A model has room of its own around the object, for any hand", "[grasp][object_model]") {
  const ObjectModel object = build_object_model(geometry::box({0.1, 0.05, 0.05}), {});
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  CHECK(lattice.counts == Eigen::Vector3i(30 + 16, 15 + 16, 15 + 16));
  // The distance of a link 1 m away is the true one: straight before a face to the voxel.
  const double h = lattice.voxel_size;
  CHECK(object.distance.at(Vector3d(0.05 + 300.5 * h, 0, 0)) == 300.0F);
}

TEST_CASE("A patch is weak if at least half of its area is on weak faces",
          "[grasp][object_model][weak]") {
  // A block has a fin 3 mm thick and long faces, so that patches at the fin's foot have both kinds.
  geometry::TriangleMesh fin = geometry::box({0.03, 0.003, 0.04});
  for (Vector3d& vertex : fin.vertices) vertex.z() += 0.03;
  const geometry::TriangleMesh mesh =
      geometry::concatenated({geometry::box({0.06, 0.04, 0.04}), fin});
  const ObjectModelOptions options{
      .resolution = 25, .weak = geometry::WeakRegionOptions{}, .weak_cache = {.is_on = false}};
  const ObjectModel object = build_object_model(mesh, options);
  CHECK(object.timings.weak_s > 0.0);
  REQUIRE(object.weak.has_value());
  REQUIRE(object.weak->regions.size() == 1);
  CHECK(object.weak->regions[0].verdict == geometry::WeakVerdict::Weak);
  std::map<std::int64_t, std::pair<double, double>> weak_and_all;
  for (const geometry::VoxelPiece& piece : geometry::clip_by_voxels(mesh, object.grid.lattice)) {
    auto& [weak, all] = weak_and_all[piece.voxel];
    all += piece.piece.area;
    if (object.weak->is_weak[piece.piece.face]) weak += piece.piece.area;
  }
  REQUIRE(object.is_weak_patch.size() == object.patches.size());
  int num_mixed = 0;
  int num_weak = 0;
  for (std::size_t i = 0; i < object.patches.size(); ++i) {
    const auto& [weak, all] = weak_and_all.at(object.patches[i].voxel);
    // It is half, but for rounding.
    if (std::abs(2 * weak - all) < 1e-9 * all) continue;
    CHECK(object.is_weak_patch[i] == (2 * weak > all));
    num_mixed += weak > 0.0 && weak < all;
    num_weak += object.is_weak_patch[i];
  }
  CHECK(num_mixed > 0);
  CHECK(num_weak > 30);

  const ObjectModel unknown = build_object_model(mesh, {.resolution = 25});
  CHECK_FALSE(unknown.weak.has_value());
  CHECK(unknown.is_weak_patch == std::vector<bool>(unknown.patches.size(), false));
  CHECK_THROWS_WITH(
      build_object_model(mesh, {.weak = geometry::WeakRegionOptions{.weak_thickness = 0.0}}),
      Contains("weak_thickness = 0"));
}

namespace {

void check_equal(const ObjectModel& a, const ObjectModel& b) {
  CHECK(a.grid.lattice == b.grid.lattice);
  CHECK(a.grid.classes == b.grid.classes);
  CHECK(a.distance.lattice == b.distance.lattice);
  CHECK(a.distance.values == b.distance.values);
  CHECK(a.distance.first_partial == b.distance.first_partial);
  CHECK(a.distance.last_partial == b.distance.last_partial);
  CHECK(a.scores.scores == b.scores.scores);
  CHECK(a.scores.mean_plane_distance == b.scores.mean_plane_distance);
  CHECK(a.scores.mean_normal_angle_deg == b.scores.mean_normal_angle_deg);
  CHECK(a.patch_of_voxel == b.patch_of_voxel);
  CHECK(a.mass.center_of_mass == b.mass.center_of_mass);
  CHECK(a.is_weak_patch == b.is_weak_patch);
  REQUIRE(a.patches.size() == b.patches.size());
  bool are_equal = true;
  for (std::size_t i = 0; i < a.patches.size(); ++i) {
    const geometry::SurfacePatch& p = a.patches[i];
    const geometry::SurfacePatch& q = b.patches[i];
    are_equal = are_equal && p.voxel == q.voxel && p.area == q.area && p.centroid == q.centroid &&
                p.outward_normal == q.outward_normal && p.has_normal == q.has_normal &&
                p.faces == q.faces && p.area_centroid == q.area_centroid &&
                p.area_weighted_normal == q.area_weighted_normal &&
                p.plain_normal == q.plain_normal;
  }
  CHECK(are_equal);
}

}  // namespace

TEST_CASE("A model from the cache is the built one bit for bit, and damaged entries are replaced",
          "[grasp][object_model]") {
  const graspfit::testing::TemporaryFolder folder;
  const base::ContentCache cache{.folder = folder.path()};
  const geometry::TriangleMesh mesh = geometry::torus(0.05, 0.02, 40, 20);
  const ObjectModelOptions options{.resolution = 14};
  const ObjectModel built = build_object_model(mesh, options);
  CHECK(std::filesystem::is_empty(folder.path()));  // Building alone keeps nothing.
  check_equal(cached_object_model(mesh, options, cache), built);
  const auto entries = [&] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    return files;
  };
  REQUIRE(entries().size() == 1);
  const std::filesystem::path file = entries()[0];
  const std::string text = base::read_file(file);
  const ObjectModel read = cached_object_model(mesh, options, cache);
  check_equal(read, built);
  CHECK(read.timings.patches_s == 0.0);  // Nothing was built.

  // An entry may be damaged, or sealed as if it were whole but cut short or with a wild number
  // inside.
  const std::string content = text.substr(0, text.rfind("sha256 "));
  const auto sealed = [](const std::string& bytes) {
    return bytes + "sha256 " + base::sha256_hex(bytes) + '\n';
  };
  REQUIRE(sealed(content) == text);
  const std::size_t head = content.find('\n', content.find('\n') + 1) + 1;
  std::string wild_size = content;
  wild_size.replace(head, 8, std::string(8, '\x7f'));
  std::string wild_voxel = content;
  wild_voxel.replace(head + 8, 8, std::string(8, '\xff'));
  std::string wild_count = content;
  wild_count.replace(head + 16, 8, std::string(8, '\x7f'));
  for (const std::string& damaged :
       {std::string(), text.substr(0, text.size() / 2), text + "x", sealed(wild_size),
        sealed(wild_voxel), sealed(wild_count), sealed(content + "12345678"),
        sealed(content.substr(0, content.size() - 8)), sealed(content.substr(0, head))}) {
    base::write_file_atomically(file, damaged);
    check_equal(cached_object_model(mesh, options, cache), built);
    CHECK(base::read_file(file) == text);
  }

  // Every option and every bit of the mesh has an entry of its own.
  for (const ObjectModelOptions& other : std::vector<ObjectModelOptions>{
           {.resolution = 15},
           {.resolution = 14, .margin = 0.0},
           {.resolution = 14, .averaging = geometry::PatchAveraging::Plain},
           {.resolution = 14, .score = {.neighborhood = 3}},
           {.resolution = 14, .score = {.gamma_deg = 90.0}},
           {.resolution = 14, .score = {.length_voxels = 4.0}},
           {.resolution = 14, .score = {.normalization = ScoreNormalization::Max}},
           {.resolution = 14, .score = {.plane_distance = PlaneDistance::Unsigned}},
           {.resolution = 14, .score = {.mean_filter_radius = 2}},
           {.resolution = 14, .score = {.mean_filter_passes = 2}},
           {.resolution = 14, .score = {.floor = 0.06}},
           {.resolution = 14, .score = {.median_factor = 1.5}}}) {
    const std::size_t before = entries().size();
    check_equal(cached_object_model(mesh, other, cache), build_object_model(mesh, other));
    CHECK(entries().size() == before + 1);
  }
  geometry::TriangleMesh nudged = mesh;
  nudged.vertices[3][1] = std::nextafter(nudged.vertices[3][1], 2.0);
  (void)cached_object_model(nudged, options, cache);
  CHECK(entries().size() == 14);
}

TEST_CASE("Options reach the parts they are for", "[grasp][object_model]") {
  const geometry::TriangleMesh ball = geometry::ball(0.05, 4);
  const ObjectModel normalized = build_object_model(ball, {.resolution = 12});
  const ObjectModel raw = build_object_model(
      ball, {.resolution = 12, .score = {.normalization = ScoreNormalization::Raw}});
  REQUIRE(normalized.patches.size() == raw.patches.size());
  for (const double score : normalized.scores.scores) CHECK(score <= 1.0);
  for (const double score : raw.scores.scores) CHECK(score > 1.0);
  const ObjectModel plain =
      build_object_model(ball, {.resolution = 12, .averaging = geometry::PatchAveraging::Plain});
  bool differs = false;
  for (std::size_t i = 0; i < plain.patches.size(); ++i) {
    differs = differs || plain.patches[i].outward_normal != raw.patches[i].outward_normal;
  }
  CHECK(differs);
}

TEST_CASE("Objects without faces or volume are refused", "[grasp][object_model]") {
  CHECK_THROWS_AS(build_object_model({}, {}), base::InvalidInput);
  CHECK_THROWS_WITH(build_object_model({}, {}), Contains("no faces"));
  geometry::TriangleMesh inside_out = geometry::ball(0.05, 2);
  for (geometry::Face& face : inside_out.faces) std::swap(face[1], face[2]);
  CHECK_THROWS_AS(build_object_model(inside_out, {}), base::DegenerateGeometry);
  geometry::TriangleMesh flat = geometry::box({0.1, 0.1, 0.1});
  for (Vector3d& vertex : flat.vertices) vertex.z() = 0.0;
  CHECK_THROWS_AS(build_object_model(flat, {}), base::DegenerateGeometry);
}

TEST_CASE("Object model options out of range are refused by field and value",
          "[grasp][object_model]") {
  const geometry::TriangleMesh ball = geometry::ball(0.05, 1);
  CHECK_NOTHROW(ObjectModelOptions{}.validate());
  CHECK_THROWS_WITH(build_object_model(ball, {.resolution = 3}),
                    Contains("ObjectModelOptions") && Contains("resolution = 3"));
  CHECK_THROWS_WITH(build_object_model(ball, {.resolution = 513}), Contains("resolution = 513"));
  CHECK_THROWS_WITH(build_object_model(ball, {.margin = -0.5}), Contains("margin = -0.5"));
  CHECK_THROWS_WITH(build_object_model(ball, {.margin = std::nan("")}), Contains("margin = nan"));
  CHECK_THROWS_WITH(build_object_model(ball, {.score = {.neighborhood = 2}}),
                    Contains("neighborhood = 2"));
}

TEST_CASE("The score at a point is that of the patch there", "[grasp][object_model]") {
  const ObjectModel object = build_object_model(geometry::box({0.06, 0.08, 0.10}), {});
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  for (std::size_t i = 0; i < object.patches.size(); ++i) {
    const Vector3d& centroid = object.patches[i].centroid;
    // By rounding a centroid on a plane between voxels may be in either.
    const bool is_inside = lattice.index(lattice.voxel_at(centroid)) == object.patches[i].voxel;
    if (is_inside) CHECK(contact_score_at(object, centroid) == object.scores.scores[i]);
  }
  const auto [lowest, highest] =
      std::minmax_element(object.scores.scores.begin(), object.scores.scores.end());
  REQUIRE(*lowest < *highest);  // Edges and faces differ.

  // The face lies in a plane between voxels. On one of its sides is a voxel without surface, which
  // has the score of its neighbor.
  const double h = lattice.voxel_size;
  const Vector3d on_face(0.03, 0.4 * h, 0.4 * h);
  const auto at_face = contact_score_at(object, on_face);
  REQUIRE(at_face);
  CHECK(contact_score_at(object, on_face + Vector3d(0.5 * h, 0, 0)) == at_face);
  CHECK_FALSE(contact_score_at(object, on_face + Vector3d(3.5 * h, 0, 0)));
  CHECK_FALSE(contact_score_at(object, Vector3d(10, 0, 0)));  // It is beyond the lattice.
  CHECK_FALSE(contact_score_at(object, Vector3d::Zero()));    // It is far inside.
}

}  // namespace test_object_model
