#include "graspfit/grasp/planner_options.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "rows/range_check.hpp"
#include "targets/object_size.hpp"

namespace graspfit::grasp {

using base::InvalidInput;
using base::shortest_decimal;

void PlannerOptions::validate() const {
  internal::require_ranges("PlannerOptions", *this, internal::planner_rows);
  const auto require = [](bool is_met, std::string_view field, const auto& value,
                          std::string_view rule) {
    base::require(is_met, "PlannerOptions", field, value, rule);
  };
  const bool has_palm = palm.value_or(style == GraspStyle::Power);
  const int least_fingers = has_palm ? 1 : 2;
  require(!fingers.empty() || num_contacts >= least_fingers, "num_contacts", num_contacts,
          has_palm ? ">= 1 beside the palm" : ">= 2");
  require(fingers.empty() || std::ssize(fingers) >= least_fingers, "fingers", fingers.size(),
          has_palm ? "at least one name beside the palm" : "at least two names");
  if (approach_O) {
    require(approach_O->allFinite() && approach_O->norm() > 0.0, "approach_O",
            shortest_decimal((*approach_O)[0]) + "," + shortest_decimal((*approach_O)[1]) + "," +
                shortest_decimal((*approach_O)[2]),
            "finite and not zero");
  }
  require(style != GraspStyle::Auto || targets.search == TargetSearch::Reach, "style",
          name_of(style), "precision or power unless targets.search is reach");
  require(style != GraspStyle::Auto || planner == PlannerOptions().planner, "style", name_of(style),
          "precision or power unless planner is " + PlannerOptions().planner);
  require(!refine || missing_contact == MissingContact::Fails, "missing_contact",
          name_of(missing_contact), "fails with refine, which accepts no part without contact");
  // Grasp files say 0 where these two are empty.
  require(targets.min_separation != 0.0, "min_separation_m", 0, "> 0, or empty");
  require(quality.merge_distance != 0.0, "merge_distance_m", 0, "> 0, or empty");
  score.validate();
  if (weak) weak->validate();
  targets.validate();
  fitting.validate();
  sampling.validate();
  medial_symmetry.validate();
  refinement.validate();
  pre_grasp.validate();
  squeeze.validate();
  distinct.validate();
  quality.validate();
}

double clip_thickness(const PlannerOptions& options, double voxel_size) {
  return options.clip_thickness.value_or(std::max(0.5 * voxel_size, 0.001));
}

FittingOptions fitting_options(const PlannerOptions& options) {
  FittingOptions fitting = options.fitting;
  // At the first graze refinement takes over, which moves the palm too and would undo any further
  // closing.
  if (options.refine) fitting.contact_state = ContactState::FirstGraze;
  // Where other contacts may do, fingers close however far one of them has stopped.
  if (options.missing_contact == MissingContact::Measured) {
    fitting.give_up_distance = std::numeric_limits<double>::max();
  }
  return fitting;
}

double merge_distance(const PlannerOptions& options, double voxel_size) {
  return options.quality.merge_distance.value_or(0.1 * voxel_size);
}

double largest_deviation(const PlannerOptions& options, const hands::HandModel& hand) {
  if (options.largest_deviation) return *options.largest_deviation;
  return internal::fingertip_width(hand, requested_parts(hand, options).fingers);
}

contact::ContactEstimationOptions contact_estimation(const PlannerOptions& options,
                                                     double clip_thickness) {
  const bool is_precision = options.style == GraspStyle::Precision;
  return {.clip_thickness = clip_thickness,
          .averaging = options.averaging,
          .pads = options.counted_pads.value_or(is_precision ? contact::CountedPads::TipsAndPalm
                                                             : contact::CountedPads::All),
          .pieces = options.contact_pieces,
          .faces = options.contact_faces};
}

std::optional<double> bearing_gap(const PlannerOptions& options) {
  return options.refine ? std::optional(options.refinement.largest_gap) : std::nullopt;
}

RequestedParts parts_to_touch(const PlannerOptions& options, const RequestedParts& requested,
                              const TargetContacts& targets) {
  const bool may_be_others =
      options.style != GraspStyle::Precision && options.targets.search == TargetSearch::Reach;
  return may_be_others ? parts_of(targets) : requested;
}

RequestedParts requested_parts(const hands::HandModel& hand, const PlannerOptions& options) {
  RequestedParts parts;
  parts.palm = options.palm.value_or(options.style == GraspStyle::Power);
  if (parts.palm && !hand.palm.pad) {
    throw InvalidInput("the palm of hand " + hand.name +
                       " has no contact pad, so it cannot be asked to touch");
  }
  std::vector<int>& fingers = parts.fingers;
  if (options.fingers.empty()) {
    if (options.num_contacts > std::ssize(hand.fingers)) {
      throw InvalidInput("hand " + hand.name + " has " + std::to_string(hand.fingers.size()) +
                         " fingers, " + std::to_string(options.num_contacts) +
                         " contacts were asked for");
    }
    fingers.push_back(hand.thumb());
    for (int finger = 0; std::ssize(fingers) < options.num_contacts; ++finger) {
      if (finger != hand.thumb()) fingers.push_back(finger);
    }
  } else {
    for (const std::string& name : options.fingers) {
      const int finger = hand.finger_index(name);
      if (std::find(fingers.begin(), fingers.end(), finger) != fingers.end()) {
        throw InvalidInput("finger " + name + " is named twice");
      }
      fingers.push_back(finger);
    }
  }
  for (const int finger : fingers) hand.tip_pad_of(finger);
  const auto thumb = std::find(fingers.begin(), fingers.end(), hand.thumb());
  if (thumb != fingers.end()) std::rotate(fingers.begin(), thumb, thumb + 1);
  return parts;
}

}  // namespace graspfit::grasp
