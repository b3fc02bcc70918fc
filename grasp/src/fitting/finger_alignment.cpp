#include "fitting/finger_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp {

using Eigen::Vector3d;
using geometry::RigidTransform;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Azimuth error of a finger toward a point around its own swing axis's origin, or around the palm
/// center where it does not swing. Only the finger's own chain is posed.
class AzimuthOfFinger {
 public:
  AzimuthOfFinger(const hands::HandModel& hand, int finger)
      : hand_(hand),
        finger_(hand.fingers[finger]),
        chain_(hands::links_to(hand, hand.pads[finger_.tip_pad].link)),
        contact_C_(hands::pad_contact_point_C(hand.pads[finger_.tip_pad])),
        X_OL_(hand.links.size()) {}

  double error(const hands::HandConfiguration& configuration, const Vector3d& point_O) {
    Vector3d pivot = configuration.X_OH * hand_.palm.center_H;
    for (const int link : chain_) {
      X_OL_[link] = hands::link_pose(hand_, link, X_OL_, configuration);
      if (finger_.swing_joint && hand_.links[link].parent_joint == *finger_.swing_joint) {
        const hands::Joint& swing = hand_.joints[*finger_.swing_joint];
        pivot = X_OL_[swing.parent_link] * swing.X_PJ.translation();
      }
    }
    const Vector3d tip = X_OL_[chain_.back()] * (hand_.pads[finger_.tip_pad].X_LC * contact_C_);
    const Vector3d axis = (configuration.X_OH.linear() * hand_.palm.direction_H).normalized();
    return azimuth_error(tip - pivot, point_O - pivot, axis);
  }

 private:
  const hands::HandModel& hand_;
  const hands::Finger& finger_;
  std::vector<int> chain_;
  Vector3d contact_C_;
  std::vector<RigidTransform> X_OL_;  ///< Of the links of the chain.
};

/// A finger and the target that it is to look at.
struct Look {
  int finger = 0;
  int target = 0;
  auto operator<=>(const Look&) const = default;
};

/// Where a swing joint stands best for all fingers that hang on it.
struct Swing {
  double position = 0.0;
  double squared_error = 0.0;
};

/// The position of `leader` with the least sum of squared errors (A26): samples of its range, the
/// best one refined by golden section; the error has one minimum per turn of a finger.
Swing best_swing(const hands::HandModel& hand, const hands::HandConfiguration& configuration,
                 const TargetContacts& targets, int leader, const std::vector<Look>& looks) {
  constexpr int kCoarse = 18;
  constexpr int kRefine = 20;  // the range shrinks by 0.618 each
  constexpr double kGolden = 0.61803398874989485;
  std::vector<AzimuthOfFinger> azimuths;
  for (const Look& look : looks) azimuths.emplace_back(hand, look.finger);
  hands::HandConfiguration trial = configuration;
  const auto error_at = [&](double position) {
    trial.q[leader] = position;
    hands::apply_couplings(hand, trial.q);
    double sum = 0.0;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const double error = azimuths[i].error(trial, targets.contacts[looks[i].target].point_O);
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
  const double position = 0.5 * (a + b);
  return {position, error_at(position)};
}

/// Fingers with targets by the independent joint that swings them; those that do not swing first.
std::map<std::optional<int>, std::vector<Look>> looks_by_leader(const hands::HandModel& hand,
                                                                const TargetContacts& targets) {
  std::map<std::optional<int>, std::vector<Look>> looks;
  for (std::size_t t = 0; t < targets.contacts.size(); ++t) {
    const int finger = targets.contacts[t].finger;
    if (finger == contact::kPalm) continue;
    std::optional<int> leader = hand.fingers[finger].swing_joint;
    if (leader) leader = hands::leader_of(hand, *leader);
    looks[leader].push_back({finger, static_cast<int>(t)});
  }
  return looks;
}

}  // namespace

