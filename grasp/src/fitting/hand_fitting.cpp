#include "graspfit/grasp/hand_fitting.hpp"

#include <cmath>
#include <string>
#include <string_view>

#include "fitting/fitting_loop.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {
namespace {

using base::InvalidInput;
using base::shortest_decimal;

/// The palm's target has to be the last of several, and the palm needs a pad to touch with.
void require_palm(const hands::HandModel& hand, std::size_t target, std::size_t num_targets) {
  if (target + 1 != num_targets || num_targets < 2) {
    throw InvalidInput("fit_hand: target " + std::to_string(target) +
                       " is the palm's, which must be the last after a finger's");
  }
  hand.palm_pad();
}

/// The result of a loop that `run` runs while the depths of some links are guarded. With the guard
/// on voxels, a hand that ends with a link deeper in the object than a voxel's edge (one of twenty)
/// is fitted again, with the depth of that link guarded at every motion.
template <class Run>
FittingResult fitted(const Run& run) {
  std::vector<int> guarded;
  for (double spent_s = 0.0;;) {
    internal::FittingLoop::Outcome outcome = run(guarded);
    outcome.result.contact_tests_s += spent_s;
    const std::vector<int>& deep = outcome.links_too_deep;
    if (deep.empty()) return outcome.result;
    // Links that are guarded already are none of these, so that this ends.
    guarded.insert(guarded.end(), deep.begin(), deep.end());
    spent_s = outcome.result.contact_tests_s;
  }
}

}  // namespace

void FittingOptions::validate() const {
  internal::require_ranges("FittingOptions", *this, internal::fitting_rows);
}

FittingResult fit_hand(const GraspScene& scene, GraspStyle style, const TargetContacts& targets,
                       const PalmPlacement& placement, const FittingOptions& options,
                       const std::optional<hands::HandConfiguration>& goal) {
  options.validate();
  scene.contact_options.validate();
  if (targets.contacts.size() < 2) {
    throw InvalidInput("fit_hand: " + std::to_string(targets.contacts.size()) +
                       " targets, a grasp needs at least two");
  }
  const hands::HandModel& model = scene.hand.model();
  RequestedParts requested;
  for (std::size_t t = 0; t < targets.contacts.size(); ++t) {
    const TargetContact& target = targets.contacts[t];
    if (target.is_palm) {
      require_palm(model, t, targets.contacts.size());
      requested.palm = true;
      continue;
    }
    if (!target.finger) {
      throw InvalidInput("fit_hand: target " + std::to_string(t) +
                         " is for no finger; call assign_fingers first");
    }
    model.tip_pad_of(*target.finger);
    if (target.pad) {
      throw InvalidInput("fit_hand: target " + std::to_string(t) + " is for pad " +
                         std::to_string(*target.pad) + ", only fingertips' pads can be fitted");
    }
    requested.fingers.push_back(*target.finger);
  }
  return fitted([&](const std::vector<int>& depth_guarded) {
    return internal::FittingLoop(scene, style, requested, options, depth_guarded)
        .fit(targets, placement, goal);
  });
}

FittingResult close_hand(const GraspScene& scene, GraspStyle style, const RequestedParts& requested,
                         const hands::HandConfiguration& start, const RetreatRule& retreat,
                         const FittingOptions& options) {
  options.validate();
  scene.contact_options.validate();
  const hands::HandModel& model = scene.hand.model();
  hands::validate(model, start);
  if (requested.fingers.empty()) throw InvalidInput("close_hand: no finger is requested");
  if (!requested.other_pads.empty()) {
    throw InvalidInput("close_hand: pad " + std::to_string(requested.other_pads.front()) +
                       " is requested, only fingertips' pads are closed onto the object");
  }
  for (const int finger : requested.fingers) model.tip_pad_of(finger);
  if (requested.palm) model.palm_pad();
  if (const double step = retreat.step.value_or(1.0); !(step > 0.0 && std::isfinite(step))) {
    throw InvalidInput("close_hand: retreat step = " + shortest_decimal(step) +
                       ", must be finite and > 0 m");
  }
  if (retreat.most_steps.value_or(0) < 0) {
    throw InvalidInput("close_hand: retreat of at most " + std::to_string(*retreat.most_steps) +
                       " steps, must be >= 0");
  }
  return fitted([&](const std::vector<int>& depth_guarded) {
    return internal::FittingLoop(scene, style, requested, options, depth_guarded)
        .close(start, retreat);
  });
}

}  // namespace graspfit::grasp
