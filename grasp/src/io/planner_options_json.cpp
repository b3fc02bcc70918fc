#include "io/planner_options_json.hpp"

#include "graspfit/base/errors.hpp"
#include "io/json_fields.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp::internal {

Json planner_options_json(const PlannerOptions& options) {
  Json json = Json::object();
  JsonWriter writer(json);
  planner_rows(writer, options);
  return json;
}

PlannerOptions read_planner_options(const JsonNode& node, std::uint64_t seed) {
  PlannerOptions options;
  const JsonReader reader(node);
  planner_rows(reader, options);
  options.seed = seed;
  try {
    options.validate();
  } catch (const base::InvalidInput& error) {
    node.fail(error.what());
  }
  return options;
}

}  // namespace graspfit::grasp::internal
