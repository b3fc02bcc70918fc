#include "graspfit/grasp/hand_fitting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "internal/finger_alignment.hpp"
#include "internal/stopwatch.hpp"
#include "internal/target_marks.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;
using geometry::InvalidInput;
using geometry::RigidTransform;
using geometry::shortest_decimal;

// A link whose samples keep this far [voxels] cannot meet the surface: a sample and a point of the
// surface are each up to √3/2 from the centers of their voxels, and a point of the link is up
// to 1.44 spacings (at most 0.85 voxel) from a sample.
constexpr float kNearVoxels = 3.0F;

void require(bool holds, const std::string& field, const std::string& value,
             const std::string& range) {
  if (!holds) throw InvalidInput("FittingOptions: " + field + " = " + value + ", must be " + range);
}

/// A finger that has a target, while the loop runs.
struct Part {
  enum class State { Free, Touching, Blocked, AtLimit };
  int finger = -1;
  int pad = -1;
  int tip_link = -1;
  std::size_t target = 0;  ///< Index into the target set.
  int closing_joint = -1;  ///< The proximal joint; the distal one after a breakaway. Fingers that
                           ///< move together share it.
  int breakaway_joint =
      -1;  ///< The joint that goes on when the proximal link is blocked; −1 if none.
  std::vector<int> distal_joints;  ///< Independent joints beyond the proximal one (step 5).
  State state = State::Free;
};

/// One run of the adjustment loop.
class Loop {
 public:
  Loop(const FittingHand& hand, const ObjectModel& object, const TargetContacts& targets,
       const ContactEstimationOptions& contact_options, const FittingOptions& options)
      : hand_(hand),
        model_(hand.model()),
        object_(object),
        targets_(targets),
        contact_options_(contact_options),
        options_(options),
        voxel_size_(object.grid.lattice.voxel_size),
        is_one_sided_(is_one_sided(hand.model())) {
    for (std::size_t joint = 0; joint < model_.joints.size(); ++joint) {
      moved_links_.push_back(hands::links_moved_by(model_, static_cast<int>(joint)));
    }
    all_links_.resize(model_.links.size());
    std::iota(all_links_.begin(), all_links_.end(), 0);
    for (std::size_t t = 0; t < targets.contacts.size(); ++t) add_part(t);
  }

  FittingResult run(const PalmPlacement& placement) {
    FittingResult result;
    const bool is_clear = place(placement);
    result.initial = configuration_;
    result.configuration = configuration_;
    if (!is_clear) {
      result.stop = FittingStop::InitialCollision;
      result.smallest_distance = distance_over(all_links_);
      return result;
    }
    while (result.iterations < options_.max_iterations && num_free() > 0) {
      ++result.iterations;
      for (Part& part : parts_) {
        if (part.state == Part::State::Free) close(part);
      }
      translate_to_targets();
      turn_to_seed();
      swing_to_targets();
      for (Part& part : parts_) {
        if (part.state == Part::State::Free) align_distal(part);
      }
      for (Part& part : parts_) {
        if (part.state == Part::State::Free && touches(part)) part.state = Part::State::Touching;
      }
    }
    if (options_.settle) {
      for (Part& part : parts_) {
        if (part.state == Part::State::Touching) settle(part);
      }
    }
    finish(result);
    return result;
  }

 private:
  void add_part(std::size_t target) {
    Part part;
    part.target = target;
    part.finger = targets_.contacts[target].finger;
    const hands::Finger& finger = model_.fingers[part.finger];
    part.pad = finger.tip_pad;
    part.tip_link = model_.pads[part.pad].link;
    part.closing_joint = closing_joint(model_, finger);
    part.distal_joints = distal_joints(model_, finger);
    for (const int joint : finger.joints) {
      const hands::Joint& description = model_.joints[joint];
      const bool can_go_on = description.coupling && description.coupling->breakaway;
      if (description.closing_sign != 0 && can_go_on) part.breakaway_joint = joint;
    }
    parts_.push_back(part);
  }

  int num_free() const {
    return static_cast<int>(std::count_if(parts_.begin(), parts_.end(), [](const Part& part) {
      return part.state == Part::State::Free;
    }));
  }

