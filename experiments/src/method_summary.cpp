#include "internal/method_summary.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "internal/method_table.hpp"
#include "internal/paper_table1.hpp"
#include "internal/planning_table.hpp"
#include "internal/prediction_statistics.hpp"

namespace graspfit::experiments::internal {
namespace {

/// Methods in the paper's order, with the names of their columns.
constexpr std::pair<const char*, const char*> kMethods[] = {
    {"gs", "gs"}, {"ma", "ma"}, {"ma-full-retreat", "ma_full_retreat"}, {"fitting", "fitting"}};
constexpr const char* kAll = "all";

std::optional<std::size_t> axis_of(const ParameterSweep& sweep, const std::string& name) {
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (sweep.axes[a].name == name) return a;
  }
  return std::nullopt;
}

std::string label_of(const FinishedCell& cell, const std::optional<std::size_t>& axis) {
  return axis ? cell.labels[*axis] : "";
}

std::size_t column_of(const std::vector<Column>& details, const std::string& name) {
  const auto found = std::find_if(details.begin(), details.end(),
                                  [&](const Column& column) { return column.name == name; });
  return static_cast<std::size_t>(found - details.begin());
}

std::vector<double> numbers_of(const FinishedCell& cell, std::size_t column) {
  std::vector<double> values;
  for (const std::vector<std::string>& row : cell.details) {
    if (const auto value = csv_number(row[column])) values.push_back(*value);
  }
  return values;
}

}  // namespace

std::vector<Column> paper_layout_columns(const MethodTableAxes& axes) {
  std::vector<Column> columns = {
      {"object", "", "label of the object"},
      {axes.row, "", "label of its " + axes.row + "; empty where there is one only"}};
  for (const auto& [method, name] : kMethods) {
    const std::string prefix = name;
    const std::string of = std::string(" of planner ") + method;
    columns.push_back({prefix + "_grasps", "1", "grasps" + of});
    columns.push_back({prefix + "_mean_m", "1", "mean M of these"});
    columns.push_back({prefix + "_sd_m", "1", "standard deviation of M of these"});
    columns.push_back({prefix + "_median_m", "1", "median M of these"});
    columns.push_back({prefix + "_paper_m", "1", "mean M in the paper's Table 1"});
    columns.push_back({prefix + "_paper_time_s", "s", "its time per grasp"});
  }
  columns.push_back({"fitting_above_ma", "", "fitting has the larger mean M, as in the paper"});
  columns.push_back({"ma_above_gs", "", "ma has the larger mean M, as in the paper"});
  columns.push_back({"fitting_above_ma_full_retreat", "", "the same with full retreat"});
  columns.push_back({"ma_full_retreat_above_gs", "", "the same with full retreat"});
  columns.push_back({"fitting_above_gs", "", "fitting has the larger mean M, as in the paper"});
  return columns;
}

