#include "settings/table_settings.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "graspfit/base/units.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments::internal {
namespace {

Eigen::Vector2d place_of(const base::JsonValue& value) {
  const std::vector<base::JsonValue> numbers = value.items();
  if (numbers.size() != 2) value.refuse("must be [x, y] in meters");
  return {numbers[0].number(), numbers[1].number()};
}

Eigen::Vector3d direction_of(const base::JsonValue& value) {
  const Eigen::Vector3d direction = sweep::vector_of(value);
  if (!(direction.norm() > 0.0)) value.refuse("must have a length");
  return direction;
}

RestSettings rest_of(const base::JsonValue& value) {
  value.require_members({}, {"up", "turn_deg", "at_m"});
  RestSettings rest;
  rest.up_O = direction_of(value.at("up"));
  rest.place_W = place_of(value.at("at_m"));
  if (value.has("turn_deg")) rest.turn = value.at("turn_deg").number() * base::kRadiansPerDegree;
  return rest;
}

/// The planner's settings for an object of the table: those of the cell and the object's own.
PlanningSettings object_settings(const sweep::Cell& cell, const nlohmann::json& cell_settings,
                                 const base::JsonValue& value) {
  nlohmann::json merged = cell_settings;
  for (const char* key : {"file", "packaged", "shape", "size_m", "size_axis"}) {
    if (cell_settings.contains(key)) {
      throw sweep::SettingError(key, "must be among those of an object of `objects`");
    }
    if (value.has(key)) merged[key] = nlohmann::json(value.at(key).json());
  }
  try {
    return planning_settings(merged.dump(), cell.seed, table_setting_names());
  } catch (const sweep::SettingError& error) {
    if (value.has(error.key()))
      throw sweep::SettingError(value.location() + '/' + error.key(), error.what());
    throw;
  }
}

}  // namespace

std::vector<sweep::Column> table_setting_names() {
  return {
      {"title", "", "what pictures and pages are headed with"},
      {"objects", "",
       "array of {name, file, packaged or shape, size_m, size_axis, start, goal}; start and goal "
       "are {up: direction of the mesh that is up, of all ways of resting the nearest; turn_deg: "
       "about z; at_m: [x, y] under the center of mass}"},
      {"home", "",
       "{palm_m, direction, turn_deg}: palm center and palm direction in the world, where every "
       "move begins and ends"},
      {"resting_places_m", "m", "array of [x, y] where an object may be put down in between"},
      {"travel_clearance_mm", "mm",
       "kept from everything while hand and object travel; from 0, below pre-grasp-clearance-mm"},
      {"frame_step_mm", "mm",
       "largest motion of any point between two frames that are measured; above 0"},
      {"max_moves", "1", "moves planned at most, failures included; from 1"}};
}

TableSettings table_settings(const sweep::Cell& cell) {
  const nlohmann::json json = nlohmann::json::parse(cell.settings);
  for (const char* key : {"table", "approach"}) {
    if (json.contains(key)) throw sweep::SettingError(key, "is set by the experiment itself");
  }
  if (json.contains("rotation_deg")) {
    throw sweep::SettingError("rotation_deg",
                              "means nothing here: start and goal say how objects lie");
  }
  const auto value = [&](const char* key) { return sweep::setting(cell, key); };
  TableSettings settings;
  settings.title = value("title").name();
  std::set<std::string> names;
  for (const base::JsonValue& item : value("objects").some_items()) {
    item.require_members(
        {}, {"name", "file", "packaged", "shape", "size_m", "size_axis", "start", "goal", "note"});
    const PlanningSettings planning = object_settings(cell, json, item);
    settings.hand = planning.hand;
    settings.tidying.move.planner = planning.options;
    settings.objects.push_back({item.at("name").name(), planning.object, rest_of(item.at("start")),
                                rest_of(item.at("goal"))});
    if (!names.insert(settings.objects.back().name).second) {
      item.at("name").refuse("must differ from those of the other objects");
    }
  }
  const base::JsonValue home = value("home");
  home.require_members({}, {"palm_m", "direction", "turn_deg"});
  settings.home_palm_W = sweep::vector_of(home.at("palm_m"));
  settings.home_direction_W = direction_of(home.at("direction")).normalized();
  if (home.has("turn_deg"))
    settings.home_turn = home.at("turn_deg").number() * base::kRadiansPerDegree;
  settings.frame_step = value("frame_step_mm").positive_number() * base::kMetersPerMillimeter;
  motion::TidyingOptions& tidying = settings.tidying;
  for (const base::JsonValue& resting_place : value("resting_places_m").some_items()) {
    tidying.resting_places_W.push_back(place_of(resting_place));
  }
  tidying.move.clearance = value("travel_clearance_mm").number() * base::kMetersPerMillimeter;
  const double kept = tidying.move.planner.pre_grasp.clearance / base::kMetersPerMillimeter;
  const base::NumberRange clearances{.least = 0, .most = kept, .has_most = false};
  if (!clearances.contains(value("travel_clearance_mm").number())) {
    value("travel_clearance_mm")
        .refuse("must be " + clearances.text() + ", below pre-grasp-clearance-mm");
  }
  const grasp::PlannerOptions& planner = tidying.move.planner;
  if (planner.acceptance != grasp::Acceptance::Valid) {
    throw sweep::SettingError("accept", "must be valid: objects are moved by valid grasps");
  }
  if (!planner.pre_grasps) {
    throw sweep::SettingError("pre-grasps", "must be true: objects are approached from pre-grasps");
  }
  tidying.move.cache = {.is_on = true};
  tidying.max_moves_tried = value("max_moves").small_integer();
  if (tidying.max_moves_tried < 1) value("max_moves").refuse("must be >= 1");
  tidying.validate();
  return settings;
}

hands::HandConfiguration home_of(const TableSettings& settings, const hands::HandModel& hand) {
  hands::HandConfiguration home = hands::open_configuration(hand);
  home.X_OH.linear() =
      (Eigen::AngleAxisd(settings.home_turn, settings.home_direction_W) *
       Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, settings.home_direction_W))
          .toRotationMatrix();
  home.X_OH.translation() = settings.home_palm_W - home.X_OH.linear() * hand.palm.center_H;
  return home;
}

std::vector<std::filesystem::path> table_inputs(const TableSettings& settings) {
  std::vector<std::filesystem::path> files;
  for (const TableObject& object : settings.objects) {
    PlanningSettings planning;
    planning.object = object.object;
    planning.hand = settings.hand;
    for (std::filesystem::path& file : planning_inputs(planning)) files.push_back(std::move(file));
  }
  return files;
}

}  // namespace graspfit::experiments::internal
