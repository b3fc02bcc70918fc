#include "graspfit/geometry/weak_regions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "feature/shape_diameter.hpp"
#include "feature/solid_opening.hpp"
#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "voxel/voxel_sets.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using internal::for_each_neighbor;
using internal::Index;
using internal::label_sets;

constexpr int kLeastResolution = 16;               // Enough for any object smaller than a ball.
constexpr double kFewestVoxelsPerThickness = 2.0;  // Fewer do not resolve a ball.

/// Voxel of the solid in which the middle of a face lies; empty if there is none near.
std::optional<Index> voxel_of_face(const TriangleMesh& mesh, std::int32_t face,
                                   const VoxelGrid& grid) {
  const auto [a, b, c] = corners(mesh, face);
  const Vector3d middle = (a + b + c) / 3.0;
  const VoxelLattice& lattice = grid.lattice;
  const Vector3i voxel =
      lattice.voxel_at(middle).cwiseMax(0).cwiseMin(lattice.counts - Vector3i::Ones());
  const Index index = lattice.index(voxel);
  if (grid.classes[index] != VoxelClass::Empty) return index;
  // By rounding the point is in an empty voxel, beside the voxel that has the surface.
  std::optional<Index> best;
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

/// Searches the regions of a solid, one connected piece of the opening's residue after the other.
class RegionSearch {
 public:
  RegionSearch(const MeshQuery& object, const WeakRegionOptions& options, const VoxelGrid& grid,
               const internal::SolidOpening& opening, WeakRegions& result)
      : mesh_(object.mesh()),
        options_(options),
        lattice_(grid.lattice),
        radius_(0.5 * options.weak_thickness / grid.lattice.voxel_size),
        opening_(opening),
        result_(result),
        is_body_(opening.is_opened),
        label_(grid.classes.size(), -1),
        longest_way_(lattice_, label_) {
    internal::keep_largest_set(lattice_, is_body_);
    std::vector<Index> residue;
    for (Index i = 0; i < std::ssize(grid.classes); ++i) {
      if (grid.classes[i] != VoxelClass::Empty && !is_body_[i]) {
        residue.push_back(i);
      }
    }
    const auto is_residue = [&](Index i) {
      return grid.classes[i] != VoxelClass::Empty && !is_body_[i];
    };
    pieces_ = label_sets(lattice_, residue, is_residue, label_);
    faces_of_.resize(pieces_.size());
    std::vector<std::int32_t> faces;
    for (std::int32_t face = 0; face < std::ssize(mesh_.faces); ++face) {
      const std::optional<Index> voxel = voxel_of_face(mesh_, face, grid);
      if (!voxel || label_[*voxel] < 0) continue;
      faces_of_[label_[*voxel]].emplace_back(face, *voxel);
      faces.push_back(face);
    }
    // Faces that may be thin first: pieces without a thin face are no regions.
    const std::vector<char> may_be_thin =
        internal::may_be_thinner(object, faces, options.weak_thickness, options.shape_diameter);
    std::vector<char> is_measured(mesh_.faces.size(), 0);
    const auto measure = [&](const std::vector<std::int32_t>& chosen) {
      const std::vector<double> thickness =
          shape_diameter(object, chosen, options.shape_diameter).thickness;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        result_.thickness[chosen[i]] = thickness[i];
        is_measured[chosen[i]] = 1;
      }
    };
    std::vector<std::int32_t> chosen;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (may_be_thin[i] != 0) chosen.push_back(faces[i]);
    }
    measure(chosen);
    chosen.clear();
    for (const Faces& own : faces_of_) {
      const bool is_region = has_thin(own);
      for (const auto& [face, voxel] : own) {
        if (!is_region) result_.thickness[face] = std::numeric_limits<double>::infinity();
        if (is_region && is_measured[face] == 0) chosen.push_back(face);
      }
    }
    measure(chosen);
  }

  void run() {
    for (std::int32_t piece = 0; piece < std::ssize(pieces_); ++piece) {
      if (has_thin(faces_of_[piece])) search(piece);
    }
    std::sort(result_.regions.begin(), result_.regions.end(),
              [](const WeakRegion& a, const WeakRegion& b) { return a.faces[0] < b.faces[0]; });
  }

 private:
  /// Faces, each with the voxel that holds its middle.
  using Faces = std::vector<std::pair<std::int32_t, Index>>;

  bool is_thin(std::int32_t face) const {
    return result_.thickness[face] < options_.weak_thickness;
  }
  bool has_thin(const Faces& faces) const {
    return std::any_of(faces.begin(), faces.end(),
                       [&](const auto& face) { return is_thin(face.first); });
  }

  double median_thickness(const Faces& faces) const {
    std::vector<std::pair<double, double>> thickness_and_area;
    for (const auto& [face, voxel] : faces) {
      if (std::isinf(result_.thickness[face])) continue;
      thickness_and_area.emplace_back(result_.thickness[face], vector_area(mesh_, face).norm());
    }
    return median_by_area(thickness_and_area);
  }

  /// How the region behind a neck is attached.
  struct Hold {
    int num_necks = 0;
    bool is_ring = false;
    bool is_single() const { return num_necks == 1 && !is_ring; }
  };
  Hold hold(std::vector<Index>& neck) const {
    std::sort(neck.begin(), neck.end());
    neck.erase(std::unique(neck.begin(), neck.end()), neck.end());
    if (neck.empty()) return {};
    // A ring around an opening narrower than the thickness is the neck of a hollow leg, or
    // surrounds a dent in a solid one.
    const int growth = base::bounded_integer(std::ceil(radius_), 0, lattice_.counts.maxCoeff());
    Hold result{internal::topology(lattice_, neck, 1).num_pieces, false};
    if (result.num_necks == 1) {
      result.is_ring = internal::topology(lattice_, neck, growth).num_rings > 0;
    }
    return result;
  }

  double longest_of(const std::vector<Index>& voxels) const {
    float longest = 0.0F;
    for (const Index voxel : voxels) longest = std::max(longest, longest_way_.length_at(voxel));
    return lattice_.voxel_size * longest;
  }

  bool is_short(double length, double thickness) const {
    return length < options_.min_length_ratio * thickness;
  }

  void search(std::int32_t piece) {
    std::vector<Index> neck;
    std::vector<std::pair<float, Index>> starts;
    for (const Index voxel : pieces_[piece]) {
      const std::size_t before = neck.size();
      for_each_neighbor(lattice_, voxel, [&](Index neighbor) {
        if (is_body_[neighbor]) neck.push_back(neighbor);
      });
      if (neck.size() > before) {
        const double beyond = std::max(0.0, opening_.to_center[voxel] - radius_);
        starts.emplace_back(static_cast<float>(beyond), voxel);
      }
    }
    const Hold held = hold(neck);
    Faces faces = std::move(faces_of_[piece]);
    double length = 0.0;
    if (held.num_necks > 0) {
      length = lattice_.voxel_size * longest_way_(piece, starts);
      if (!held.is_single()) take_branches(piece, faces);
      if (!has_thin(faces)) return;
    }
    const double thickness = median_thickness(faces);
    WeakVerdict verdict = WeakVerdict::Weak;
    if (held.num_necks == 0) {
      verdict = WeakVerdict::NoNeck;
    } else if (held.num_necks > 1) {
      verdict = WeakVerdict::SeveralNecks;
    } else if (held.is_ring) {
      verdict = WeakVerdict::HeldAllAround;
    } else if (is_short(length, thickness)) {
      verdict = WeakVerdict::Short;
    }
    add(faces, thickness, length, held.num_necks, verdict);
  }

  /// Makes weak branches of a piece regions of their own and takes their faces from those of the
  /// piece.
  void take_branches(std::int32_t piece, Faces& faces) {
    const double cut = options_.weak_thickness / lattice_.voxel_size;
    std::vector<Index> beyond;
    for (const Index voxel : pieces_[piece]) {
      if (longest_way_.length_at(voxel) > cut) beyond.push_back(voxel);
    }
    if (beyond.empty()) return;
    const auto is_beyond = [&](Index voxel) {
      return label_[voxel] == piece && longest_way_.length_at(voxel) > cut;
    };
    if (branch_label_.empty()) branch_label_.assign(label_.size(), -1);
    const auto branches = label_sets(lattice_, beyond, is_beyond, branch_label_);
    for (std::int32_t name = 0; name < std::ssize(branches); ++name) {
      std::vector<Index> neck;
      for (const Index voxel : branches[name]) {
        for_each_neighbor(lattice_, voxel, [&](Index neighbor) {
          if (label_[neighbor] == piece && !is_beyond(neighbor)) neck.push_back(neighbor);
        });
      }
      const auto is_own = [&](const auto& face) {
        return branch_label_[face.second] == name && label_[face.second] == piece;
      };
      Faces own;
      std::copy_if(faces.begin(), faces.end(), std::back_inserter(own), is_own);
      if (!has_thin(own) || !hold(neck).is_single()) continue;
      const double thickness = median_thickness(own);
      const double length = longest_of(branches[name]);
      if (is_short(length, thickness)) continue;
      add(own, thickness, length, 1, WeakVerdict::Weak);
      std::erase_if(faces, is_own);
    }
  }

  void add(const Faces& faces, double thickness, double length, int num_necks,
           WeakVerdict verdict) {
    WeakRegion region{{}, thickness, length, num_necks, verdict};
    for (const auto& [face, voxel] : faces) {
      region.faces.push_back(face);
      if (verdict == WeakVerdict::Weak && is_thin(face)) result_.is_weak[face] = true;
    }
    result_.regions.push_back(std::move(region));
  }

  const TriangleMesh& mesh_;
  const WeakRegionOptions& options_;
  const VoxelLattice& lattice_;
  double radius_;  // Of the ball, in voxels.
  const internal::SolidOpening& opening_;
  WeakRegions& result_;
  std::vector<char> is_body_;        // The largest piece of the opened solid.
  std::vector<std::int32_t> label_;  // Piece of each voxel.
  std::vector<std::vector<Index>> pieces_;
  std::vector<Faces> faces_of_;  // One per piece.
  internal::LongestWay longest_way_;
  std::vector<std::int32_t> branch_label_;  // Branch of each voxel in its piece.
};

}  // namespace

