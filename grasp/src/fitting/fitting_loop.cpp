#include "fitting/fitting_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/finger_alignment.hpp"
#include "fitting/finger_crossing.hpp"
#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using geometry::RigidTransform;

namespace {

/// A number of steps as an int; limited to the largest int, since steps may be very short.
int steps_of(double number) {
  return base::bounded_integer(number, 0, std::numeric_limits<int>::max());
}

}  // namespace

FittingLoop::FittingLoop(const GraspScene& scene, GraspStyle style, const RequestedParts& requested,
                         const FittingOptions& options, const std::vector<int>& depth_guarded)
    : hand_(scene.hand),
      model_(scene.hand.model()),
      object_(scene.object),
      contact_options_(scene.contact_options),
      options_(options),
      voxel_size_(scene.object.grid.lattice.voxel_size),
      state_(scene, options, depth_guarded),
      style_(style),
      has_palm_target_(requested.palm),
      stops_at_palm_(requested.palm) {
  for (int joint = 0; joint < std::ssize(model_.joints); ++joint) {
    moved_links_.push_back(hands::links_moved_by(model_, joint));
  }
  std::vector<bool> has_target(model_.fingers.size(), false);
  for (const int finger : requested.fingers) {
    has_target[finger] = true;
    add_part(finger, true);
  }
  if (style == GraspStyle::Power) {
    for (int finger = 0; finger < std::ssize(model_.fingers); ++finger) {
      if (!has_target[finger]) add_part(finger, false);
    }
  }
  for (Part& part : parts_) {
    part.is_shared =
        !part.closing.empty() &&
        std::count_if(parts_.begin(), parts_.end(), [&](const Part& other) {
          return !other.closing.empty() && other.closing.front() == part.closing.front();
        }) > 1;
  }
}

FittingLoop::Outcome FittingLoop::fit(const TargetContacts& targets, const PalmPlacement& placement,
                                      const std::optional<hands::HandConfiguration>& goal) {
  goal_ = goal ? *goal
               : fitting_goal(hand_, targets, posture_for(model_, targets, placement), options_);
  for (Part& part : parts_) {
    const auto target =
        std::find_if(targets.contacts.begin(), targets.contacts.end(),
                     [&](const TargetContact& contact) { return contact.finger == part.finger; });
    if (target != targets.contacts.end()) part.target_O = target->point_O;
    part.is_toward_goal = style_ != GraspStyle::Power && part.closing.size() > 1 && !part.is_shared;
  }
  if (!place()) return failed_start();
  approach();
  const Vector3d palm = state_.configuration().X_OH * model_.palm.center_H;
  const double way = (targets.contacts.back().point_O - palm).dot(palm_direction());
  seat_palm(std::max(0.0, way));
  return run();
}

FittingLoop::Outcome FittingLoop::close(const hands::HandConfiguration& start,
                                        const RetreatRule& rule) {
  goal_ = start;
  is_palm_done_ = true;
  const double step = rule.step.value_or(voxel_size_);
  // Far enough to pass the object, whose normalizing radius is half its diagonal, by the hand's own
  // length.
  const double far = 2.0 * (object_.normalizing_radius + hands::largest_reach(model_));
  const int steps_to_far = steps_of(std::ceil(far / step));
  const int most_steps = rule.most_steps.value_or(steps_to_far);
  if (!retreat(start, step, most_steps) && !rule.closes_in_collision) return failed_start();
  if (rule.palm_may_touch && model_.palm.pad) {
    bring_palm((start.X_OH.translation() - initial_.X_OH.translation()).dot(palm_direction()));
  }
  seat_palm(0.0);
  return run();
}

FittingLoop::Outcome FittingLoop::failed_start() const {
  FittingResult result;
  result.initial = result.configuration = initial_;
  result.stop = FittingStop::InitialCollision;
  result.smallest_distance = state_.smallest_distance();
  return {result, {}};
}

FittingLoop::Outcome FittingLoop::run() {
  if (close_free_parts() && options_.palm_after_contact == PalmAfterContact::Recentred) recenter();
  Outcome outcome{finished(), {}};
  if (is_clear_at_start_ && options_.guard == PenetrationGuard::Voxels) {
    outcome.links_too_deep = state_.links_too_deep();
  }
  return outcome;
}

