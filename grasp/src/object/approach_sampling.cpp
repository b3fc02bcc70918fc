#include "graspfit/grasp/approach_sampling.hpp"

#include <cmath>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;

/// Coordinates of points at `spacing` on an edge of length `length`, symmetric about its middle.
std::vector<double> grid_coordinates(double length, double spacing) {
  const auto steps = static_cast<int>(std::floor(length / (2.0 * spacing)));
  std::vector<double> coordinates;
  for (int i = -steps; i <= steps; ++i) coordinates.push_back(i * spacing);
  return coordinates;
}

std::vector<geometry::SurfaceSample> box_ray_hits(const ObjectModel& object,
                                                  const ApproachSamplingOptions& options) {
  Eigen::AlignedBox3d box = object.query.box();
  const Vector3d margin = Vector3d::Constant(options.box_margin);
  box.min() -= margin;
  box.max() += margin;
  const Vector3d sizes = box.sizes();
  double num_rays = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    num_rays += 2.0 * (sizes[(axis + 1) % 3] / options.box_spacing + 1.0) *
                (sizes[(axis + 2) % 3] / options.box_spacing + 1.0);
  }
  base::require(num_rays <= 1e6, "ApproachSamplingOptions", "box_spacing", options.box_spacing,
                "large enough for at most a million rays");
  std::vector<geometry::SurfaceSample> hits;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      for (const double at_u : grid_coordinates(sizes[u], options.box_spacing)) {
        for (const double at_v : grid_coordinates(sizes[v], options.box_spacing)) {
          Vector3d origin = box.center();
          origin[axis] += side * 0.5 * sizes[axis];
          origin[u] += at_u;
          origin[v] += at_v;
          const auto hit = object.query.first_hit(origin, Vector3d(-side * Vector3d::Unit(axis)));
          if (!hit) continue;
          const Vector3d area = geometry::vector_area(object.mesh(), hit->face);
          if (!(area.norm() > 0.0)) continue;
          hits.push_back({hit->point, area.normalized(), hit->face, Vector3d::Zero()});
        }
      }
    }
  }
  return hits;
}

}  // namespace

void ApproachSamplingOptions::validate() const {
  internal::require_ranges("ApproachSamplingOptions", *this, internal::sampling_rows);
}

std::vector<geometry::SurfaceSample> approach_samples(const ObjectModel& object,
                                                      const ApproachSamplingOptions& options,
                                                      std::uint64_t seed) {
  options.validate();
  if (options.source == ApproachSource::BoxRays) return box_ray_hits(object, options);
  return geometry::sample_surface(object.mesh(),
                                  {.count = static_cast<std::size_t>(options.count), .seed = seed});
}

}  // namespace graspfit::grasp
