#pragma once

#include "graspfit/base/content_cache.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

/// Appends all of a model that what its pads can do depends on: not names, files, nor what only
/// pictures show.
void append(base::ContentKey& key, const HandModel& model);

}  // namespace graspfit::hands::internal
