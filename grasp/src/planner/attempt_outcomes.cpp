#include "planner/attempt_outcomes.hpp"

#include <algorithm>

namespace graspfit::grasp::internal {

AttemptOutcome unusable_outcome(const Grasp& grasp) {
  const bool is_all_weak =
      !grasp.contacts.empty() &&
      std::all_of(grasp.contacts.begin(), grasp.contacts.end(),
                  [](const contact::Contact& contact) { return contact.weak.value_or(false); });
  if (is_all_weak) return AttemptOutcome::Weak;
  return grasp.quality.stable_pairs.empty() ? AttemptOutcome::Unstable : AttemptOutcome::PoorShape;
}

std::optional<AttemptOutcome> failure_of(FittingStop stop) {
  switch (stop) {
    case FittingStop::InitialCollision:
      return AttemptOutcome::InitialCollision;
    case FittingStop::BlockedFinger:
      return AttemptOutcome::BlockedFinger;
    case FittingStop::MissedContact:
      return AttemptOutcome::MissedContact;
    case FittingStop::IterationLimit:
      return AttemptOutcome::IterationLimit;
    case FittingStop::Contact:
      break;
  }
  return std::nullopt;
}

std::optional<AttemptOutcome> failure_of(RefinementStop stop) {
  switch (stop) {
    case RefinementStop::Contact:
      return std::nullopt;
    case RefinementStop::OutOfReach:
      return AttemptOutcome::MissedContact;
    case RefinementStop::Intersecting:
      return AttemptOutcome::BlockedFinger;
    case RefinementStop::SelfCollision:
      return AttemptOutcome::SelfCollision;
    case RefinementStop::GapLeft:
    case RefinementStop::IterationLimit:
      break;
  }
  return AttemptOutcome::GapLeft;
}

int stage_of(AttemptOutcome outcome) {
  switch (outcome) {
    case AttemptOutcome::NoTargets:
      return 0;
    case AttemptOutcome::InitialCollision:
      return 1;
    case AttemptOutcome::IterationLimit:
      return 2;
    case AttemptOutcome::BlockedFinger:
    case AttemptOutcome::MissedContact:
      return 3;
    case AttemptOutcome::GapLeft:
      return 4;
    case AttemptOutcome::Weak:
    case AttemptOutcome::Unstable:
    case AttemptOutcome::PoorShape:
      return 5;
    case AttemptOutcome::SelfCollision:
      return 6;
    case AttemptOutcome::Rejected:
      return 7;
    case AttemptOutcome::NoWayIn:
      return 8;
    case AttemptOutcome::UsableOnly:
      return 9;
    case AttemptOutcome::Valid:
      return 10;
  }
  return 0;
}

}  // namespace graspfit::grasp::internal
