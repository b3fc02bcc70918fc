#include "fitting/finger_swing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;

double azimuth_error(const Vector3d& from, const Vector3d& to, const Vector3d& axis) {
  const Vector3d a = from - from.dot(axis) * axis;
  const Vector3d b = to - to.dot(axis) * axis;
  if (a.norm() < 1e-9 || b.norm() < 1e-9) return 0.0;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

AzimuthOfFinger::AzimuthOfFinger(const hands::HandModel& hand, int finger)
    : hand_(hand),
      finger_(hand.fingers[finger]),
      chain_(hands::links_to(hand, hand.pads[*finger_.tip_pad].link)),
      contact_C_(hands::pad_contact_point_C(hand.pads[*finger_.tip_pad])),
      X_OL_(hand.links.size()) {}

double AzimuthOfFinger::error(const hands::HandConfiguration& configuration,
                              const Vector3d& point_O) {
  Vector3d pivot = configuration.X_OH * hand_.palm.center_H;
  for (const int link : chain_) {
    X_OL_[link] = hands::link_pose(hand_, link, X_OL_, configuration);
    if (finger_.swing_joint && hand_.links[link].parent_joint == *finger_.swing_joint) {
      const hands::Joint& swing = hand_.joints[*finger_.swing_joint];
      pivot = X_OL_[swing.parent_link] * swing.X_PJ.translation();
    }
  }
  const Vector3d tip = X_OL_[chain_.back()] * (hand_.pads[*finger_.tip_pad].X_LC * contact_C_);
  const Vector3d axis = (configuration.X_OH.linear() * hand_.palm.direction_H).normalized();
  return azimuth_error(tip - pivot, point_O - pivot, axis);
}

double best_swing(const hands::HandModel& hand, const hands::HandConfiguration& configuration,
                  const TargetContacts& targets, int leader,
                  const std::vector<FingerTarget>& pairs) {
  constexpr int kCoarse = 18;  // samples, an evaluation each; the sum over fingers of one leader
                               // may have several minima
  constexpr int kRefine = 20;  // the range shrinks by 0.618 each: to 1e-5 of a joint's range
  constexpr double kGolden = 0.61803398874989485;
  std::vector<AzimuthOfFinger> azimuths;
  for (const FingerTarget& pair : pairs) azimuths.emplace_back(hand, pair.finger);
  hands::HandConfiguration trial = configuration;
  const auto error_at = [&](double position) {
    trial.q[leader] = position;
    hands::apply_couplings(hand, trial.q);
    double sum = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double error = azimuths[i].error(trial, targets.contacts[pairs[i].target].point_O);
      sum += error * error;
    }
    return sum;
  };
  const double lower = hand.joints[leader].lower;
  const double width = (hand.joints[leader].upper - lower) / kCoarse;
  double best = lower;
  double best_error = std::numeric_limits<double>::infinity();
  for (int sample = 0; sample <= kCoarse; ++sample) {
    const double error = error_at(lower + sample * width);
    if (error < best_error) {
      best_error = error;
      best = lower + sample * width;
    }
  }
  double a = std::max(lower, best - width);
  double b = std::min(hand.joints[leader].upper, best + width);
  double x1 = b - kGolden * (b - a);
  double x2 = a + kGolden * (b - a);
  double f1 = error_at(x1);
  double f2 = error_at(x2);
  for (int step = 0; step < kRefine; ++step) {
    if (f1 <= f2) {
      b = x2;
      x2 = x1;
      f2 = f1;
      x1 = b - kGolden * (b - a);
      f1 = error_at(x1);
    } else {
      a = x1;
      x1 = x2;
      f1 = f2;
      x2 = a + kGolden * (b - a);
      f2 = error_at(x2);
    }
  }
  return 0.5 * (a + b);
}

std::map<std::optional<int>, std::vector<FingerTarget>> pairs_by_leader(
    const hands::HandModel& hand, const TargetContacts& targets) {
  std::map<std::optional<int>, std::vector<FingerTarget>> pairs;
  for (int t = 0; t < std::ssize(targets.contacts); ++t) {
    if (targets.contacts[t].is_palm) continue;
    const int finger = *targets.contacts[t].finger;
    std::optional<int> leader = hand.fingers[finger].swing_joint;
    if (leader) leader = hands::leader_of(hand, *leader);
    pairs[leader].push_back({finger, t});
  }
  return pairs;
}

Eigen::VectorXd aligned_swing(const hands::HandModel& hand,
                              const hands::HandConfiguration& configuration,
                              const TargetContacts& targets) {
  Eigen::VectorXd q = configuration.q;
  for (const auto& [leader, pairs] : pairs_by_leader(hand, targets)) {
    if (leader) q[*leader] = best_swing(hand, configuration, targets, *leader, pairs);
  }
  hands::apply_couplings(hand, q);
  return q;
}

}  // namespace graspfit::grasp::internal
