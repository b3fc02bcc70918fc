#include "voxel/voxel_sets.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3i;

/// Members of a row along x without a gap.
struct Run {
  int first = 0;
  int last = 0;
};

/// Steps of paths through voxels: the 98 primitive ones of the 5 × 5 × 5 block, whose paths are at
/// most 5 % longer than straight ones.
struct PathStep {
  Vector3i offset;
  float length;
};

std::vector<PathStep> path_steps() {
  std::vector<PathStep> steps;
  for_each_in_block(Vector3i::Constant(-2), Vector3i::Constant(2), [&](const Vector3i& offset) {
    if (std::gcd(std::gcd(offset[0], offset[1]), offset[2]) != 1) return;
    steps.push_back({offset, static_cast<float>(offset.cast<double>().norm())});
  });
  return steps;
}

}  // namespace

void keep_largest_set(const VoxelLattice& lattice, std::vector<char>& is_member) {
  const int nx = lattice.counts[0];
  const int ny = lattice.counts[1];
  const int nz = lattice.counts[2];
  std::vector<Run> runs;
  std::vector<std::size_t> first_of_row;  // First run of each row, and the end of the last.
  for (std::size_t row = 0; row < is_member.size(); row += nx) {
    first_of_row.push_back(runs.size());
    const auto begin = is_member.begin() + row;
    for (auto at = begin; (at = std::find(at, begin + nx, 1)) != begin + nx;) {
      const auto end = std::find(at, begin + nx, 0);
      runs.push_back({static_cast<int>(at - begin), static_cast<int>(end - begin) - 1});
      at = end;
    }
  }
  first_of_row.push_back(runs.size());

  base::DisjointSets sets(runs.size());
  const auto unite_rows = [&](int row, int other) {
    std::size_t b = first_of_row[other];
    for (std::size_t a = first_of_row[row]; a < first_of_row[row + 1]; ++a) {
      while (b < first_of_row[other + 1] && runs[b].last + 1 < runs[a].first) ++b;
      // The last of them may touch the next run too.
      for (std::size_t c = b; c < first_of_row[other + 1] && runs[c].first <= runs[a].last + 1;
           ++c) {
        sets.unite(base::as_index<std::int32_t>(a), base::as_index<std::int32_t>(c));
      }
    }
  };
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const int row = j + ny * k;
      if (j > 0) unite_rows(row, row - 1);
      if (k == 0) continue;
      for (int other = std::max(0, j - 1); other <= std::min(ny - 1, j + 1); ++other) {
        unite_rows(row, other + ny * (k - 1));
      }
    }
  }

  const std::vector<std::int32_t> set_of = sets.numbered();
  std::vector<std::int64_t> size_of(runs.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    size_of[set_of[i]] += runs[i].last - runs[i].first + 1;
  }
  const auto largest = std::max_element(size_of.begin(), size_of.end()) - size_of.begin();
  for (std::size_t row = 0; row + 1 < first_of_row.size(); ++row) {
    for (std::size_t i = first_of_row[row]; i < first_of_row[row + 1]; ++i) {
      if (set_of[i] == largest) continue;
      const auto begin = is_member.begin() + row * nx;
      std::fill(begin + runs[i].first, begin + runs[i].last + 1, 0);
    }
  }
}

