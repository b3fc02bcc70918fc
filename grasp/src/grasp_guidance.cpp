#include "graspfit/grasp/grasp_guidance.hpp"

#include <array>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "internal/guidance_list.hpp"

namespace graspfit::grasp {

std::span<const PlanningMethod> planning_methods() {
  static constexpr std::array methods = {
      PlanningMethod{"fitting", "hand-object geometric fitting", internal::fitting_guidance, true,
                     true},
      PlanningMethod{"gs-targets", "sampled target contacts", internal::sample_target_guidance,
                     true},
      PlanningMethod{"gs", "sampled surface normals", internal::sampling_guidance},
      PlanningMethod{"ma", "medial axis, short retreat", internal::medial_guidance},
      PlanningMethod{"ma-full-retreat", "medial axis, full retreat",
                     internal::medial_guidance_with_full_retreat},
  };
  return methods;
}

const PlanningMethod& find_planning_method(std::string_view name) {
  for (const PlanningMethod& method : planning_methods()) {
    if (method.name == name) return method;
  }
  throw geometry::InvalidInput("planner \"" + std::string(name) + "\" is not one of " +
                               planning_method_names());
}

std::string planning_method_names() {
  std::string names;
  for (const PlanningMethod& method : planning_methods()) {
    if (!names.empty()) names += '|';
    names += method.name;
  }
  return names;
}

std::string to_csv(const GuidanceModel& model) {
  std::string text;
  for (std::size_t c = 0; c < model.columns.size(); ++c) {
    text += (c == 0 ? "" : ",") + model.columns[c];
  }
  text += '\n';
  for (const std::vector<double>& row : model.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += (c == 0 ? "" : ",") + geometry::shortest_decimal(row[c]);
    }
    text += '\n';
  }
  return text;
}

std::string to_ply(const GuidanceModel& model) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(model.rows.size()) + '\n';
  for (const std::string& column : model.columns) {
    const bool is_coordinate = column == "x_m" || column == "y_m" || column == "z_m";
    text += "property double " + (is_coordinate ? column.substr(0, 1) : column) + '\n';
  }
  text += "end_header\n";
  for (const std::vector<double>& row : model.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += (c == 0 ? "" : " ") + geometry::shortest_decimal(row[c]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace graspfit::grasp
