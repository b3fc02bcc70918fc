#pragma once

#include "graspfit/contact/contact.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::testing {

/// Returns a rectangular pad in the x-y plane of its link that faces z [m].
inline hands::ContactPad rectangular_pad(double width, double length, int link,
                                         std::optional<int> finger) {
  hands::ContactPad pad;
  pad.name = "pad_" + std::to_string(link);
  pad.link = link;
  pad.finger = finger;
  const double x = width / 2;
  const double y = length / 2;
  pad.outline = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  return pad;
}

/// Returns a hand without joints: a palm (link 0, pad 0) and fingers of one link each, finger f
/// with link and pad f + 1. All pads are alike. It has all that functions of pads alone need.
inline hands::HandModel pad_hand(int num_fingers, double width = 0.02, double length = 0.04) {
  hands::HandModel hand;
  hand.name = "pads";
  for (int link = 0; link <= num_fingers; ++link) {
    hands::Link body;
    body.name = "link_" + std::to_string(link);
    if (link > 0) body.parent_link = 0;
    hand.links.push_back(body);
    hand.pads.push_back(
        rectangular_pad(width, length, link, link == 0 ? std::nullopt : std::optional(link - 1)));
    if (link == 0) continue;
    hands::Finger finger;
    finger.name = "finger_" + std::to_string(link);
    finger.links = {link};
    finger.tip_pad = link;
    finger.is_thumb = link == 1;
    hand.fingers.push_back(finger);
  }
  hand.palm.link = 0;
  hand.palm.pad = 0;
  return hand;
}

/// Returns a contact of a finger of `pad_hand` (−1: its palm) at `direction` (unit) on a ball
/// around the origin, in the middle of its pad and over 30 % of its area.
inline contact::Contact ball_contact(const hands::HandModel& hand, int finger,
                                     const Eigen::Vector3d& direction, double radius = 0.05) {
  contact::Contact contact;
  contact.point_O = radius * direction;
  contact.inward_normal_O = -direction;
  if (finger >= 0) contact.finger = finger;
  contact.link = finger + 1;
  contact.pad = finger + 1;
  contact.area = 0.3 * hands::pad_area(hand.pads[*contact.pad]);
  contact.pad_boundary_distance = hands::largest_boundary_distance(hand.pads[*contact.pad]);
  return contact;
}

}  // namespace graspfit::testing
