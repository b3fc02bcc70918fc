#include "hold_run.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/hands/jacobian.hpp"

namespace graspfit::hold_test::internal {

using geometry::RigidTransform;
using hands::HandConfiguration;

namespace {

std::vector<bool> following_joints(const hands::HandModel& hand, const Eigen::VectorXd& q) {
  std::vector<bool> follows(hand.joints.size(), false);
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const auto& coupling = hand.joints[j].coupling;
    if (!coupling) continue;
    follows[j] =
        !coupling->breakaway || hands::follows_leader(hand, j, q, hands::Followers::InPlace);
  }
  return follows;
}

std::string millimeters(double length) {
  std::array<char, 32> text{};
  // Tenths of a millimeter as integers: the decimal point of the C library follows the locale.
  const auto tenths =
      base::bounded_integer<std::int64_t>(std::round(length * 1e4), 0, 1'000'000'000'000'000);
  std::snprintf(text.data(), text.size(), "%" PRId64 ".%" PRId64 " mm", tenths / 10, tenths % 10);
  return text.data();
}

void require_size(const hands::HandModel& hand, const HandConfiguration& configuration,
                  const char* what) {
  if (configuration.q.size() == std::ssize(hand.joints) && configuration.q.allFinite() &&
      configuration.X_OH.matrix().allFinite()) {
    return;
  }
  throw base::InvalidInput(std::string("HoldTest: the ") + what + " has " +
                           std::to_string(configuration.q.size()) +
                           " joint positions or numbers that are not finite; hand " + hand.name +
                           " has " + std::to_string(hand.joints.size()) + " joints");
}

/// The hand with each joint that opens and closes it moved by `share` of its way to that limit, the
/// others as they are and followers with their leaders.
HandConfiguration toward_limits(const hands::HandModel& hand, HandConfiguration at,
                                double (hands::Joint::*limit)() const, double share) {
  for (const int j : hands::independent_joints(hand)) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.closing_sign != 0) at.q[j] += share * ((joint.*limit)() - at.q[j]);
  }
  hands::apply_couplings(hand, at.q);
  return at;
}

}  // namespace

int HoldRun::num_steps(double duration) const {
  return base::bounded_integer(std::round(duration / protocol_.step), 1,
                               std::numeric_limits<int>::max());
}

RigidTransform HoldRun::X_HB() const {
  return geometry::relative_pose(physics_.hand().X_OH, physics_.X_OB());
}

HoldRun::Motion HoldRun::motion(const RigidTransform& before, const RigidTransform& now) const {
  const Eigen::Vector3d& center = object_.center_of_mass_O;
  const Eigen::Quaterniond turn(before.linear().transpose() * now.linear());
  return {(now * center - before * center).norm(),
          2.0 * std::acos(std::min(1.0, std::abs(turn.w())))};
}

bool HoldRun::is_lost(const Motion& motion) const {
  return motion.shift >= protocol_.largest_shift || motion.turn >= protocol_.largest_turn;
}

bool HoldRun::step(const Watch& watch) {
  failure_ = physics_.step();
  if (!failure_.empty()) return false;
  if (watch) watch();
  return true;
}

HoldRun::Ends HoldRun::ends_of(const grasp::Grasp& grasp) const {
  const HandConfiguration& at_grasp = grasp.configuration;
  if (protocol_.squeeze == SqueezeRule::Limits) {
    return {toward_limits(hand_, at_grasp, &hands::Joint::open_limit, protocol_.opening_share),
            toward_limits(hand_, at_grasp, &hands::Joint::closed_limit, protocol_.closing_share)};
  }
  Ends ends{grasp.pre_grasp->configuration, at_grasp};
  if (protocol_.squeeze == SqueezeRule::Forces) ends.squeeze.q = grasp.squeeze->configuration.q;
  if (protocol_.squeeze == SqueezeRule::Extrapolation) {
    ends.squeeze.q += protocol_.extrapolation * (at_grasp.q - ends.start.q);
    hands::clamp_to_limits(hand_, ends.squeeze.q);
  }
  return ends;
}

std::string HoldRun::rejection(const grasp::Grasp& grasp) const {
  require_size(hand_, grasp.configuration, "grasp");
  if (protocol_.squeeze == SqueezeRule::Limits) return {};
  if (!grasp.pre_grasp) return "no pre-grasp";
  require_size(hand_, grasp.pre_grasp->configuration, "pre-grasp");
  if (protocol_.squeeze == SqueezeRule::Forces) {
    if (!grasp.squeeze) return "no squeeze";
    require_size(hand_, grasp.squeeze->configuration, "squeeze");
  }
  return {};
}

