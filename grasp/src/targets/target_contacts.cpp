#include "graspfit/grasp/target_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "graspfit/base/option_check.hpp"
#include "graspfit/contact/contact.hpp"

namespace graspfit::grasp {

using Eigen::Vector3d;

void TargetOptions::validate() const {
  const auto require = [](bool is_met, std::string_view field, const auto& value,
                          std::string_view rule) {
    base::require(is_met, "TargetOptions", field, value, rule);
  };
  require(score_threshold >= 0.0 && score_threshold < 1.0, "score_threshold", score_threshold,
          "in [0, 1)");
  require(theta_max > 0.0 && theta_max < std::numbers::pi / 2, "theta_max", theta_max,
          "in (0, pi/2) rad");
  const auto require_finite = [&](std::string_view field, double value, std::string_view rule) {
    require(value >= 0.0 && std::isfinite(value), field, value, rule);
  };
  require_finite("edge_tolerance_rel", edge_tolerance_rel, "finite and >= 0");
  require_finite("centroid_limit_rel", centroid_limit_rel, "finite and >= 0");
  require_finite("angle_weight", angle_weight, "finite and >= 0");
  require(pool_fraction > 0.0 && pool_fraction <= 1.0, "pool_fraction", pool_fraction, "in (0, 1]");
  require(pool_minimum >= 1, "pool_minimum", pool_minimum, ">= 1");
  require(max_seeds >= 1, "max_seeds", max_seeds, ">= 1");
  require(relax_after_seeds >= 0, "relax_after_seeds", relax_after_seeds, ">= 0");
  require_finite("min_separation", min_separation, "finite and >= 0 m");
  require_finite("pool_spacing", pool_spacing, "finite and >= 0 m");
  require_finite("ideal_m_bias", ideal_m_bias, "finite and >= 0");
  require(ideal_m_draws >= 1, "ideal_m_draws", ideal_m_draws, ">= 1");
  require_finite("palm_reach_tolerance", palm_reach_tolerance, "finite and >= 0 m");
}

Vector3d TargetContacts::centroid() const {
  Vector3d sum = Vector3d::Zero();
  int num_fingers = 0;
  for (const TargetContact& contact : contacts) {
    if (contact.finger == contact::kPalm) continue;
    sum += contact.point_O;
    ++num_fingers;
  }
  return num_fingers == 0 ? sum : Vector3d(sum / static_cast<double>(num_fingers));
}

PartDistances part_distances(const hands::HandModel& hand) {
  return part_distances(hand, {.fingers = {}, .palm = true});
}

PartDistances part_distances(const hands::HandModel& hand, const RequestedParts& parts) {
  PartDistances distances;
  distances.tip_to_tip = hands::tip_distances(hand);
  if (!parts.palm || hand.palm.pad < 0) return distances;
  distances.palm_to_tip = hands::palm_distances(hand);
  PalmReach& palm = distances.palm.emplace();
  palm.center_H = hand.palm.center_H;
  palm.direction_H = hand.palm.direction_H;
  for (const Eigen::Vector2d& corner : hand.pads[hand.palm.pad].outline) {
    palm.pad_radius = std::max(palm.pad_radius, corner.norm());
  }
  palm.tips = hands::tip_reaches(hand);
  return distances;
}

std::vector<contact::Contact> contacts_at(const TargetContacts& targets,
                                          const std::vector<int>& fingers) {
  std::vector<contact::Contact> contacts;
  for (const TargetContact& target : targets.contacts) {
    contact::Contact contact;
    contact.point_O = target.point_O;
    contact.inward_normal_O = -target.outward_normal_O;
    contact.finger = target.finger;
    if (target.finger == kUnassigned && contacts.size() < fingers.size()) {
      contact.finger = fingers[contacts.size()];
    }
    contacts.push_back(contact);
  }
  return contacts;
}

double ideal_m(const ObjectModel& object, const TargetContacts& targets,
               const IdealMeasure& measure, const std::vector<int>& fingers) {
  const contact::QualityContext context{.center_of_mass_O = object.mass.center_of_mass,
                                        .normalizing_radius = object.normalizing_radius,
                                        .hand = measure.hand};
  return contact::ideal_quality(contacts_at(targets, fingers), context, kIdealBoundaryDistance,
                                kIdealArea, measure.options)
      .m;
}

std::vector<int> requested_pads(const hands::HandModel& hand, const RequestedParts& requested) {
  std::vector<int> pads;
  for (const int finger : requested.fingers) pads.push_back(hand.fingers[finger].tip_pad);
  if (requested.palm) pads.push_back(hand.palm.pad);
  return pads;
}

}  // namespace graspfit::grasp
