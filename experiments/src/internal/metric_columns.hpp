#pragma once

#include <vector>

#include "graspfit/experiments/result_table.hpp"
#include "graspfit/grasp/grasp_metric.hpp"

namespace graspfit::experiments::internal {

/// The column of a metric: its name, with the unit where it has one (`contact_area_m2`).
Column metric_column(const grasp::GraspMetric& metric);

/// One column per metric, in their order.
std::vector<Column> metric_columns(const grasp::GraspMetrics& metrics);

/// Their values for one grasp; fields stay empty where a metric is not defined.
void fill_metric_columns(const grasp::GraspMetrics& metrics, const grasp::GraspMetricInput& input,
                         ResultRow& row);

}  // namespace graspfit::experiments::internal