/// Steps 1 and 2 until every finger has stopped or the iterations are used up. Returns false as
/// soon as the fit is hopeless.
bool FittingLoop::close_free_parts() {
  while (iterations_ < options_.max_iterations && num_free() > 0) {
    ++iterations_;
    for (Part& part : parts_) {
      if (part.state == Part::State::Free) close_part(part);
    }
    move_palm_to_goal();
    bool is_hopeless_now = false;
    for (Part& part : parts_) {
      if (part.state == Part::State::Free && touches(part)) part.state = Part::State::Touching;
      is_hopeless_now = is_hopeless_now || is_hopeless(part);
    }
    if (is_hopeless_now) return false;
  }
  if (options_.contact_state == ContactState::Closed) {
    for (Part& part : parts_) {
      if (part.state == Part::State::Touching) close_on(part);
    }
  }
  return true;
}

void FittingLoop::add_part(int finger, bool has_target) {
  Part part;
  part.finger = finger;
  part.has_target = has_target;
  const hands::Finger& description = model_.fingers[finger];
  part.pad = description.tip_pad;
  part.tip_link = part.pad ? model_.pads[*part.pad].link : description.links.back();
  part.closing = closing_joints(model_, description);
  parts_.push_back(part);
}

int FittingLoop::num_free() const {
  return static_cast<int>(std::count_if(parts_.begin(), parts_.end(), [](const Part& part) {
    return part.state == Part::State::Free;
  }));
}

bool FittingLoop::any_touching() const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.state == Part::State::Touching; });
}

Vector3d FittingLoop::palm_direction() const {
  return (goal_.X_OH.linear() * model_.palm.direction_H).normalized();
}

/// The paper's initial configuration (section 7) read from the goal: its palm withdrawn along
/// n_palm until the object is before it, fingers open, swinging joints as at the goal. False
/// if no distance is clear.
bool FittingLoop::place() {
  const Vector3d direction = palm_direction();
  const Vector3d palm = goal_.X_OH * model_.palm.center_H;
  double extent = 0.0;
  for (const geometry::SurfacePatch& patch : object_.patches) {
    extent = std::max(extent, (palm - patch.centroid).dot(direction));
  }
  hands::HandConfiguration start = opened_from(model_, goal_);
  start.X_OH.pretranslate(Vector3d(-(extent + options_.clearance) * direction));
  return retreat(start, voxel_size_, steps_of(2.0 * hands::largest_reach(model_) / voxel_size_));
}

/// Puts the hand at its first clear pose, from `start` on in steps against the palm direction.
/// Returns false if none is clear; the hand is then at the last one.
bool FittingLoop::retreat(hands::HandConfiguration start, double step, int most_steps) {
  const Vector3d back = -step * palm_direction();
  for (int steps = 0;; ++steps) {
    state_.put(start);
    initial_ = start;
    is_clear_at_start_ = state_.is_clear();
    if (is_clear_at_start_) return true;
    if (steps == most_steps) return false;
    start.X_OH.pretranslate(back);
  }
}

/// Moves the palm up to `distance` along n_palm in steps that the guard bounds; gives up where a
/// step would be shorter than `tolerance`.
void FittingLoop::advance(double distance, double tolerance) {
  const Vector3d direction = palm_direction();
  while (distance > tolerance) {
    double step = std::min(distance, state_.allowed_motion(state_.all_links()));
    bool is_done = false;
    for (; step >= tolerance && !is_done; step /= 2) {
      hands::HandConfiguration candidate = state_.configuration();
      candidate.X_OH.pretranslate(Vector3d(step * direction));
      is_done = try_move(candidate, state_.all_links(), step);
      if (is_done) distance -= step;
    }
    if (!is_done || (stops_at_palm_ && palm_touches())) return;
  }
}

/// Step 2 along n_palm, with open fingers: moves the palm to the goal, or until the guard or the
/// palm's contact stops it.
void FittingLoop::approach() {
  const double wanted =
      (goal_.X_OH.translation() - state_.configuration().X_OH.translation()).dot(palm_direction());
  advance(wanted, options_.small_step * voxel_size_);
}

/// Moves the palm, if it is requested, onto the surface about `distance` before it: first until its
/// clip volume holds surface or the guard stops it, then until it touches.
void FittingLoop::seat_palm(double distance) {
  if (!has_palm_target_) return;
  is_palm_done_ = true;
  // The goal weighs the palm's target against those of the fingers; and the surface at the target
  // may lie deeper than its patch by some voxels.
  constexpr double kSearch = 4.0;  // [voxels]
  bring_palm(distance + kSearch * voxel_size_);
}

/// Moves the palm onto the surface, if the surface is within `distance` along n_palm.
void FittingLoop::bring_palm(double distance) {
  stops_at_palm_ = true;
  if (!palm_touches()) advance(distance, options_.small_step * voxel_size_ / 8.0);
  if (options_.contact_state == ContactState::Closed && palm_touches()) press_palm();
}

