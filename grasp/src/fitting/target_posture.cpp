#include "fitting/target_posture.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fitting/finger_alignment.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/angle.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::RigidTransform;

// A centimeter off counts as a pad that leans by 1 / 1.5 rad: then both limit a grasp alike.
constexpr double kMissUnit = 0.01;    // [m]
constexpr double kTiltWeight = 1.5;   // per unit length of the difference of two unit normals
constexpr double kRestWeight = 0.04;  // per share of a joint's range off its start: decides what
                                      // targets leave open, and little else
// Weight of pads that do not face each other, relative to pads that lean. Valid of 30 attempts with
// 0, 1, 2: bunny00 28, 29, 30; ball 28, 28, 30; horse 11, 11, 14; but 2 costs M (README).
constexpr double kPairWeight = 0.5;
// More iterations and a smaller gain bring fingertips nearer to their targets, at a forward
// kinematics with Jacobian each; the posture is the start of fitting, no result.
constexpr int kIterations = 20;
constexpr double kSmallGain = 1e-3;  // of the squared error, at which the search ends

/// Fraction of the way to closed from which the search starts.
constexpr double kStartClosed = 0.45;

/// One fingertip with a target.
struct Tip {
  int pad = 0;
  Vector3d contact_C = Vector3d::Zero();
  std::vector<int> links;   ///< Root to the pad's link.
  std::vector<int> joints;  ///< Joints between these links.
  const TargetContact* target = nullptr;
};

/// The search: variables are three translations of the palm, its turn, and independent joints.
class Search {
 public:
  Search(const hands::HandModel& hand, const TargetContacts& targets,
         const hands::HandConfiguration& start, const std::optional<double>& palm_distance)
      : hand_(hand),
        direction_((start.X_OH.linear() * hand.palm.direction_H).normalized()),
        centroid_(targets.centroid()),
        wanted_distance_(palm_distance),
        variable_of_(hand.joints.size()),
        start_(start) {
    for (const TargetContact& target : targets.contacts) {
      if (target.is_palm) {
        palm_target_ = &target;
        continue;
      }
      const int pad = *hand.fingers[*target.finger].tip_pad;
      tips_.push_back({pad, hands::pad_contact_point_C(hand.pads[pad]),
                       hands::links_to(hand, hand.pads[pad].link),
                       hands::joints_to(hand, hand.pads[pad].link), &target});
      for (const int joint : tips_.back().joints) {
        const int leader = hands::leader_of(hand, joint);
        if (variable_of_[leader] || hand.joints[leader].upper <= hand.joints[leader].lower) {
          continue;
        }
        variable_of_[leader] = base::as_index<int>(4 + joints_.size());
        joints_.push_back(leader);
      }
    }
    num_residuals_ = base::as_index<int>(6 * tips_.size() + 3 + 1 + joints_.size());
  }

  TargetPosture run() const {
    Evaluated best = evaluated(start_);
    MatrixXd jacobian = jacobian_at(best);
    double error = best.residual.squaredNorm();
    double damping = 1e-3;
    for (int iteration = 0; iteration < kIterations && damping < 1e3; ++iteration) {
      Evaluated trial = evaluated(moved(best.at, bounded_step(best, jacobian, damping)));
      const double trial_error = trial.residual.squaredNorm();
      if (!(trial_error < error)) {
        damping *= 8.0;
        continue;
      }
      const bool is_done = error - trial_error < kSmallGain * error;
      best = std::move(trial);
      error = trial_error;
      damping = std::max(damping / 8.0, 1e-6);
      if (is_done) break;
      jacobian = jacobian_at(best);
    }
    return measured(best);
  }

 private:
  /// A configuration, and how far it is from what is wanted.
  struct Evaluated {
    hands::HandConfiguration at;
    std::vector<RigidTransform> X_OL;  ///< Of the links that a tip hangs on; others are not set.
    VectorXd residual;
  };

  hands::HandConfiguration moved(const hands::HandConfiguration& from, const VectorXd& step) const {
    hands::HandConfiguration result = start_;
    result.X_OH = turned(from.X_OH, from.X_OH * hand_.palm.center_H, direction_, step[3]);
    result.X_OH.pretranslate(Vector3d(step.head<3>() * kMissUnit));
    for (const int joint : joints_) {
      result.q[joint] = std::clamp(from.q[joint] + step[*variable_of_[joint]],
                                   hand_.joints[joint].lower, hand_.joints[joint].upper);
    }
    hands::apply_couplings(hand_, result.q);
    return result;
  }

