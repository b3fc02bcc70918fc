#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/geometry/voxel_grid.hpp"
#include "graspfit/grasp/object_model.hpp"

namespace graspfit::app {

/// A named array with one value per voxel.
struct CellArray {
  std::string name;
  std::string_view type;  ///< VTK's name of the type: "UInt8" or "Float32".
  std::string bytes;      ///< The values in index order, little-endian.
};
CellArray cell_array(const std::string& name, const std::vector<std::uint8_t>& values);
CellArray cell_array(const std::string& name, const std::vector<float>& values);

/// A VTK XML image (.vti) of a lattice with arrays of cell data, base64 without compression:
/// ParaView and VTK open it.
std::string vtk_image(const geometry::VoxelLattice& lattice, const std::vector<CellArray>& arrays);

/// The clipped polygons of all patches as an ASCII PLY file for ParaView and MeshLab: color from
/// red (score 0) to green (score 1 and above), and as face properties `quality` (score), nx ny nz
/// (the patch's normal) and `voxel` (index in the lattice).
std::string patches_ply(const grasp::ObjectModel& object);

}  // namespace graspfit::app
