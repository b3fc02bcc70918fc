#pragma once

#include <string>
#include <vector>

#include "graspfit/sweep/experiment.hpp"

/// \file
/// Tables over all cells of a comparison of methods, made of its details.

namespace graspfit::experiments::internal {

/// Axes that tell the rows of a summary apart beside the object, and the correlations' groups.
struct MethodTableAxes {
  std::string row = "size";  ///< Axis of the summary's rows; its column is empty where the sweep
                             ///< has no such axis.
  std::string group = "planner";  ///< Axis for each of whose values there are correlations, besides
                                  ///< those of all.
};

/// The table in the paper's layout: a row per object, value of `axes.row` and method, over all
/// seeds, with the mean M beside the paper's and whether it is above those of the baselines.
/// `columns` and `details` are those of the cells.
std::vector<sweep::Column> paper_layout_columns(const MethodTableAxes& axes = {});
std::vector<sweep::ResultRow> paper_layout(const std::vector<sweep::Column>& columns,
                                           const std::vector<sweep::Column>& details,
                                           const sweep::ParameterSweep& sweep,
                                           const std::vector<sweep::FinishedCell>& cells,
                                           const MethodTableAxes& axes = {});

/// The table of Spearman's rank correlations: a row per pair of measures, value of `axes.group` (or
/// all) and scope.
std::vector<sweep::Column> correlation_columns(const MethodTableAxes& axes = {});
std::vector<sweep::ResultRow> correlations(const std::vector<std::string>& measures,
                                           const std::vector<sweep::Column>& details,
                                           const sweep::ParameterSweep& sweep,
                                           const std::vector<sweep::FinishedCell>& cells,
                                           const MethodTableAxes& axes = {});

}  // namespace graspfit::experiments::internal
