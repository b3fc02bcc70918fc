#pragma once

#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/contact/wrench_convention.hpp"

/// \file
/// Sets of contacts whose measures are known in closed form. The cases have the letters by which
/// tests of wrench spaces and min-weights name them, too. The torque scale is 1, and torques are
/// about the origin.

namespace graspfit::testing {

using Contacts = std::vector<contact::Contact>;

/// Returns contacts at points of the unit sphere, held along its normals.
inline Contacts on_sphere(const std::vector<Eigen::Vector3d>& directions) {
  Contacts contacts;
  for (const Eigen::Vector3d& direction : directions) {
    contacts.push_back(contact_at(direction.normalized(), -direction.normalized()));
  }
  return contacts;
}

/// Case E has two contacts opposite each other, of rank 5.
inline Contacts antipodal() { return on_sphere({{1, 0, 0}, {-1, 0, 0}}); }

/// Case F has the middles of the faces of a cube with half edge 1.
inline Contacts on_cube() {
  return on_sphere({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
}

/// Case G has the corners of a regular tetrahedron.
inline Contacts on_tetrahedron() {
  return on_sphere({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}});
}

/// Returns the object by which tools scale: the unit ball.
inline contact::WrenchObject unit_ball() {
  return {.center_of_mass_O = Eigen::Vector3d::Zero(),
          .largest_radius = 1.0,
          .extents_O = Eigen::Vector3d::Constant(2.0)};
}

}  // namespace graspfit::testing
