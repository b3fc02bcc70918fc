#include "graspfit/grasp/object_model.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "graspfit/base/option_check.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "object/object_parts.hpp"

namespace graspfit::grasp {
namespace {

/// What `step` returns; its time goes to `seconds`.
template <typename Step>
auto timed(double& seconds, Step step) {
  const base::Stopwatch watch(seconds);
  return step();
}

geometry::ConvexVolume box_of_voxel(const geometry::VoxelLattice& lattice, std::int64_t index) {
  const Eigen::Vector3i voxel = lattice.voxel(index);
  geometry::ConvexVolume box;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    box.push_back({-along, -lattice.plane(axis, voxel[axis])});
    box.push_back({along, lattice.plane(axis, voxel[axis] + 1)});
  }
  return box;
}

/// Whether at least half of a patch lies on weak faces.
bool is_weak(const geometry::SurfacePatch& patch, const std::vector<bool>& is_weak_face,
             const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice) {
  std::vector<std::int32_t> weak_faces;
  for (const std::int32_t face : patch.faces) {
    if (is_weak_face[face]) weak_faces.push_back(face);
  }
  if (weak_faces.empty()) return false;
  if (weak_faces.size() == patch.faces.size()) return true;
  double weak_area = 0.0;
  for (const auto& piece : geometry::clip(mesh, weak_faces, box_of_voxel(lattice, patch.voxel))) {
    weak_area += piece.area;
  }
  return 2.0 * weak_area >= patch.area;
}

geometry::VoxelLattice lattice_of(const Eigen::AlignedBox3d& box,
                                  const ObjectModelOptions& options) {
  const double margin = kMarginVoxels * box.sizes().maxCoeff() / options.resolution;
  return geometry::lattice_around(
      box, {.resolution = options.resolution, .margin = options.margin.value_or(margin)});
}

internal::ObjectParts find_parts(const geometry::MeshQuery& query,
                                 const geometry::VoxelLattice& lattice,
                                 const ObjectModelOptions& options, ObjectModelTimings& spent) {
  internal::ObjectParts parts;
  parts.patches = timed(spent.patches_s, [&] {
    return geometry::surface_patches(query.mesh(), lattice, {.averaging = options.averaging});
  });
  parts.grid =
      timed(spent.voxels_s, [&] { return geometry::voxelize(query, lattice, parts.patches); });
  parts.distance =
      timed(spent.distance_s, [&] { return geometry::signed_distance_map(parts.grid); });
  parts.scores = timed(spent.scores_s,
                       [&] { return contact_score_map(parts.patches, lattice, options.score); });
  return parts;
}

}  // namespace

void ObjectModelOptions::validate() const {
  base::require(resolution >= 4 && resolution <= 512, "ObjectModelOptions", "resolution",
                resolution, "in [4, 512]");
  base::require(!margin || (*margin >= 0.0 && std::isfinite(*margin)), "ObjectModelOptions",
                "margin", margin.value_or(0.0), "finite and at least 0");
  if (weak) weak->validate();
  score.validate();
}

ObjectModel build_object_model(const geometry::TriangleMesh& mesh,
                               const ObjectModelOptions& options) {
  return cached_object_model(mesh, options, {.is_on = false});
}

ObjectModel cached_object_model(const geometry::TriangleMesh& mesh,
                                const ObjectModelOptions& options,
                                const base::ContentCache& cache) {
  options.validate();
  if (mesh.faces.empty()) {
    throw base::InvalidInput("build_object_model: the mesh has no faces");
  }
  const geometry::MassProperties mass = geometry::mass_properties(mesh);
  const Eigen::AlignedBox3d box = geometry::bounding_box(mesh);
  const geometry::VoxelLattice lattice = lattice_of(box, options);

  ObjectModelTimings spent;
  geometry::MeshQuery query = timed(spent.query_s, [&] {
    geometry::MeshQuery built(mesh);
    built.build();
    return built;
  });
  const auto find = [&] { return find_parts(query, lattice, options, spent); };
  internal::ObjectParts parts =
      cache.is_on ? cache.value(
                        kObjectModelKind, internal::object_parts_key(mesh, options), find,
                        [&](std::string_view bytes) {
                          return internal::from_bytes(bytes, lattice, mesh.faces.size());
                        },
                        internal::to_bytes)
                  : find();

  std::vector<std::int32_t> patch_of_voxel(lattice.num_voxels(), -1);
  for (std::int32_t i = 0; i < std::ssize(parts.patches); ++i) {
    patch_of_voxel[parts.patches[i].voxel] = i;
  }
  std::optional<geometry::WeakRegions> weak;
  std::vector<bool> is_weak_patch(parts.patches.size(), false);
  if (options.weak) {
    const base::Stopwatch watch(spent.weak_s);
    weak = geometry::cached_weak_regions(query, *options.weak, options.weak_cache);
    for (std::size_t i = 0; i < parts.patches.size(); ++i) {
      is_weak_patch[i] = is_weak(parts.patches[i], weak->is_weak, mesh, lattice);
    }
  }

  return ObjectModel{.query = std::move(query),
                     .mass = mass,
                     .normalizing_radius = contact::normalizing_radius(box),
                     .grid = std::move(parts.grid),
                     .patches = std::move(parts.patches),
                     .patch_of_voxel = std::move(patch_of_voxel),
                     .distance = std::move(parts.distance),
                     .scores = std::move(parts.scores),
                     .weak = std::move(weak),
                     .is_weak_patch = std::move(is_weak_patch),
                     .timings = spent};
}

std::optional<double> contact_score_at(const ObjectModel& object, const Eigen::Vector3d& point_O) {
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  const Eigen::Vector3i own = lattice.voxel_at(point_O);
  const auto patch_at = [&](const Eigen::Vector3i& voxel) {
    return lattice.contains(voxel) ? object.patch_in(lattice.index(voxel)) : std::nullopt;
  };
  if (const auto patch = patch_at(own)) return object.scores.scores[*patch];
  std::optional<std::int32_t> patch;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 27; ++i) {
    const auto other = patch_at(own + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
    if (!other) continue;
    const double distance = (object.patches[*other].centroid - point_O).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    patch = other;
  }
  if (!patch) return std::nullopt;
  return object.scores.scores[*patch];
}

}  // namespace graspfit::grasp
