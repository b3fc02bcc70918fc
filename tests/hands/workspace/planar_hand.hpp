#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

/// \file
/// Hands made of points and lines, whose reach is known in closed form.

namespace graspfit::testing {

inline hands::RigidTransform at(const Eigen::Vector3d& point) {
  hands::RigidTransform X = hands::RigidTransform::Identity();
  X.translation() = point;
  return X;
}

/// Adds a link that turns about −y (x toward z for growing q) or, prismatic, moves along x. Poses
/// are taken by value, since they may be those of a part of the hand, whose lists grow.
inline int add_link(hands::HandModel& hand, int parent, hands::RigidTransform X_PJ, double lower,
                    double upper, hands::JointType type = hands::JointType::Revolute) {
  const int link = static_cast<int>(hand.links.size());
  const int joint = static_cast<int>(hand.joints.size());
  hands::Joint& j = hand.joints.emplace_back();
  j.name = "joint " + std::to_string(joint);
  j.type = type;
  j.parent_link = parent;
  j.child_link = link;
  j.X_PJ = X_PJ;
  j.axis_J =
      type == hands::JointType::Revolute ? Eigen::Vector3d(0, -1, 0) : Eigen::Vector3d(1, 0, 0);
  j.lower = lower;
  j.upper = upper;
  j.closing_sign = 1;
  hands::Link& l = hand.links.emplace_back();
  l.name = "link " + std::to_string(link);
  l.parent_link = parent;
  l.parent_joint = joint;
  return link;
}

/// Adds a finger of the last `num_links` links whose pad has pose `X_LC` on the last.
inline void add_finger(hands::HandModel& hand, int num_links, hands::RigidTransform X_LC) {
  const int index = static_cast<int>(hand.fingers.size());
  hands::Finger& finger = hand.fingers.emplace_back();
  finger.name = "finger " + std::to_string(index);
  finger.tip_pad = static_cast<int>(hand.pads.size());
  for (int link = static_cast<int>(hand.links.size()) - num_links;
       link < static_cast<int>(hand.links.size()); ++link) {
    finger.links.push_back(link);
    finger.joints.push_back(*hand.links[link].parent_joint);
  }
  hands::ContactPad& pad = hand.pads.emplace_back();
  pad.name = "pad " + std::to_string(index);
  pad.link = finger.links.back();
  pad.finger = index;
  pad.X_LC = X_LC;
  pad.outline = {{-0.01, -0.01}, {0.01, -0.01}, {0.01, 0.01}, {-0.01, 0.01}};
}

inline hands::HandModel bare_palm() {
  hands::HandModel hand;
  hand.name = "test";
  hand.links.emplace_back().name = "palm";
  hand.palm.link = 0;
  return hand;
}

/// Returns two fingers in the x-z plane, mirrored, with bases at x = ±base. Each is a chain of
/// links of given lengths, straight outward at q = 0, and each joint turns from 0 to `upper` toward
/// z and inward. The pads look where the fingers close.
inline hands::HandModel planar_hand(double base, const std::vector<double>& lengths, double upper) {
  hands::HandModel hand = bare_palm();
  for (const double side : {1.0, -1.0}) {
    hands::RigidTransform X = at({side * base, 0, 0});
    if (side < 0)
      X.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    int parent = 0;
    for (const double length : lengths) {
      parent = add_link(hand, parent, X, 0.0, upper);
      X = at({length, 0, 0});
    }
    add_finger(hand, static_cast<int>(lengths.size()), X);
  }
  return hand;
}

}  // namespace graspfit::testing
