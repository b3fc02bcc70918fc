#include "graspfit/geometry/surface_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/random.hpp"
#include "mesh/input_check.hpp"

namespace graspfit::geometry {
namespace {

constexpr std::size_t kMostPoints = 10'000'000;

// Uniform points of a surface, each from a random stream of its own.
class AreaSampler {
 public:
  AreaSampler(const char* who, const TriangleMesh& mesh, std::uint64_t seed)
      : mesh_(mesh), seed_(seed) {
    double sum = 0.0;
    area_below_.reserve(mesh.faces.size());
    for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
      sum += vector_area(mesh, face).norm();
      area_below_.push_back(sum);
    }
    if (!(sum > 0.0) || !std::isfinite(sum)) {
      throw base::DegenerateGeometry(std::string(who) + ": the surface has area " +
                                     base::shortest_decimal(sum) +
                                     " m2, must be positive and finite");
    }
  }

  double area() const { return area_below_.back(); }

  SurfaceSample draw(std::uint64_t index) const {
    base::Random random = base::Random::stream(seed_, index);
    // The first face for which the area up to and including it exceeds `area_drawn`: never a face
    // without area.
    const double area_drawn = random.uniform() * area();
    const auto found = std::upper_bound(area_below_.begin(), area_below_.end(), area_drawn);
    const auto face = base::as_index<std::int32_t>(
        std::min<std::ptrdiff_t>(found - area_below_.begin(), last_with_area()));
    // The root turns a uniform number into one whose density grows with the width of the triangle
    // [Osada et al. 2002].
    const double across = std::sqrt(random.uniform());
    const double along = random.uniform();
    SurfaceSample sample;
    sample.face = face;
    sample.barycentric = {1.0 - across, across * (1.0 - along), across * along};
    const auto [a, b, c] = corners(mesh_, face);
    sample.point =
        sample.barycentric[0] * a + sample.barycentric[1] * b + sample.barycentric[2] * c;
    sample.normal = face_normal(mesh_, face);
    return sample;
  }

 private:
  // A product that rounds up to the whole area must not select a face after the last one with area.
  std::ptrdiff_t last_with_area() const {
    return std::lower_bound(area_below_.begin(), area_below_.end(), area()) - area_below_.begin();
  }

  const TriangleMesh& mesh_;
  std::uint64_t seed_;
  std::vector<double> area_below_;  // Area of a face and all before it.
};

}  // namespace

void SurfaceSamplingOptions::validate() const {
  base::require(count <= kMostPoints, "SurfaceSamplingOptions", "count", count,
                "at most " + std::to_string(kMostPoints));
}

std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh,
                                          const SurfaceSamplingOptions& options) {
  options.validate();
  internal::require_usable(mesh, "sample_surface");
  const AreaSampler sampler("sample_surface", mesh, options.seed);
  std::vector<SurfaceSample> samples;
  samples.reserve(options.count);
  for (std::size_t i = 0; i < options.count; ++i) samples.push_back(sampler.draw(i));
  return samples;
}

}  // namespace graspfit::geometry
