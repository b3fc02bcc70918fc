#include "output/vtk_files.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/surface_patch.hpp"

namespace graspfit::app {
namespace {

using base::shortest_decimal;

static_assert(std::endian::native == std::endian::little, "files are written in memory order");

template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t num_bytes = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < num_bytes ? static_cast<std::uint8_t>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= num_bytes ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
    }
  }
  return text;
}

std::string three(const Eigen::Vector3d& v) {
  return shortest_decimal(v.x()) + ' ' + shortest_decimal(v.y()) + ' ' + shortest_decimal(v.z());
}

/// Color of a score: red for 0, yellow halfway, green from 1.
std::string color(double score) {
  const double s = std::clamp(score, 0.0, 1.0);
  const auto channel = [](double value) {
    return std::to_string(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  };
  return channel(2.0 - 2.0 * s) + ' ' + channel(2.0 * s) + " 0";
}

}  // namespace

CellArray cell_array(const std::string& name, const std::vector<std::uint8_t>& values) {
  return {name, "UInt8", bytes_of(values)};
}

CellArray cell_array(const std::string& name, const std::vector<float>& values) {
  return {name, "Float32", bytes_of(values)};
}

std::string vtk_image(const geometry::VoxelLattice& lattice, const std::vector<CellArray>& arrays) {
  const std::string extent = "0 " + std::to_string(lattice.counts[0]) + " 0 " +
                             std::to_string(lattice.counts[1]) + " 0 " +
                             std::to_string(lattice.counts[2]);
  const Eigen::Vector3d spacing = Eigen::Vector3d::Constant(lattice.voxel_size);
  std::string data;
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<ImageData WholeExtent=\"" +
      extent + "\" Origin=\"" + three(lattice.origin) + "\" Spacing=\"" + three(spacing) +
      "\">\n<Piece Extent=\"" + extent + "\">\n<CellData Scalars=\"" + arrays.at(0).name + "\">\n";
  for (const CellArray& array : arrays) {
    text += "<DataArray type=\"" + std::string(array.type) + "\" Name=\"" + array.name +
            "\" format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>\n";
    const std::uint64_t num_bytes = array.bytes.size();
    std::string block(sizeof num_bytes, '\0');
    std::memcpy(block.data(), &num_bytes, sizeof num_bytes);
    data += base64(block + array.bytes);
  }
  return text + "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"base64\">\n_" +
         data + "\n</AppendedData>\n</VTKFile>\n";
}

std::string patches_ply(const grasp::ObjectModel& object) {
  const std::vector<geometry::VoxelPiece> pieces =
      geometry::clip_by_voxels(object.mesh(), object.grid.lattice);
  std::string vertices;
  std::string faces;
  std::size_t num_vertices = 0;
  for (const geometry::VoxelPiece& piece : pieces) {
    const std::int32_t patch = object.patch_of_voxel.at(piece.voxel);
    const double score = object.scores.scores.at(patch);
    faces += std::to_string(piece.piece.polygon.size());
    for (const Eigen::Vector3d& corner : piece.piece.polygon) {
      vertices += three(corner) + '\n';
      faces += ' ' + std::to_string(num_vertices++);
    }
    faces += ' ' + color(score) + ' ' + shortest_decimal(std::min(score, 1e30)) + ' ' +
             three(object.patches.at(patch).outward_normal) + ' ' + std::to_string(piece.voxel) +
             '\n';
  }
  return "ply\nformat ascii 1.0\n"
         "comment surface clipped by voxels, meters, object frame\n"
         "comment quality: contact score; nx ny nz: normal of the patch; voxel: index in the grid\n"
         "element vertex " +
         std::to_string(num_vertices) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(pieces.size()) +
         "\nproperty list uchar int vertex_indices\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
         "property double quality\n"
         "property double nx\nproperty double ny\nproperty double nz\nproperty int voxel\n"
         "end_header\n" +
         vertices + faces;
}

}  // namespace graspfit::app
