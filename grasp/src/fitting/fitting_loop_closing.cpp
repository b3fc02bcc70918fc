// How a finger closes: which joint moves next, by how much, and what it can do when a finger on the
// same joint is stopped.

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/fitting_loop.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using geometry::RigidTransform;

/// Distance of the farthest point of `link` from the origin of `joint`, enlarged by what coupled
/// joints add: bounds the motion per radian [m/rad].
double FittingLoop::lever(int joint, int link) const {
  if (model_.joints[joint].type == hands::JointType::Prismatic) return 1.0;
  const std::vector<RigidTransform>& X_OL = state_.X_OL();
  const Vector3d origin =
      (X_OL[model_.joints[joint].parent_link] * model_.joints[joint].X_PJ).translation();
  const double reach = (X_OL[link].translation() - origin).norm() + hand_.samples(link).reach;
  double factor = 1.0;
  for (const hands::Joint& other : model_.joints) {
    if (other.coupling && other.coupling->leader == joint) {
      factor += std::abs(other.coupling->ratio);
    }
  }
  return std::max(reach * factor, 1e-6);
}

/// The largest lever of all links that `joint` moves.
double FittingLoop::lever(int joint) const {
  double largest = 1e-6;
  for (const int link : moved_links_[joint]) largest = std::max(largest, lever(joint, link));
  return largest;
}

/// How far `joint` may move now: every link no farther than its own distance allows.
double FittingLoop::allowed_step(int joint) const {
  double step = std::numeric_limits<double>::infinity();
  for (const int link : moved_links_[joint]) {
    step = std::min(step, state_.allowed_motion({link}) / lever(joint, link));
  }
  return step;
}

hands::HandConfiguration FittingLoop::with_joint(int joint, double position) const {
  hands::HandConfiguration candidate = state_.configuration();
  candidate.q[joint] = std::clamp(position, model_.joints[joint].lower, model_.joints[joint].upper);
  hands::apply_couplings(model_, candidate.q);
  return candidate;
}

bool FittingLoop::is_at_closing_limit(int joint) const {
  return state_.configuration().q[joint] == model_.joints[joint].closed_limit();
}

/// Step 1: closes one finger, as far as the guard allows.
void FittingLoop::close_part(Part& part) {
  if (part.is_toward_goal && close_toward_goal(part)) return;
  while (part.stage < part.closing.size() && is_at_closing_limit(part.closing[part.stage])) {
    ++part.stage;
  }
  if (part.stage >= part.closing.size()) {
    part.state = Part::State::AtLimit;
    return;
  }
  const int joint = part.closing[part.stage];
  double step = allowed_step(joint) * model_.joints[joint].closing_sign;
  for (int halving = 0; halving <= options_.max_halvings; ++halving, step /= 2) {
    if (try_closing(part, step)) return;
  }
  // A finger that is blocked at its tip has stopped; one that is blocked behind its tip goes on by
  // its more distal joints.
  const bool is_tip = state_.blocking_link() == part.tip_link;
  if (is_tip || !next_stage(part)) {
    part.state = touches(part) ? Part::State::Touching : Part::State::Blocked;
  }
}

/// Moves all joints of the finger at once toward the goal: steps 1, 4 and 5 in one. Returns false
/// once the finger has reached the goal or is stopped behind its tip; from then on it closes joint
/// by joint.
bool FittingLoop::close_toward_goal(Part& part) {
  const hands::HandConfiguration& now = state_.configuration();
  const std::vector<int>& moved = moved_links_[part.closing.front()];
  double length = 0.0;
  for (const int joint : part.closing) {
    if (!model_.joints[joint].coupling) {
      length += std::abs(goal_.q[joint] - now.q[joint]) * lever(joint);
    }
  }
  part.is_toward_goal = length > 1e-6;
  if (!part.is_toward_goal) return false;
  double share = std::min(1.0, state_.allowed_motion(moved) / length);
  for (int halving = 0; halving <= options_.max_halvings; ++halving, share /= 2) {
    hands::HandConfiguration candidate = now;
    for (const int joint : part.closing) {
      if (!model_.joints[joint].coupling) {
        candidate.q[joint] += share * (goal_.q[joint] - now.q[joint]);
      }
    }
    hands::apply_couplings(model_, candidate.q);
    if (try_move(candidate, moved, share * length)) return true;
  }
  part.is_toward_goal = false;
  if (state_.blocking_link() == part.tip_link) {
    part.state = touches(part) ? Part::State::Touching : Part::State::Blocked;
    return true;
  }
  return false;
}

/// Closes a joint by `step`. Where the joint closes several fingers and one of them is stopped, the
/// hand moves so that the stopped finger stays where it is and the others close by as much in all.
bool FittingLoop::try_closing(const Part& part, double step) {
  const int joint = part.closing[part.stage];
  const double length = std::abs(step) * lever(joint);
  const double position = state_.configuration().q[joint];
  if (try_move(with_joint(joint, position + step), moved_links_[joint], length)) return true;
  const Part* const stopped = stopped_part_sharing(joint);
  if (!stopped) return false;
  hands::HandConfiguration candidate = with_joint(joint, position + step / 2);
  const Vector3d moved_by = hands::pad_contact_point(model_, *stopped->pad,
                                                     hands::forward_kinematics(model_, candidate)) -
                            hands::pad_contact_point(model_, *stopped->pad, state_.X_OL());
  candidate.X_OH.pretranslate(Vector3d(-moved_by));
  return try_move(candidate, state_.all_links(), length / 2 + moved_by.norm());
}

/// The part that prevented the last motion, if its closing joint closes other parts, too.
const FittingLoop::Part* FittingLoop::stopped_part_sharing(int joint) const {
  const Part* stopped = nullptr;
  for (const Part& part : parts_) {
    if (!part.is_shared || part.closing.front() != joint) continue;
    const std::vector<int>& links = model_.fingers[part.finger].links;
    const std::optional<int> blocking = state_.blocking_link();
    const bool is_in_the_way = blocking
                                   ? std::find(links.begin(), links.end(), *blocking) != links.end()
                                   : part.state == Part::State::Touching;
    if (!stopped && is_in_the_way) stopped = &part;
  }
  return stopped;
}

/// Goes on to the next joint that does not move the blocking link. Returns false if there is none.
bool FittingLoop::next_stage(Part& part) {
  const std::optional<int> blocking = state_.blocking_link();
  while (++part.stage < part.closing.size()) {
    const std::vector<int>& moved = moved_links_[part.closing[part.stage]];
    if (std::find(moved.begin(), moved.end(), blocking) == moved.end()) return true;
  }
  return false;
}

/// Closes a touching finger on until the guard stops even the smallest motion.
void FittingLoop::close_on(Part& part) {
  double motion = options_.small_step * voxel_size_;
  while (motion >= options_.closing_tolerance && part.stage < part.closing.size()) {
    const int joint = part.closing[part.stage];
    const double step = motion / lever(joint) * model_.joints[joint].closing_sign;
    const bool is_at_limit = is_at_closing_limit(joint);
    if (is_at_limit) state_.forget_blocking();
    if (!is_at_limit && try_closing(part, step)) continue;
    motion /= 2;
    // The tip may go on where only the link behind it is stopped.
    const bool is_stopped_behind =
        is_at_limit || (state_.blocking_link() && state_.blocking_link() != part.tip_link);
    if (motion < options_.closing_tolerance && is_stopped_behind && next_stage(part)) {
      motion = options_.small_step * voxel_size_;
    }
  }
}

}  // namespace graspfit::grasp::internal
