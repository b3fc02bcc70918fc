#include "voxel/bounded_distance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

namespace graspfit::geometry::internal {
namespace {

using Squared = std::int16_t;

/// row = min(row, other + d²), for rows of n voxels.
void take_nearer_row(Squared* row, const Squared* other, int d, int n) {
  const auto added = static_cast<Squared>(d * d);
  for (int i = 0; i < n; ++i) {
    row[i] = std::min(row[i], static_cast<Squared>(other[i] + added));
  }
}

}  // namespace

// Along each axis result(q) = min over p of (q − p)² + f(p), for |q − p| up to the bound [Saito &
// Toriwaki 1994].
BoundedDistance::BoundedDistance(const VoxelLattice& lattice, const std::vector<char>& is_source,
                                 double bound)
    : squared_(is_source.size()) {
  const double diagonal = lattice.counts.cast<double>().norm();
  const double most = std::min(bound, diagonal);
  assert(most <= kLargestBound);
  const int reach = static_cast<int>(most);
  const auto largest = static_cast<int>(most * most);
  const auto far = static_cast<Squared>(largest + 1);  // which stands for all beyond the bound
  distances_.resize(static_cast<std::size_t>(largest) + 2);
  for (int s = 0; s <= largest; ++s) {
    distances_[s] = static_cast<float>(std::sqrt(static_cast<double>(s)));
  }
  distances_.back() = std::numeric_limits<float>::infinity();

  const int nx = lattice.counts[0];
  const int ny = lattice.counts[1];
  const int nz = lattice.counts[2];
  const auto row_at = [&](int j, int k) {
    return static_cast<std::size_t>(nx) * (j + static_cast<std::size_t>(ny) * k);
  };
  std::vector<char> has_near(static_cast<std::size_t>(ny) * nz, 0);  // per row
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const std::size_t start = row_at(j, k);
      Squared* const row = squared_.data() + start;
      const bool is_any = std::memchr(is_source.data() + start, 1, nx) != nullptr;
      has_near[j + static_cast<std::size_t>(ny) * k] = is_any;
      if (!is_any) {
        std::fill(row, row + nx, far);
        continue;
      }
      int steps = reach + 1;  // since the last source
      for (int i = 0; i < nx; ++i) {
        steps = is_source[start + i] != 0 ? 0 : std::min(steps + 1, reach + 1);
        row[i] = steps <= reach ? static_cast<Squared>(steps * steps) : far;
      }
      steps = reach + 1;
      for (int i = nx - 1; i >= 0; --i) {
        steps = row[i] == 0 ? 0 : std::min(steps + 1, reach + 1);
        if (steps <= reach) row[i] = std::min(row[i], static_cast<Squared>(steps * steps));
      }
    }
  }

  // Rows beside each other along an axis, of which `rows` holds a copy.
  std::vector<Squared> rows(static_cast<std::size_t>(nx) * std::max(ny, nz));
  std::vector<char> is_near(std::max(ny, nz));
  const auto pass = [&](int count, const auto& row_number, const auto& flag_number) {
    for (int p = 0; p < count; ++p) {
      is_near[p] = has_near[flag_number(p)];
      if (!is_near[p]) continue;
      const Squared* const row = squared_.data() + row_number(p);
      std::copy(row, row + nx, rows.data() + static_cast<std::size_t>(nx) * p);
    }
    for (int q = 0; q < count; ++q) {
      Squared* const row = squared_.data() + row_number(q);
      for (int p = std::max(0, q - reach); p <= std::min(count - 1, q + reach); ++p) {
        if (p == q || !is_near[p]) continue;
        take_nearer_row(row, rows.data() + static_cast<std::size_t>(nx) * p, q - p, nx);
        has_near[flag_number(q)] = 1;
      }
    }
  };
  for (int k = 0; k < nz; ++k) {
    pass(
        ny, [&](int j) { return row_at(j, k); },
        [&](int j) { return j + static_cast<std::size_t>(ny) * k; });
  }
  for (int j = 0; j < ny; ++j) {
    pass(
        nz, [&](int k) { return row_at(j, k); },
        [&](int k) { return j + static_cast<std::size_t>(ny) * k; });
  }
}

}  // namespace graspfit::geometry::internal
