#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "grasp/target_oracle.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/random_targets.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "support/catch.hpp"

/// Objects and hands on which target selections can be checked.
namespace graspfit::testing {

using Eigen::Vector3d;
using grasp::PartDistances;
using grasp::RequestedParts;
using grasp::TargetOptions;
using grasp::TargetSelection;

/// Returns fingers whose every pair reaches the same distances.
inline PartDistances equal_reach(int num_fingers, double smallest, double largest) {
  PartDistances distances;
  distances.tip_to_tip.assign(num_fingers, std::vector<hands::DistanceRange>(num_fingers));
  for (int a = 0; a < num_fingers; ++a) {
    for (int b = 0; b < num_fingers; ++b) {
      if (a != b) distances.tip_to_tip[a][b] = {smallest, largest};
    }
  }
  return distances;
}

inline void set_range(PartDistances& distances, int a, int b, hands::DistanceRange range) {
  distances.tip_to_tip[a][b] = range;
  distances.tip_to_tip[b][a] = range;
}

inline grasp::ObjectModel object_of(const geometry::TriangleMesh& mesh) {
  // The selection sees the object alone: there is no margin for a hand around it, so that building
  // is fast.
  grasp::ObjectModelOptions options;
  options.margin = 0.0;
  return grasp::build_object_model(mesh, options);
}

/// A place that may be chosen, for objects made of nothing but such places.
struct Place {
  Vector3d point;
  Vector3d outward_normal;
  double score = 0.9;
  bool has_normal = true;
};

/// Returns an object whose patches are exactly `places`, so that what is selected from it can be
/// worked out by hand. Its mesh, a box that holds the places, is not used. The center of mass is at
/// the origin, the radius is 1.
inline grasp::ObjectModel object_of(const std::vector<Place>& places) {
  grasp::ObjectModel object = object_of(geometry::box(Vector3d(4, 4, 4)));
  object.mass.center_of_mass = Vector3d::Zero();
  object.normalizing_radius = 1.0;
  object.patches.clear();
  std::fill(object.patch_of_voxel.begin(), object.patch_of_voxel.end(), -1);
  object.scores = {};
  for (const Place& place : places) {
    geometry::SurfacePatch patch;
    patch.voxel = object.grid.lattice.index(object.grid.lattice.voxel_at(place.point));
    patch.area = 1e-4;
    patch.centroid = place.point;
    patch.outward_normal =
        place.has_normal ? place.outward_normal.normalized() : Vector3d(Vector3d::Zero());
    patch.has_normal = place.has_normal;
    object.patch_of_voxel[patch.voxel] = static_cast<int>(object.patches.size());
    object.patches.push_back(patch);
    object.scores.scores.push_back(place.score);
    object.scores.mean_plane_distance.push_back(0.0);
    object.scores.mean_normal_angle_deg.push_back(0.0);
  }
  return object;
}

/// Returns places on the unit circle at the given angles [deg], with radial normals.
inline std::vector<Place> on_unit_circle(const std::vector<double>& angles_deg) {
  std::vector<Place> places;
  for (const double angle_deg : angles_deg) {
    const double angle = angle_deg * std::numbers::pi / 180.0;
    const Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
    places.push_back({radial, radial});
  }
  return places;
}

inline TargetSelection select(const grasp::ObjectModel& object, const PartDistances& distances,
                              const RequestedParts& parts, const TargetOptions& options,
                              std::uint64_t seed) {
  base::Random random(seed);
  return grasp::TargetSelector(object, distances, parts, options, grasp::IdealMeasure{})
      .select(random);
}

inline std::vector<int> patches_of(const grasp::TargetContacts& targets) {
  std::vector<int> patches;
  for (const auto& target : targets.contacts) patches.push_back(target.patch.value());
  return patches;
}
inline std::vector<int> patches_of(const TargetSelection& selection) {
  return selection.targets ? patches_of(*selection.targets) : std::vector<int>{};
}

/// Selects with many seeds and checks every set, and that its points lie on the surface. Returns
/// the number of sets.
inline int check_selections(const grasp::ObjectModel& object, const PartDistances& distances,
                            const RequestedParts& parts, const TargetOptions& options,
                            int num_seeds) {
  int num_sets = 0;
  for (int seed = 1; seed <= num_seeds; ++seed) {
    const TargetSelection selection = select(object, distances, parts, options, seed);
    CHECK(selection.seeds_tried <= options.max_seeds);
    if (!selection.targets) continue;
    ++num_sets;
    INFO("seed " << seed);
    CHECK(selection.targets->seeds_tried == selection.seeds_tried);
    CHECK(broken_requirements(object, distances, parts, options, *selection.targets) ==
          std::vector<std::string>{});
    for (const auto& target : selection.targets->contacts) {
      // This is the rounding of a projected point, which is larger on the slivers of a cylinder.
      const double limit = 1e-12 * geometry::longest_extent(object.mesh());
      CHECK(std::sqrt(object.query.closest_point(target.point_O).squared_distance) <= limit);
    }
  }
  return num_sets;
}

struct NamedMesh {
  std::string name;
  geometry::TriangleMesh mesh;
};

inline std::vector<NamedMesh> shapes() {
  return {{"ball", geometry::ball(0.05)},
          {"box", geometry::box(Vector3d(0.10, 0.06, 0.08))},
          {"torus", geometry::torus(0.05, 0.018)},
          {"capsule", geometry::capsule(0.03, 0.08)}};
}

}  // namespace graspfit::testing
