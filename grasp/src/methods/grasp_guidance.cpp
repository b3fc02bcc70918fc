#include "graspfit/grasp/grasp_guidance.hpp"

#include <algorithm>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "methods/guidance_list.hpp"

namespace graspfit::grasp {

void PlanningMethods::add(PlanningMethod method) {
  const auto check = [&](bool is_met, std::string_view field, std::string_view value,
                         std::string_view rule) {
    base::require(is_met, "PlanningMethod", field, value, rule);
  };
  check(!method.name.empty(), "name", method.name, "given");
  check(find(method.name) == nullptr, "name", method.name, "new: there is such a method");
  check(!method.title.empty(), "title of " + method.name, method.title, "given");
  check(method.make != nullptr, "make of " + method.name, "null", "a function");
  methods_.push_back(std::move(method));
}

const PlanningMethod* PlanningMethods::find(std::string_view name) const {
  const auto found =
      std::find_if(methods_.begin(), methods_.end(),
                   [&](const PlanningMethod& method) { return method.name == name; });
  return found == methods_.end() ? nullptr : &*found;
}

const PlanningMethod& PlanningMethods::at(std::string_view name) const {
  if (const PlanningMethod* const method = find(name)) return *method;
  throw base::InvalidInput("planner \"" + std::string(name) + "\" is not one of " + names());
}

std::string PlanningMethods::names() const {
  return base::list_text(methods_, &PlanningMethod::name, "|");
}

const PlanningMethods& planning_methods() {
  static const PlanningMethods methods = [] {
    PlanningMethods all;
    all.add({"fitting", "hand-object geometric fitting", internal::fitting_guidance, true, true});
    all.add({"gs-targets", "sampled target contacts", internal::sample_target_guidance, true});
    all.add({"gs", "sampled surface normals", internal::sampling_guidance});
    all.add({"ma", "medial axis, short retreat", internal::medial_guidance});
    all.add({"ma-full-retreat", "medial axis, full retreat",
             internal::medial_guidance_with_full_retreat});
    return all;
  }();
  return methods;
}

std::string to_csv(const GuidanceModel& model) {
  std::string text;
  for (std::size_t c = 0; c < model.columns.size(); ++c) {
    text += (c == 0 ? "" : ",") + model.columns[c];
  }
  text += '\n';
  for (const std::vector<double>& row : model.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += (c == 0 ? "" : ",") + base::shortest_decimal(row[c]);
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
      text += (c == 0 ? "" : " ") + base::shortest_decimal(row[c]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace graspfit::grasp
