#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"

namespace graspfit::experiments::internal {

/// Values of measures of a grasp by their names; empty where one is not defined.
using GraspMeasures = std::map<std::string, std::optional<double>>;

/// One column per measure.
std::vector<sweep::Column> grasp_measure_columns();

/// All measures of a grasp of a run; the time that it takes is added to `seconds`.
GraspMeasures measures_of(const Planned& planned, const grasp::Grasp& grasp, double& seconds);

/// Names of the measures that are compared by rank with one another.
std::vector<std::string> correlated_measures();

}  // namespace graspfit::experiments::internal
