#include "graspfit/geometry/distance_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "graspfit/base/errors.hpp"

namespace graspfit::geometry {
namespace {

// Three squares of it fit in 32 bits.
constexpr int kMostVoxelsPerAxis = 1 << 14;

// Squared distances in voxels; a lattice has at most 2^31 voxels, so 64 bits hold any sum.
using Squared = std::int64_t;
constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

// One pass of [Felzenszwalb & Huttenlocher 2012] in whole numbers, as in [Meijster et al. 2000]:
// result(q) = min over p of (q − p)² + f(p), from the lower envelope of the parabolas.
class Envelope {
 public:
  explicit Envelope(int length) : parabola_(length), start_(length) {}

  void transform(const std::int32_t* f, std::int32_t* result, int n) {
    int k = -1;
    for (int q = 0; q < n; ++q) {
      if (f[q] == kNone) continue;
      // First integer at which the parabola of q is strictly below that of p < q.
      const auto first_below = [&](int p) {
        const Squared numerator = Squared{q} * q + f[q] - Squared{p} * p - f[p];
        const Squared denominator = 2 * (Squared{q} - p);
        return (numerator >= 0 ? numerator / denominator
                               : -((-numerator + denominator - 1) / denominator)) +
               1;
      };
      Squared start = 0;
      while (k >= 0) {
        start = first_below(parabola_[k]);
        if (start > start_[k]) break;
        --k;
      }
      if (k < 0) start = 0;
      if (start >= n) continue;
      parabola_[++k] = q;
      start_[k] = static_cast<int>(std::max<Squared>(start, 0));
    }
    if (k < 0) {
      std::fill(result, result + n, kNone);
      return;
    }
    for (int q = n - 1; q >= 0; --q) {
      while (start_[k] > q) --k;
      const Squared d = q - parabola_[k];
      result[q] = static_cast<std::int32_t>(d * d + f[parabola_[k]]);
    }
  }

 private:
  std::vector<int> parabola_;
  std::vector<int> start_;
};

// Columns that are transformed together, so that strided memory is read by whole cache lines.
constexpr int kBlock = 16;

}  // namespace

float SignedDistanceMap::at_beyond(const Eigen::Vector3d& position) const {
  using Eigen::Array3d;
  if (position.hasNaN()) throw base::InvalidInput("SignedDistanceMap::at: the point is no point");
  const Array3d voxel = position.array().floor();
  const Array3d inner = voxel.max(0.0).min(lattice.counts.cast<double>().array() - 1.0);
  const float value = at(Eigen::Vector3i(inner.cast<int>()));
  if (value < 0.0F || std::isinf(value)) return value;
  // A partial voxel p differs from the voxel v by |v − c| + |c − p| on the axes on which c was
  // clamped: |v − p|² = |v − c|² + |c − p|² + 2 Σ |v − c| |c − p|.
  const Array3d excess = (voxel - inner).abs();
  const Array3d gap = (inner - last_partial.cast<double>().array())
                          .max(first_partial.cast<double>().array() - inner)
                          .max(0.0);
  // The value is a rounded root, the square a whole number: this is the least it can have been, as
  // (1 + 2^-24)² (1 − 2^-22) < 1.
  const double squared = std::ceil(double{value} * value * (1.0 - 0x1p-22));
  return static_cast<float>(
      std::sqrt(squared + excess.square().sum() + 2.0 * (excess * gap).sum()));
}

SignedDistanceMap signed_distance_map(const VoxelGrid& grid) {
  const VoxelLattice& lattice = grid.lattice;
  const int nx = lattice.counts[0];
  const int ny = lattice.counts[1];
  const int nz = lattice.counts[2];
  if (lattice.counts.maxCoeff() > kMostVoxelsPerAxis) {
    throw base::InvalidInput(
        "signed_distance_map: the lattice has more than 16384 voxels on an axis");
  }
  std::vector<std::int32_t> squared(grid.classes.size());

  // Along x: the nearest partial voxel of the row, by one sweep each way.
  for (std::size_t row = 0; row < squared.size(); row += nx) {
    int last = -1;
    for (int i = 0; i < nx; ++i) {
      if (grid.classes[row + i] == VoxelClass::Partial) last = i;
      squared[row + i] = last < 0 ? kNone : (i - last) * (i - last);
    }
    if (last < 0) continue;
    for (int i = last; i >= 0; --i) {
      if (grid.classes[row + i] == VoxelClass::Partial) last = i;
      squared[row + i] = std::min(squared[row + i], (last - i) * (last - i));
    }
  }

  // Along y, then z, a block of neighboring columns at a time.
  const int longest = std::max(ny, nz);
  Envelope envelope(longest);
  std::vector<std::int32_t> columns(static_cast<std::size_t>(kBlock) * longest);
  std::vector<std::int32_t> result(longest);
  const auto pass = [&](std::int64_t start, std::int64_t stride, int length, int width) {
    for (int p = 0; p < length; ++p) {
      const std::int32_t* const from = squared.data() + start + p * stride;
      for (int c = 0; c < width; ++c) columns[static_cast<std::size_t>(c) * length + p] = from[c];
    }
    for (int c = 0; c < width; ++c) {
      std::int32_t* const column = columns.data() + static_cast<std::size_t>(c) * length;
      envelope.transform(column, result.data(), length);
      std::copy(result.begin(), result.begin() + length, column);
    }
    for (int p = 0; p < length; ++p) {
      std::int32_t* const to = squared.data() + start + p * stride;
      for (int c = 0; c < width; ++c) to[c] = columns[static_cast<std::size_t>(c) * length + p];
    }
  };
  const std::int64_t layer = std::int64_t{nx} * ny;
  for (int k = 0; k < nz; ++k) {
    for (int i = 0; i < nx; i += kBlock) pass(k * layer + i, nx, ny, std::min(kBlock, nx - i));
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; i += kBlock) {
      pass(std::int64_t{j} * nx + i, layer, nz, std::min(kBlock, nx - i));
    }
  }

  SignedDistanceMap map;
  map.lattice = lattice;
  map.values.resize(squared.size());
  map.first_partial = lattice.counts;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const auto row = grid.classes.begin() + lattice.index({0, j, k});
      const auto first = std::find(row, row + nx, VoxelClass::Partial);
      if (first == row + nx) continue;
      const auto last = std::find(std::make_reverse_iterator(row + nx),
                                  std::make_reverse_iterator(first), VoxelClass::Partial);
      const Eigen::Vector3i low(static_cast<int>(first - row), j, k);
      const Eigen::Vector3i high(static_cast<int>(last.base() - row) - 1, j, k);
      map.first_partial = map.first_partial.cwiseMin(low);
      map.last_partial = map.last_partial.cwiseMax(high);
    }
  }
  for (std::size_t i = 0; i < squared.size(); ++i) {
    // The root of a whole number in double, then float: rounding twice is innocuous (53 ≥ 2·24 +
    // 2).
    const float distance = squared[i] == kNone
                               ? std::numeric_limits<float>::infinity()
                               : static_cast<float>(std::sqrt(static_cast<double>(squared[i])));
    map.values[i] = grid.classes[i] == VoxelClass::Full ? -distance : distance;
  }
  return map;
}

}  // namespace graspfit::geometry
