#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment_commands.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "text_table.hpp"

namespace graspfit::app {
namespace {

using experiments::Column;
using experiments::Experiment;
using experiments::ExperimentConfig;
using Json = nlohmann::json;

Command describe_command() {
  Command command{"experiment describe", "SLUG",
                  "Shows an experiment's question, axes and columns, and every setting with the "
                  "value that it has\nthere, unit, and values that are allowed.\n",
                  option_group(), ""};
  command.options.add(config_change_options());
  return command;
}

std::string unit_text(const Column& column) { return column.unit.empty() ? "-" : column.unit; }

std::string columns_text(const std::vector<Column>& columns) {
  std::vector<std::vector<std::string>> rows;
  for (const Column& column : columns) {
    rows.push_back({column.name, unit_text(column), column.meaning});
  }
  return indented_table(rows);
}

/// "barrett", "0.5", "[1, 2]"; of what is nested further only that it is there.
std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_primitive()) return value.dump();
  const bool is_flat = value.is_array() && std::all_of(value.begin(), value.end(), [](auto& item) {
                         return item.is_primitive();
                       });
  if (!is_flat) return "given";
  std::string text;
  for (const Json& item : value) text += (text.empty() ? "" : ", ") + value_text(item);
  return '[' + text + ']';
}

/// What a setting is in the cells of an experiment: "axis resolution" where an axis sets it, else
/// the value for all cells, else the planner's; "-" where there is none.
std::string value_in(const ExperimentConfig& config, const std::string& name,
                     const std::string& fallback) {
  for (const experiments::Axis& axis : config.sweep.axes) {
    for (const experiments::AxisValue& value : axis.values) {
      if (Json::parse(value.settings).contains(name)) return "axis " + axis.name;
    }
  }
  const Json settings = Json::parse(config.sweep.settings);
  if (settings.contains(name)) return value_text(settings.at(name));
  return fallback.empty() ? "-" : fallback;
}

std::string settings_text(const Experiment& experiment, const ExperimentConfig& config) {
  std::vector<std::vector<std::string>> rows = {{"name", "default", "unit", "allowed", "meaning"}};
  for (const Column& setting : experiment.settings) {
    rows.push_back({setting.name, value_in(config, setting.name, ""), unit_text(setting),
                    "see meaning", setting.meaning});
  }
  for (const auto& setting : experiments::planning_setting_descriptions()) {
    const std::string& name = setting.name.name;
    rows.push_back({name, value_in(config, name, setting.fallback), unit_text(setting.name),
                    setting.allowed, setting.name.meaning});
  }
  return indented_table(rows);
}

}  // namespace

ExitCode run_experiment_describe(const std::vector<std::string>& arguments) {
  const Command command = describe_command();
  const std::optional<ExperimentCall> call = experiment_call(command, arguments);
  if (!call) return kSuccess;
  const Experiment& experiment = call->experiment;
  const ExperimentConfig config = load_experiment_config(experiment, call->flags);
  std::printf("%s\n\nquestion  %s\ncell      %s\nconfig    %s\n\n%zu cells:\n",
              experiment.slug.c_str(), config.question.c_str(), config.cell.c_str(),
              config.file.c_str(), config.sweep.num_cells());
  for (const experiments::Axis& axis : config.sweep.axes) {
    std::printf("  %s:", axis.name.c_str());
    for (const experiments::AxisValue& value : axis.values) {
      std::printf(" %s", value.label.c_str());
    }
    std::printf("\n");
  }
  std::printf("  settings of all: %s\n", config.sweep.settings.c_str());
  std::printf("\nColumns of %s.csv after the axes, cell_seed, status and reason:\n%s",
              experiment.slug.c_str(), columns_text(experiment.columns).c_str());
  std::printf("\nColumns of %s.timing.csv after the axes, wall_s and cpu_s:\n%s",
              experiment.slug.c_str(), columns_text(experiment.timings).c_str());
  if (!experiment.details.empty()) {
    std::printf("\nColumns of %s.details.csv after the axes:\n%s", experiment.slug.c_str(),
                columns_text(experiment.details).c_str());
  }
  for (const experiments::SummaryTable& summary : experiment.summaries) {
    std::printf("\nColumns of %s.%s.csv:\n%s", experiment.slug.c_str(), summary.name.c_str(),
                columns_text(summary.columns).c_str());
  }
  std::printf("\nSettings, each of which can be an axis:\n%s",
              settings_text(experiment, config).c_str());
  return kSuccess;
}

}  // namespace graspfit::app
