#pragma once

#include <string>
#include <vector>

#include "graspfit/experiments/experiment.hpp"

/// \file
/// Tables over all cells of a comparison of methods, made of its details.

namespace graspfit::experiments::internal {

/// The paper's layout: a row per object and size, mean M of each method beside the paper's, and
/// whether the order of methods is the paper's.
std::vector<Column> paper_layout_columns();
std::vector<ResultRow> paper_layout(const std::vector<Column>& details, const ParameterSweep& sweep,
                                    const std::vector<FinishedCell>& cells);

/// A row per pair of measures, method (or all) and scope: Spearman's rank correlation.
std::vector<Column> correlation_columns();
std::vector<ResultRow> correlations(const std::vector<std::string>& measures,
                                    const std::vector<Column>& details, const ParameterSweep& sweep,
                                    const std::vector<FinishedCell>& cells);

}  // namespace graspfit::experiments::internal
