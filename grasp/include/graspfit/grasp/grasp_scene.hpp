#pragma once

#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/surroundings.hpp"

namespace graspfit::grasp {

/// Who is there when a hand moves at an object, and what counts as contact. Refers to all of it.
struct GraspScene {
  const FittingHand& hand;
  const ObjectModel& object;
  const SurroundingsCollision& surroundings;
  const contact::ContactEstimationOptions& contact_options;
};

}  // namespace graspfit::grasp
