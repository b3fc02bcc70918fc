#include "object/surface_places.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/convex_clip.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::SurfacePatch;
using geometry::TriangleMesh;

// A patch whose mean normal is shorter may have two sides: a right-angled edge has 0.71, half a
// tube 0.64.
constexpr double kLongestMean = 0.7;
constexpr double kLargestCosine = -0.5;  // between the sides' normals
// Of the other patches in a window of so many voxels to every side at least this share must face as
// a side of a wall does.
constexpr int kWindow = 2;
constexpr double kAlike = 0.8;
constexpr double kLeastShare = 0.5;

struct Side {
  Vector3d vector_area = Vector3d::Zero();
  std::vector<std::int32_t> faces;
};

/// The point of some faces that is nearest to `point`.
Vector3d nearest_on(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces,
                    const Vector3d& point) {
  Vector3d best = point;
  double least = std::numeric_limits<double>::infinity();
  geometry::ClippedPiece whole;
  for (const std::int32_t face : faces) {
    const std::array<Vector3d, 3> corners = geometry::corners(mesh, face);
    whole.polygon.assign(corners.begin(), corners.end());
    const Vector3d candidate = geometry::closest_point(whole, point);
    const double squared = (candidate - point).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    best = candidate;
  }
  return best;
}

/// Both sides of a patch on a thin wall; empty if it is on none. Its faces count whole, beyond
/// their voxel, too.
std::optional<std::pair<SurfacePlace, SurfacePlace>> sides_of(const TriangleMesh& mesh,
                                                              const SurfacePatch& patch) {
  if (patch.area_weighted_normal.norm() > kLongestMean) return std::nullopt;
  Matrix3d moment = Matrix3d::Zero();
  for (const std::int32_t face : patch.faces) {
    const Vector3d area = geometry::vector_area(mesh, face);
    if (!area.isZero(0.0)) moment += area * area.transpose() / area.norm();
  }
  // Across the wall, as most of its area faces.
  const Vector3d across = Eigen::SelfAdjointEigenSolver<Matrix3d>(moment).eigenvectors().col(2);
  std::array<Side, 2> sides;
  for (const std::int32_t face : patch.faces) {
    const Vector3d area = geometry::vector_area(mesh, face);
    Side& side = sides[area.dot(across) < 0.0 ? 1 : 0];
    side.vector_area += area;
    side.faces.push_back(face);
  }
  std::array<SurfacePlace, 2> places;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (sides[s].vector_area.isZero(0.0)) return std::nullopt;
    places[s].point_O = nearest_on(mesh, sides[s].faces, patch.area_centroid);
    places[s].outward_normal_O = sides[s].vector_area.normalized();
    places[s].has_normal = true;
  }
  const auto& [a, b] = places;
  const bool are_opposite = a.outward_normal_O.dot(b.outward_normal_O) < kLargestCosine;
  // Between the sides of a gap there is air.
  const bool is_gap = (a.point_O - b.point_O).dot(a.outward_normal_O - b.outward_normal_O) < 0.0;
  if (!are_opposite || is_gap) return std::nullopt;
  return std::pair(a, b);
}

using Sides = std::vector<std::optional<std::pair<SurfacePlace, SurfacePlace>>>;

/// Whether most of the surface in the window about a patch faces as one side of it does, or as the
/// other: on a wall, not on the lip of a can.
bool is_on_wall(const ObjectModel& object, const Sides& sides, std::int32_t patch) {
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  const Eigen::Vector3i center = lattice.voxel(object.patches[patch].voxel);
  const Eigen::Vector3i low = (center.array() - kWindow).max(0);
  const Eigen::Vector3i high = (center.array() + kWindow).min(lattice.counts.array() - 1);
  int num_all = 0;
  int num_like_first = 0;
  int num_like_second = 0;
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        const auto other = object.patch_in(lattice.index({x, y, z}));
        if (!other || *other == patch) continue;
        ++num_all;
        const auto is_like = [&](const Vector3d& normal) {
          if (!sides[*other]) return object.patches[*other].outward_normal.dot(normal) > kAlike;
          return std::max(sides[*other]->first.outward_normal_O.dot(normal),
                          sides[*other]->second.outward_normal_O.dot(normal)) > kAlike;
        };
        num_like_first += is_like(sides[patch]->first.outward_normal_O) ? 1 : 0;
        num_like_second += is_like(sides[patch]->second.outward_normal_O) ? 1 : 0;
      }
    }
  }
  return std::min(num_like_first, num_like_second) >= kLeastShare * num_all;
}

}  // namespace

std::vector<SurfacePlace> surface_places(const ObjectModel& object, bool splits_walls) {
  std::vector<SurfacePlace> places;
  std::vector<SurfacePlace> others;
  Sides all(object.patches.size());
  for (std::size_t i = 0; i < all.size() && splits_walls; ++i) {
    all[i] = sides_of(object.mesh(), object.patches[i]);
  }
  for (std::int32_t i = 0; i < std::ssize(object.patches); ++i) {
    const SurfacePatch& patch = object.patches[i];
    const auto& sides = all[i];
    if (!sides || !is_on_wall(object, all, i)) {
      places.push_back({patch.centroid, patch.outward_normal, patch.has_normal, i});
      continue;
    }
    SurfacePlace& first = places.emplace_back(sides->first);
    SurfacePlace& second = others.emplace_back(sides->second);
    first.patch = second.patch = second.other_side = i;
    first.other_side = base::as_index<std::int32_t>(object.patches.size() + others.size() - 1);
  }
  places.insert(places.end(), others.begin(), others.end());
  return places;
}

}  // namespace graspfit::grasp::internal