std::vector<ResultRow> paper_layout(const std::vector<Column>& details, const ParameterSweep& sweep,
                                    const std::vector<FinishedCell>& cells,
                                    const MethodTableAxes& axes) {
  const auto object_axis = axis_of(sweep, kObjectAxis);
  const auto row_axis = axis_of(sweep, axes.row);
  const auto method_axis = axis_of(sweep, kMethodAxis);
  const std::size_t m_at = column_of(details, "m");
  std::vector<std::pair<std::string, std::string>> order;  // of rows, as in the sweep
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::vector<double>>> found;
  for (const FinishedCell& cell : cells) {
    const std::pair key(label_of(cell, object_axis), label_of(cell, row_axis));
    if (!found.contains(key)) order.push_back(key);
    std::vector<double>& ms = found[key][label_of(cell, method_axis)];
    const std::vector<double> more = numbers_of(cell, m_at);
    ms.insert(ms.end(), more.begin(), more.end());
  }
  std::vector<ResultRow> rows;
  for (const auto& key : order) {
    ResultRow row(paper_layout_columns(axes));
    row.set("object", key.first);
    row.set(axes.row, key.second);
    std::map<std::string, double> means;
    for (const auto& [method, name] : kMethods) {
      const std::string prefix = name;
      if (const auto paper = paper_table1(key.first, method)) {
        row.set(prefix + "_paper_m", paper->quality);
        row.set(prefix + "_paper_time_s", paper->time_s);
      }
      const auto ms = found[key].find(method);
      if (ms == found[key].end()) continue;
      row.set(prefix + "_grasps", field(ms->second.size()));
      row.set(prefix + "_mean_m", field(mean(ms->second)));
      row.set(prefix + "_sd_m", field(standard_deviation(ms->second)));
      row.set(prefix + "_median_m", field(median(ms->second)));
      if (const auto m = mean(ms->second)) means[name] = *m;
    }
    const auto compare = [&](const char* column, const char* larger, const char* smaller) {
      if (means.contains(larger) && means.contains(smaller)) {
        row.set(column, means[larger] > means[smaller]);
      }
    };
    compare("fitting_above_ma", "fitting", "ma");
    compare("ma_above_gs", "ma", "gs");
    compare("fitting_above_ma_full_retreat", "fitting", "ma_full_retreat");
    compare("ma_full_retreat_above_gs", "ma_full_retreat", "gs");
    compare("fitting_above_gs", "fitting", "gs");
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Column> correlation_columns(const MethodTableAxes& axes) {
  return {{axes.group, "", "of whose grasps, or all"},
          {"measure", "", "one measure"},
          {"other", "", "the other one"},
          {"scope", "", "all: all grasps are compared; cell: only those of one cell"},
          {"spearman", "1", "rank correlation; empty where it is not defined: all equal"},
          {"low", "1", "of the 95 % interval, from 1000 draws of cells with replacement"},
          {"high", "1", "of the same"},
          {"grasps", "1", "with both numbers"}};
}

std::vector<ResultRow> correlations(const std::vector<std::string>& measures,
                                    const std::vector<Column>& details, const ParameterSweep& sweep,
                                    const std::vector<FinishedCell>& cells,
                                    const MethodTableAxes& axes) {
  const auto group_axis = axis_of(sweep, axes.group);
  std::vector<std::string> groups = {kAll};
  if (group_axis) {
    for (const AxisValue& value : sweep.axes[*group_axis].values) groups.push_back(value.label);
  }
  std::vector<ResultRow> rows;
  for (const std::string& group : groups) {
    for (std::size_t i = 0; i < measures.size(); ++i) {
      for (std::size_t j = i + 1; j < measures.size(); ++j) {
        const std::size_t a = column_of(details, measures[i]);
        const std::size_t b = column_of(details, measures[j]);
        std::vector<ScoredOutcomes> clusters;
        std::size_t count = 0;
        for (const FinishedCell& cell : cells) {
          if (group != kAll && label_of(cell, group_axis) != group) continue;
          ScoredOutcomes cluster;
          for (const std::vector<std::string>& row : cell.details) {
            const auto x = csv_number(row[a]);
            const auto y = csv_number(row[b]);
            if (!x || !y) continue;
            cluster.scores.push_back(*x);
            cluster.outcomes.push_back(*y);
          }
          count += cluster.scores.size();
          if (!cluster.scores.empty()) clusters.push_back(std::move(cluster));
        }
        for (const StatisticScope scope : {StatisticScope::All, StatisticScope::WithinClusters}) {
          const Estimate found =
              estimate(clusters, RankStatistic::Spearman, scope, {.seed = sweep.base_seed});
          ResultRow row(correlation_columns(axes));
          row.set(axes.group, group);
          row.set("measure", measures[i]);
          row.set("other", measures[j]);
          row.set("scope", scope == StatisticScope::All ? "all" : "cell");
          row.set("spearman", field(found.value));
          if (found.interval) {
            row.set("low", found.interval->low);
            row.set("high", found.interval->high);
          }
          row.set("grasps", field(count));
          rows.push_back(std::move(row));
        }
      }
    }
  }
  return rows;
}

}  // namespace graspfit::experiments::internal
