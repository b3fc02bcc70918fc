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
/// Yes-or-no questions about a grasp, by which a program decides whether a case of the paper came
/// out. Each needs at least one contact to say yes. Approximate: comparisons of rounded numbers.

namespace graspfit::experiments {

/// The object as predicates see it.
struct PredicateObject {
  Eigen::AlignedBox3d box_O;                                   ///< Of the mesh [m].
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();  ///< [m]
};

/// Every contact is on the side of the surface that looks away from the line through the center of
/// mass along `axis` (0, 1, 2 for x, y, z): its outward normal has a positive part that way. On a
/// torus with that axis: on the outer half of the tube. A contact on the line itself says no.
bool contacts_on_outer_side(std::span<const contact::Contact> contacts,
                            const PredicateObject& object, int axis);

/// Some contact's outward normal points to that line within `angle` [rad, in (0, π/2]]: the finger
/// is inside the hole of a torus.
bool normal_points_to_axis(std::span<const contact::Contact> contacts,
                           const PredicateObject& object, int axis, double angle);

/// A box given by shares of the object's bounding box, 0 at its lower and 1 at its upper corner.
struct RelativeBox {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Ones();
};

/// No contact point lies in any of the (closed) boxes. Of what a contact covers only its point
/// counts.
bool no_contact_in_region(std::span<const contact::Contact> contacts, const PredicateObject& object,
                          std::span<const RelativeBox> region);

/// At least `least` and at most `most` contacts with a gap of at most `largest_gap` [m]; infinite:
/// what the clip volumes call a contact, the paper's N'.
bool num_contacts(std::span<const contact::Contact> contacts, int least, std::optional<int> most,
                  double largest_gap);

/// The parts with a contact of at most that gap are these, by the names of the hand's fingers and
/// "palm"; others may touch too unless `is_exact`.
bool parts_touch(std::span<const contact::Contact> contacts, const hands::HandModel& hand,
                 const std::vector<std::string>& parts, double largest_gap, bool is_exact);

/// The palm looks along `direction_O` (need not be unit) within `angle` [rad].
bool approaches_along(const grasp::Grasp& grasp, const hands::HandModel& hand,
                      const Eigen::Vector3d& direction_O, double angle);

/// No contact is known to be on a weak feature, and at least one is known not to be.
bool no_contact_on_weak(std::span<const contact::Contact> contacts);

/// The mode has the largest M of all that have a grasp; a tie says no.
bool best_style_by_m(const std::map<std::string, double>& best_m, const std::string& mode);

}  // namespace graspfit::experiments
