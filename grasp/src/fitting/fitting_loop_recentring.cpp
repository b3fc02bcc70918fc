// The palm after the first contact.

#include <algorithm>
#include <array>
#include <utility>

#include "fitting/fitting_loop.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;

/// Repeats steps 2 and 1 in turn: the palm makes a small step that brings the mean of the contacts
/// toward the mean of the targets, then the fingers close again; this goes on as long as it brings
/// contacts nearer to targets. Of the configurations in which the guard on voxels finds no link too
/// deep, the one nearest to the targets is kept.
void FittingLoop::recenter() {
  // A finger that closes by the same joint as others would move them along; for such fingers the
  // hand itself gives way while they close (`try_closing`).
  if (std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.is_shared; })) {
    return;
  }
  // A step that gains nothing itself may still allow the next one to gain.
  constexpr int kPatience = 4;
  const double small_step = options_.small_step * voxel_size_;
  is_palm_held_ = has_palm_target_ && palm_touches();
  std::vector<Formed> tried = {formed()};
  std::size_t nearest = 0;
  while (tried.size() <= nearest + kPatience && iterations_ < options_.max_iterations) {
    const Vector3d to_center = tried.back().to_center;
    const double length = to_center.norm();
    if (length < small_step / 4.0) break;
    const Vector3d shift = std::min(1.0, small_step / length) * to_center;
    constexpr std::array kOpenings = {0.0, 1.0, 2.0, 4.0};  // of the step, at the fastest point
    if (std::none_of(kOpenings.begin(), kOpenings.end(),
                     [&](double opening) { return try_shift(shift, opening * shift.norm()); })) {
      break;
    }
    if (!close_free_parts() || num_free() > 0) break;
    tried.push_back(formed());
    if (is_nearer(tried.back(), tried[nearest])) nearest = tried.size() - 1;
  }
  std::stable_sort(tried.begin(), tried.end(), is_nearer);
  // One that is too deep in the object would have to be fitted again.
  const bool looks_at_depth = options_.guard == PenetrationGuard::Voxels && tried.size() > 1;
  auto kept = std::find_if(tried.begin(), tried.end(), [&](const Formed& hand) {
    state_.put(hand.configuration);
    return !looks_at_depth || state_.links_too_deep().empty();
  });
  if (kept == tried.end()) kept = tried.begin();
  state_.put(kept->configuration);
  parts_ = std::move(kept->parts);
}

bool FittingLoop::is_nearer(const Formed& a, const Formed& b) {
  return std::pair(a.num_missing, a.miss) < std::pair(b.num_missing, b.miss);
}

FittingLoop::Formed FittingLoop::formed() {
  Formed formed{state_.configuration(), parts_, 0, 0.0, Vector3d::Zero()};
  const std::vector<contact::Contact> contacts =
      contact::estimate_contacts(model_, state_.X_OL(), object_.query, contact_options_);
  int num_targets = 0;
  for (const Part& part : parts_) {
    if (!part.target_O) continue;
    const auto contact =
        std::find_if(contacts.begin(), contacts.end(),
                     [&](const contact::Contact& candidate) { return candidate.pad == part.pad; });
    const bool has_contact = contact != contacts.end();
    const Vector3d point_O =
        has_contact ? contact->point_O : hands::pad_contact_point(model_, *part.pad, state_.X_OL());
    if (has_contact) {
      formed.miss += (*part.target_O - point_O).norm();
    } else {
      ++formed.num_missing;
    }
    formed.to_center += *part.target_O - point_O;
    ++num_targets;
  }
  if (num_targets > 0) formed.to_center /= num_targets;
  return formed;
}

/// Shifts the palm while every finger opens by `opening` [m] at its fastest point. Fingers that
/// then do not touch are free to close again by all their joints.
bool FittingLoop::try_shift(const Vector3d& shift, double opening) {
  const std::vector<Part> before = parts_;
  hands::HandConfiguration candidate = state_.configuration();
  candidate.X_OH.pretranslate(shift);
  for (Part& part : parts_) {
    part.state = Part::State::Free;  // it may lose its contact
    if (opening == 0.0 || part.closing.empty()) continue;
    const int joint = part.closing.front();
    const hands::Joint& description = model_.joints[joint];
    const double opened = candidate.q[joint] - description.closing_sign * opening / lever(joint);
    candidate.q[joint] = std::clamp(opened, description.lower, description.upper);
  }
  hands::apply_couplings(model_, candidate.q);
  if (!try_move(candidate, state_.all_links(), shift.norm() + opening)) {
    parts_ = before;
    return false;
  }
  for (Part& part : parts_) {
    if (touches(part)) {
      part.state = Part::State::Touching;
    } else {
      part.stage = 0;
    }
  }
  return true;
}

}  // namespace graspfit::grasp::internal
