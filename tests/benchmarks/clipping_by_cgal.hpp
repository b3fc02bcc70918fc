#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/surface_patch.hpp"

namespace graspfit::testing {

/// Runs the same loop as in doubles with the points and numbers of CGAL's kernel with exact
/// constructions (Epeck) in their place: this is what one gets by changing the kernel of such a
/// program.
std::vector<geometry::SurfacePatch> surface_patches_by_epeck(const geometry::TriangleMesh& mesh,
                                                             const geometry::VoxelLattice& lattice);

/// Runs the same loop with as few constructions as possible: one for each corner, area and
/// centroid, none for faces within one voxel.
std::vector<geometry::SurfacePatch> surface_patches_by_frugal_epeck(
    const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice);

/// Processor time [s] and area [m²] of CGAL's `Polygon_mesh_processing::clip` of the whole mesh by
/// one voxel, as a surface. It changes the mesh, whose copying is not counted.
struct CgalClip {
  double seconds = 0.0;
  double area = 0.0;
};
std::vector<CgalClip> clip_by_cgal(const geometry::TriangleMesh& mesh,
                                   const geometry::VoxelLattice& lattice,
                                   const std::vector<std::int64_t>& voxels);

}  // namespace graspfit::testing
