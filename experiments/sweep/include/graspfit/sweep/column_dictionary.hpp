#pragma once

#include <string>

#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::sweep {

/// Name, unit and meaning of every column of an experiment's tables, in their order, as JSON text:
/// {"experiment": SLUG, "tables": {"SLUG.csv": [{"name", "unit", "meaning"}, ...], ...}}. Units are
/// as in `Column`.
std::string column_dictionary(const Experiment& experiment, const ExperimentConfig& config);

}  // namespace graspfit::sweep