SetTopology topology(const VoxelLattice& lattice, const std::vector<Index>& voxels, int growth) {
  Vector3i low = Vector3i::Constant(std::numeric_limits<int>::max());
  Vector3i high = Vector3i::Constant(std::numeric_limits<int>::min());
  for (const Index index : voxels) {
    low = low.cwiseMin(lattice.voxel(index));
    high = high.cwiseMax(lattice.voxel(index));
  }
  low.array() -= growth + 1;  // One voxel of surroundings.
  const Vector3i size = high - low + Vector3i::Constant(growth + 2);
  const auto at = [&](int i, int j, int k) {
    return i + size[0] * (j + static_cast<std::ptrdiff_t>(size[1]) * k);
  };
  std::vector<char> cells(static_cast<std::size_t>(size[0]) * size[1] * size[2], 0);
  for (const Index index : voxels) {
    const Vector3i v = lattice.voxel(index) - low;
    for (int k = v[2] - growth; k <= v[2] + growth; ++k) {
      for (int j = v[1] - growth; j <= v[1] + growth; ++j) {
        const auto row = cells.begin() + at(v[0] - growth, j, k);
        std::fill(row, row + 2 * growth + 1, 1);
      }
    }
  }
  // Every corner, edge and face is in the set if one of the cells that share it is; it is counted
  // at the highest of these cells.
  std::int64_t euler = 0;
  const Vector3i last = size - Vector3i::Ones();
  for_each_in_block(Vector3i::Ones(), last, [&](const Vector3i& v) {
    const auto filled = [&](int a, int b, int c) {
      return cells[at(v[0] - a, v[1] - b, v[2] - c)] != 0;
    };
    const bool o = filled(0, 0, 0), x = filled(1, 0, 0), y = filled(0, 1, 0), z = filled(0, 0, 1),
               xy = filled(1, 1, 0), yz = filled(0, 1, 1), zx = filled(1, 0, 1),
               xyz = filled(1, 1, 1);
    euler += o || x || y || z || xy || yz || zx || xyz;
    euler -= (o || x || y || xy) + (o || y || z || yz) + (o || z || x || zx);
    euler += (o || x) + (o || y) + (o || z);
    euler -= o;
  });
  // Cells of the set are connected even by corners, cells outside of it by faces only.
  const auto count_sets = [&](char value, bool by_corners) {
    std::vector<char> seen(cells.size(), 0);
    std::vector<Vector3i> stack;
    int sets = 0;
    const auto take = [&](const Vector3i& v) {
      const auto index = at(v[0], v[1], v[2]);
      if (cells[index] != value || seen[index]) return false;
      seen[index] = 1;
      stack.push_back(v);
      return true;
    };
    for_each_in_block(Vector3i::Zero(), last, [&](const Vector3i& start) {
      if (!take(start)) return;
      ++sets;
      while (!stack.empty()) {
        const Vector3i v = stack.back();
        stack.pop_back();
        for_each_in_block((v.array() - 1).max(0), (v.array() + 1).min(last.array()),
                          [&](const Vector3i& w) {
                            if (by_corners || (w - v).cwiseAbs().sum() == 1) take(w);
                          });
      }
    });
    return sets;
  };
  SetTopology result;
  result.num_pieces = count_sets(1, true);
  const int num_cavities = count_sets(0, false) - 1;
  result.num_rings = static_cast<int>(result.num_pieces + num_cavities - euler);
  return result;
}

double LongestWay::operator()(std::int32_t name,
                              const std::vector<std::pair<float, Index>>& starts) {
  const std::vector<PathStep> steps = path_steps();
  std::priority_queue<std::pair<float, Index>, std::vector<std::pair<float, Index>>, std::greater<>>
      open;
  for (const auto& [length, voxel] : starts) {
    length_[voxel] = length;
    open.emplace(length, voxel);
  }
  float longest = 0.0F;
  while (!open.empty()) {
    const auto [length, index] = open.top();
    open.pop();
    if (length > length_[index]) continue;
    longest = std::max(longest, length);
    const Vector3i voxel = lattice_.voxel(index);
    for (const PathStep& step : steps) {
      const std::optional<Index> target = member(voxel + step.offset, name);
      if (!target || length + step.length >= length_[*target]) continue;
      // A step of two voxels must not jump a gap: one of the two beside its middle is inside too.
      if (step.offset.cwiseAbs().maxCoeff() == 2) {
        const Vector3i inner = step.offset / 2;  // Toward zero.
        const Vector3i outer = step.offset - inner;
        if (!member(voxel + inner, name) && !member(voxel + outer, name)) continue;
      }
      length_[*target] = length + step.length;
      open.emplace(length_[*target], *target);
    }
  }
  return longest;
}

}  // namespace graspfit::geometry::internal
