#include "graspfit/grasp/planner_result.hpp"

namespace graspfit::grasp {

const char* outcome_name(AttemptOutcome outcome) {
  switch (outcome) {
    case AttemptOutcome::Valid:
      return "valid";
    case AttemptOutcome::UsableOnly:
      return "usable but not valid";
    case AttemptOutcome::NoTargets:
      return "no target set";
    case AttemptOutcome::InitialCollision:
      return "initial collision";
    case AttemptOutcome::BlockedFinger:
      return "blocked finger";
    case AttemptOutcome::MissedContact:
      return "missed contact";
    case AttemptOutcome::GapLeft:
      return "gap left";
    case AttemptOutcome::NoWayIn:
      return "no way in";
    case AttemptOutcome::Weak:
      return "weak features only";
    case AttemptOutcome::SelfCollision:
      return "self-collision";
    case AttemptOutcome::Rejected:
      return "rejected";
    case AttemptOutcome::IterationLimit:
      return "iteration limit";
    case AttemptOutcome::Unstable:
      return "no stable pair";
    case AttemptOutcome::PoorShape:
      return "poor shape";
  }
  return "";
}

std::int64_t PlannerStatistics::usable() const {
  return valid() + outcomes.at(AttemptOutcome::UsableOnly);
}

std::int64_t PlannerStatistics::valid() const { return outcomes.at(AttemptOutcome::Valid); }

PlannerTimings& PlannerTimings::operator+=(const PlannerTimings& other) {
  targets_s += other.targets_s;
  fitting_s += other.fitting_s;
  contact_tests_s += other.contact_tests_s;
  refinement_s += other.refinement_s;
  measure_s += other.measure_s;
  pre_grasp_s += other.pre_grasp_s;
  return *this;
}

}  // namespace graspfit::grasp
