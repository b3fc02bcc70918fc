#include "graspfit/geometry/weak_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "internal/parallel_for.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using Index = std::int64_t;

constexpr double kHalfDiagonal = 0.8660254037844387;  // Of a voxel, in voxels: √3 / 2.
constexpr int kLeastResolution = 16;                  // Enough for any object smaller than a ball.
// Of the radius: depth of residue along a crease that is no feature.
constexpr double kFillet = 0.5;
constexpr double kFewestVoxelsPerThickness = 2.0;  // Fewer do not show the ball as one.

/// Calls visit(neighbor) for the voxels of the 3 × 3 × 3 block around `voxel` that exist.
template <typename Visit>
void for_each_neighbor(const VoxelLattice& lattice, Index index, const Visit& visit) {
  const Vector3i voxel = lattice.voxel(index);
  const Vector3i low = (voxel.array() - 1).max(0);
  const Vector3i high = (voxel.array() + 1).min(lattice.counts.array() - 1);
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        const Index neighbor = lattice.index({i, j, k});
        if (neighbor != index) visit(neighbor);
      }
    }
  }
}

/// Whether a ball of `radius` inside the solid has its center in the voxel: starting at the voxel's
/// center, the ball that touches the nearest surface point is moved inward until it fits.
bool holds_ball_center(const MeshQuery& object, const VoxelLattice& lattice, Index index,
                       double radius) {
  constexpr int kMostMoves = 8;
  constexpr double kFit = 1.0 - 1e-6;  // Moves converge from below.
  const Vector3d start = lattice.center(lattice.voxel(index));
  const double reach = kHalfDiagonal * lattice.voxel_size;
  Vector3d center = start;
  for (int move = 0; move < kMostMoves; ++move) {
    const ClosestPoint closest = object.closest_point(center);
    const double distance = std::sqrt(closest.squared_distance);
    if (distance >= kFit * radius) return true;
    if (distance == 0.0) return false;
    center += (center - closest.point) / distance * (radius - distance);
    if ((center - start).norm() > reach) return false;
  }
  return false;
}

/// The voxels that hold centers of inscribed balls of `radius`, as those that are Partial.
VoxelGrid ball_centers(const MeshQuery& object, const VoxelGrid& grid, double radius,
                       int num_threads) {
  const VoxelLattice& lattice = grid.lattice;
  const double in_voxels = radius / lattice.voxel_size;
  const SignedDistanceMap map = signed_distance_map(grid);
  VoxelGrid centers{lattice, std::vector<VoxelClass>(grid.classes.size(), VoxelClass::Empty)};
  std::vector<Index> open;
  for (std::size_t i = 0; i < grid.classes.size(); ++i) {
    if (grid.classes[i] == VoxelClass::Empty) continue;
    // Surface lies within half a diagonal of each partial voxel's center, and only there.
    const double depth = std::abs(map.values[i]);
    if (grid.classes[i] == VoxelClass::Full && depth - kHalfDiagonal >= in_voxels) {
      centers.classes[i] = VoxelClass::Partial;
    } else if (depth + 2.0 * kHalfDiagonal >= in_voxels) {
      open.push_back(static_cast<Index>(i));
    }
  }
  internal::parallel_for(open.size(), num_threads, [&](std::size_t k) {
    const Index i = open[k];
    const bool is_inside =
        grid.classes[i] == VoxelClass::Full ||
        object.containment(lattice.center(lattice.voxel(i))) == Containment::Inside;
    if (is_inside && holds_ball_center(object, lattice, i, radius)) {
      centers.classes[i] = VoxelClass::Partial;
    }
  });
  return centers;
}

