// Question: do the paper's measure M, its parts, and the wrench-space measures epsilon, volume and
// min-weight tell grasps that hold in a physics engine from those that do not, and those with a
// large margin from those with a small one?
//
// Answered by the summary: per grip and for all together, for every measure the area under the ROC
// curve against held (0.5: no better than chance) and Spearman's rank correlation with the margins
// (0: none), with 95 % bootstrap intervals over cells; among all grasps, and among grasps of one
// hand on one object only, where a measure cannot profit from telling objects apart.
#include <algorithm>

#include "cells/grasp_measures.hpp"
#include "cells/hold_cell.hpp"
#include "cells/prediction_statistics.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace hold_prediction_parts {
namespace {

std::vector<sweep::Column> summary_columns() {
  return {{"grip", "", "hand and style, or all"},
          {"target", "", "what is to be predicted: a protocol's held, or a margin"},
          {"measure", "", "what predicts it"},
          {"scope", "", "all: all grasps are compared; cell: only those of one hand and object"},
          {"statistic", "", "auc, the area under the ROC curve, or spearman, the rank correlation"},
          {"value", "1", "empty where it is not defined: all equal"},
          {"low", "1", "of the 95 % interval, from 1000 draws of cells with replacement"},
          {"high", "1", "of the same"},
          {"grasps", "1", "with both numbers"},
          {"held", "1", "of these, for the targets that are held"},
          {"cells", "1", "with grasps"}};
}

/// What is predicted, by which column of the details.
struct Target {
  std::string name;
  std::string column;
  RankStatistic statistic;
};

std::vector<Target> targets() {
  std::vector<Target> all;
  for (const TestedProtocol& protocol : kTestedProtocols) {
    const std::string prefix = protocol.prefix;
    all.push_back({prefix + "held", prefix + kStageColumn, RankStatistic::Auc});
  }
  for (const char* const margin : kMarginColumns) {
    all.push_back({margin, margin, RankStatistic::Spearman});
  }
  return all;
}

std::optional<double> outcome(const std::string& field, RankStatistic statistic) {
  if (statistic == RankStatistic::Spearman) return sweep::csv_number(field);
  if (field.empty()) return std::nullopt;
  return field == kHeldStage ? 1.0 : 0.0;
}

/// One cluster per cell that has grasps with both numbers.
std::vector<ScoredOutcomes> clusters_of(const std::vector<const sweep::FinishedCell*>& cells,
                                        const std::vector<sweep::Column>& details,
                                        const std::string& measure, const Target& target) {
  const std::size_t score_at = column_index(details, measure);
  const std::size_t outcome_at = column_index(details, target.column);
  std::vector<ScoredOutcomes> clusters;
  for (const sweep::FinishedCell* cell : cells) {
    ScoredOutcomes cluster;
    for (const std::vector<std::string>& row : cell->details) {
      const std::optional<double> score = sweep::csv_number(row[score_at]);
      const std::optional<double> value = outcome(row[outcome_at], target.statistic);
      if (!score || !value) continue;
      cluster.scores.push_back(*score);
      cluster.outcomes.push_back(*value);
    }
    if (!cluster.scores.empty()) clusters.push_back(std::move(cluster));
  }
  return clusters;
}

sweep::ResultRow summary_row(const std::string& group, const Target& target,
                             const std::string& measure, StatisticScope scope,
                             const std::vector<ScoredOutcomes>& clusters, std::uint64_t seed) {
  std::int64_t grasps = 0;
  std::int64_t held = 0;
  for (const ScoredOutcomes& cluster : clusters) {
    grasps += static_cast<std::int64_t>(cluster.scores.size());
    held += std::count(cluster.outcomes.begin(), cluster.outcomes.end(), 1.0);
  }
  const Estimate found = estimate(clusters, target.statistic, scope, {.seed = seed});
  const bool is_auc = target.statistic == RankStatistic::Auc;
  sweep::ResultRow row(summary_columns());
  row.set("grip", group);
  row.set("target", target.name);
  row.set("measure", measure);
  row.set("scope", scope == StatisticScope::All ? "all" : "cell");
  row.set("statistic", is_auc ? "auc" : "spearman");
  if (found.value) row.set("value", *found.value);
  if (found.interval) {
    row.set("low", found.interval->low);
    row.set("high", found.interval->high);
  }
  row.set("grasps", grasps);
  if (is_auc) row.set("held", held);
  row.set("cells", static_cast<std::int64_t>(clusters.size()));
  return row;
}

std::vector<sweep::ResultRow> summarize(const std::vector<sweep::Column>& details,
                                        const sweep::ParameterSweep& sweep,
                                        const std::vector<sweep::FinishedCell>& cells) {
  std::vector<sweep::ResultRow> rows;
  for (const auto& [group, members] : cells_by_grip(sweep, cells)) {
    for (const Target& target : targets()) {
      for (const std::string& measure : correlated_measures()) {
        const std::vector<ScoredOutcomes> clusters = clusters_of(members, details, measure, target);
        for (const StatisticScope scope : {StatisticScope::All, StatisticScope::WithinClusters}) {
          rows.push_back(summary_row(group, target, measure, scope, clusters, sweep.base_seed));
        }
      }
    }
  }
  return rows;
}

}  // namespace
}  // namespace hold_prediction_parts

sweep::Experiment hold_prediction() {
  using namespace hold_prediction_parts;
  sweep::Experiment experiment = hold_experiment("hold_prediction");
  experiment.summaries.push_back(
      {"summary", summary_columns(),
       [details = experiment.details](const sweep::ParameterSweep& sweep,
                                      const std::vector<sweep::FinishedCell>& cells) {
         return summarize(details, sweep, cells);
       }});
  return experiment;
}

}  // namespace graspfit::experiments::internal
