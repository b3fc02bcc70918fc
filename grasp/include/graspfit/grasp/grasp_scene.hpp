#pragma once

#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/surroundings.hpp"

namespace graspfit::grasp {

/// The hand, the object and the surroundings among which the hand moves, and what counts as
/// contact. The scene refers to all of them and owns none.
struct GraspScene {
  const FittingHand& hand;
  const ObjectModel& object;
  const SurroundingsCollision& surroundings;
  const contact::ContactEstimationOptions& contact_options;
};

}  // namespace graspfit::grasp
