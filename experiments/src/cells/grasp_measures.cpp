#include "cells/grasp_measures.hpp"

#include <chrono>
#include <string_view>

#include "graspfit/grasp/grasp_metric.hpp"

namespace graspfit::experiments::internal {
namespace {

// Pose robustness takes a hundred wrench spaces, half a second, per grasp; `graspfit evaluate` has
// it for single grasps.
constexpr std::string_view kLeftOut = "pose robustness";

/// The library's metrics but those that take too long for thousands of grasps.
std::vector<const grasp::GraspMetric*> table_metrics() {
  std::vector<const grasp::GraspMetric*> metrics;
  for (const grasp::GraspMetric& metric : grasp::grasp_metrics().all()) {
    if (metric.group != kLeftOut) metrics.push_back(&metric);
  }
  return metrics;
}

}  // namespace

std::vector<sweep::Column> grasp_measure_columns() {
  std::vector<sweep::Column> columns;
  for (const grasp::GraspMetric* metric : table_metrics()) {
    columns.push_back({metric->name, metric->unit, metric->meaning});
  }
  return columns;
}

GraspMeasures measures_of(const Planned& planned, const grasp::Grasp& grasp, double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  const grasp::GraspMetricInput input(
      grasp::metric_facts(planned.object, *planned.hand, planned.settings.options, grasp));
  GraspMeasures values;
  for (const grasp::GraspMetric* metric : table_metrics()) {
    values[metric->name] = metric->value(input);
  }
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return values;
}

std::vector<std::string> correlated_measures() {
  return {"m", "m1", "m2", "m3", "epsilon", "volume", "min_weight"};
}

}  // namespace graspfit::experiments::internal
