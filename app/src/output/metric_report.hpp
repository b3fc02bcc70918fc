#pragma once

#include <string>
#include <vector>

#include "graspfit/grasp/grasp_metric.hpp"

namespace graspfit::app {

/// The metrics of the grasps of a file.
class MetricReport {
 public:
  explicit MetricReport(grasp::GraspMetrics metrics) : metrics_(std::move(metrics)) {}

  bool is_empty() const { return metrics_.all().empty(); }

  /// Evaluates all metrics for the next grasp.
  void add(const grasp::GraspMetricInput& input);

  /// One table per group, a row per grasp, and the conventions of its metrics.
  std::string tables() const;
  /// A row per grasp and metric: grasp, metric, value, unit, better, convention.
  std::string csv() const;
  /// {"epsilon": {"value": ..., "unit": ..., "better": ..., "convention": ...}, ...} of one grasp;
  /// value null where the metric is not defined.
  std::string json(std::size_t grasp) const;

 private:
  std::string group_table(std::size_t first, std::size_t last) const;

  grasp::GraspMetrics metrics_;
  std::vector<std::vector<grasp::GraspMetricValue>> values_;  ///< Per grasp, per metric.
};

/// Names, units and meanings of all metrics, under their groups, for --help.
std::string metrics_help();

}  // namespace graspfit::app
