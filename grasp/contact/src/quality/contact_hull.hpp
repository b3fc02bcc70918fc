#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "graspfit/geometry/convex_hull.hpp"

namespace graspfit::contact::internal {

/// The contact polygon or polyhedron (paper section 4.3).
struct ContactHull {
  std::size_t num_contacts = 0;         ///< Before merging.
  std::vector<Eigen::Vector3d> points;  ///< Close contacts merged into their mean [m].
  geometry::ConvexHull3 hull;  ///< Hull of `points`; its rank is by the thresholds of `regularity`.
};

/// Contacts linked by chains of distances below `merge_distance` become one point, their mean, so
/// that the outcome does not depend on their order.
ContactHull contact_hull(std::span<const Eigen::Vector3d> contacts, double merge_distance);

}  // namespace graspfit::contact::internal
