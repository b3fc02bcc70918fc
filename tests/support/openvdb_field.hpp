#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::testing {

/// OpenVDB's narrow-band signed distance field, sampled at the centers of a lattice's voxels.
class OpenVdbField {
 public:
  struct Grid;
  explicit OpenVdbField(std::shared_ptr<const Grid> grid) : grid_(std::move(grid)) {}

  /// Signed distance in voxels, negative inside; beyond the band of 3 voxels it is ±3.
  double at(const Eigen::Vector3i& voxel) const;

  std::size_t num_bytes() const;

 private:
  std::shared_ptr<const Grid> grid_;
};

/// A mesh as OpenVDB takes it (in single precision, copied once) with the lattice on which it is
/// sampled.
class OpenVdbMesh {
 public:
  OpenVdbMesh(const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice);

  /// Calls `meshToSignedDistanceField` with its default band and all of its steps.
  OpenVdbField signed_distance_field() const;

  /// Calls it without the steps that change computed distances (renormalization, removal of voxels
  /// that self-intersections made, trimming), so that each value is the distance to some face.
  OpenVdbField unsmoothed_distance_field() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Limits the threads that OpenVDB may use while it lives.
class OpenVdbThreads {
 public:
  explicit OpenVdbThreads(int count);
  ~OpenVdbThreads();
  OpenVdbThreads(const OpenVdbThreads&) = delete;
  OpenVdbThreads& operator=(const OpenVdbThreads&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace graspfit::testing
