#pragma once

#include <vector>

#include "graspfit/grasp/grasp_metric.hpp"

/// \file
/// One function per source of src/metrics/: a metric, or a few that come from one computation. Each
/// has a line here and one in `grasp_metrics`.

namespace graspfit::grasp::internal {

std::vector<GraspMetric> balance_metrics();
std::vector<GraspMetric> contact_metrics();
std::vector<GraspMetric> contact_quality_metrics();
std::vector<GraspMetric> epsilon_linf_metrics();
std::vector<GraspMetric> grasp_matrix_metrics();
std::vector<GraspMetric> min_weight_metrics();
std::vector<GraspMetric> penetration_metrics();
std::vector<GraspMetric> pose_robustness_metrics();
std::vector<GraspMetric> wrench_space_metrics();

/// The convention of the input's wrench space in words; empty text where there is none.
std::string describe_convention(const GraspMetricInput& input);

}  // namespace graspfit::grasp::internal
