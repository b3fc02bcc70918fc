#pragma once

#include <string>
#include <vector>

#include "description/sidecar.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

/// Sets the couplings that a sidecar lists, over those of the description.
/// @throws InvalidInput, prefixed by `file`, for unknown joints and joints given twice.
void set_couplings(const std::vector<SidecarCoupling>& couplings, const std::string& file,
                   HandModel& model);

/// A follower of a follower is made to follow the first leader.
/// @throws InvalidInput, prefixed by `file`, if the couplings form a cycle.
void follow_first_leaders(const std::string& file, HandModel& model);

/// A model of links, joints and couplings with the fingers, pads, palm, closing signs and
/// exclusions of a complete sidecar. Links that are fixed to each other are excluded besides.
/// @throws InvalidInput, prefixed by `file`, for names that nothing bears.
HandModel resolved(const Sidecar& sidecar, const std::string& file, HandModel model);

}  // namespace graspfit::hands::internal
