#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::testing {

inline Eigen::Vector3d random_unit(base::Random& random) {
  for (;;) {
    const Eigen::Vector3d v(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                            random.uniform(-1.0, 1.0));
    if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
  }
}

/// Returns a convex solid with corners on an ellipsoid.
inline geometry::TriangleMesh random_solid(base::Random& random) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 40; ++i) {
    mesh.vertices.push_back(random_unit(random).cwiseProduct(Eigen::Vector3d(0.1, 0.07, 0.05)));
  }
  for (const geometry::HullFacet& facet : geometry::convex_hull(mesh.vertices).facets) {
    mesh.faces.push_back({static_cast<std::int32_t>(facet[0]), static_cast<std::int32_t>(facet[1]),
                          static_cast<std::int32_t>(facet[2])});
  }
  return mesh;
}

}  // namespace graspfit::testing