  /// Damped least squares; joints that stand at a limit and would leave it are held.
  VectorXd bounded_step(const Evaluated& from, const MatrixXd& jacobian, double damping) const {
    MatrixXd normal = jacobian.transpose() * jacobian;
    VectorXd gradient = jacobian.transpose() * from.residual;
    for (const int joint : joints_) {
      const int i = *variable_of_[joint];
      const double q = from.at.q[joint];
      const bool is_held = (q <= hand_.joints[joint].lower && gradient[i] > 0.0) ||
                           (q >= hand_.joints[joint].upper && gradient[i] < 0.0);
      if (!is_held) continue;
      normal.row(i).setZero();
      normal.col(i).setZero();
      normal(i, i) = 1.0;
      gradient[i] = 0.0;
    }
    normal.diagonal().array() += damping;
    return -normal.ldlt().solve(gradient);
  }

  Evaluated evaluated(const hands::HandConfiguration& at) const {
    Evaluated result{at, std::vector<RigidTransform>(hand_.links.size()),
                     VectorXd::Zero(num_residuals_)};
    VectorXd& residual = result.residual;
    int row = 0;
    for (const Tip& tip : tips_) {
      for (const int link : tip.links) {
        result.X_OL[link] = hands::link_pose(hand_, link, result.X_OL, at);
      }
      const auto [point, normal] = contact_of(tip, result.X_OL);
      residual.segment<3>(row) = (point - tip.target->point_O) / kMissUnit;
      residual.segment<3>(row + 3) = kTiltWeight * (normal + tip.target->outward_normal_O);
      row += 6;
    }
    const Vector3d palm = at.X_OH * hand_.palm.center_H;
    if (palm_target_) residual.segment<3>(row) = (palm - palm_target_->point_O) / kMissUnit;
    row += 3;
    if (const std::optional<double> distance = distance_below_wanted(palm)) {
      residual[row] = (*wanted_distance_ - *distance) / kMissUnit;
    }
    ++row;
    for (const int joint : joints_) {
      residual[row] = kRestWeight * (at.q[joint] - start_.q[joint]) / range(joint);
      ++row;
    }
    return result;
  }

  /// The derivative of the residual over the variables.
  MatrixXd jacobian_at(const Evaluated& from) const {
    MatrixXd jacobian = MatrixXd::Zero(num_residuals_, 4 + std::ssize(joints_));
    int row = 0;
    const Vector3d palm = from.at.X_OH * hand_.palm.center_H;
    for (const Tip& tip : tips_) {
      const auto [point, normal] = contact_of(tip, from.X_OL);
      jacobian.block<3, 3>(row, 0).setIdentity();
      jacobian.block<3, 1>(row, 3) = direction_.cross(point - palm) / kMissUnit;
      jacobian.block<3, 1>(row + 3, 3) = kTiltWeight * direction_.cross(normal);
      for (const int joint : tip.joints) {
        const std::optional<int> column = variable_of_[hands::leader_of(hand_, joint)];
        const double ratio =
            hands::ratio_to_leader(hand_, joint, from.at.q, hands::Followers::BetweenLimits);
        if (!column || ratio == 0.0) continue;
        const hands::Joint& driven = hand_.joints[joint];
        const hands::JointVelocity velocity =
            hands::joint_velocity(driven, from.X_OL[driven.parent_link] * driven.X_PJ, point);
        jacobian.block<3, 1>(row, *column) += ratio * velocity.linear / kMissUnit;
        jacobian.block<3, 1>(row + 3, *column) +=
            ratio * kTiltWeight * velocity.angular.cross(normal);
      }
      row += 6;
    }
    if (palm_target_) jacobian.block<3, 3>(row, 0).setIdentity();
    row += 3;
    if (distance_below_wanted(palm)) jacobian.block<1, 3>(row, 0) = direction_.transpose();
    ++row;
    for (const int joint : joints_) {
      jacobian(row, *variable_of_[joint]) = kRestWeight / range(joint);
      ++row;
    }
    return jacobian;
  }

  /// Where a pad is to touch.
  struct TipContact {
    Vector3d point_O;
    Vector3d normal_O;  ///< Of the pad, outward.
  };
  TipContact contact_of(const Tip& tip, const std::vector<RigidTransform>& X_OL) const {
    const RigidTransform X_OC = X_OL[tip.links.back()] * hand_.pads[tip.pad].X_LC;
    return {X_OC * tip.contact_C, X_OC.linear().col(2)};
  }

  /// Distance of the palm from the targets along its direction [m], where it is less than wanted.
  std::optional<double> distance_below_wanted(const Vector3d& palm_O) const {
    const double distance = (centroid_ - palm_O).dot(direction_);
    if (!wanted_distance_ || !(distance < *wanted_distance_)) return std::nullopt;
    return distance;
  }

