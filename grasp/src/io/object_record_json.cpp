#include "graspfit/base/path_text.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "io/record_json.hpp"

namespace graspfit::grasp::internal {
namespace {

template <class Enum>
Json choice(Enum value) {
  return std::string(name_of(value));
}

Json mesh_json(const geometry::MeshAnalysis& mesh) {
  return {{"num_vertices", mesh.num_vertices},
          {"num_faces", mesh.num_faces},
          {"num_parts", mesh.num_parts},
          {"is_closed", mesh.is_closed},
          {"is_manifold", mesh.is_manifold},
          {"is_outward", mesh.is_outward},
          {"num_unused_vertices", mesh.num_unused_vertices},
          {"num_degenerate_faces", mesh.num_degenerate_faces},
          {"num_doubled_faces", mesh.num_doubled_faces},
          {"num_boundary_edges", mesh.num_boundary_edges},
          {"num_nonmanifold_edges", mesh.num_nonmanifold_edges},
          {"num_inconsistent_edges", mesh.num_inconsistent_edges},
          {"num_inward_parts", mesh.num_inward_parts},
          {"num_self_intersections", or_null(mesh.num_self_intersections)},
          {"bounding_box_m",
           {{"lower", to_json(Eigen::Vector3d(mesh.box.min()))},
            {"upper", to_json(Eigen::Vector3d(mesh.box.max()))}}}};
}

}  // namespace

Json object_json(const ObjectRecord& object, const std::optional<std::string>& used_mesh_file) {
  Json repairs = Json::array();
  for (const geometry::RepairStep& step : object.repairs) {
    repairs.push_back({{"what", step.what},
                       {"count", step.count},
                       {"volume_change_m3", step.volume_change},
                       {"hausdorff_bound_m", step.hausdorff_bound}});
  }
  Json wrap = nullptr;
  if (object.repair.wrap) {
    wrap = {{"alpha_rel", object.repair.wrap->alpha_rel},
            {"offset_rel", object.repair.wrap->offset_rel}};
  }
  return {{"file", base::path_text(object.file)},
          {"sha256", object.sha256},
          {"meters_per_file_unit", object.meters_per_file_unit},
          {"used_mesh_file", or_null(used_mesh_file)},
          {"repair",
           {{"mode", choice(object.repair.mode)},
            {"weld_distance_rel", object.repair.weld_distance_rel},
            {"max_hole_extent_rel", object.repair.max_hole_extent_rel},
            {"self_intersections", choice(object.repair.self_intersections)},
            {"wrap", wrap},
            {"steps", repairs}}},
          {"mesh", mesh_json(object.analysis)},
          {"center_of_mass_O_m", to_json(object.center_of_mass_O)},
          {"volume_m3", object.volume},
          {"normalizing_radius_m", object.normalizing_radius}};
}

Json surroundings_json(const GraspFile& file) {
  Json obstacles = Json::array();
  for (std::size_t i = 0; i < file.surroundings.obstacles.size(); ++i) {
    obstacles.push_back(object_json(
        file.surroundings.obstacles[i],
        file.used_meshes ? std::optional(file.used_meshes->obstacles.at(i)) : std::nullopt));
  }
  return {{"table_z_O_m", or_null(file.surroundings.table_z_O)}, {"obstacles", obstacles}};
}

}  // namespace graspfit::grasp::internal
