#include "internal/finger_alignment.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp {

using Eigen::Vector3d;
using geometry::RigidTransform;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Azimuth error of one assigned finger around its own swing axis's origin, or around the palm
/// center where it does not swing.
double finger_error(const hands::HandModel& hand, const hands::HandConfiguration& configuration,
                    const std::vector<RigidTransform>& X_OL, const TargetContact& target) {
  const hands::Finger& finger = hand.fingers[target.finger];
  Vector3d pivot = configuration.X_OH * hand.palm.center_H;
  if (finger.swing_joint) {
    const hands::Joint& joint = hand.joints[*finger.swing_joint];
    pivot = (X_OL[joint.parent_link] * joint.X_PJ).translation();
  }
  const Vector3d tip = hands::pad_contact_point(hand, finger.tip_pad, X_OL);
  const Vector3d axis = (configuration.X_OH.linear() * hand.palm.direction_H).normalized();
  return azimuth_error(tip - pivot, target.point_O - pivot, axis);
}

/// The independent joint behind a swing joint.
int leader_of(const hands::HandModel& hand, int joint) {
  while (hand.joints[joint].coupling) joint = hand.joints[joint].coupling->leader;
  return joint;
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
  constexpr int kCoarse =
      18;  // samples of the range; the error has one minimum per turn of a finger
  constexpr int kRefine = 20;  // golden-section steps: the range shrinks by 0.618 each
  constexpr double kGolden = 0.61803398874989485;
  hands::HandConfiguration trial = configuration;
  std::vector<int> leaders;
  for (const TargetContact& target : targets.contacts) {
    const hands::Finger& finger = hand.fingers[target.finger];
    if (!finger.swing_joint) continue;
    const int leader = leader_of(hand, *finger.swing_joint);
    if (std::find(leaders.begin(), leaders.end(), leader) == leaders.end()) {
      leaders.push_back(leader);
    }
  }
  for (const int leader : leaders) {
    const auto error_at = [&](double position) {
      trial.q[leader] = position;
      hands::apply_couplings(hand, trial.q);
      const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, trial);
      double sum = 0.0;
      for (const TargetContact& target : targets.contacts) {
        const hands::Finger& finger = hand.fingers[target.finger];
        if (!finger.swing_joint || leader_of(hand, *finger.swing_joint) != leader) continue;
        const double error = finger_error(hand, trial, X_OL, target);
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
    error_at(0.5 * (a + b));  // leaves the joint there
  }
  return trial.q;
}

double swing_error(const hands::HandModel& hand, const hands::HandConfiguration& configuration,
                   const TargetContacts& targets) {
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  double sum = 0.0;
  for (std::size_t t = 1; t < targets.contacts.size(); ++t) {
    const double error = finger_error(hand, configuration, X_OL, targets.contacts[t]);
    sum += error * error;
  }
  return sum;
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
  for (const TargetContact& target : targets.contacts) {
    to_tips +=
        hands::pad_contact_point(hand, hand.fingers[target.finger].tip_pad, X_OL) - palm_center;
  }
  to_tips /= static_cast<double>(targets.contacts.size());
  const Vector3d axis = (X_OH.linear() * hand.palm.direction_H).normalized();
  return palm_center + to_tips - to_tips.dot(axis) * axis;
}

int closing_joint(const hands::HandModel& hand, const hands::Finger& finger) {
  int leader = -1;
  for (const int joint : finger.joints) {
    const hands::Joint& description = hand.joints[joint];
    if (description.closing_sign == 0) continue;
    if (!description.coupling) return joint;
    if (leader < 0) leader = description.coupling->leader;
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
                                           const Vector3d& direction_O, double distance) {
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  configuration.X_OH.linear() =
      Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, direction_O).toRotationMatrix();
  std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  const Vector3d pivot = targets.centroid() - distance * direction_O;
  configuration.X_OH.pretranslate(pivot - turning_point(hand, is_one_sided(hand), X_OL, targets));
  const TargetContact& seed = targets.contacts.front();
  X_OL = hands::forward_kinematics(hand, configuration);
  const Vector3d tip = hands::pad_contact_point(hand, hand.fingers[seed.finger].tip_pad, X_OL);
  const double angle = azimuth_error(tip - pivot, seed.point_O - pivot, direction_O);
  configuration.X_OH = turned(configuration.X_OH, pivot, direction_O, angle);
  configuration.q = aligned_swing(hand, configuration, targets);
  return configuration;
}

TargetContacts assign_fingers(const hands::HandModel& hand, const TargetContacts& targets,
                              const RequestedParts& parts, const PalmPlacement& placement) {
  const std::vector<int>& fingers = parts.fingers;
  if (fingers.size() != targets.contacts.size()) {
    throw geometry::InvalidInput("assign_fingers: " + std::to_string(fingers.size()) +
                                 " fingers for " + std::to_string(targets.contacts.size()) +
                                 " targets");
  }
  TargetContacts best;
  double best_error = std::numeric_limits<double>::infinity();
  std::vector<int> order(fingers.begin() + 1, fingers.end());
  std::sort(order.begin(), order.end());
  do {
    TargetContacts assigned = targets;
    assigned.contacts.front().finger = fingers.front();
    for (std::size_t t = 0; t < order.size(); ++t) assigned.contacts[t + 1].finger = order[t];
    const hands::HandConfiguration start = aligned_open_hand(
        hand, assigned, placement.direction_O.normalized(), hands::largest_reach(hand));
    const double error = swing_error(hand, start, assigned);
    if (error < best_error) {
      best_error = error;
      best = std::move(assigned);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

double pad_tilt(const hands::HandModel& hand, const TargetContacts& targets,
                const PalmPlacement& placement) {
  constexpr int kSamples = 24;  // of each closing joint: 6 degrees for a finger that turns by 140
  const Vector3d direction = placement.direction_O.normalized();
  const hands::HandConfiguration start =
      aligned_open_hand(hand, targets, direction, hands::largest_reach(hand));
  const Vector3d center =
      turning_point(hand, is_one_sided(hand), hands::forward_kinematics(hand, start), targets);
  double largest = 0.0;
  for (const TargetContact& target : targets.contacts) {
    const hands::Finger& finger = hand.fingers[target.finger];
    const int closing = closing_joint(hand, finger);
    if (closing < 0) continue;
    const std::vector<int> distal = distal_joints(hand, finger);
    const hands::Joint& joint = hand.joints[closing];
    const double open = joint.closing_sign > 0 ? joint.lower : joint.upper;
    const double closed = joint.closing_sign > 0 ? joint.upper : joint.lower;
    hands::HandConfiguration trial = start;
    const auto links_at = [&](double share) {
      trial.q = start.q;  // a breakaway joint must not keep the position of a more closed sample
      trial.q[closing] = open + share * (closed - open);
      hands::apply_couplings(hand, trial.q);
      std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, trial);
      for (const int other : distal) {  // as step 5 of the loop will
        trial.q[other] = std::clamp(trial.q[other] + distal_change(hand, X_OL, other, target),
                                    hand.joints[other].lower, hand.joints[other].upper);
        hands::apply_couplings(hand, trial.q);
        X_OL = hands::forward_kinematics(hand, trial);
      }
      return X_OL;
    };
    const auto tip_at = [&](double share) {
      return hands::pad_contact_point(hand, finger.tip_pad, links_at(share));
    };
    // Along the direction in which the open finger looks, so that a pad beyond the axis counts as
    // closer.
    Vector3d outward =
        hands::pad_contact_point(hand, finger.tip_pad, hands::forward_kinematics(hand, start)) -
        center;
    outward -= outward.dot(direction) * direction;
    outward.normalize();
    const auto distance_from_axis = [&](const Vector3d& point) {
      return (point - center).dot(outward);
    };
    const double wanted = distance_from_axis(target.point_O);
    double before = 0.0;
    double excess_before = distance_from_axis(tip_at(0.0)) - wanted;
    double share = 0.0;
    for (int sample = 1; sample <= kSamples && excess_before > 0.0; ++sample) {
      share = static_cast<double>(sample) / kSamples;
      const double excess = distance_from_axis(tip_at(share)) - wanted;
      if (excess <= 0.0) {
        share = before + (share - before) * excess_before / (excess_before - excess);
        break;
      }
      before = share;
      excess_before = excess;
    }
    const Vector3d pad_normal =
        hands::pad_pose(hand, finger.tip_pad, links_at(share)).linear() * Vector3d::UnitZ();
    const Vector3d inward = -target.outward_normal_O;
    largest =
        std::max(largest, std::atan2(pad_normal.cross(inward).norm(), pad_normal.dot(inward)));
  }
  return largest;
}

std::vector<PalmPlacement> palm_placements(const ObjectModel& object, const TargetContacts& targets,
                                           const std::optional<Vector3d>& approach_O) {
  constexpr int kDirectionsAroundAxis = 16;  // for two targets (A23)
  const Vector3d center = targets.centroid();
  std::vector<Vector3d> directions;
  if (targets.contacts.size() == 2) {
    const Vector3d axis = (targets.contacts[1].point_O - targets.contacts[0].point_O).normalized();
    const Vector3d first = axis.unitOrthogonal();
    for (int k = 0; k < kDirectionsAroundAxis; ++k) {
      directions.push_back(Eigen::AngleAxisd(2.0 * kPi * k / kDirectionsAroundAxis, axis) * first);
    }
  } else {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const TargetContact& target : targets.contacts) {
      spread += (target.point_O - center) * (target.point_O - center).transpose();
    }
    // The eigenvalues come in increasing order: the first vector is the plane's normal.
    const Vector3d normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0).normalized();
    directions = {normal, -normal};
  }
  if (approach_O) {
    std::erase_if(directions, [&](const Vector3d& d) { return d.dot(*approach_O) <= 0.0; });
    std::stable_sort(directions.begin(), directions.end(),
                     [&](const Vector3d& a, const Vector3d& b) {
                       return a.dot(*approach_O) > b.dot(*approach_O);
                     });
  } else {
    // The palm stands where the object sticks out least from the targets' plane.
    const auto extent = [&](const Vector3d& direction) {
      double largest = 0.0;
      for (const Vector3d& vertex : object.mesh().vertices) {
        largest = std::max(largest, (center - vertex).dot(direction));
      }
      return largest;
    };
    std::vector<std::pair<double, Vector3d>> ranked;
    for (const Vector3d& direction : directions) ranked.emplace_back(extent(direction), direction);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::transform(ranked.begin(), ranked.end(), directions.begin(),
                   [](const auto& entry) { return entry.second; });
  }
  std::vector<PalmPlacement> placements;
  for (const Vector3d& direction : directions) placements.push_back({direction});
  return placements;
}

}  // namespace graspfit::grasp
