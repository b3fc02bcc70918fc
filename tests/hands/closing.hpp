#pragma once

#include <algorithm>

#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::testing {

/// Returns the hand at the share `closing` of the way from open to closed; neutral joints are at
/// the value nearest zero.
inline hands::HandConfiguration closed_by(const hands::HandModel& hand, double closing) {
  hands::HandConfiguration c = hands::open_configuration(hand);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.closing_sign == 0) continue;
    const double open = joint.closing_sign > 0 ? joint.lower : joint.upper;
    const double closed = joint.closing_sign > 0 ? joint.upper : joint.lower;
    c.q[static_cast<Eigen::Index>(j)] = open + closing * (closed - open);
  }
  // Followers are where their leaders put them; breakaway joints would stay further closed.
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const auto& coupling = hand.joints[j].coupling;
    if (!coupling) continue;
    c.q[static_cast<Eigen::Index>(j)] =
        std::clamp(coupling->ratio * c.q[coupling->leader] + coupling->offset, hand.joints[j].lower,
                   hand.joints[j].upper);
  }
  return c;
}

}  // namespace graspfit::testing
