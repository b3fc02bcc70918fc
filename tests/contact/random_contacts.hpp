#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/contact/contact.hpp"

namespace graspfit::testing {

/// Draws a direction uniformly from the unit sphere, by rejection from the cube.
inline Eigen::Vector3d random_direction(base::Random& random) {
  for (;;) {
    Eigen::Vector3d v;
    for (double& x : v) x = random.uniform(-1.0, 1.0);
    if (const double length = v.norm(); length > 0.1 && length < 1.0) return v / length;
  }
}

inline contact::Contact contact_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  contact::Contact contact;
  contact.point_O = point;
  contact.inward_normal_O = normal;
  return contact;
}

/// Draws contacts near the unit sphere, off it and off its normals.
inline std::vector<contact::Contact> random_contacts(base::Random& random, int count) {
  std::vector<contact::Contact> contacts;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d outward = random_direction(random);
    const Eigen::Vector3d point = random.uniform(0.6, 1.2) * outward;
    contacts.push_back(contact_at(point, -(outward + 0.4 * random_direction(random)).normalized()));
  }
  return contacts;
}

}  // namespace graspfit::testing
