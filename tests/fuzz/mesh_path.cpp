#include "mesh_path.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "mesh_io/mesh_formats.hpp"

namespace graspfit::testing {
namespace {

using namespace geometry;

// With these limits an input takes thousandths of a second; more of the same finds nothing new.
constexpr std::size_t kMostFacesQueried = 300;
constexpr std::size_t kMostFacesResolved = 60;

// The limit keeps products of three coordinates within the range of double, as the module does.
constexpr double kLargestCoordinate = 1e90;

bool is_of_usual_size(const TriangleMesh& mesh) {
  return bounding_box(mesh).min().cwiseAbs().maxCoeff() < kLargestCoordinate &&
         bounding_box(mesh).max().cwiseAbs().maxCoeff() < kLargestCoordinate;
}

// Chooses by the number of bytes: mostly the default, and each option in one case of eight.
MeshRepairOptions repair_options(std::string_view input) {
  MeshRepairOptions options;
  switch (input.size() % 8) {
    case 0:
      options.self_intersections = SelfIntersections::Resolve;
      break;
    case 1:
      options.wrap = AlphaWrap{.alpha_rel = 0.2, .offset_rel = 0.05};
      break;
    case 2:
      options.weld_distance_rel = 0.01;
      break;
    case 3:
      options.mode = RepairMode::Strict;
      break;
    default:
      break;
  }
  return options;
}

void require(bool condition, const char* promise) {
  if (!condition) throw std::logic_error(promise);
}

void require_round_trips(const TriangleMesh& mesh) {
  const std::array<std::pair<const char*, std::string>, 3> written = {
      {{"off", internal::format_off(mesh)},
       {"obj", internal::format_obj(mesh)},
       {"ply", internal::format_ply(mesh)}}};
  for (const auto& [format, content] : written) {
    require(internal::mesh_from_content(content, format).mesh == mesh,
            "every bit of a double survives OFF, OBJ and PLY");
  }
}

void query(const TriangleMesh& mesh) {
  const MeshQuery object(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 6});
  const auto patches = surface_patches(mesh, lattice);
  const VoxelGrid grid = voxelize(object, lattice, patches);
  require(grid.count(VoxelClass::Partial) == static_cast<std::int64_t>(patches.size()),
          "a voxel is partial iff it has a patch");
  const SignedDistanceMap map = signed_distance_map(grid);
  for (std::int64_t i = 0; i < lattice.num_voxels(); ++i) {
    if (grid.classes[i] == VoxelClass::Partial) continue;
    const Eigen::Vector3d center = lattice.center(lattice.voxel(i));
    const bool is_inside = object.containment(center) == Containment::Inside;
    require(is_inside == (grid.classes[i] == VoxelClass::Full), "classes agree with containment");
    require(is_inside == (map.values[i] < 0.0f), "the map's sign agrees with containment");
  }
}

}  // namespace

std::string take_mesh_path(std::string_view input) {
  if (input.empty()) return "nothing";
  constexpr std::array<const char*, 4> kFormats = {"off", "obj", "ply", "stl"};
  std::string format = kFormats[static_cast<unsigned char>(input[0]) % 4];
  if (input[0] == 'o') format = "off";
  if (input[0] == 'b') format = "obj";
  if (input[0] == 'p') format = "ply";
  if (input[0] == 's') format = "stl";
  try {
    const TriangleMesh mesh = internal::mesh_from_content(input.substr(1), format).mesh;
    for (const Face& face : mesh.faces) {
      for (const std::int32_t vertex : face) {
        require(vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.vertices.size(),
                "the indices of what is read are in range");
      }
    }
    require_round_trips(mesh);
    analyze(mesh, {.count_self_intersections = mesh.faces.size() <= kMostFacesQueried});
    const MeshRepairOptions options = repair_options(input);
    if (options.self_intersections != SelfIntersections::Leave || options.wrap) {
      if (mesh.faces.size() > kMostFacesResolved || !is_of_usual_size(mesh)) return "left out";
    }
    const RepairedMesh repaired = repair_mesh(mesh, options);
    require(repaired.after.is_closed && repaired.after.is_outward, "repair closes or refuses");
    require(analyze(repaired.mesh).is_closed, "what repair calls closed is closed");
    const bool is_small = repaired.mesh.faces.size() <= kMostFacesQueried;
    const Eigen::AlignedBox3d box = bounding_box(repaired.mesh);
    if (is_small &&
        box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff() < kLargestCoordinate) {
      query(repaired.mesh);
    }
    return "good";
  } catch (const base::Error& refusal) {
    const std::string what = refusal.what();
    require(!what.empty() && what.find('\n') == std::string::npos, "a refusal is one line");
    return what;
  }
}

}  // namespace graspfit::testing
