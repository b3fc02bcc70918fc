#include "graspfit/grasp/grasp_io.hpp"

#include <algorithm>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "internal/pose_numbers.hpp"
#include "internal/recorded_hand.hpp"

namespace graspfit::grasp {

using geometry::RigidTransform;
using geometry::shortest_decimal;
using geometry::TriangleMesh;

const char* library_version() { return GRASPFIT_VERSION; }

GraspFile make_grasp_file(const ObjectRecord& record, const hands::HandModel& hand,
                          const PlannerOptions& options, const ObjectModel& object,
                          const PlannerResult& result) {
  GraspFile file;
  file.object = record;
  file.hand = hand;
  file.link_mesh_sha256 = internal::link_mesh_hashes(hand);
  file.options = options;
  for (int finger : requested_parts(hand, options).fingers) {
    file.fingers.push_back(hand.fingers[finger].name);
  }
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
  geometry::write_file_atomically(path, to_json(file));
}

double largest_contact_gap(const Grasp& grasp) {
  double gap = 0.0;
  for (const Contact& contact : grasp.contacts) gap = std::max(gap, contact.gap);
  return gap;
}

double largest_penetration(const Grasp& grasp) {
  return std::max(grasp.penetration.object_depth, grasp.penetration.self_depth);
}

QualityContext quality_context(const GraspFile& file, const TriangleMesh& object) {
  QualityContext context;
  context.center_of_mass_O = geometry::mass_properties(object).center_of_mass;
  context.normalizing_radius = 0.5 * geometry::bounding_box(object).diagonal().norm();
  context.hand = &file.hand;
  return context;
}

ContactEstimationOptions contact_options(const GraspFile& file) {
  ContactEstimationOptions options;
  options.clip_thickness = file.clip_thickness;
  options.averaging = file.options.averaging;
  return options;
}

QualityOptions quality_options(const GraspFile& file) {
  QualityOptions options = file.options.quality;
  options.merge_distance = file.merge_distance;
  return options;
}

std::string to_csv(const GraspFile& file) {
  // A name with a separator or a quote in it is quoted as RFC 4180 says.
  const auto cell = [](const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
  };

  std::string csv =
      "rank,m,m1,m2,m3,regularity,centroid_distance_m,num_contacts,num_stable_pairs,"
      "largest_contact_gap_m,largest_penetration_m,usable,valid,attempt,"
      "palm_x_m,palm_y_m,palm_z_m,palm_qw,palm_qx,palm_qy,palm_qz";
  for (const hands::Joint& joint : file.hand.joints) {
    csv += ',' + cell(joint.name + (joint.type == hands::JointType::Revolute ? "_rad" : "_m"));
  }
  csv += '\n';
  for (std::size_t i = 0; i < file.grasps.size(); ++i) {
    const Grasp& grasp = file.grasps[i];
    const ContactQuality& quality = grasp.quality;
    csv += std::to_string(i + 1);
    for (double value : {quality.m, quality.m1, quality.m2, quality.m3, quality.regularity,
                         quality.centroid_distance}) {
      csv += ',' + shortest_decimal(value);
    }
    csv += ',' + std::to_string(grasp.contacts.size());
    csv += ',' + std::to_string(quality.stable_pairs.size());
    csv += ',' + shortest_decimal(largest_contact_gap(grasp));
    csv += ',' + shortest_decimal(largest_penetration(grasp));
    csv += grasp.is_usable() ? ",true" : ",false";
    csv += grasp.is_valid() ? ",true," : ",false,";
    csv += std::to_string(grasp.attempt);
    const RigidTransform& X_OH = grasp.configuration.X_OH;
    for (int axis = 0; axis < 3; ++axis) csv += ',' + shortest_decimal(X_OH.translation()[axis]);
    for (double value : internal::rotation_wxyz(X_OH)) csv += ',' + shortest_decimal(value);
    for (double value : grasp.configuration.q) csv += ',' + shortest_decimal(value);
    csv += '\n';
  }
  return csv;
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
