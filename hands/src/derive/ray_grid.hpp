#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "derive/pad_fit.hpp"
#include "graspfit/geometry/mesh_query.hpp"

/// \file
/// Samples, by a grid of rays, the part of a link's surface that is visible from the side that its
/// pad is to face. In the search frame S, z is the direction that the pad is to face, and x follows
/// the pad's x axis.

namespace graspfit::hands::internal {

/// Differences of height up to this value count as flat [m]; it is below the 1 mm voxels of the
/// planner.
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

/// Box of the surface that is searched, in S, and the height from which rays start.
struct SearchBox {
  Eigen::AlignedBox3d box_S;
  double top = 0.0;
};

SearchBox search_box(const geometry::MeshQuery& link,
                     const std::vector<geometry::MeshQuery>& others, const Eigen::Matrix3d& R_LS,
                     const PadSearch& search);

/// Casts the ray against z at the position `position_S` of the search frame: returns its hit on the
/// link, unless the others hide it.
Sample probe(const geometry::MeshQuery& link, const std::vector<geometry::MeshQuery>& others,
             const Eigen::Matrix3d& R_LS, const Eigen::Vector2d& position_S, double top);

/// Casts the rays over the box; the grid has no samples if the box has no area.
RayGrid cast(const geometry::MeshQuery& link, const std::vector<geometry::MeshQuery>& others,
             const Eigen::Matrix3d& R_LS, const SearchBox& box);

/// The cells of one connected part of the surface that faces the rays: the largest, or that nearest
/// to `center`.
std::vector<bool> facing_part(const RayGrid& grid, const std::optional<Eigen::Vector2d>& center);

}  // namespace graspfit::hands::internal
