#include "graspfit/grasp/object_model.hpp"

#include <cmath>
#include <utility>

#include "internal/option_check.hpp"
#include "internal/stopwatch.hpp"

namespace graspfit::grasp {
namespace {

/// What `step` returns; its time goes to `seconds`.
template <typename Step>
auto timed(double& seconds, Step step) {
  const Stopwatch watch(seconds);
  return step();
}

}  // namespace

void ObjectModelOptions::validate() const {
  internal::require(resolution >= 4 && resolution <= 512, "ObjectModelOptions", "resolution",
                    resolution, "in [4, 512]");
  internal::require(margin >= 0.0 && std::isfinite(margin), "ObjectModelOptions", "margin", margin,
                    "finite and at least 0");
  score.validate();
}

ObjectModel build_object_model(const geometry::TriangleMesh& mesh,
                               const ObjectModelOptions& options, ObjectModelTimings* timings) {
  options.validate();
  if (mesh.faces.empty()) {
    throw geometry::InvalidInput("build_object_model: the mesh has no faces");
  }
  const geometry::MassProperties mass = geometry::mass_properties(mesh);
  const Eigen::AlignedBox3d box = geometry::bounding_box(mesh);
  const geometry::VoxelLattice lattice =
      geometry::lattice_around(box, {.resolution = options.resolution, .margin = options.margin});

  ObjectModelTimings spent;
  geometry::MeshQuery query = timed(spent.query_s, [&] { return geometry::MeshQuery(mesh); });
  std::vector<geometry::SurfacePatch> patches = timed(spent.patches_s, [&] {
    return geometry::surface_patches(mesh, lattice, {.averaging = options.averaging});
  });
  geometry::VoxelGrid grid =
      timed(spent.voxels_s, [&] { return geometry::voxelize(query, lattice, patches); });
  geometry::SignedDistanceMap distance =
      timed(spent.distance_s, [&] { return geometry::signed_distance_map(grid); });
  ContactScoreMap scores =
      timed(spent.scores_s, [&] { return contact_score_map(patches, lattice, options.score); });

  std::vector<std::int32_t> patch_of_voxel(static_cast<std::size_t>(lattice.num_voxels()), -1);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    patch_of_voxel[patches[i].voxel] = static_cast<std::int32_t>(i);
  }
  if (timings != nullptr) *timings = spent;

  return ObjectModel{.query = std::move(query),
                     .mass = mass,
                     .normalizing_radius = 0.5 * box.diagonal().norm(),
                     .grid = std::move(grid),
                     .patches = std::move(patches),
                     .patch_of_voxel = std::move(patch_of_voxel),
                     .distance = std::move(distance),
                     .scores = std::move(scores),
                     .weak = std::nullopt,
                     .is_weak_patch = {}};
}

}  // namespace graspfit::grasp