/// Labels the 26-connected sets of voxels for which `is_member`, in order of their first voxel;
/// −1 for the others. Returns the sets' voxels.
template <typename IsMember>
std::vector<std::vector<Index>> label_sets(const VoxelLattice& lattice,
                                           const std::vector<Index>& solid,
                                           const IsMember& is_member,
                                           std::vector<std::int32_t>& label) {
  std::vector<std::vector<Index>> sets;
  for (const Index first : solid) {
    if (label[first] >= 0 || !is_member(first)) continue;
    const auto name = static_cast<std::int32_t>(sets.size());
    std::vector<Index> set = {first};
    label[first] = name;
    for (std::size_t next = 0; next < set.size(); ++next) {
      for_each_neighbor(lattice, set[next], [&](Index neighbor) {
        if (label[neighbor] >= 0 || !is_member(neighbor)) return;
        label[neighbor] = name;
        set.push_back(neighbor);
      });
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

/// Topology of a set of voxels taken as closed cubes.
struct SetTopology {
  int num_pieces = 0;
  int num_rings = 0;  ///< Independent loops: 1 for a ring, 0 for a disk.
};

/// Of the voxels, each grown by `growth` voxels to all sides, which closes narrower gaps and holes.
/// Numbers of cubes, walls, edges and corners decide: pieces − rings + cavities = χ (Euler).
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
  // Every corner, edge and wall belongs to the cells that share it; counted by its highest cell.
  std::int64_t euler = 0;
  for (int k = 1; k < size[2]; ++k) {
    for (int j = 1; j < size[1]; ++j) {
      for (int i = 1; i < size[0]; ++i) {
        const auto filled = [&](int a, int b, int c) {
          return cells[at(i - a, j - b, k - c)] != 0;
        };
        const bool o = filled(0, 0, 0), x = filled(1, 0, 0), y = filled(0, 1, 0),
                   z = filled(0, 0, 1), xy = filled(1, 1, 0), yz = filled(0, 1, 1),
                   zx = filled(1, 0, 1), xyz = filled(1, 1, 1);
        euler += o || x || y || z || xy || yz || zx || xyz;
        euler -= (o || x || y || xy) + (o || y || z || yz) + (o || z || x || zx);
        euler += (o || x) + (o || y) + (o || z);
        euler -= o;
      }
    }
  }
  // Pieces touch by corners; what is between them is connected by walls only.
  const auto count_sets = [&](char value, bool by_corners) {
    std::vector<char> seen(cells.size(), 0);
    std::vector<Vector3i> stack;
    int sets = 0;
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) {
          if (cells[at(i, j, k)] != value || seen[at(i, j, k)]) continue;
          ++sets;
          seen[at(i, j, k)] = 1;
          stack.emplace_back(i, j, k);
          while (!stack.empty()) {
            const Vector3i v = stack.back();
            stack.pop_back();
            for (int step = 0; step < 27; ++step) {
              const Vector3i d(step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
              if (!by_corners && d.cwiseAbs().sum() != 1) continue;
              const Vector3i w = v + d;
              if ((w.array() < 0).any() || (w.array() >= size.array()).any()) continue;
              const auto place = at(w[0], w[1], w[2]);
              if (cells[place] != value || seen[place]) continue;
              seen[place] = 1;
              stack.push_back(w);
            }
          }
        }
      }
    }
    return sets;
  };
  SetTopology result;
  result.num_pieces = count_sets(1, true);
  const int num_cavities = count_sets(0, false) - 1;
  result.num_rings = static_cast<int>(result.num_pieces + num_cavities - euler);
  return result;
}

/// Steps of paths through voxels: the 98 primitive ones of the 5 × 5 × 5 block, whose paths are at
/// most 5 % longer than straight ones.
struct PathStep {
  Vector3i offset;
  float length;
};

std::vector<PathStep> path_steps() {
  std::vector<PathStep> steps;
  for (int k = -2; k <= 2; ++k) {
    for (int j = -2; j <= 2; ++j) {
      for (int i = -2; i <= 2; ++i) {
        if (std::gcd(std::gcd(i, j), k) != 1) continue;
        const Vector3i offset(i, j, k);
        steps.push_back({offset, static_cast<float>(offset.cast<double>().norm())});
      }
    }
  }
  return steps;
}

/// Longest way [voxels] from the body to any voxel of a set, inside the set. `ahead[v]` is how far
/// voxel v is from the body, for those next to it.
class LongestWay {
 public:
  LongestWay(const VoxelLattice& lattice, const std::vector<std::int32_t>& label)
      : lattice_(lattice),
        label_(label),
        steps_(path_steps()),
        length_(label.size(), std::numeric_limits<float>::infinity()) {}

  double operator()(std::int32_t name, const std::vector<std::pair<float, Index>>& starts) {
    std::priority_queue<std::pair<float, Index>, std::vector<std::pair<float, Index>>,
                        std::greater<>>
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
      for (const PathStep& step : steps_) {
        const Index target = member(voxel + step.offset, name);
        if (target < 0 || length + step.length >= length_[target]) continue;
        // A step of two voxels must not jump a gap: one of the two beside its middle is inside too.
        if (step.offset.cwiseAbs().maxCoeff() == 2) {
          const Vector3i inner = step.offset / 2;  // Toward zero.
          const Vector3i outer = step.offset - inner;
          if (member(voxel + inner, name) < 0 && member(voxel + outer, name) < 0) continue;
        }
        length_[target] = length + step.length;
        open.emplace(length_[target], target);
      }
    }
    return longest;
  }

 private:
  Index member(const Vector3i& voxel, std::int32_t name) const {
    if (!lattice_.contains(voxel)) return -1;
    const Index index = lattice_.index(voxel);
    return label_[index] == name ? index : -1;
  }

  const VoxelLattice& lattice_;
  const std::vector<std::int32_t>& label_;
  const std::vector<PathStep> steps_;
  std::vector<float> length_;
};

