#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "derive/pad_fit.hpp"
#include "graspfit/geometry/mesh_query.hpp"

/// \file
/// What of a link's surface is seen from the side to which its pad is to look, on a grid of rays.
/// Frame S of the search: z is that direction, x follows the pad's.

namespace graspfit::hands::internal {

/// Heights up to here are not told apart [m]: below the 1 mm voxels of the planner.
inline constexpr double kFlatTolerance = 3e-4;

/// What a ray met, in the frame of the search (z against the rays).
struct Sample {
  bool is_hit = false;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// A rectangular grid of rays and what they met.
struct RayGrid {
  int nx = 0;
  int ny = 0;
  double step = 0.0;
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< Of the first cell.
  std::vector<Sample> samples;                       ///< x fastest.

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * nx + x); }
  Eigen::Vector2d center(int x, int y) const {
    return corner + step * Eigen::Vector2d(x + 0.5, y + 0.5);
  }
};

/// Corners of the surface that is seen, and the height from which rays start.
struct SearchBox {
  Eigen::AlignedBox3d box_S;
  double top = 0.0;
};

SearchBox search_box(const geometry::MeshQuery& link,
                     const std::vector<geometry::MeshQuery>& others, const Eigen::Matrix3d& R_LS,
                     const PadSearch& search);

/// The ray against z at a place of the search frame: what it meets of the link, if the others do
/// not stand before it.
Sample probe(const geometry::MeshQuery& link, const std::vector<geometry::MeshQuery>& others,
             const Eigen::Matrix3d& R_LS, const Eigen::Vector2d& place, double top);

/// The rays over the box; no samples where it has no area.
RayGrid cast(const geometry::MeshQuery& link, const std::vector<geometry::MeshQuery>& others,
             const Eigen::Matrix3d& R_LS, const SearchBox& box);

/// The cells of one connected part of the surface that faces the rays: the largest, or that nearest
/// to `center`.
std::vector<bool> facing_part(const RayGrid& grid, const std::optional<Eigen::Vector2d>& center);

}  // namespace graspfit::hands::internal
