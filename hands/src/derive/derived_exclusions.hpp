#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Pairs of links whose collision says nothing about the hand. `model` has closing signs.
///
/// Excluded are: links of bodies that a joint joins (bodies without surface between them are
/// stepped over), if their surfaces meet in any sampled configuration; pairs that meet in the open
/// configuration; and pairs that meet in at least kAlwaysShare of kNumPostures random
/// configurations, in which coupled joints follow. Whether two links meet is exact. Links that are
/// fixed to each other are excluded by the reader and not listed. Pairs other than neighbors are
/// noted.
std::vector<std::pair<std::string, std::string>> derived_exclusions(const HandModel& model,
                                                                    Findings& findings);

}  // namespace graspfit::hands::internal
