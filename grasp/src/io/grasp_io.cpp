#include "graspfit/grasp/grasp_io.hpp"

#include <algorithm>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::grasp {

using base::shortest_decimal;
using geometry::RigidTransform;
using geometry::TriangleMesh;

const char* library_version() { return GRASPFIT_VERSION; }

GraspFile make_grasp_file(const ObjectRecord& record, const hands::HandModel& hand,
                          const PlannerOptions& options, const ObjectModel& object,
                          const PlannerResult& result, const SurroundingsRecord& surroundings) {
  GraspFile file;
  file.object = record;
  file.surroundings = surroundings;
  file.hand = hand;
  file.link_mesh_sha256 = hands::link_mesh_hashes(hand);
  file.options = options;
  const RequestedParts requested = requested_parts(hand, options);
  for (int finger : requested.fingers) file.fingers.push_back(hand.fingers[finger].name);
  file.palm = requested.palm;
  file.voxel_size = object.grid.lattice.voxel_size;
  file.clip_thickness = clip_thickness(options, file.voxel_size);
  file.merge_distance = merge_distance(options, file.voxel_size);
  file.grasps = result.grasps;
  file.statistics = result.statistics;
  file.stop = result.stop;
  file.timings = result.timings;
  return file;
}

void write_grasps(const std::filesystem::path& path, const GraspFile& file) {
  base::write_file_atomically(path, to_json(file));
}

UsedMeshFiles write_used_meshes(const std::filesystem::path& folder, const hands::HandModel& hand,
                                const TriangleMesh& object, const Surroundings& surroundings) {
  UsedMeshFiles files;
  files.object = "object.ply";
  geometry::write_mesh(folder / files.object, object);
  for (const geometry::MeshQuery& obstacle : surroundings.obstacles) {
    files.obstacles.push_back("obstacle_" + std::to_string(files.obstacles.size() + 1) + ".ply");
    geometry::write_mesh(folder / files.obstacles.back(), obstacle.mesh());
  }
  for (const hands::Link& link : hand.links) {
    const std::size_t number = files.links.size();
    files.links.emplace_back();
    if (link.mesh_L.faces.empty()) continue;
    std::string name = link.name;
    for (char& c : name) {
      const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                            (c >= '0' && c <= '9') || c == '-' || c == '_';
      if (!is_plain) c = '_';
    }
    files.links.back() =
        (number < 10 ? "link_0" : "link_") + std::to_string(number) + '_' + name + ".ply";
    geometry::write_mesh(folder / files.links.back(), link.mesh_L);
  }
  return files;
}

Surroundings read_surroundings(const SurroundingsRecord& record,
                               const std::vector<std::filesystem::path>& files) {
  Surroundings surroundings;
  surroundings.table_z_O = record.table_z_O;
  surroundings.table_clearance = record.table_clearance;
  for (std::size_t i = 0; i < record.obstacles.size(); ++i) {
    surroundings.obstacles.emplace_back(
        read_object(record.obstacles[i], files.empty() ? std::filesystem::path() : files.at(i)));
  }
  return surroundings;
}

double largest_contact_gap(const Grasp& grasp) {
  double gap = 0.0;
  for (const contact::Contact& contact : grasp.contacts) gap = std::max(gap, contact.gap);
  return gap;
}

double largest_requested_gap(const Grasp& grasp) {
  double gap = 0.0;
  for (const contact::Contact& contact : grasp.contacts) {
    if (contact.is_target) gap = std::max(gap, contact.gap);
  }
  return gap;
}

double largest_penetration(const Grasp& grasp) {
  return std::max(grasp.penetration.object_depth, grasp.penetration.self_depth);
}

TriangleMesh posed_scene(const TriangleMesh& object, const hands::HandModel& hand,
                         const hands::HandConfiguration& configuration) {
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  std::vector<TriangleMesh> meshes = {object};
  for (std::size_t link = 0; link < hand.links.size(); ++link) {
    meshes.push_back(geometry::transformed(hand.links[link].mesh_L, X_OL[link]));
  }
  return geometry::concatenated(meshes);
}

std::string posed_scene_obj(const TriangleMesh& object, const hands::HandModel& hand,
                            const hands::HandConfiguration& configuration) {
  std::string text = "# Frame: object. Unit: meter.\n";
  std::size_t first_index = 1;  // OBJ counts vertices from 1, over all parts
  const auto append = [&](const std::string& name, const TriangleMesh& mesh) {
    text += "o " + name + '\n';
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      text += "v " + shortest_decimal(vertex.x()) + ' ' + shortest_decimal(vertex.y()) + ' ' +
              shortest_decimal(vertex.z()) + '\n';
    }
    for (const geometry::Face& face : mesh.faces) {
      text += 'f';
      for (std::int32_t corner : face) text += ' ' + std::to_string(first_index + corner);
      text += '\n';
    }
    first_index += mesh.vertices.size();
  };

  append("object", object);
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  for (std::size_t link = 0; link < hand.links.size(); ++link) {
    if (hand.links[link].mesh_L.faces.empty()) continue;
    append("link " + hand.links[link].name,
           geometry::transformed(hand.links[link].mesh_L, X_OL[link]));
  }
  return text;
}

}  // namespace graspfit::grasp
