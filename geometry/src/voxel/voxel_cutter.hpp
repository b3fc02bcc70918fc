#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "voxel/triangle_clip.hpp"

namespace graspfit::geometry::internal {

/// The piece of a face in a voxel.
struct CutPiece {
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;
  double area;
  std::int32_t first_corner;  ///< Index of the piece's first corner in `CutLayer::corners`, where
                              ///< whole faces have no corners.
  float squared_radius;       ///< Of a ball about the centroid that holds it; rounded to a float.
  std::int32_t face;
};

/// A piece by its voxel, its face and its index in `CutLayer::pieces`.
struct CutPieceName {
  std::int32_t cell;  ///< Index of its voxel in the layer, x fastest.
  std::int32_t face;
  std::int32_t piece;
};

/// The pieces in one layer of voxels across z. Layers are filled and finished one after the other,
/// from below, so that the data in use stay in the processor's caches and memory is used again.
struct CutLayer {
  std::vector<CutPiece> pieces;
  std::vector<Eigen::Vector3d> corners;
  std::vector<CutPieceName> names;  ///< Once complete, ascending by voxel, then face.

  bool is_whole(std::int32_t piece) const { return end_of(piece) == pieces[piece].first_corner; }
  /// Of a piece that is not a whole face.
  std::span<const Eigen::Vector3d> polygon(std::int32_t piece) const {
    return {corners.data() + pieces[piece].first_corner, corners.data() + end_of(piece)};
  }

  void clear() {
    pieces.clear();
    corners.clear();
    names.clear();
  }

 private:
  std::int32_t end_of(std::int32_t piece) const {
    const auto next = static_cast<std::size_t>(piece) + 1;
    return next < pieces.size() ? pieces[next].first_corner
                                : base::as_index<std::int32_t>(corners.size());
  }
};

/// Cuts the faces of a mesh at the planes of a lattice, first into layers along z, each layer into
/// rows along y, and each row into voxels along x.
class VoxelCutter {
 public:
  /// Mesh and lattice outlive the cutter. @throws InvalidInput if the lattice has no voxels or too
  /// many.
  VoxelCutter(const TriangleMesh& mesh, const VoxelLattice& lattice);

  /// Calls `take(layer, first voxel)` for every layer that holds pieces, from below.
  /// @throws InvalidInput if a face leaves the lattice, perhaps after layers were taken.
  void run(const std::function<void(const CutLayer&, std::int64_t)>& take);

 private:
  struct Level {
    CutPolygon rest;   ///< The polygon that is not yet cut along this axis.
    CutPolygon piece;  ///< The polygon's piece in one slab of this axis and of the axes before.
    CutPolygon other;
  };

  /// Twice the cell of a vertex on each axis, plus one unless it lies in the cell's lower plane.
  using VertexCode = std::array<int, 3>;

  std::vector<VertexCode> vertex_codes() const;
  void find_cells(std::int32_t face);
  void measure(const std::array<Eigen::Vector3d, 3>& triangle);
  void cut(std::int32_t face);
  template <int kAxis>
  void cut_along(int first, int last);
  template <int kAxis>
  void cut_narrowed();
  void add_whole(const std::array<Eigen::Vector3d, 3>& triangle);
  void add_cut(const CutPolygon& polygon);
  void add(CutLayer& layer, double area, const Eigen::Vector3d& centroid, std::size_t first_corner,
           double squared_radius);
  CutLayer& layer_of_cell();

  const TriangleMesh& mesh_;
  const VoxelLattice& lattice_;
  std::vector<VertexCode> codes_;
  std::vector<CutLayer> layers_;
  std::vector<CutLayer> spare_;  ///< Cleared layers, kept for their memory.
  TriangleCutter cutter_;
  std::array<Level, 3> levels_;
  std::array<int, 3> first_;  ///< First cell of the current face on each axis; `last_` is the last.
  std::array<int, 3> last_;
  std::array<std::uint32_t, 3> first_line_;  ///< Name of the plane above the first cell on each
                                             ///< axis.
  std::array<int, 3> cell_;                  ///< Cell of the current piece.
  std::int32_t face_ = -1;
  Eigen::Vector3d normal_;  ///< Unit normal of the current face.
  double area_ = 0.0;  ///< Area of the current face: zero if and only if its corners are collinear.
};

}  // namespace graspfit::geometry::internal
