// An option whose field and row were added, and nothing else: it has a flag with help, a key and a
// schema in grasp files, and a range that is checked.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/planner_option_table.hpp"

using namespace graspfit::grasp;

namespace {

const PlannerOption* option_named(const std::string& name) {
  for (const PlannerOption& option : planner_option_table()) {
    if (option.name == name) return &option;
  }
  return nullptr;
}

std::string refusal(const PlannerOptions& options) {
  try {
    options.validate();
  } catch (const graspfit::base::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

bool is_equal(const char* what, const std::string& found, const std::string& expected) {
  std::printf("%-8s %s\n", what, found.c_str());
  if (found == expected) return true;
  std::printf("         expected: %s\n", expected.c_str());
  return false;
}

}  // namespace

int main() {
  const PlannerOption* const option = option_named("example-margin-mm");
  if (option == nullptr) {
    std::puts("no option has the name of the new row");
    return 1;
  }
  bool is_right = is_equal("default", option->fallback + ' ' + std::string(option->unit), "2 mm");
  is_right &= is_equal("range", option->range.text(), "> 0");
  is_right &= is_equal("in files", option->path, "example_margin_m");
  is_right &= is_equal("meaning", std::string(option->meaning) + option->source_text(),
                       "margin of the example [R]");

  const std::string file = with_option_schema(R"({"$defs": {"options": {}}})", "schema");
  const auto schema = nlohmann::json::parse(file);
  is_right &=
      is_equal("schema", schema["$defs"]["options"]["properties"]["example_margin_m"].dump(),
               R"({"description":"margin of the example","exclusiveMinimum":0,"type":"number"})");

  PlannerOptions options;
  set_option(options, *option, 3.0);
  is_right &= options.example_margin == 0.003;
  is_right &= is_equal("3 mm", refusal(options), "accepted");
  set_option(options, *option, 0.0);
  is_right &=
      is_equal("0 mm", refusal(options), "PlannerOptions: example_margin_m = 0, must be > 0");
  return is_right ? 0 : 1;
}