/// Voxel of the solid in which the middle of a face lies; −1 if there is none near.
Index voxel_of_face(const TriangleMesh& mesh, std::size_t face, const VoxelGrid& grid) {
  const auto [a, b, c] = corners(mesh, face);
  const Vector3d middle = (a + b + c) / 3.0;
  const VoxelLattice& lattice = grid.lattice;
  const Vector3i voxel =
      lattice.voxel_at(middle).cwiseMax(0).cwiseMin(lattice.counts - Vector3i::Ones());
  const Index index = lattice.index(voxel);
  if (grid.classes[index] != VoxelClass::Empty) return index;
  // Rounding put it beside the voxel that has its surface.
  Index best = -1;
  double best_distance = std::numeric_limits<double>::infinity();
  for_each_neighbor(lattice, index, [&](Index neighbor) {
    if (grid.classes[neighbor] == VoxelClass::Empty) return;
    const double distance = (lattice.center(lattice.voxel(neighbor)) - middle).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = neighbor;
    }
  });
  return best;
}

double median_by_area(std::vector<std::pair<double, double>>& thickness_and_area) {
  std::sort(thickness_and_area.begin(), thickness_and_area.end());
  double total = 0.0;
  for (const auto& [thickness, area] : thickness_and_area) total += area;
  double sum = 0.0;
  for (const auto& [thickness, area] : thickness_and_area) {
    sum += area;
    if (2.0 * sum >= total) return thickness;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

void WeakRegionOptions::validate() const {
  const auto refuse = [](const char* field, const std::string& value, const char* range) {
    throw InvalidInput(std::string("WeakRegionOptions: ") + field + " = " + value + ", must be " +
                       range);
  };
  if (!(weak_thickness > 0.0) || !std::isfinite(weak_thickness)) {
    refuse("weak_thickness", shortest_decimal(weak_thickness), "finite and > 0 m");
  }
  if (!(min_length_ratio >= 0.0) || !std::isfinite(min_length_ratio)) {
    refuse("min_length_ratio", shortest_decimal(min_length_ratio), "finite and >= 0");
  }
  if (!(voxels_per_thickness >= 4.0 && voxels_per_thickness <= 32.0)) {
    refuse("voxels_per_thickness", shortest_decimal(voxels_per_thickness), "in [4, 32]");
  }
  if (max_resolution < kLeastResolution || max_resolution > 512) {
    refuse("max_resolution", std::to_string(max_resolution), "in [16, 512]");
  }
  shape_diameter.validate();
}

WeakRegions find_weak_regions(const MeshQuery& object, const WeakRegionOptions& options) {
  options.validate();
  const TriangleMesh& mesh = object.mesh();
  const double radius = 0.5 * options.weak_thickness;
  const double wanted =
      std::ceil(longest_extent(mesh) * options.voxels_per_thickness / options.weak_thickness);
  const int resolution =
      static_cast<int>(std::clamp<double>(wanted, kLeastResolution, options.max_resolution));
  const VoxelLattice lattice = lattice_around(object.box(), {.resolution = resolution});
  const double h = lattice.voxel_size;
  WeakRegions result;
  result.thickness = shape_diameter(object, options.shape_diameter).thickness;
  result.is_weak.assign(mesh.faces.size(), false);
  result.voxel_size = h;
  if (h * kFewestVoxelsPerThickness > options.weak_thickness) {
    result.outcome = WeakOutcome::TooCoarse;
    return result;
  }

  const VoxelGrid grid = voxelize(object, lattice, surface_patches(mesh, lattice));
  const int num_threads = options.shape_diameter.num_threads;
  const VoxelGrid centers = ball_centers(object, grid, radius, num_threads);
  if (centers.count(VoxelClass::Partial) == 0) {
    result.outcome = WeakOutcome::NothingLeft;
    return result;
  }
  const SignedDistanceMap to_center = signed_distance_map(centers);

  // A voxel is opened if it may be within the radius of a ball's center, and a fillet more: that
  // lies up to half a diagonal from the center of its voxel, and the solid's part of a partial
  // voxel again as far. The fillet keeps neighbors apart that share a crease at their roots.
  std::vector<Index> solid;
  std::vector<bool> is_opened(grid.classes.size(), false);
  for (std::size_t i = 0; i < grid.classes.size(); ++i) {
    if (grid.classes[i] == VoxelClass::Empty) continue;
    solid.push_back(static_cast<Index>(i));
    double slack = std::max(kHalfDiagonal, kFillet * radius / h);
    if (grid.classes[i] == VoxelClass::Partial) slack += kHalfDiagonal;
    is_opened[i] = to_center.values[i] <= radius / h + slack;
  }
  std::vector<std::int32_t> opened_label(grid.classes.size(), -1);
  const auto opened = label_sets(
      lattice, solid, [&](Index i) { return bool{is_opened[i]}; }, opened_label);
  const auto body = static_cast<std::int32_t>(
      std::max_element(opened.begin(), opened.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); }) -
      opened.begin());
  std::vector<std::int32_t> label(grid.classes.size(), -1);
  const auto is_solid = [&](Index i) { return grid.classes[i] != VoxelClass::Empty; };
  const auto pieces = label_sets(
      lattice, solid, [&](Index i) { return is_solid(i) && opened_label[i] != body; }, label);

  // Faces of each piece; only pieces with a thin face are regions.
  std::vector<std::vector<std::int32_t>> faces_of(pieces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Index voxel = voxel_of_face(mesh, face, grid);
    if (voxel < 0 || label[voxel] < 0) continue;
    faces_of[label[voxel]].push_back(static_cast<std::int32_t>(face));
  }
  const auto is_thin = [&](std::int32_t face) {
    return result.thickness[face] < options.weak_thickness;
  };
  LongestWay longest_way(lattice, label);
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    if (std::none_of(faces_of[piece].begin(), faces_of[piece].end(), is_thin)) continue;
    WeakRegion region;
    region.faces = std::move(faces_of[piece]);
    std::vector<std::pair<double, double>> thickness_and_area;
    for (const std::int32_t face : region.faces) {
      if (std::isinf(result.thickness[face])) continue;
      thickness_and_area.emplace_back(result.thickness[face], vector_area(mesh, face).norm());
    }
    region.thickness = median_by_area(thickness_and_area);

    std::vector<Index> neck;
    std::vector<std::pair<float, Index>> starts;
    for (const Index voxel : pieces[piece]) {
      const std::size_t before = neck.size();
      for_each_neighbor(lattice, voxel, [&](Index neighbor) {
        if (opened_label[neighbor] == body) neck.push_back(neighbor);
      });
      if (neck.size() > before) {
        const double beyond = std::max(0.0, to_center.values[voxel] - radius / h);
        starts.emplace_back(static_cast<float>(beyond), voxel);
      }
    }
    if (neck.empty()) {
      region.verdict = WeakVerdict::NoNeck;
    } else {
      std::sort(neck.begin(), neck.end());
      neck.erase(std::unique(neck.begin(), neck.end()), neck.end());
      region.num_necks = topology(lattice, neck, 1).num_pieces;
      // A ring around less than the thickness is that of a hollow leg, or of a dent in a solid one.
      const int growth = static_cast<int>(std::ceil(radius / h));
      region.length = h * longest_way(static_cast<std::int32_t>(piece), starts);
      if (region.num_necks > 1) {
        region.verdict = WeakVerdict::SeveralNecks;
      } else if (topology(lattice, neck, growth).num_rings > 0) {
        region.verdict = WeakVerdict::HeldAllAround;
      } else if (region.length < options.min_length_ratio * region.thickness) {
        region.verdict = WeakVerdict::Short;
      }
    }
    if (region.verdict == WeakVerdict::Weak) {
      for (const std::int32_t face : region.faces) {
        if (is_thin(face)) result.is_weak[face] = true;
      }
    }
    result.regions.push_back(std::move(region));
  }
  std::sort(result.regions.begin(), result.regions.end(),
            [](const WeakRegion& a, const WeakRegion& b) { return a.faces[0] < b.faces[0]; });
  return result;
}

WeakRegions painted(WeakRegions regions, std::span<const std::int32_t> faces, FacePaint paint) {
  for (const std::int32_t face : faces) {
    if (face < 0 || static_cast<std::size_t>(face) >= regions.is_weak.size()) {
      throw InvalidInput("painted: face " + std::to_string(face) + " of " +
                         std::to_string(regions.is_weak.size()));
    }
  }
  for (const std::int32_t face : faces) regions.is_weak[face] = paint == FacePaint::Weak;
  return regions;
}

}  // namespace graspfit::geometry
