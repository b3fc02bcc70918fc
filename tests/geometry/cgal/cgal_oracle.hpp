#pragma once

#include <CGAL/enum.h>

#include <Eigen/Geometry>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

/// \file
/// What the tests share in which CGAL answers, by its own algorithms, what ours are asked. Both see
/// the same doubles and both decide exactly, so that decisions have to be equal, not close; what is
/// constructed is compared up to rounding.

namespace graspfit::testing {

/// Returns a random point of the box.
inline Eigen::Vector3d drawn_point(base::Random& random, const Eigen::AlignedBox3d& box) {
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] = random.uniform(box.min()[axis], box.max()[axis]);
  }
  return point;
}

/// Returns a random turn with a translation of up to `most` along each axis.
inline geometry::RigidTransform drawn_pose(base::Random& random, double most) {
  Eigen::Vector4d q;
  for (double& x : q) x = random.uniform(-1.0, 1.0);
  geometry::RigidTransform X(Eigen::Quaterniond(q).normalized());
  for (double& x : X.translation()) x = random.uniform(-most, most);
  return X;
}

inline geometry::Containment containment_of(CGAL::Bounded_side side) {
  if (side == CGAL::ON_BOUNDARY) return geometry::Containment::OnSurface;
  return side == CGAL::ON_BOUNDED_SIDE ? geometry::Containment::Inside
                                       : geometry::Containment::Outside;
}

/// How many answers there were of each kind: a test that has seen none of one kind shows nothing
/// about it.
struct ContainmentCounts {
  int inside = 0;
  int on_surface = 0;
  int outside = 0;

  void add(geometry::Containment containment) {
    inside += containment == geometry::Containment::Inside;
    on_surface += containment == geometry::Containment::OnSurface;
    outside += containment == geometry::Containment::Outside;
  }
};

}  // namespace graspfit::testing