/// Puts the hand at its start and says what is too deep in what; empty if nothing is. `q` are the
/// joints of the grasp.
std::string HoldRun::overlap_at(const HandConfiguration& start, const Eigen::VectorXd& q) {
  physics_.reset(start, following_joints(hand_, q));
  const Physics::Overlap overlap = physics_.deepest_overlap();
  if (overlap.depth <= protocol_.largest_penetration) return {};
  const auto name = [&](int link) { return hand_.links[link].name; };
  return "at the pre-grasp " + name(overlap.link_a) + " is " + millimeters(overlap.depth) +
         " deep in " + (overlap.link_b ? name(*overlap.link_b) : "the object or table");
}

bool HoldRun::move(const HandConfiguration& from, const HandConfiguration& to, double duration,
                   HoldVerdict& verdict, const Watch& watch) {
  const int last = num_steps(duration);
  const int between_checks = num_steps(protocol_.check_interval);
  for (int i = 1; i <= last; ++i) {
    physics_.command(grasp::interpolated(from, to, static_cast<double>(i) / last));
    if (!step(watch)) return false;
    if (i % between_checks != 0 && i != last) continue;
    const Motion moved = motion(RigidTransform::Identity(), physics_.X_OB());
    verdict.approach_shift = std::max(verdict.approach_shift, moved.shift);
    verdict.approach_turn = std::max(verdict.approach_turn, moved.turn);
    if (is_lost(moved)) return false;
  }
  return true;
}

HoldVerdict HoldRun::approach(const grasp::Grasp& grasp, const Watch& watch, double load_share) {
  HoldVerdict verdict;
  failure_.clear();
  verdict.stage = HoldStage::Rejected;
  verdict.reason = rejection(grasp);
  if (!verdict.reason.empty()) return verdict;
  const auto [start, end] = ends_of(grasp);
  verdict.reason = overlap_at(start, grasp.configuration.q);
  if (!verdict.reason.empty()) return verdict;
  if (watch) watch();
  verdict.stage = HoldStage::Approach;
  if (protocol_.load == HoldLoad::Lift) {
    physics_.set_load({0.0, 0.0, -load_share * protocol_.gravity * protocol_.object_mass},
                      Eigen::Vector3d::Zero());
  }
  const bool is_there = move(start, grasp.configuration, protocol_.approach_time, verdict, watch) &&
                        move(grasp.configuration, end, protocol_.squeeze_time, verdict, watch);
  verdict.reason = failure_;
  if (!is_there) return verdict;
  verdict.stage = HoldStage::Held;
  verdict.squeeze_force = physics_.squeeze_force();
  squeezed_state_ = physics_.state();
  X_HB_squeezed_ = X_HB();
  return verdict;
}

DirectionVerdict HoldRun::load(const Eigen::Vector3d& direction_O, const Eigen::Vector3d& force_O,
                               const Eigen::Vector3d& torque_O, const Watch& watch) {
  const int lifted = protocol_.load == HoldLoad::Lift ? num_steps(protocol_.lift_time) : 0;
  const auto act = [&](int i, int) {
    if (i == 1) physics_.set_load(force_O, torque_O);
    if (i <= lifted) physics_.command_lift(protocol_.lift_height * i / lifted);
  };
  return hold(direction_O, act, watch);
}

DirectionVerdict HoldRun::load_in_turn(double force, const Watch& watch) {
  const auto act = [&](int i, int last) {
    constexpr int kNumTurns = 6;
    const int turn = static_cast<int>(std::int64_t{kNumTurns} * (i - 1) / last);
    const double sign = turn < 3 ? 1.0 : -1.0;
    physics_.set_load(sign * force * Eigen::Vector3d::Unit(turn % 3), Eigen::Vector3d::Zero());
  };
  return hold(Eigen::Vector3d::Zero(), act, watch);
}

DirectionVerdict HoldRun::hold(const Eigen::Vector3d& direction_O,
                               const std::function<void(int, int)>& act, const Watch& watch) {
  failure_.clear();
  physics_.restore(squeezed_state_);
  DirectionVerdict verdict;
  verdict.direction_O = direction_O;
  const int last = num_steps(protocol_.hold_time);
  const int between_checks = num_steps(protocol_.check_interval);
  for (int i = 1; i <= last; ++i) {
    act(i, last);
    const bool is_sound = step(watch);
    if (is_sound && i % between_checks != 0 && i != last) continue;
    const Motion moved = is_sound ? motion(X_HB_squeezed_, X_HB()) : Motion{};
    verdict.largest_shift = std::max(verdict.largest_shift, moved.shift);
    verdict.largest_turn = std::max(verdict.largest_turn, moved.turn);
    if (is_sound && !is_lost(moved)) continue;
    verdict.stage = HoldStage::Load;
    verdict.failed_at = i * protocol_.step;
    break;
  }
  return verdict;
}

}  // namespace graspfit::hold_test::internal