void WeakRegionOptions::validate() const {
  const char* const where = "WeakRegionOptions";
  base::require(weak_thickness > 0.0 && std::isfinite(weak_thickness), where, "weak_thickness",
                weak_thickness, "finite and > 0 m");
  base::require(min_length_ratio >= 0.0 && std::isfinite(min_length_ratio), where,
                "min_length_ratio", min_length_ratio, "finite and >= 0");
  base::require_between(4.0, 32.0, where, "voxels_per_thickness", voxels_per_thickness);
  base::require_between(kLeastResolution, 512, where, "max_resolution", max_resolution);
  shape_diameter.validate();
}

WeakRegions find_weak_regions(const MeshQuery& object, const WeakRegionOptions& options) {
  options.validate();
  const TriangleMesh& mesh = object.mesh();
  const double wanted =
      std::ceil(longest_extent(mesh) * options.voxels_per_thickness / options.weak_thickness);
  const int resolution =
      static_cast<int>(std::clamp<double>(wanted, kLeastResolution, options.max_resolution));
  const VoxelLattice lattice = lattice_around(object.box(), {.resolution = resolution});
  WeakRegions result;
  result.thickness.assign(mesh.faces.size(), std::numeric_limits<double>::infinity());
  result.is_weak.assign(mesh.faces.size(), false);
  result.voxel_size = lattice.voxel_size;
  if (lattice.voxel_size * kFewestVoxelsPerThickness > options.weak_thickness) {
    result.outcome = WeakOutcome::TooCoarse;
    return result;
  }
  const VoxelGrid grid = voxelize(object, lattice, surface_voxels(mesh, lattice));
  const auto opening = internal::open_solid(object, grid, 0.5 * options.weak_thickness,
                                            options.shape_diameter.num_threads);
  if (!opening) {
    result.outcome = WeakOutcome::NothingLeft;
    return result;
  }
  RegionSearch(object, options, grid, *opening, result).run();
  return result;
}

}  // namespace graspfit::geometry
