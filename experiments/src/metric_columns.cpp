#include "internal/metric_columns.hpp"

namespace graspfit::experiments::internal {

Column metric_column(const grasp::GraspMetric& metric) {
  return {metric.unit == "1" ? metric.name : metric.name + "_" + metric.unit, metric.unit,
          metric.meaning};
}

std::vector<Column> metric_columns(const grasp::GraspMetrics& metrics) {
  std::vector<Column> columns;
  for (const grasp::GraspMetric& metric : metrics.all()) columns.push_back(metric_column(metric));
  return columns;
}

void fill_metric_columns(const grasp::GraspMetrics& metrics, const grasp::GraspMetricInput& input,
                         ResultRow& row) {
  for (const grasp::GraspMetric& metric : metrics.all()) {
    const std::optional<double> value = metric.value(input);
    if (value) row.set(metric_column(metric).name, *value);
  }
}

}  // namespace graspfit::experiments::internal
