#include "graspfit/grasp/target_contacts.hpp"

#include <algorithm>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/contact/contact.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {

using Eigen::Vector3d;

namespace {

void require_pad(const hands::HandModel& hand, int pad) {
  if (pad >= 0 && pad < std::ssize(hand.pads)) return;
  throw base::InvalidInput("pad " + std::to_string(pad) + " of hand " + hand.name + ", which has " +
                           std::to_string(hand.pads.size()));
}

}  // namespace

void TargetOptions::validate() const {
  internal::require_ranges("TargetOptions", *this, internal::target_rows);
}

int pad_for(const hands::HandModel& hand, const TargetContact& target) {
  if (target.pad) {
    require_pad(hand, *target.pad);
    return *target.pad;
  }
  return target.finger ? hand.tip_pad_of(*target.finger) : hand.palm_pad();
}

bool is_for_part_of(const TargetContact& target, const contact::Contact& contact) {
  return contact.finger ? target.finger == contact.finger : target.is_palm;
}

Vector3d TargetContacts::centroid() const {
  Vector3d sum = Vector3d::Zero();
  int num_fingers = 0;
  for (const TargetContact& contact : contacts) {
    if (contact.is_palm) continue;
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
  if (!parts.palm || !hand.palm.pad) return distances;
  distances.palm_to_tip = hands::palm_distances(hand);
  PalmReach& palm = distances.palm.emplace();
  palm.center_H = hand.palm.center_H;
  palm.direction_H = hand.palm.direction_H;
  for (const Eigen::Vector2d& corner : hand.pads[*hand.palm.pad].outline) {
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
    contact.pad = target.pad;
    if (!target.is_palm && !target.finger && contacts.size() < fingers.size()) {
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

RequestedParts parts_of(const TargetContacts& targets) {
  RequestedParts parts;
  for (const TargetContact& target : targets.contacts) {
    if (target.finger) parts.fingers.push_back(*target.finger);
    if (target.pad) parts.other_pads.push_back(*target.pad);
    parts.palm = parts.palm || target.is_palm;
  }
  return parts;
}

std::vector<int> requested_pads(const hands::HandModel& hand, const RequestedParts& requested) {
  const std::vector<int>& fingers = requested.fingers;
  for (const int pad : requested.other_pads) {
    require_pad(hand, pad);
    const std::optional<int>& finger = hand.pads[pad].finger;
    if (finger && std::find(fingers.begin(), fingers.end(), *finger) != fingers.end()) continue;
    throw base::InvalidInput("pad " + hand.pads[pad].name + " is of no requested finger");
  }
  std::vector<int> pads;
  for (const int finger : fingers) {
    const auto other = std::find_if(requested.other_pads.begin(), requested.other_pads.end(),
                                    [&](int pad) { return hand.pads[pad].finger == finger; });
    pads.push_back(other == requested.other_pads.end() ? hand.tip_pad_of(finger) : *other);
  }
  if (requested.palm) pads.push_back(hand.palm_pad());
  return pads;
}

}  // namespace graspfit::grasp
