#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/surface_patch.hpp"

namespace graspfit::testing {

/// The same loop as in doubles with the points and numbers of CGAL's kernel with exact
/// constructions (Epeck) in their place: what one gets who changes the kernel of such a program.
std::vector<geometry::SurfacePatch> surface_patches_by_epeck(const geometry::TriangleMesh& mesh,
                                                             const geometry::VoxelLattice& lattice);

/// The same with as few constructions as can be: one for each corner, area and centroid, none for
/// faces within one voxel.
std::vector<geometry::SurfacePatch> surface_patches_by_frugal_epeck(
    const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice);

/// Processor time [s] and area [m²] of CGAL's `Polygon_mesh_processing::clip` of the whole mesh by
/// one voxel, as a surface; copying the mesh, which it changes, is not counted.
struct CgalClip {
  double seconds = 0.0;
  double area = 0.0;
};
std::vector<CgalClip> clip_by_cgal(const geometry::TriangleMesh& mesh,
                                   const geometry::VoxelLattice& lattice,
                                   const std::vector<std::int64_t>& voxels);

}  // namespace graspfit::testing
