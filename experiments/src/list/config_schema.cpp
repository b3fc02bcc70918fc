#include <nlohmann/json.hpp>

#include "graspfit/experiments/experiment_registry.hpp"
#include "settings/planning_setting_schemas.hpp"

namespace graspfit::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json reference(const std::string& definition) { return {{"$ref", "#/$defs/" + definition}}; }

/// The settings of the planner and those of single experiments, about which only the experiment
/// itself knows more than their names.
Json known_settings() {
  Json properties = internal::planning_setting_schemas();
  for (const sweep::Experiment& experiment : all_experiments()) {
    for (const sweep::Column& setting : experiment.settings) {
      properties[setting.name] = {{"description", setting.meaning + " (" + experiment.slug + ')'}};
    }
  }
  return {{"type", "object"}, {"properties", properties}};
}

/// A value of an axis; a plain one as `plain` says.
Json axis_of(const Json& plain) {
  return {{"type", "array"},
          {"minItems", 1},
          {"items", {{"anyOf", {plain, reference("named_value"), reference("values_of")}}}}};
}

Json axes() {
  Json properties;
  for (const auto& [name, schema] : internal::planning_setting_schemas().items()) {
    properties[name] = axis_of(reference("known_settings/properties/" + name));
  }
  return {{"description", "name -> values, the first axis slowest"},
          {"type", "object"},
          {"minProperties", 1},
          {"propertyNames", {{"allOf", {reference("label"), {{"not", {{"const", "seed"}}}}}}}},
          {"properties", properties},
          {"additionalProperties", axis_of({{"type", {"number", "string", "boolean"}}})}};
}

Json definitions() {
  const Json text = {{"type", "string"}, {"minLength", 1}};
  Json labels = {
      {"type", "array"}, {"minItems", 1}, {"items", {{"type", {"number", "string", "boolean"}}}}};
  return {{"label",
           {{"type", "string"}, {"pattern", "^[A-Za-z0-9_.+-]*[A-Za-z0-9_+-][A-Za-z0-9_.+-]*$"}}},
          {"labels", labels},
          {"seeds", {{"type", "integer"}, {"minimum", 1}, {"maximum", 100000}}},
          {"known_settings", known_settings()},
          {"settings", {{"$ref", "#/$defs/known_settings"}, {"unevaluatedProperties", false}}},
          {"named_value",
           {{"$ref", "#/$defs/known_settings"},
            {"required", Json::array({"name"})},
            {"properties", {{"name", reference("label")}, {"note", text}}},
            {"unevaluatedProperties", false}}},
          {"values_of",
           {{"type", "object"},
            {"required", Json::array({"values_of"})},
            {"properties", {{"values_of", reference("label")}, {"only", reference("labels")}}},
            {"additionalProperties", false}}}};
}

}  // namespace

std::string config_schema() {
  Json slugs = Json::array();
  for (const sweep::Experiment& experiment : all_experiments()) slugs.push_back(experiment.slug);
  const Json text = {{"type", "string"}, {"minLength", 1}};
  const Json picks = {
      {"type", "array"},
      {"minItems", 1},
      {"items",
       {{"anyOf", {{{"type", {"number", "string", "boolean"}}}, reference("named_value")}}}}};
  const Json quick = {{"type", "object"},
                      {"properties",
                       {{"axes", {{"type", "object"}, {"additionalProperties", picks}}},
                        {"settings", reference("settings")},
                        {"seeds", reference("seeds")}}},
                      {"additionalProperties", false}};
  const Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                       {"title", "Configuration of a graspfit experiment"},
                       {"description", "Written by graspfit experiment schema"},
                       {"type", "object"},
                       {"required", {"experiment", "question", "cell", "seed", "axes"}},
                       {"properties",
                        {{"experiment", {{"enum", slugs}}},
                         {"question", text},
                         {"cell", text},
                         {"seed", {{"type", "integer"}, {"minimum", 0}}},
                         {"seeds", reference("seeds")},
                         {"settings", reference("settings")},
                         {"axes", axes()},
                         {"quick", quick}}},
                       {"additionalProperties", false},
                       {"$defs", definitions()}};
  return schema.dump(2) + '\n';
}

}  // namespace graspfit::experiments
