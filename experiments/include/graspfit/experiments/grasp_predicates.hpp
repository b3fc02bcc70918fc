#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graspfit/grasp/grasp.hpp"
#include "graspfit/hands/hand_model.hpp"

/// \file
/// Predicates of a grasp, by which a program decides whether a case of the paper came out. Each
/// needs at least one contact to hold. They are approximate: they compare rounded numbers.

namespace graspfit::experiments {

/// The object as predicates see it.
struct PredicateObject {
  Eigen::AlignedBox3d box_O;                                   ///< Of the mesh [m].
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();  ///< [m]
};

/// Says whether every contact is on the side of the surface that faces away from the line through
/// the center of mass along `axis` (0, 1, 2 for x, y, z): its outward normal has a positive
/// component away from the line. On a torus with that axis this is the outer half of the tube. A
/// contact on the line itself fails.
bool contacts_on_outer_side(std::span<const contact::Contact> contacts,
                            const PredicateObject& object, int axis);

/// Says whether some contact's outward normal points to the line through the center of mass along
/// `axis` within `angle` [rad, in (0, π/2]]. On a torus the finger is then inside the hole.
bool normal_points_to_axis(std::span<const contact::Contact> contacts,
                           const PredicateObject& object, int axis, double angle);

/// A box given by shares of the object's bounding box, 0 at its lower and 1 at its upper corner.
struct RelativeBox {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Ones();
};

/// Says whether no contact point lies in any of the (closed) boxes. Of the area that a contact
/// covers only its point counts.
bool no_contact_in_region(std::span<const contact::Contact> contacts, const PredicateObject& object,
                          std::span<const RelativeBox> region);

/// Says whether at least `least` and at most `most` contacts have a gap of at most `largest_gap`
/// [m]. If this is infinite, every contact of the clip volumes counts, as in the paper's N'.
bool num_contacts(std::span<const contact::Contact> contacts, int least, std::optional<int> most,
                  double largest_gap);

/// Says whether all `parts` (the hand's fingers by their names, and "palm") have a contact with a
/// gap of at most `largest_gap` [m]; others may touch too unless `is_exact`.
bool parts_touch(std::span<const contact::Contact> contacts, const hands::HandModel& hand,
                 const std::vector<std::string>& parts, double largest_gap, bool is_exact);

/// Says whether the palm's direction is along `direction_O` (need not be unit) within `angle`
/// [rad].
bool approaches_along(const grasp::Grasp& grasp, const hands::HandModel& hand,
                      const Eigen::Vector3d& direction_O, double angle);

/// Says whether no contact is known to be on a weak feature, and at least one is known not to be.
bool no_contact_on_weak(std::span<const contact::Contact> contacts);

/// Says whether the mode has the largest M of all modes that have a grasp; with a tie it has not.
bool best_style_by_m(const std::map<std::string, double>& best_m, const std::string& mode);

}  // namespace graspfit::experiments
