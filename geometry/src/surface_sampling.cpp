#include "graspfit/geometry/surface_sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <unordered_map>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/random.hpp"

namespace graspfit::geometry {
namespace {

constexpr std::size_t kMostPoints = 10'000'000;
constexpr double kMostDarts = 1e8;
constexpr double kMostCells = 0x1p53;  // along an axis: beyond, their numbers are not exact

// Uniform points of a surface, each from a random stream of its own.
class AreaSampler {
 public:
  AreaSampler(const char* who, const TriangleMesh& mesh, std::uint64_t seed)
      : mesh_(mesh), seed_(seed) {
    double sum = 0.0;
    area_below_.reserve(mesh.faces.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      sum += vector_area(mesh, face).norm();
      area_below_.push_back(sum);
    }
    if (!(sum > 0.0) || !std::isfinite(sum)) {
      throw DegenerateGeometry(std::string(who) + ": the surface has area " +
                               shortest_decimal(sum) + " m2, must be positive and finite");
    }
  }

  double area() const { return area_below_.back(); }

  SurfaceSample draw(std::uint64_t index) const {
    Random random = Random::stream(seed_, index);
    // The first face whose sum exceeds the place: never one without area.
    const double place = random.uniform() * area();
    const auto found = std::upper_bound(area_below_.begin(), area_below_.end(), place);
    const auto face = std::min<std::ptrdiff_t>(found - area_below_.begin(), last_with_area());
    // [Osada et al. 2002]: the root turns a uniform number into one that grows with the width of
    // the triangle.
    const double across = std::sqrt(random.uniform());
    const double along = random.uniform();
    SurfaceSample sample;
    sample.face = static_cast<std::int32_t>(face);
    sample.barycentric = {1.0 - across, across * (1.0 - along), across * along};
    const auto [a, b, c] = corners(mesh_, static_cast<std::size_t>(face));
    sample.point =
        sample.barycentric[0] * a + sample.barycentric[1] * b + sample.barycentric[2] * c;
    sample.normal = face_normal(mesh_, static_cast<std::size_t>(face));
    return sample;
  }

 private:
  // A product that rounds up to the whole area must not fall behind the last face that has some.
  std::ptrdiff_t last_with_area() const {
    return std::lower_bound(area_below_.begin(), area_below_.end(), area()) - area_below_.begin();
  }

  const TriangleMesh& mesh_;
  std::uint64_t seed_;
  std::vector<double> area_below_;  // Area of a face and all before it.
};

using Cell = std::array<std::int64_t, 3>;
struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t i : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Points kept so far in cells as large as their least distance (and a little, since the quotients
// are rounded); asked by cell only, so that its order shows nowhere.
class KeptPoints {
 public:
  KeptPoints(const Eigen::Vector3d& origin, double min_distance)
      : origin_(origin), min_distance_(min_distance), cell_size_(min_distance * (1.0 + 1e-6)) {}

  bool add(const Eigen::Vector3d& point) {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] =
          static_cast<std::int64_t>(std::floor((point[axis] - origin_[axis]) / cell_size_));
    }
    for (std::int64_t i = cell[0] - 1; i <= cell[0] + 1; ++i) {
      for (std::int64_t j = cell[1] - 1; j <= cell[1] + 1; ++j) {
        for (std::int64_t k = cell[2] - 1; k <= cell[2] + 1; ++k) {
          const auto found = cells_.find({i, j, k});
          if (found == cells_.end()) continue;
          for (const Eigen::Vector3d& other : found->second) {
            if ((other - point).norm() < min_distance_) return false;
          }
        }
      }
    }
    cells_[cell].push_back(point);
    return true;
  }

 private:
  Eigen::Vector3d origin_;
  double min_distance_;
  double cell_size_;
  std::unordered_map<Cell, std::vector<Eigen::Vector3d>, CellHash> cells_;
};

}  // namespace

void SurfaceSamplingOptions::validate() const {
  if (count > kMostPoints) {
    throw InvalidInput("SurfaceSamplingOptions: count = " + std::to_string(count) +
                       ", must be at most " + std::to_string(kMostPoints));
  }
}

void EvenSamplingOptions::validate() const {
  if (!(min_distance > 0.0) || !std::isfinite(min_distance)) {
    throw InvalidInput("EvenSamplingOptions: min_distance = " + shortest_decimal(min_distance) +
                       ", must be finite and > 0 m");
  }
  if (num_trials_per_point < 1 || num_trials_per_point > 10000) {
    throw InvalidInput("EvenSamplingOptions: num_trials_per_point = " +
                       std::to_string(num_trials_per_point) + ", must be in [1, 10000]");
  }
}

std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh,
                                          const SurfaceSamplingOptions& options) {
  options.validate();
  const AreaSampler sampler("sample_surface", mesh, options.seed);
  std::vector<SurfaceSample> samples;
  samples.reserve(options.count);
  for (std::size_t i = 0; i < options.count; ++i) samples.push_back(sampler.draw(i));
  return samples;
}

std::vector<SurfaceSample> sample_surface_evenly(const TriangleMesh& mesh,
                                                 const EvenSamplingOptions& options) {
  options.validate();
  const AreaSampler sampler("sample_surface_evenly", mesh, options.seed);
  // The densest packing of disks of diameter d in the plane has one per (√3/2) d².
  const double most_points =
      sampler.area() / (0.5 * std::numbers::sqrt3 * options.min_distance * options.min_distance);
  const double darts = std::ceil(std::max(1.0, most_points) * options.num_trials_per_point);
  if (!(darts <= kMostDarts)) {
    throw InvalidInput(
        "EvenSamplingOptions: min_distance = " + shortest_decimal(options.min_distance) + " m on " +
        shortest_decimal(sampler.area()) + " m2 needs more than 1e8 darts");
  }
  // A needle may be longer than its area tells, and cells need numbers.
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  if (!(box.sizes().maxCoeff() < kMostCells * options.min_distance)) {
    throw InvalidInput(
        "EvenSamplingOptions: min_distance = " + shortest_decimal(options.min_distance) +
        " m on a surface " + shortest_decimal(box.sizes().maxCoeff()) + " m long is too small");
  }
  KeptPoints kept(box.min(), options.min_distance);
  std::vector<SurfaceSample> samples;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(darts); ++i) {
    SurfaceSample sample = sampler.draw(i);
    if (kept.add(sample.point)) samples.push_back(sample);
  }
  return samples;
}

}  // namespace graspfit::geometry
