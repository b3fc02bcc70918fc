#include "cells/method_summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "cells/method_table.hpp"
#include "cells/paper_table1.hpp"
#include "cells/planning_table.hpp"
#include "cells/prediction_statistics.hpp"

namespace graspfit::experiments::internal {
namespace {

/// The baselines that a method may be above, with the names of the columns that say so.
constexpr std::pair<const char*, const char*> kBaselines[] = {
    {"gs-targets", "above_gs_targets"},
    {"gs", "above_gs"},
    {"ma", "above_ma"},
    {"ma-full-retreat", "above_ma_full_retreat"}};
constexpr const char* kAll = "all";

std::optional<std::size_t> axis_of(const sweep::ParameterSweep& sweep, const std::string& name) {
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (sweep.axes[a].name == name) return a;
  }
  return std::nullopt;
}

std::string label_of(const sweep::FinishedCell& cell, const std::optional<std::size_t>& axis) {
  return axis ? cell.labels[*axis] : "";
}

std::size_t column_of(const std::vector<sweep::Column>& details, const std::string& name) {
  const auto found = std::find_if(details.begin(), details.end(),
                                  [&](const sweep::Column& column) { return column.name == name; });
  return static_cast<std::size_t>(found - details.begin());
}

std::vector<double> numbers_of(const sweep::FinishedCell& cell, std::size_t column) {
  std::vector<double> values;
  for (const std::vector<std::string>& row : cell.details) {
    if (const auto value = sweep::csv_number(row[column])) values.push_back(*value);
  }
  return values;
}

}  // namespace

std::vector<sweep::Column> paper_layout_columns(const MethodTableAxes& axes) {
  std::vector<sweep::Column> columns = {
      {"object", "", "label of the object"},
      {axes.row, "", "label of its " + axes.row + "; empty where there is one only"},
      {"planner", "", "label of the method"},
      {"hand", "", "name of the hand"},
      {"grasps", "1", "with M > 0, of all cells of this row"},
      {"attempts", "1", "for these"},
      {"mean_m", "1", "mean M of the grasps"},
      {"se_m", "1", "its standard error: standard deviation over the root of their number"},
      {"sd_m", "1", "standard deviation of M"},
      {"median_m", "1", "median M"},
      {"m_per_attempt", "1", "mean M per attempt, 0 for those without a grasp"},
      {"rejected_rate", "1", "attempts rejected for their deviation or their M, over attempts"},
      {"paper_m", "1", "mean M in the paper's Table 1"},
      {"m_over_paper", "1", "mean M over the paper's"},
      {"paper_time_s", "s", "its time per grasp"},
      {"target_distance_m", "m", "mean distance of contacts from their targets"},
      {"area_share_median", "1",
       "median over the grasps of that over contacts of A over the pad's"},
      {"gap_median_m", "m", "median over the grasps of that over contacts of the gap"},
      {"overlap_mean_m", "m", "mean over the grasps of the deepest overlap"},
      {"overlap_max_m", "m", "largest"}};
  for (const auto& [method, column] : kBaselines) {
    columns.push_back({column, "", std::string("the mean M is above that of ") + method});
  }
  return columns;
}

namespace {

/// Results of the cells of one method on one object and row, taken together.
struct MethodCells {
  std::string hand;
  double attempts = 0.0;
  double rejected = 0.0;
  std::map<std::string, std::vector<double>> details;

  const std::vector<double>& of(const std::string& name) const { return details.at(name); }
};

/// Details that the layout sums up.
constexpr const char* kSummedDetails[] = {"m", "target_distance_mean", "area_share_median",
                                          "gap_median_m", "deepest_overlap_m"};

void add(const sweep::FinishedCell& cell, const std::vector<sweep::Column>& columns,
         const std::vector<sweep::Column>& details, MethodCells& cells) {
  const auto number = [&](const char* name) {
    return sweep::csv_number(cell.row[column_of(columns, name)]).value_or(0.0);
  };
  cells.hand = cell.row[column_of(columns, "hand")];
  cells.attempts += number("attempts");
  cells.rejected += number("attempts_rejected");
  for (const char* const name : kSummedDetails) {
    const std::vector<double> more = numbers_of(cell, column_of(details, name));
    std::vector<double>& all = cells.details[name];
    all.insert(all.end(), more.begin(), more.end());
  }
}

std::optional<double> over(std::optional<double> value, double divisor) {
  if (!value || !(divisor > 0.0)) return std::nullopt;
  return *value / divisor;
}

void fill_layout_row(const std::string& object, const std::string& method, const MethodCells& cells,
                     sweep::ResultRow& row) {
  const std::vector<double>& ms = cells.of("m");
  const auto count = static_cast<double>(ms.size());
  row.set("hand", cells.hand);
  row.set("grasps", field(ms.size()));
  row.set("attempts", cells.attempts);
  row.set("mean_m", field(mean(ms)));
  row.set("se_m", field(over(standard_deviation(ms), std::sqrt(count))));
  row.set("sd_m", field(standard_deviation(ms)));
  row.set("median_m", field(median(ms)));
  row.set("m_per_attempt", field(over(std::accumulate(ms.begin(), ms.end(), 0.0), cells.attempts)));
  row.set("rejected_rate", field(over(cells.rejected, cells.attempts)));
  row.set("target_distance_m", field(mean(cells.of("target_distance_mean"))));
  row.set("area_share_median", field(median(cells.of("area_share_median"))));
  row.set("gap_median_m", field(median(cells.of("gap_median_m"))));
  row.set("overlap_mean_m", field(mean(cells.of("deepest_overlap_m"))));
  row.set("overlap_max_m", field(largest(cells.of("deepest_overlap_m"))));
  if (const auto paper = paper_table1(object, method)) {
    row.set("paper_m", paper->quality);
    row.set("m_over_paper", field(over(mean(ms), paper->quality)));
    row.set("paper_time_s", paper->time_s);
  }
}

}  // namespace

