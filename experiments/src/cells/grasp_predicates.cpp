#include "graspfit/experiments/grasp_predicates.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "graspfit/base/errors.hpp"

namespace graspfit::experiments {
namespace {

/// Unit vector from the line along an axis through the center of mass to a point; zero on the line.
Eigen::Vector3d away_from_axis(const Eigen::Vector3d& point_O, const PredicateObject& object,
                               int axis) {
  Eigen::Vector3d radial = point_O - object.center_of_mass_O;
  radial[axis] = 0.0;
  const double length = radial.norm();
  return length > 0.0 ? Eigen::Vector3d(radial / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// Cosine of the angle between a contact's outward normal and the direction of `away_from_axis`.
double outward_cosine(const contact::Contact& contact, const PredicateObject& object, int axis) {
  return -contact.inward_normal_O.dot(away_from_axis(contact.point_O, object, axis));
}

}  // namespace

bool contacts_on_outer_side(std::span<const contact::Contact> contacts,
                            const PredicateObject& object, int axis) {
  return !contacts.empty() &&
         std::all_of(contacts.begin(), contacts.end(), [&](const contact::Contact& contact) {
           return outward_cosine(contact, object, axis) > 0.0;
         });
}

bool normal_points_to_axis(std::span<const contact::Contact> contacts,
                           const PredicateObject& object, int axis, double angle) {
  return std::any_of(contacts.begin(), contacts.end(), [&](const contact::Contact& contact) {
    return outward_cosine(contact, object, axis) <= -std::cos(angle) &&
           outward_cosine(contact, object, axis) < 0.0;
  });
}

bool no_contact_in_region(std::span<const contact::Contact> contacts, const PredicateObject& object,
                          std::span<const RelativeBox> region) {
  const Eigen::Vector3d corner = object.box_O.min();
  const Eigen::Vector3d sizes = object.box_O.sizes();
  return !contacts.empty() &&
         std::none_of(contacts.begin(), contacts.end(), [&](const contact::Contact& contact) {
           return std::any_of(region.begin(), region.end(), [&](const RelativeBox& box) {
             const Eigen::AlignedBox3d box_O(corner + box.lower.cwiseProduct(sizes),
                                             corner + box.upper.cwiseProduct(sizes));
             return box_O.contains(contact.point_O);
           });
         });
}

bool num_contacts(std::span<const contact::Contact> contacts, int least, std::optional<int> most,
                  double largest_gap) {
  const auto count =
      std::count_if(contacts.begin(), contacts.end(),
                    [&](const contact::Contact& contact) { return contact.gap <= largest_gap; });
  return count > 0 && count >= least && (!most || count <= *most);
}

bool parts_touch(std::span<const contact::Contact> contacts, const hands::HandModel& hand,
                 const std::vector<std::string>& parts, double largest_gap, bool is_exact) {
  std::set<std::string> touching;
  for (const contact::Contact& contact : contacts) {
    if (contact.gap > largest_gap) continue;
    touching.insert(hand.part_name(contact.finger));
  }
  const std::set<std::string> wanted(parts.begin(), parts.end());
  if (touching.empty()) return false;
  if (is_exact) return touching == wanted;
  return std::includes(touching.begin(), touching.end(), wanted.begin(), wanted.end());
}

bool approaches_along(const grasp::Grasp& grasp, const hands::HandModel& hand,
                      const Eigen::Vector3d& direction_O, double angle) {
  if (!(direction_O.norm() > 0.0)) {
    throw base::InvalidInput("approaches_along: direction_O is zero");
  }
  if (grasp.contacts.empty()) return false;
  const Eigen::Vector3d palm_O =
      grasp.configuration.X_OH.rotation() * hand.palm.direction_H.normalized();
  return palm_O.dot(direction_O.normalized()) >= std::cos(angle);
}

bool no_contact_on_weak(std::span<const contact::Contact> contacts) {
  const auto is = [](bool weak) {
    return [weak](const contact::Contact& contact) { return contact.weak == weak; };
  };
  return std::none_of(contacts.begin(), contacts.end(), is(true)) &&
         std::any_of(contacts.begin(), contacts.end(), is(false));
}

bool best_style_by_m(const std::map<std::string, double>& best_m, const std::string& mode) {
  const auto own = best_m.find(mode);
  if (own == best_m.end()) return false;
  return std::all_of(best_m.begin(), best_m.end(), [&](const auto& other) {
    return other.first == mode || other.second < own->second;
  });
}

}  // namespace graspfit::experiments
