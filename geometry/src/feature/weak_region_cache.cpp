#include <limits>
#include <string_view>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/geometry/weak_regions.hpp"

namespace graspfit::geometry {
namespace {

// Raised whenever the same input may give another result.
constexpr std::string_view kAlgorithm = "weak regions 5";

std::string to_text(const WeakRegions& result) {
  base::NumberWriter out;
  out.number(static_cast<std::int64_t>(result.outcome));
  out.number(result.voxel_size);
  out.end_line();
  for (const double thickness : result.thickness) out.number(thickness);
  out.end_line();
  std::vector<std::int32_t> weak;
  for (std::int32_t face = 0; face < std::ssize(result.is_weak); ++face) {
    if (result.is_weak[face]) weak.push_back(face);
  }
  out.indices(weak);
  out.number(static_cast<std::int64_t>(result.regions.size()));
  out.end_line();
  for (const WeakRegion& region : result.regions) {
    out.number(static_cast<std::int64_t>(region.verdict));
    out.number(std::int64_t{region.num_necks});
    out.number(region.thickness);
    out.number(region.length);
    out.indices(region.faces);
  }
  return out.text();
}

/// Empty unless the text is one that was written for a mesh of so many faces.
std::optional<WeakRegions> from_text(std::string_view text, std::size_t num_faces) {
  const auto most_faces = static_cast<std::int64_t>(num_faces);
  base::NumberReader in(text);
  WeakRegions result;
  result.outcome = static_cast<WeakOutcome>(in.integer(0, 2));
  result.voxel_size = in.real(0.0);
  for (std::size_t face = 0; face < num_faces; ++face) result.thickness.push_back(in.real(0.0));
  result.is_weak.assign(num_faces, false);
  for (const std::int32_t face : in.indices(most_faces)) result.is_weak[face] = true;
  const std::int64_t num_regions = in.integer(0, most_faces);
  for (std::int64_t i = 0; i < num_regions && in.is_good(); ++i) {
    WeakRegion region;
    region.verdict = static_cast<WeakVerdict>(in.integer(0, 4));
    region.num_necks = static_cast<int>(in.integer(0, std::numeric_limits<int>::max()));
    region.thickness = in.real(0.0);
    region.length = in.real(0.0);
    region.faces = in.indices(most_faces);
    result.regions.push_back(std::move(region));
  }
  if (!in.is_finished()) return std::nullopt;
  return result;
}

}  // namespace

std::string weak_region_key(const TriangleMesh& mesh, const WeakRegionOptions& options) {
  const ShapeDiameterOptions& rays = options.shape_diameter;
  base::ContentKey key(kAlgorithm);
  for (const double value :
       {options.weak_thickness, options.min_length_ratio, options.voxels_per_thickness,
        rays.cone_angle_deg, rays.trim_deviations}) {
    key.number(value);
  }
  key.number(std::int64_t{options.max_resolution});
  key.number(std::int64_t{rays.num_rays});
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Face) == 12);
  key.list(mesh.vertices);
  key.list(mesh.faces);
  return key.sha256();
}

WeakRegions cached_weak_regions(const MeshQuery& object, const WeakRegionOptions& options,
                                const base::ContentCache& cache) {
  options.validate();
  return cache.value(
      kWeakRegionKind, weak_region_key(object.mesh(), options),
      [&] { return find_weak_regions(object, options); },
      [&](std::string_view text) { return from_text(text, object.mesh().faces.size()); }, to_text);
}

}  // namespace graspfit::geometry