/// Moves the palm on along n_palm until the guard stops even the smallest motion, or the palm would
/// lose its contact.
void FittingLoop::press_palm() {
  is_palm_held_ = true;
  const Vector3d direction = palm_direction();
  double motion = options_.small_step * voxel_size_;
  while (motion >= options_.closing_tolerance) {
    hands::HandConfiguration candidate = state_.configuration();
    candidate.X_OH.pretranslate(Vector3d(motion * direction));
    if (!try_move(candidate, state_.all_links(), motion)) motion /= 2;
  }
  is_palm_held_ = has_palm_target_;
}

bool FittingLoop::palm_touches() {
  return state_.distance(model_.pads[*model_.palm.pad].link) <= options_.large_step_at &&
         has_contact_at(*model_.palm.pad, state_.X_OL());
}

/// Moves to `candidate` if the guard lets every moved link through and no touching part loses
/// contact.
bool FittingLoop::try_move(const hands::HandConfiguration& candidate, const std::vector<int>& moved,
                           double length) {
  return state_.try_move(candidate, moved, length, [&](const std::vector<RigidTransform>& X_OL) {
    for (const Part& part : parts_) {
      if (part.state != Part::State::Touching || !part.pad) continue;
      if (std::find(moved.begin(), moved.end(), part.tip_link) == moved.end()) continue;
      if (!has_contact_at(*part.pad, X_OL)) return false;
    }
    return !is_palm_held_ || moved.size() != state_.all_links().size() ||
           has_contact_at(*model_.palm.pad, X_OL);
  });
}

bool FittingLoop::has_contact_at(int pad, const std::vector<RigidTransform>& X_OL) {
  const base::Stopwatch watch(contact_tests_s_);
  return contact::has_contact(model_, pad, hands::pad_pose(model_, pad, X_OL), object_.query,
                              contact_options_);
}

/// Section 10: the clip test is made once the tip link shares a voxel with the surface.
bool FittingLoop::touches(const Part& part) {
  return part.pad && state_.distance(part.tip_link) == 0.0F &&
         has_contact_at(*part.pad, state_.X_OL());
}

/// Steps 2 and 3: moves the palm toward the pose in which the fingertips will be at their targets.
/// Once a finger touches, the palm stays.
void FittingLoop::move_palm_to_goal() {
  if (is_palm_done_ || any_touching()) return;
  const Vector3d wanted = goal_.X_OH.translation() - state_.configuration().X_OH.translation();
  const double length = wanted.norm();
  is_palm_done_ = length < options_.small_step * voxel_size_ / 4.0;
  if (is_palm_done_) return;
  const double share = std::min(1.0, state_.allowed_motion(state_.all_links()) / length);
  hands::HandConfiguration candidate = state_.configuration();
  candidate.X_OH.pretranslate(Vector3d(share * wanted));
  try_move(candidate, state_.all_links(), share * length);
}

/// Whether a part with a target has stopped too far from the object for any later stage to close
/// the gap.
bool FittingLoop::is_hopeless(const Part& part) const {
  if (!part.has_target || part.state == Part::State::Free || part.state == Part::State::Touching) {
    return false;
  }
  const Vector3d tip = hands::pad_contact_point(model_, *part.pad, state_.X_OL());
  // The map's value is that of voxel centers, each up to √3/2 from the points meant.
  return (object_.distance.at(tip) - std::sqrt(3.0)) * voxel_size_ > options_.give_up_distance;
}

FittingResult FittingLoop::finished() {
  state_.measure_all();
  FittingResult result;
  result.initial = initial_;
  result.iterations = iterations_;
  result.configuration = state_.configuration();
  result.smallest_distance = state_.smallest_distance();
  bool has_all = true;
  bool is_blocked = false;
  const auto note_contact = [&](int pad, bool is_stopped) {
    if (has_contact_at(pad, state_.X_OL())) return;
    has_all = false;
    is_blocked = is_blocked || is_stopped;
    const Vector3d point = hands::pad_contact_point(model_, pad, state_.X_OL());
    result.largest_gap = std::max(result.largest_gap,
                                  std::sqrt(object_.query.closest_point(point).squared_distance));
  };
  for (const Part& part : parts_) {
    if (part.has_target) note_contact(*part.pad, part.state == Part::State::Blocked);
  }
  if (has_palm_target_) note_contact(*model_.palm.pad, true);
  result.contact_tests_s = contact_tests_s_;
  const bool is_out_of_budget = iterations_ >= options_.max_iterations && num_free() > 0;
  result.stop = is_out_of_budget ? FittingStop::IterationLimit
                : has_all        ? FittingStop::Contact
                : is_blocked     ? FittingStop::BlockedFinger
                                 : FittingStop::MissedContact;
  return result;
}

}  // namespace graspfit::grasp::internal