double azimuth_error(const Vector3d& from, const Vector3d& to, const Vector3d& axis) {
  const Vector3d a = from - from.dot(axis) * axis;
  const Vector3d b = to - to.dot(axis) * axis;
  if (a.norm() < 1e-9 || b.norm() < 1e-9) return 0.0;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

RigidTransform turned(const RigidTransform& X_OH, const Vector3d& pivot, const Vector3d& axis,
                      double angle) {
  RigidTransform turn = RigidTransform::Identity();
  turn.translate(pivot);
  turn.rotate(Eigen::AngleAxisd(angle, axis));
  turn.translate(-pivot);
  RigidTransform result = turn * X_OH;
  // Many small turns must not let the rotation drift.
  result.linear() = Eigen::Quaterniond(result.linear()).normalized().toRotationMatrix();
  return result;
}

Eigen::VectorXd aligned_swing(const hands::HandModel& hand,
                              const hands::HandConfiguration& configuration,
                              const TargetContacts& targets) {
  Eigen::VectorXd q = configuration.q;
  for (const auto& [leader, looks] : looks_by_leader(hand, targets)) {
    if (leader) q[*leader] = best_swing(hand, configuration, targets, *leader, looks).position;
  }
  hands::apply_couplings(hand, q);
  return q;
}

bool is_one_sided(const hands::HandModel& hand) {
  const hands::HandConfiguration open = hands::open_configuration(hand);
  const std::vector<RigidTransform> X_HL = hands::forward_kinematics(hand, open);
  const Vector3d& axis = hand.palm.direction_H;
  const Vector3d zero_azimuth = axis.unitOrthogonal();
  std::vector<double> azimuths;
  for (const hands::Finger& finger : hand.fingers) {
    if (finger.tip_pad < 0) continue;
    const Vector3d tip = hands::pad_contact_point(hand, finger.tip_pad, X_HL);
    azimuths.push_back(azimuth_error(zero_azimuth, tip - hand.palm.center_H, axis));
  }
  if (azimuths.empty()) return false;
  std::sort(azimuths.begin(), azimuths.end());
  double gap = azimuths.front() + 2.0 * kPi - azimuths.back();
  for (std::size_t i = 1; i < azimuths.size(); ++i) {
    gap = std::max(gap, azimuths[i] - azimuths[i - 1]);
  }
  // Opposite jaws leave half a turn on either side, up to the rounding of the description.
  constexpr double kRounding = 1e-6;  // [rad]
  return gap > kPi + kRounding;
}

Vector3d turning_point(const hands::HandModel& hand, bool is_hand_one_sided,
                       const std::vector<RigidTransform>& X_OL, const TargetContacts& targets) {
  const RigidTransform& X_OH = X_OL[hand.palm.link];
  const Vector3d palm_center = X_OH * hand.palm.center_H;
  if (!is_hand_one_sided) return palm_center;
  Vector3d to_tips = Vector3d::Zero();
  int num_fingers = 0;
  for (const TargetContact& target : targets.contacts) {
    if (target.finger == contact::kPalm) return palm_center;
    to_tips +=
        hands::pad_contact_point(hand, hand.fingers[target.finger].tip_pad, X_OL) - palm_center;
    ++num_fingers;
  }
  to_tips /= num_fingers;
  const Vector3d axis = (X_OH.linear() * hand.palm.direction_H).normalized();
  return palm_center + to_tips - to_tips.dot(axis) * axis;
}

std::optional<int> closing_joint(const hands::HandModel& hand, const hands::Finger& finger) {
  std::optional<int> leader;
  for (const int joint : finger.joints) {
    const hands::Joint& description = hand.joints[joint];
    if (description.closing_sign == 0) continue;
    if (!description.coupling) return joint;
    if (!leader) leader = description.coupling->leader;
  }
  return leader;
}

std::vector<int> distal_joints(const hands::HandModel& hand, const hands::Finger& finger) {
  std::vector<int> joints;
  for (const int joint : finger.joints) {
    const hands::Joint& description = hand.joints[joint];
    const bool closes_alone = description.closing_sign != 0 && !description.coupling;
    if (closes_alone && joint != closing_joint(hand, finger)) joints.push_back(joint);
  }
  return joints;
}

double distal_change(const hands::HandModel& hand, const std::vector<RigidTransform>& X_OL,
                     int joint, const TargetContact& target) {
  const hands::Joint& description = hand.joints[joint];
  const Vector3d pad_normal =
      hands::pad_pose(hand, hand.fingers[target.finger].tip_pad, X_OL).linear() * Vector3d::UnitZ();
  const Vector3d axis =
      X_OL[description.parent_link].linear() * (description.X_PJ.linear() * description.axis_J);
  return azimuth_error(pad_normal, -target.outward_normal_O, axis.normalized());
}

hands::HandConfiguration aligned_open_hand(const hands::HandModel& hand,
                                           const TargetContacts& targets,
                                           const PalmPlacement& placement, double distance) {
  const Vector3d direction = placement.direction_O.normalized();
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  configuration.X_OH.linear() =
      Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, direction).toRotationMatrix();
  std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  const bool has_palm = targets.contacts.back().finger == contact::kPalm;
  const Vector3d pivot =
      (has_palm ? targets.contacts.back().point_O : targets.centroid()) - distance * direction;
  configuration.X_OH.pretranslate(
      Vector3d(pivot - turning_point(hand, is_one_sided(hand), X_OL, targets)));
  const TargetContact& seed = targets.contacts.front();
  X_OL = hands::forward_kinematics(hand, configuration);
  const Vector3d tip = hands::pad_contact_point(hand, hand.fingers[seed.finger].tip_pad, X_OL);
  const double angle = azimuth_error(tip - pivot, seed.point_O - pivot, direction);
  configuration.X_OH = turned(configuration.X_OH, pivot, direction, angle + placement.turn);
  configuration.q = aligned_swing(hand, configuration, targets);
  return configuration;
}

