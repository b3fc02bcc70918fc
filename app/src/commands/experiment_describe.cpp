#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands/experiment_commands.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/planner_presets.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/sweep/data_needs.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

using sweep::Column;
using sweep::Experiment;
using sweep::ExperimentConfig;
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

/// A value as text: "barrett", "0.5", "[1, 2]"; "given" if it is nested further.
std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_primitive()) return value.dump();
  const bool is_flat = value.is_array() && std::all_of(value.begin(), value.end(), [](auto& item) {
                         return item.is_primitive();
                       });
  if (!is_flat) return "given";
  return '[' + base::list_text(value, value_text) + ']';
}

/// The value of the setting `name` among `settings`: its own value, or that of a preset among them.
std::optional<std::string> value_among(const Json& settings, const std::string& name) {
  if (settings.contains(name)) return value_text(settings.at(name));
  if (!settings.contains("preset")) return std::nullopt;
  const auto* const preset = grasp::preset_named(settings.at("preset").get<std::string>());
  for (const auto& [option, value] : preset->values) {
    if (option == name) return grasp::value_text(value);
  }
  return std::nullopt;
}

/// The value of a setting in the cells of an experiment: "axis resolution" if an axis sets it,
/// directly or by a preset, else the value for all cells, else the planner's; "-" if there is none.
std::string value_in(const ExperimentConfig& config, const std::string& name,
                     const std::string& fallback) {
  for (const sweep::Axis& axis : config.sweep.axes) {
    for (const sweep::AxisValue& value : axis.values) {
      if (value_among(Json::parse(value.settings), name)) return "axis " + axis.name;
    }
  }
  const auto value = value_among(Json::parse(config.sweep.settings), name);
  return value ? *value : fallback.empty() ? "-" : fallback;
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

const char* source_text(sweep::DataSource source) {
  switch (source) {
    case sweep::DataSource::BuiltIn:
      return "built in";
    case sweep::DataSource::Packaged:
      return "libcgal-demo";
    case sweep::DataSource::DataFolder:
      return "data folder";
    case sweep::DataSource::DataFolderOrPackaged:
      return "data folder or libcgal-demo";
    case sweep::DataSource::OwnFile:
      return "your file";
  }
  return "";
}

/// The sources of the data that settings name, each once: "data folder, built in"; empty if they
/// name no data.
std::string sources_text(const std::string& settings) {
  std::vector<std::string> sources;
  for (const sweep::DataNeed& need : sweep::data_needs(settings)) {
    const std::string source = source_text(need.source);
    if (std::find(sources.begin(), sources.end(), source) == sources.end()) {
      sources.push_back(source);
    }
  }
  return base::list_text(sources);
}

/// A table of the data that an experiment needs. It has a row per axis, source of the values' data,
/// and whether the data exist, and rows for the settings of all cells.
std::string data_text(const ExperimentConfig& config) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& where, const std::string& settings,
                       const std::string& label) {
    const std::string sources = sources_text(settings);
    if (sources.empty()) return;
    const std::string there = sweep::has_all_data(settings) ? "there" : "missing";
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& other) {
      return other[0] == where && other[1] == sources && other[2] == there;
    });
    if (row == rows.end()) {
      rows.push_back({where, sources, there, label});
    } else {
      row->back() += ' ' + label;
    }
  };
  for (const sweep::Axis& axis : config.sweep.axes) {
    for (const sweep::AxisValue& value : axis.values) {
      add(axis.name, value.settings, value.label);
    }
  }
  add("all cells", config.sweep.settings, "by the settings of all");
  if (rows.empty()) return "  none\n";
  rows.insert(rows.begin(), {"axis", "from", "now", "values"});
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
  for (const sweep::Axis& axis : config.sweep.axes) {
    std::printf("  %s:", axis.name.c_str());
    for (const sweep::AxisValue& value : axis.values) {
      std::printf(" %s", value.label.c_str());
    }
    std::printf("\n");
  }
  std::printf("  settings of all: %s\n", config.sweep.settings.c_str());
  std::printf("\nData, the data folder being %s:\n%s", sweep::data_folder().c_str(),
              data_text(config).c_str());
  if (const ExperimentConfig to_run = load_config_to_run(experiment, call->flags);
      !to_run.left_out.empty()) {
    std::printf("  a run here, without that folder: %s\n", to_run.left_out.c_str());
  }
  std::printf("\nColumns of %s.csv after the axes, cell_seed, status and reason:\n%s",
              experiment.slug.c_str(), columns_text(experiment.columns).c_str());
  std::printf("\nColumns of %s.timing.csv after the axes, wall_s and cpu_s:\n%s",
              experiment.slug.c_str(), columns_text(experiment.timings).c_str());
  if (!experiment.details.empty()) {
    std::printf("\nColumns of %s.details.csv after the axes:\n%s", experiment.slug.c_str(),
                columns_text(experiment.details).c_str());
  }
  for (const sweep::SummaryTable& summary : experiment.summaries) {
    std::printf("\nColumns of %s.%s.csv:\n%s", experiment.slug.c_str(), summary.name.c_str(),
                columns_text(summary.columns).c_str());
  }
  std::printf("\nSettings, each of which can be an axis:\n%s",
              settings_text(experiment, config).c_str());
  return kSuccess;
}

}  // namespace graspfit::app