  /// [rad or m]
  double range(int joint) const { return hand_.joints[joint].upper - hand_.joints[joint].lower; }

  TargetPosture measured(const Evaluated& best) const {
    TargetPosture result;
    result.configuration = best.at;
    const VectorXd& residual = best.residual;
    for (Eigen::Index i = 0; i < std::ssize(tips_); ++i) {
      const Eigen::Index row = 6 * i;
      result.largest_miss =
          std::max(result.largest_miss, residual.segment<3>(row).norm() * kMissUnit);
      const double chord = residual.segment<3>(row + 3).norm() / kTiltWeight;
      result.largest_tilt =
          std::max(result.largest_tilt, 2.0 * std::asin(std::min(1.0, chord / 2.0)));
    }
    if (palm_target_) {
      const Eigen::Index row = 6 * std::ssize(tips_);
      result.largest_miss =
          std::max(result.largest_miss, residual.segment<3>(row).norm() * kMissUnit);
    }
    return result;
  }

  const hands::HandModel& hand_;
  const Vector3d direction_;
  const Vector3d centroid_;
  const std::optional<double> wanted_distance_;
  std::vector<Tip> tips_;
  const TargetContact* palm_target_ = nullptr;
  std::vector<int> joints_;                      ///< Independent joints that move a tip.
  std::vector<std::optional<int>> variable_of_;  ///< Per joint; empty if it is none.
  hands::HandConfiguration start_;
  int num_residuals_ = 0;
};

}  // namespace

TargetPosture posture_for(const hands::HandModel& hand, const TargetContacts& targets,
                          const PalmPlacement& placement) {
  hands::HandConfiguration start = aligned_open_hand(hand, targets, placement, 0.0);
  for (const TargetContact& target : targets.contacts) {
    if (target.is_palm) continue;
    for (const int index : hand.fingers[*target.finger].joints) {
      const hands::Joint& joint = hand.joints[index];
      if (joint.closing_sign == 0 || joint.coupling) continue;
      const double open = joint.open_limit();
      start.q[index] = open + kStartClosed * (joint.closed_limit() - open);
    }
  }
  hands::apply_couplings(hand, start.q);
  // Moves the mean of the fingertips (and the palm) onto the mean of their targets: step 2, all at
  // once.
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, start);
  Vector3d shift = Vector3d::Zero();
  int count = 0;
  for (const TargetContact& target : targets.contacts) {
    shift += target.point_O -
             (target.is_palm
                  ? Vector3d(start.X_OH * hand.palm.center_H)
                  : hands::pad_contact_point(hand, *hand.fingers[*target.finger].tip_pad, X_OL));
    ++count;
  }
  start.X_OH.pretranslate(Vector3d(shift / count));
  return Search(hand, targets, start, placement.palm_distance).run();
}

namespace {

/// Adds the distances by which fingertips miss to the angles by which pads lean, at the same rate
/// as in the search.
double tilt_and_miss(const TargetPosture& posture) {
  return posture.largest_tilt + posture.largest_miss / (kTiltWeight * kMissUnit);
}

/// The larger of the two angles between the line from one pad to another and the pads' normals
/// [rad].
double pair_angle(const Vector3d& point_a, const Vector3d& normal_a, const Vector3d& point_b,
                  const Vector3d& normal_b) {
  const Vector3d line = point_b - point_a;
  return std::max(geometry::angle_between(normal_a, line),
                  geometry::angle_between(normal_b, -line));
}

}  // namespace

double reach_misfit(const hands::HandModel& hand, const TargetContacts& targets,
                    const TargetPosture& posture) {
  if (targets.contacts.back().is_palm) return tilt_and_miss(posture);
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, posture.configuration);
  const auto pad_of = [&](const TargetContact& target) {
    const int pad = *hand.fingers[*target.finger].tip_pad;
    return std::make_pair(hands::pad_contact_point(hand, pad, X_OL),
                          Vector3d(hands::pad_pose(hand, pad, X_OL).linear().col(2)));
  };
  const auto [seed_point, seed_normal] = pad_of(targets.contacts.front());
  double sum = 0.0;
  for (std::size_t t = 1; t < targets.contacts.size(); ++t) {
    const auto [point, normal] = pad_of(targets.contacts[t]);
    sum += pair_angle(seed_point, seed_normal, point, normal);
  }
  return tilt_and_miss(posture) +
         kPairWeight * sum / static_cast<double>(targets.contacts.size() - 1);
}

}  // namespace graspfit::grasp::internal
