#include "graspfit/geometry/voxel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/surface_patch.hpp"

namespace graspfit::geometry {

Eigen::Vector3i VoxelLattice::voxel(std::int64_t index) const {
  const std::int64_t row = index / counts[0];
  return {static_cast<int>(index % counts[0]), static_cast<int>(row % counts[1]),
          static_cast<int>(row / counts[1])};
}

void LatticeOptions::validate() const {
  if (resolution < 4 || resolution > 512) {
    throw base::InvalidInput("resolution is " + std::to_string(resolution) +
                             ", must be in [4, 512]");
  }
  if (!(margin >= 0.0) || !std::isfinite(margin)) {
    throw base::InvalidInput("margin is " + base::shortest_decimal(margin) +
                             " m, must be 0 or more");
  }
}

VoxelLattice lattice_around(const Eigen::AlignedBox3d& box, const LatticeOptions& options) {
  options.validate();
  if (box.isEmpty() || !(box.sizes().maxCoeff() > 0.0) || !box.sizes().allFinite()) {
    throw base::DegenerateGeometry("lattice_around: the box has no extent");
  }
  VoxelLattice lattice;
  const Eigen::Vector3d sizes = box.sizes();
  lattice.voxel_size = sizes.maxCoeff() / options.resolution;

  // Voxels that cover a length. A quotient within a billionth above a whole number is that number:
  // the voxel of margin on every side covers the rest.
  const auto voxels = [&](double length) {
    return std::max(1.0, std::ceil(length / lattice.voxel_size * (1.0 - 1e-9)));
  };
  const double margin = voxels(options.margin);
  double total = 1.0;
  for (int axis = 0; axis < 3; ++axis) total *= voxels(sizes[axis]) + 2.0 * margin;
  if (total > std::numeric_limits<std::int32_t>::max()) {
    throw base::InvalidInput("lattice_around: " + base::shortest_decimal(total) +
                             " voxels are too many; lower the resolution or the margin");
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double count = voxels(sizes[axis]) + 2.0 * margin;
    lattice.counts[axis] = static_cast<int>(count);
    lattice.origin[axis] = box.center()[axis] - 0.5 * count * lattice.voxel_size;
  }
  return lattice;
}

std::int64_t VoxelGrid::count(VoxelClass voxel_class) const {
  return std::count(classes.begin(), classes.end(), voxel_class);
}

VoxelGrid voxelize(const MeshQuery& object, const VoxelLattice& lattice,
                   const std::vector<SurfacePatch>& patches) {
  std::vector<std::int64_t> voxels;
  voxels.reserve(patches.size());
  for (const SurfacePatch& patch : patches) voxels.push_back(patch.voxel);
  return voxelize(object, lattice, voxels);
}

VoxelGrid voxelize(const MeshQuery& object, const VoxelLattice& lattice,
                   std::span<const std::int64_t> partial_voxels) {
  // Full marks "not seen yet" until every region has got its class; seen ones are labeled at once.
  VoxelGrid grid{lattice, std::vector<VoxelClass>(lattice.num_voxels(), VoxelClass::Full)};
  std::vector<char> is_seen(grid.classes.size(), 0);
  for (const std::int64_t voxel : partial_voxels) {
    if (voxel < 0 || voxel >= lattice.num_voxels()) {
      throw base::InvalidInput("voxelize: a patch is of voxel " + std::to_string(voxel) +
                               ", outside the lattice");
    }
    grid.classes[voxel] = VoxelClass::Partial;
    is_seen[voxel] = 1;
  }

  // Regions grow by whole runs along x, which is far fewer steps than voxels.
  struct Run {
    int first, last, j, k;
  };
  const int nx = lattice.counts[0];
  const int ny = lattice.counts[1];
  const int nz = lattice.counts[2];
  std::vector<Run> open;
  VoxelClass region = VoxelClass::Empty;
  const auto take = [&](int i, int j, int k) {
    char* const row = is_seen.data() + lattice.index({0, j, k});
    int first = i;
    while (first > 0 && !row[first - 1]) --first;
    int last = i;
    while (last + 1 < nx && !row[last + 1]) ++last;
    std::fill(row + first, row + last + 1, 1);
    if (region != VoxelClass::Full) {
      const auto start = grid.classes.begin() + lattice.index({first, j, k});
      std::fill(start, start + (last - first + 1), region);
    }
    open.push_back({first, last, j, k});
    return last;
  };
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const char* const row = is_seen.data() + lattice.index({0, j, k});
      for (int i = 0; i < nx; ++i) {
        if (row[i]) continue;
        region = object.containment(lattice.center({i, j, k})) == Containment::Outside
                     ? VoxelClass::Empty
                     : VoxelClass::Full;
        take(i, j, k);
        while (!open.empty()) {
          const Run run = open.back();
          open.pop_back();
          const auto join = [&](int nj, int nk) {
            if (nj < 0 || nj >= ny || nk < 0 || nk >= nz) return;
            const char* const next = is_seen.data() + lattice.index({0, nj, nk});
            for (int n = run.first; n <= run.last; ++n) {
              if (!next[n]) n = take(n, nj, nk);
            }
          };
          join(run.j - 1, run.k);
          join(run.j + 1, run.k);
          join(run.j, run.k - 1);
          join(run.j, run.k + 1);
        }
      }
    }
  }
  return grid;
}

}  // namespace graspfit::geometry
