#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::testing {

inline const hands::Joint& joint(const hands::HandModel& hand, std::string_view name) {
  return hand.joints[static_cast<std::size_t>(hand.joint_index(std::string(name)))];
}

inline bool mentions(const std::vector<hands::HandFinding>& findings, hands::FindingKind kind,
                     const std::string& item, const std::string& what) {
  return std::any_of(findings.begin(), findings.end(), [&](const hands::HandFinding& finding) {
    return finding.kind == kind && finding.item == item &&
           finding.what.find(what) != std::string::npos;
  });
}

/// Draws every joint from anywhere between its limits, followers as well.
inline hands::HandConfiguration random_configuration(const hands::HandModel& hand,
                                                     base::Random& random) {
  hands::HandConfiguration c;
  c.q.resize(static_cast<Eigen::Index>(hand.joints.size()));
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    c.q[static_cast<Eigen::Index>(j)] = random.uniform(hand.joints[j].lower, hand.joints[j].upper);
  }
  return c;
}

/// A joint's axis as a line in O.
struct Line {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
};

inline Line axis_line(const hands::HandModel& hand, const std::vector<hands::RigidTransform>& X_OL,
                      const std::string& name) {
  const hands::Joint& j = joint(hand, name);
  const hands::RigidTransform X_OJ = X_OL[static_cast<std::size_t>(j.parent_link)] * j.X_PJ;
  return {X_OJ.translation(), X_OJ.linear() * j.axis_J};
}

}  // namespace graspfit::testing