TargetContacts assign_fingers(const hands::HandModel& hand, const TargetContacts& targets,
                              const RequestedParts& parts, const PalmPlacement& placement) {
  if (parts.size() != static_cast<int>(targets.contacts.size())) {
    throw base::InvalidInput("assign_fingers: " + std::to_string(parts.size()) + " parts for " +
                             std::to_string(targets.contacts.size()) + " targets");
  }
  if (parts.palm != (targets.contacts.back().finger == contact::kPalm)) {
    throw base::InvalidInput(
        "assign_fingers: the palm's target must be there exactly if the palm is asked for, and be "
        "the last one");
  }
  TargetContacts assigned = targets;
  std::vector<int> order = parts.fingers;
  std::sort(order.begin() + 1, order.end());
  const auto assign = [&] {
    for (std::size_t t = 0; t < order.size(); ++t) assigned.contacts[t].finger = order[t];
  };
  assign();
  // Where the hand stands depends on the seed and on which fingers there are, not on who serves
  // what; and a finger's error on its own group's targets alone.
  const hands::HandConfiguration start =
      aligned_open_hand(hand, assigned, placement, hands::largest_reach(hand));
  std::map<std::vector<Look>, double> known;
  const auto error_of = [&](std::optional<int> leader, std::vector<Look> looks) {
    if (const auto found = known.find(looks); found != known.end()) return found->second;
    double error = 0.0;
    hands::HandConfiguration swung = start;
    if (leader) {
      swung.q[*leader] = best_swing(hand, start, assigned, *leader, looks).position;
      hands::apply_couplings(hand, swung.q);
    }
    for (const Look& look : looks) {
      if (look.target == 0) continue;  // the hand was turned to the seed
      const double e =
          AzimuthOfFinger(hand, look.finger).error(swung, assigned.contacts[look.target].point_O);
      error += e * e;
    }
    known[std::move(looks)] = error;
    return error;
  };
  std::vector<int> best = order;
  double best_error = std::numeric_limits<double>::infinity();
  do {
    assign();
    double error = 0.0;
    for (const auto& [leader, looks] : looks_by_leader(hand, assigned)) {
      error += error_of(leader, looks);
    }
    if (error < best_error) {
      best_error = error;
      best = order;
    }
  } while (std::next_permutation(order.begin() + 1, order.end()));
  order = best;
  assign();
  return assigned;
}

}  // namespace graspfit::grasp