std::vector<sweep::ResultRow> paper_layout(const std::vector<sweep::Column>& columns,
                                           const std::vector<sweep::Column>& details,
                                           const sweep::ParameterSweep& sweep,
                                           const std::vector<sweep::FinishedCell>& cells,
                                           const MethodTableAxes& axes) {
  const auto object_axis = axis_of(sweep, sweep::kObjectAxis);
  const auto row_axis = axis_of(sweep, axes.row);
  const auto method_axis = axis_of(sweep, kMethodAxis);
  using Key = std::pair<std::string, std::string>;  // object and row
  std::vector<Key> order;                           // as in the sweep
  std::map<Key, std::vector<std::string>> methods;  // as in the sweep
  std::map<Key, std::map<std::string, MethodCells>> found;
  for (const sweep::FinishedCell& cell : cells) {
    const Key key(label_of(cell, object_axis), label_of(cell, row_axis));
    const std::string method = label_of(cell, method_axis);
    if (!found.contains(key)) order.push_back(key);
    if (!found[key].contains(method)) methods[key].push_back(method);
    add(cell, columns, details, found[key][method]);
  }
  std::vector<sweep::ResultRow> rows;
  for (const Key& key : order) {
    for (const std::string& method : methods[key]) {
      sweep::ResultRow row(paper_layout_columns(axes));
      row.set("object", key.first);
      row.set(axes.row, key.second);
      row.set("planner", method);
      const MethodCells& own = found[key][method];
      fill_layout_row(key.first, method, own, row);
      for (const auto& [baseline, column] : kBaselines) {
        const auto other = found[key].find(baseline);
        if (other == found[key].end() || baseline == method) continue;
        const auto mine = mean(own.of("m"));
        const auto others = mean(other->second.of("m"));
        if (mine && others) row.set(column, *mine > *others);
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

std::vector<sweep::Column> correlation_columns(const MethodTableAxes& axes) {
  return {{axes.group, "", "of whose grasps, or all"},
          {"measure", "", "one measure"},
          {"other", "", "the other one"},
          {"scope", "", "all: all grasps are compared; cell: only those of one cell"},
          {"spearman", "1", "rank correlation; empty where it is not defined: all equal"},
          {"low", "1", "of the 95 % interval, from 1000 draws of cells with replacement"},
          {"high", "1", "of the same"},
          {"grasps", "1", "with both numbers"}};
}

std::vector<sweep::ResultRow> correlations(const std::vector<std::string>& measures,
                                           const std::vector<sweep::Column>& details,
                                           const sweep::ParameterSweep& sweep,
                                           const std::vector<sweep::FinishedCell>& cells,
                                           const MethodTableAxes& axes) {
  const auto group_axis = axis_of(sweep, axes.group);
  std::vector<std::string> groups = {kAll};
  if (group_axis) {
    for (const sweep::AxisValue& value : sweep.axes[*group_axis].values)
      groups.push_back(value.label);
  }
  std::vector<sweep::ResultRow> rows;
  for (const std::string& group : groups) {
    for (std::size_t i = 0; i < measures.size(); ++i) {
      for (std::size_t j = i + 1; j < measures.size(); ++j) {
        const std::size_t a = column_of(details, measures[i]);
        const std::size_t b = column_of(details, measures[j]);
        std::vector<ScoredOutcomes> clusters;
        std::size_t count = 0;
        for (const sweep::FinishedCell& cell : cells) {
          if (group != kAll && label_of(cell, group_axis) != group) continue;
          ScoredOutcomes cluster;
          for (const std::vector<std::string>& row : cell.details) {
            const auto x = sweep::csv_number(row[a]);
            const auto y = sweep::csv_number(row[b]);
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
          sweep::ResultRow row(correlation_columns(axes));
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
