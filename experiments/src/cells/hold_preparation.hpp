#pragma once

#include <memory>

#include "cells/planning_table.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::experiments::internal {

/// The hand and the object of a cell as a physics engine sees them; kept for the cells that follow.
std::shared_ptr<const hold_test::HoldHand> hold_hand(const Planned& planned);
std::shared_ptr<const hold_test::HoldObject> hold_object(const Planned& planned);

/// "rejected", "approach", "load", "held": as tables call them.
const char* stage_name(hold_test::HoldStage stage);

}  // namespace graspfit::experiments::internal