  bool any_touching() const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return part.state == Part::State::Touching; });
  }

  Vector3d palm_direction() const {
    return (configuration_.X_OH.linear() * model_.palm.direction_H).normalized();
  }
  const Vector3d& target_point(const Part& part) const {
    return targets_.contacts[part.target].point_O;
  }

  float distance_of(int link, const RigidTransform& X_OL) const {
    return smallest_distance(hand_, link, X_OL, object_.distance,
                             static_cast<float>(options_.large_step_limit + 1.0));
  }

  void commit(const hands::HandConfiguration& configuration) {
    configuration_ = configuration;
    X_OL_ = hands::forward_kinematics(model_, configuration_);
    link_distance_.resize(model_.links.size());
    for (const int link : all_links_) link_distance_[link] = distance_of(link, X_OL_[link]);
  }

  /// The paper's initial configuration (section 7): fingers open, palm facing the targets, clear of
  /// the object. False if no distance is clear.
  bool place(const PalmPlacement& placement) {
    const Vector3d direction = placement.direction_O.normalized();
    const Vector3d center = targets_.centroid();
    // A24: the object's extent beyond the target plane on the palm's side, and some room.
    double extent = 0.0;
    for (const Vector3d& vertex : object_.mesh().vertices) {
      extent = std::max(extent, (center - vertex).dot(direction));
    }
    hands::HandConfiguration start =
        aligned_open_hand(model_, targets_, direction, extent + options_.clearance);
    const double limit = 2.0 * hands::largest_reach(model_) + extent;
    for (double retreat = 0.0; retreat <= limit; retreat += voxel_size_) {
      commit(start);
      if (is_clear()) return true;
      start.X_OH.pretranslate(-voxel_size_ * direction);
    }
    return false;
  }

  bool is_clear() const {
    return std::all_of(all_links_.begin(), all_links_.end(), [&](int link) {
      return link_distance_[link] > 0.0F && !cuts_object(link, link_distance_[link], X_OL_[link]);
    });
  }

  /// The exact part of the guard.
  bool cuts_object(int link, float d_min, const RigidTransform& X_OL) const {
    return options_.guard == PenetrationGuard::Meshes && d_min < kNearVoxels &&
           hand_.collision().link_intersects(object_.query, link, X_OL);
  }

  /// Motion of the fastest point allowed to something at distance `d_min` [m] (section 9, A30).
  double step_at(float d_min) const {
    const double voxels = d_min >= options_.large_step_at
                              ? std::clamp(d_min - 1.0, options_.small_step,
                                           std::max(options_.small_step, options_.large_step_limit))
                              : options_.small_step;
    return voxels * voxel_size_;
  }

  float distance_over(const std::vector<int>& links) const {
    float smallest = std::numeric_limits<float>::infinity();
    for (const int link : links) smallest = std::min(smallest, link_distance_[link]);
    return smallest;
  }

  /// Accepts `candidate` if the guard lets every moved link through and no touching part loses
  /// contact. `blocking_link_` says which link spoke against it (−1: a lost contact). The cheap
  /// tests come first.
  bool try_move(const hands::HandConfiguration& candidate, const std::vector<int>& moved) {
    const std::vector<RigidTransform> X_OL = hands::forward_kinematics(model_, candidate);
    trial_distance_ = link_distance_;
    for (const int link : moved) {
      trial_distance_[link] = distance_of(link, X_OL[link]);
      if (trial_distance_[link] < 0.0F) {
        blocking_link_ = link;
        return false;
      }
    }
    blocking_link_ = -1;
    for (const Part& part : parts_) {
      if (part.state != Part::State::Touching) continue;
      if (std::find(moved.begin(), moved.end(), part.tip_link) == moved.end()) continue;
      if (!contact_of(part, X_OL)) return false;
    }
    for (const int link : moved) {
      if (cuts_object(link, trial_distance_[link], X_OL[link])) {
        blocking_link_ = link;
        return false;
      }
    }
    configuration_ = candidate;
    X_OL_ = X_OL;
    link_distance_.swap(trial_distance_);
    return true;
  }

  std::optional<Contact> contact_of(const Part& part, const std::vector<RigidTransform>& X_OL) {
    const Stopwatch watch(contact_tests_s_);
    return estimate_contact(model_, part.pad, hands::pad_pose(model_, part.pad, X_OL),
                            object_.query, contact_options_);
  }

  /// Section 10: the clip test is made once the tip link shares a voxel with the surface.
  bool touches(const Part& part) {
    return link_distance_[part.tip_link] == 0.0F && contact_of(part, X_OL_).has_value();
  }

  /// Distance of the farthest point that joint `joint` moves from its origin, enlarged by what
  /// coupled joints add: bounds the motion per radian [m/rad].
  double lever(int joint) const {
    if (model_.joints[joint].type == hands::JointType::Prismatic) return 1.0;
    const Vector3d origin =
        (X_OL_[model_.joints[joint].parent_link] * model_.joints[joint].X_PJ).translation();
    double reach = 0.0;
    for (const int link : moved_links_[joint]) {
      reach =
          std::max(reach, (X_OL_[link].translation() - origin).norm() + hand_.samples(link).reach);
    }
    double factor = 1.0;
    for (const hands::Joint& other : model_.joints) {
      if (other.coupling && other.coupling->leader == joint) {
        factor += std::abs(other.coupling->ratio);
      }
    }
    return std::max(reach * factor, 1e-6);
  }

  hands::HandConfiguration with_joint(int joint, double position) const {
    hands::HandConfiguration candidate = configuration_;
    candidate.q[joint] =
        std::clamp(position, model_.joints[joint].lower, model_.joints[joint].upper);
    hands::apply_couplings(model_, candidate.q);
    return candidate;
  }

  bool is_at_closing_limit(int joint) const {
    const hands::Joint& description = model_.joints[joint];
    const double limit = description.closing_sign > 0 ? description.upper : description.lower;
    return configuration_.q[joint] == limit;
  }

  /// Step 1: closes one finger by its proximal joint, as far as the guard allows.
  void close(Part& part) {
    const int joint = part.closing_joint;
    if (joint < 0 || is_at_closing_limit(joint)) {
      if (!break_away(part)) part.state = Part::State::AtLimit;
      return;
    }
    double step = step_at(distance_over(moved_links_[joint])) / lever(joint) *
                  model_.joints[joint].closing_sign;
    for (int halving = 0; halving <= options_.max_halvings; ++halving, step /= 2) {
      if (try_closing(joint, step)) return;
    }
    // Blocked at the tip means done; blocked farther back lets the clutch free the distal joint
    // (A27).
    const bool is_tip = blocking_link_ == part.tip_link;
    if (is_tip || !break_away(part)) {
      part.state = touches(part) ? Part::State::Touching : Part::State::Blocked;
    }
  }

  /// Closes a joint by `step`. Where several fingers hang on it and one of them is stopped, the
  /// hand moves so that this one stays where it is and the others close, as far in all (A44).
  bool try_closing(int joint, double step) {
    if (try_move(with_joint(joint, configuration_.q[joint] + step), moved_links_[joint])) {
      return true;
    }
    const Part* const stopped = stopped_part_sharing(joint);
    if (!stopped) return false;
    hands::HandConfiguration candidate = with_joint(joint, configuration_.q[joint] + step / 2);
    const Vector3d moved_by =
        hands::pad_contact_point(model_, stopped->pad,
                                 hands::forward_kinematics(model_, candidate)) -
        hands::pad_contact_point(model_, stopped->pad, X_OL_);
    candidate.X_OH.pretranslate(-moved_by);
    return try_move(candidate, all_links_);
  }

  /// The part on whose account the last motion was not possible, if its closing joint closes others
  /// too.
  const Part* stopped_part_sharing(int joint) const {
    const Part* stopped = nullptr;
    int num_sharing = 0;
    for (const Part& part : parts_) {
      if (part.closing_joint != joint) continue;
      ++num_sharing;
      const std::vector<int>& links = model_.fingers[part.finger].links;
      const bool is_in_the_way =
          blocking_link_ < 0 ? part.state == Part::State::Touching
                             : std::find(links.begin(), links.end(), blocking_link_) != links.end();
      if (!stopped && is_in_the_way) stopped = &part;
    }
    return num_sharing > 1 ? stopped : nullptr;
  }

  /// Closes a touching finger on until the guard stops even the smallest motion.
  void settle(Part& part) {
    double motion = options_.small_step * voxel_size_;
    while (motion >= options_.settle_tolerance) {
      const int joint = part.closing_joint;
      const double step = motion / lever(joint) * model_.joints[joint].closing_sign;
      const bool is_at_limit = is_at_closing_limit(joint);
      const bool is_done = is_at_limit || !try_closing(joint, step);
      if (is_done) motion /= 2;
      // The tip may go on where only the link behind it is stopped.
      const bool is_stopped_behind =
          is_done && motion < options_.settle_tolerance &&
          (is_at_limit || (blocking_link_ >= 0 && blocking_link_ != part.tip_link));
      if (is_stopped_behind && break_away(part)) motion = options_.small_step * voxel_size_;
    }
  }

  /// The proximal link is blocked or at its limit: the distal joint may go on alone.
  bool break_away(Part& part) {
    if (part.breakaway_joint < 0 || part.closing_joint == part.breakaway_joint) return false;
    part.closing_joint = part.breakaway_joint;
    return true;
  }

  /// Tries a motion of the whole hand, its length bounded by the guard; `make(share)` gives the
  /// pose for a share of the motion wanted, `length` is that of the fastest point.
  template <typename MakePose>
  void move_hand(double length, MakePose make) {
    if (length < 1e-9) return;
    const double allowed = step_at(distance_over(all_links_));
    hands::HandConfiguration candidate = configuration_;
    double share = std::min(1.0, allowed / length);
    // Once a finger touches, a motion of the hand that is not possible is skipped (A29).
    const int max_halvings = any_touching() ? 0 : options_.max_halvings;
    for (int halving = 0; halving <= max_halvings; ++halving, share /= 2) {
      candidate.X_OH = make(share);
      if (try_move(candidate, all_links_)) return;
    }
  }

  /// Step 2: the centroid of the fingertips onto that of the targets.
  void translate_to_targets() {
    Vector3d tips = Vector3d::Zero();
    for (const Part& part : parts_) {
      tips += hands::pad_contact_point(model_, part.pad, X_OL_);
    }
    const Vector3d wanted = targets_.centroid() - tips / static_cast<double>(parts_.size());
    move_hand(wanted.norm(), [&](double share) {
      RigidTransform X_OH = configuration_.X_OH;
      return X_OH.pretranslate(share * wanted);
    });
  }

  /// Step 3: about the palm direction, until the thumb looks at the seed.
  void turn_to_seed() {
    const Vector3d axis = palm_direction();
    const Vector3d pivot = turning_point(model_, is_one_sided_, X_OL_, targets_);
    const Part& seed = parts_.front();
    const double angle = azimuth_error(hands::pad_contact_point(model_, seed.pad, X_OL_) - pivot,
                                       target_point(seed) - pivot, axis);
    double reach = 0.0;
    for (const int link : all_links_) {
      reach =
          std::max(reach, (X_OL_[link].translation() - pivot).norm() + hand_.samples(link).reach);
    }
    move_hand(std::abs(angle) * reach, [&](double share) {
      return turned(configuration_.X_OH, pivot, axis, share * angle);
    });
  }

  /// Step 4: fingers that can swing around the palm toward their targets. Fingers that share a
  /// joint take the angle with the least sum of squared errors (A26).
  void swing_to_targets() {
    const Eigen::VectorXd wanted = aligned_swing(model_, configuration_, targets_);
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      const int joint = static_cast<int>(j);
      const double change = wanted[joint] - configuration_.q[joint];
      if (model_.joints[j].coupling || std::abs(change) < 1e-9) continue;
      const double limit = step_at(distance_over(moved_links_[j])) / lever(joint);
      double step = std::clamp(change, -limit, limit);
      for (int halving = 0; halving <= options_.max_halvings; ++halving, step /= 2) {
        if (try_move(with_joint(joint, configuration_.q[joint] + step), moved_links_[j])) break;
      }
    }
  }

  /// Step 5: distal joints turn so that the reversed normal of the fingertip agrees with the
  /// target's.
  void align_distal(const Part& part) {
    for (const int joint : part.distal_joints) {
      const double change = distal_change(model_, X_OL_, joint, targets_.contacts[part.target]);
      if (std::abs(change) < 1e-6) continue;
      const double limit = step_at(distance_over(moved_links_[joint])) / lever(joint);
      double step = std::clamp(change, -limit, limit);
      for (int halving = 0; halving <= options_.max_halvings; ++halving, step /= 2) {
        if (try_move(with_joint(joint, configuration_.q[joint] + step), moved_links_[joint])) break;
      }
    }
  }

  void finish(FittingResult& result) {
    result.configuration = configuration_;
    result.smallest_distance = distance_over(all_links_);
    {
      const Stopwatch watch(contact_tests_s_);
      result.contacts = estimate_contacts(model_, X_OL_, object_.query, contact_options_);
    }
    result.contact_tests_s = contact_tests_s_;
    bool has_all = true;
    bool is_blocked = false;
    for (const Part& part : parts_) {
      const bool has_contact = internal::mark_targets(result.contacts, part.pad);
      has_all = has_all && has_contact;
      is_blocked = is_blocked || (!has_contact && part.state == Part::State::Blocked);
    }
    result.stop = num_free() > 0 ? FittingStop::IterationLimit
                  : has_all      ? FittingStop::Contact
                  : is_blocked   ? FittingStop::BlockedFinger
                                 : FittingStop::MissedContact;
  }

  const FittingHand& hand_;
  const hands::HandModel& model_;
  const ObjectModel& object_;
  const TargetContacts& targets_;
  const ContactEstimationOptions& contact_options_;
  const FittingOptions& options_;
  const double voxel_size_;
  const bool is_one_sided_;
  std::vector<std::vector<int>> moved_links_;  ///< Per joint.
  std::vector<int> all_links_;
  std::vector<Part> parts_;  ///< One per target, the seed's first.
  hands::HandConfiguration configuration_;
  std::vector<RigidTransform> X_OL_;
  std::vector<float> link_distance_;  ///< d_min of every link [voxels].
  std::vector<float> trial_distance_;
  int blocking_link_ = -1;
  double contact_tests_s_ = 0.0;
};

}  // namespace

