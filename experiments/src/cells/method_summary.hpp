#pragma once

#include <string>
#include <vector>

#include "graspfit/sweep/experiment.hpp"

/// \file
/// Tables over all cells of a comparison of methods, made of its details.

namespace graspfit::experiments::internal {

/// Axes that tell the rows of a summary apart beside the object, and the correlations' groups.
struct MethodTableAxes {
  std::string row = "size";       ///< In the summary, empty where the sweep has no such axis.
  std::string group = "planner";  ///< Correlations of its values apart, and of all.
};

/// The paper's layout: a row per object, `axes.row` and method, seeds together: mean M beside the
/// paper's, and above which other methods it is. `columns` and `details` are those of the cells.
std::vector<sweep::Column> paper_layout_columns(const MethodTableAxes& axes = {});
std::vector<sweep::ResultRow> paper_layout(const std::vector<sweep::Column>& columns,
                                           const std::vector<sweep::Column>& details,
                                           const sweep::ParameterSweep& sweep,
                                           const std::vector<sweep::FinishedCell>& cells,
                                           const MethodTableAxes& axes = {});

/// A row per pair of measures, value of `axes.group` (or all) and scope: Spearman's rank
/// correlation.
std::vector<sweep::Column> correlation_columns(const MethodTableAxes& axes = {});
std::vector<sweep::ResultRow> correlations(const std::vector<std::string>& measures,
                                           const std::vector<sweep::Column>& details,
                                           const sweep::ParameterSweep& sweep,
                                           const std::vector<sweep::FinishedCell>& cells,
                                           const MethodTableAxes& axes = {});

}  // namespace graspfit::experiments::internal
