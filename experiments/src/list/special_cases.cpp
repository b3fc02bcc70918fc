// Question: do the grasps that the paper shows for particular objects, sizes, poses and modes come
// out of the planner: a pinch of the small bunny and a power grasp of the large one, a small torus
// held from outside and a large one through its hole, legs and fins left alone, ...?
//
// Answered by one row per case and seed: `satisfied` says whether the best grasp of the case's own
// mode meets all predicates of the case, which a program decides; its share over the seeds is the
// case's result. Where a case has several modes, all are planned and their best M reported.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "cells/case_predicate.hpp"
#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace special_cases_parts {
namespace {

constexpr std::array kModes = {"pinch", "grip", "power"};

std::vector<sweep::Column> own_settings() {
  return {{"mode", "", "pinch, grip or power: the mode of `modes` that the paper has"},
          {"modes", "", "object: mode -> settings that it adds; without it there is one mode"},
          {"predicates", "", "array of {name, parameters}: all must hold"},
          {"paper", "", "what the paper shows, for people"}};
}

/// A case: what to plan and what to ask of the best grasp.
struct Case {
  std::vector<std::pair<std::string, PlanningSettings>> modes;  ///< One without name, or several.
  std::string mode;                                             ///< The one that is judged.
  std::vector<CasePredicate> predicates;
};

std::vector<std::pair<std::string, PlanningSettings>> read_modes(const sweep::Cell& cell,
                                                                 const nlohmann::json& json) {
  if (!json.contains("modes")) return {{"", planning_settings(cell, own_settings())}};
  std::vector<std::pair<std::string, PlanningSettings>> modes;
  const base::JsonValue value = sweep::setting(cell, "modes");
  value.require_members({}, {kModes.begin(), kModes.end()});
  for (const auto& [name, added] : value.json().items()) {
    if (!added.is_object()) value.at(name).refuse("must be an object of settings");
    nlohmann::json merged = json;
    merged.update(added);
    try {
      modes.emplace_back(name, planning_settings(merged.dump(), cell.seed, own_settings()));
    } catch (const sweep::SettingError& error) {
      throw sweep::SettingError(
          added.contains(error.key()) ? "modes/" + name + '/' + error.key() : error.key(),
          error.what());
    }
  }
  if (modes.empty()) value.refuse("must have at least one mode");
  return modes;
}

Case read_case(const sweep::Cell& cell) {
  const nlohmann::json json = nlohmann::json::parse(cell.settings);
  Case read;
  read.modes = read_modes(cell, json);
  if (json.contains("mode") != json.contains("modes")) {
    throw sweep::SettingError("", "mode and modes belong together");
  }
  if (const auto mode = sweep::find_setting(cell, "mode")) {
    read.mode = mode->name();
    const bool is_planned = std::any_of(read.modes.begin(), read.modes.end(),
                                        [&](const auto& m) { return m.first == read.mode; });
    if (!is_planned) mode->refuse("must be one of the modes");
  }
  for (const base::JsonValue& item : sweep::setting(cell, "predicates").some_items()) {
    read.predicates.push_back(read_predicate(item));
  }
  return read;
}

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"satisfied", "", "whether the best grasp meets all predicates; false without a grasp"},
      {"satisfying_grasps", "1", "of the grasps returned, how many do"}};
  for (const char* const mode : kModes) {
    all.push_back({std::string("best_m_") + mode, "1",
                   std::string("best M of the mode ") + mode + ", where the case has modes"});
  }
  all.push_back({"mode_failures", "", "modes that cannot be planned, and why"});
  all.push_back({"best_contacts", "", "parts that touch in the best grasp, with gaps in mm"});
  for (sweep::Column& column : planning_columns()) all.push_back(std::move(column));
  return all;
}

/// "index 0.02; palm 0.51": every contact's part and gap in millimeters.
std::string contacts_text(const grasp::Grasp& grasp, const hands::HandModel& hand) {
  constexpr double kHundredthsOfMillimeter = 1e5;
  std::string text;
  for (const contact::Contact& contact : grasp.contacts) {
    text += (text.empty() ? "" : "; ") + hand.part_name(contact.finger) + ' ' +
            sweep::csv_field(std::round(contact.gap * kHundredthsOfMillimeter) / 100.0);
  }
  return text;
}

PredicateObject predicate_object(const Planned& planned) {
  return {planned.object.query.box(), planned.object.mass.center_of_mass};
}

/// Tests which of the grasps found meet the predicates.
void judge(const Case& read, const Planned& planned, const std::map<std::string, double>& best_m,
           sweep::ResultRow& row) {
  const std::vector<grasp::Grasp>& grasps = planned.result.grasps;
  const PredicateObject object = predicate_object(planned);
  std::vector<bool> meets;
  for (const grasp::Grasp& grasp : grasps) {
    const JudgedGrasp judged{grasp, *planned.hand, object, best_m};
    meets.push_back(std::all_of(read.predicates.begin(), read.predicates.end(),
                                [&](const CasePredicate& predicate) { return predicate(judged); }));
  }
  row.set("satisfying_grasps",
          static_cast<std::int64_t>(std::count(meets.begin(), meets.end(), true)));
  if (grasps.empty()) return;
  row.set("satisfied", static_cast<bool>(meets.front()));
  row.set("best_contacts", contacts_text(grasps.front(), *planned.hand));
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Case read = read_case(cell);
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(planning_timings())};
  std::map<std::string, double> best_m;
  std::optional<Planned> judged;
  std::string failures;
  for (const auto& [mode, settings] : read.modes) {
    try {
      Planned planned = plan(settings);
      if (!planned.result.grasps.empty() && !mode.empty()) {
        best_m[mode] = planned.result.grasps.front().quality.m;
        result.row.set("best_m_" + mode, best_m[mode]);
      }
      if (mode == read.mode) judged.emplace(std::move(planned));
    } catch (const base::InvalidInput& error) {
      // An object that is too large for one mode does not fail the others; without other modes this
      // is the cell's reason.
      if (mode.empty()) throw;
      failures += (failures.empty() ? "" : "; ") + mode + ": " + error.what();
    }
  }
  result.row.set("mode_failures", failures);
  result.row.set("satisfied", false);
  if (!judged) return result;
  judge(read, *judged, best_m, result.row);
  fill_planning_columns(*judged, result.row);
  fill_planning_timings(*judged, result.timings);
  write_best_grasps(folder, *judged, 1);
  return result;
}

}  // namespace
}  // namespace special_cases_parts

sweep::Experiment special_cases() {
  using namespace special_cases_parts;
  return {.slug = "special_cases",
          .columns = columns(),
          .timings = planning_timings(),
          .settings = own_settings(),
          .check = [](const sweep::Cell& cell) { read_case(cell); },
          .run = run,
          .inputs =
              [](const sweep::Cell& cell) {
                return planning_inputs(read_case(cell).modes.front().second);
              }};
}

}  // namespace graspfit::experiments::internal
