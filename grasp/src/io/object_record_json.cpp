#include "graspfit/base/path_text.hpp"
#include "io/grasp_fields.hpp"
#include "io/json_fields.hpp"

namespace graspfit::grasp::internal {
Json object_json(const ObjectRecord& object, const std::optional<std::string>& used_mesh_file) {
  Json json = {{"file", base::path_text(object.file)},
               {"sha256", object.sha256},
               {"meters_per_file_unit", object.meters_per_file_unit},
               {"used_mesh_file", or_null(used_mesh_file)}};
  JsonWriter at(json);
  at.optional_group("laid", object.laid, laid_fields);
  at.group("repair", object, repair_fields);
  at.group("mesh", object.analysis, mesh_fields);
  json["mesh"]["bounding_box_m"] = {{"lower", to_json(Eigen::Vector3d(object.analysis.box.min()))},
                                    {"upper", to_json(Eigen::Vector3d(object.analysis.box.max()))}};
  at(object.center_of_mass_O, "center_of_mass_O_m");
  at(object.volume, "volume_m3");
  at(object.normalizing_radius, "normalizing_radius_m");
  return json;
}

Json surroundings_json(const GraspFile& file) {
  Json obstacles = Json::array();
  for (std::size_t i = 0; i < file.surroundings.obstacles.size(); ++i) {
    obstacles.push_back(object_json(
        file.surroundings.obstacles[i],
        file.used_meshes ? std::optional(file.used_meshes->obstacles.at(i)) : std::nullopt));
  }
  return {{"table_z_O_m", or_null(file.surroundings.table_z_O)},
          {"table_clearance_m", file.surroundings.table_clearance},
          {"obstacles", obstacles}};
}

}  // namespace graspfit::grasp::internal
