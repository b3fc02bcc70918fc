#pragma once

#include <vector>

#include "graspfit/hands/hand_model.hpp"

/// \file
/// How links and joints of a hand are connected, whatever its configuration is.

namespace graspfit::hands {

/// Links from the root to `link`, both included.
std::vector<int> links_to(const HandModel& model, int link);

/// Movable joints from the root to `link`, coupled ones included.
std::vector<int> joints_to(const HandModel& model, int link);

/// The independent joint that sets a joint: its leader, or the joint itself.
int leader_of(const HandModel& model, int joint);

/// The independent joints that set some joints, each once, ascending.
std::vector<int> leaders_of(const HandModel& model, const std::vector<int>& joints);

}  // namespace graspfit::hands