void FittingOptions::validate() const {
  const auto finite_positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  require(clearance >= 0.0 && std::isfinite(clearance), "clearance", shortest_decimal(clearance),
          "finite and >= 0 m");
  require(large_step_at >= 1.0 && std::isfinite(large_step_at), "large_step_at",
          shortest_decimal(large_step_at), "finite and >= 1 voxel");
  require(finite_positive(large_step_limit), "large_step_limit", shortest_decimal(large_step_limit),
          "finite and > 0 voxels");
  require(small_step > 0.0 && small_step <= 1.0, "small_step", shortest_decimal(small_step),
          "in (0, 1] voxels");
  require(max_halvings >= 0 && max_halvings <= 30, "max_halvings", std::to_string(max_halvings),
          "in [0, 30]");
  require(max_iterations >= 1, "max_iterations", std::to_string(max_iterations), ">= 1");
  require(finite_positive(settle_tolerance), "settle_tolerance", shortest_decimal(settle_tolerance),
          "finite and > 0 m");
  require(sample_spacing >= 0.05 && sample_spacing <= 0.85, "sample_spacing",
          shortest_decimal(sample_spacing), "in [0.05, 0.85] voxels");
}

FittingResult fit_hand(const FittingHand& hand, const ObjectModel& object,
                       const SurroundingsCollision& surroundings, GraspStyle style,
                       const TargetContacts& targets, const PalmPlacement& placement,
                       const ContactEstimationOptions& contact_options,
                       const FittingOptions& options) {
  (void)surroundings;
  (void)style;
  options.validate();
  contact_options.validate();
  if (targets.contacts.size() < 2) {
    throw InvalidInput("fit_hand: " + std::to_string(targets.contacts.size()) +
                       " targets, a grasp needs at least two");
  }
  for (const TargetContact& target : targets.contacts) {
    if (target.finger < 0 || target.finger >= static_cast<int>(hand.model().fingers.size())) {
      throw InvalidInput(
          "fit_hand: a target is assigned to finger " + std::to_string(target.finger) + " of " +
          std::to_string(hand.model().fingers.size()) + "; call assign_fingers first");
    }
    if (hand.model().fingers[target.finger].tip_pad < 0) {
      throw InvalidInput("fit_hand: finger " + hand.model().fingers[target.finger].name +
                         " has no fingertip pad");
    }
  }
  return Loop(hand, object, targets, contact_options, options).run(placement);
}

}  // namespace graspfit::grasp
