#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graspfit/experiments/grasp_predicates.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments::internal {

/// What a case's predicates judge.
struct JudgedGrasp {
  const grasp::Grasp& grasp;
  const hands::HandModel& hand;
  PredicateObject object;
  std::map<std::string, double> best_m;  ///< Largest M of every mode of the case that has a grasp.
};

/// A predicate with its parameters.
using CasePredicate = std::function<bool(const JudgedGrasp&)>;

/// Reads {"name": ..., parameters}. @throws SettingError that lists the predicates or parameters.
CasePredicate read_predicate(const base::JsonValue& value);

}  // namespace graspfit::experiments::internal
