#pragma once

#include <optional>
#include <string>
#include <vector>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/contact/squeeze.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// How deep a grasp cuts into things, on the true meshes.
struct GraspPenetration {
  bool object_intersects = false;   ///< Exact: some link and the object share a point.
  double object_depth = 0.0;        ///< Deepest overlap of a link and the object found [m].
  double object_depth_bound = 0.0;  ///< The true depth is at most this [m].
  std::optional<int> object_link;   ///< The deepest link, if any overlaps.
  bool self_intersects = false;     ///< Exact: two links that are not excluded share a point.
  double self_depth = 0.0;          ///< [m]
  std::optional<int> self_link_a;   ///< The two deepest in each other, if any overlap.
  std::optional<int> self_link_b;
  bool surroundings_touched = false;  ///< Some link touches the table or an obstacle.
  bool is_any() const { return object_intersects || self_intersects || surroundings_touched; }
};

/// A grasp with everything measured on it. All in the object frame O.
struct Grasp {
  hands::HandConfiguration configuration;
  /// An open hand, clear of the object, with a collision-free path to the grasp.
  std::optional<PreGrasp> pre_grasp;
  std::optional<contact::Squeeze> squeeze;  ///< The configuration commanded beyond the surface.
  TargetContacts targets;
  std::vector<contact::Contact> contacts;
  contact::ContactQuality quality;
  /// In GraspIt!'s convention at the planner's friction; none where nothing touches.
  std::optional<contact::WrenchQuality> wrench;
  double ideal_m = 0.0;  ///< M of the targets themselves.
  GraspPenetration penetration;
  bool has_all_contacts = false;  ///< Every requested finger/palm has a contact; of a refined grasp
                                  ///< one with a gap of at most RefinementOptions::largest_gap.
  std::int64_t attempt = 0;  ///< Number of the attempt that made the grasp; with the run's seed it
                             ///< seeds the attempt's random numbers.
  int iterations = 0;        ///< Of the adjustment loop.
  int refinement_iterations = 0;  ///< Of refinement; 0 without.

  /// ε of the contacts that touch; 0 without any.
  double epsilon() const { return wrench ? wrench->epsilon : 0.0; }
  bool is_force_closure() const { return wrench && wrench->is_force_closure; }
  /// Force closure with an ε above 1e-9, far above the rounding of wrenches (about 1e-16), which
  /// alone decides about `is_force_closure` where contacts face each other exactly.
  bool is_closed() const { return is_force_closure() && wrench->epsilon > 1e-9; }
  /// M > 0: the paper's meaning.
  bool is_usable() const { return quality.is_usable(); }
  bool has_palm_target() const;
  bool has_target_behind_tip() const;  ///< Some target is for another pad than a tip's.
  /// Usable, penetrates nothing on the true meshes, and every requested finger/palm has contact.
  bool is_valid() const { return is_usable() && !penetration.is_any() && has_all_contacts; }
};

/// Distance of every target from the nearest contact on the requested pad of the part that the
/// target is for [m], in the order of the targets; infinite where that pad has no contact.
std::vector<double> target_distances(const Grasp& grasp);

}  // namespace graspfit::grasp
