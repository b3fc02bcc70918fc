#pragma once

#include <Eigen/Geometry>
#include <string>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::testing {

/// Returns a hand of a palm and two jaws, which are boxes of 20 mm that slide along x towards each
/// other: at q the inner faces are at x = ∓(0.06 − q). The palm is 0.5 m above.
inline hands::HandModel two_jaws() {
  hands::HandModel hand;
  hand.name = "two jaws";
  hands::Link palm;
  palm.name = "palm";
  palm.mesh_L = geometry::transformed(geometry::box({0.1, 0.02, 0.02}),
                                      hands::RigidTransform(Eigen::Translation3d(0, 0, 0.5)));
  hand.links.push_back(palm);
  for (const double side : {-1.0, 1.0}) {
    const int index = static_cast<int>(hand.joints.size());
    hands::Joint joint;
    joint.name = side < 0 ? "left" : "right";
    joint.type = hands::JointType::Prismatic;
    joint.parent_link = 0;
    joint.child_link = index + 1;
    joint.X_PJ = Eigen::Translation3d(side * 0.07, 0, 0);
    joint.axis_J = Eigen::Vector3d(-side, 0, 0);
    joint.lower = 0.0;
    joint.upper = 0.06;
    joint.closing_sign = 1;
    hand.joints.push_back(joint);
    hands::Link jaw;
    jaw.name = joint.name;
    jaw.parent_link = 0;
    jaw.parent_joint = index;
    jaw.mesh_L = geometry::box({0.02, 0.02, 0.02});
    hand.links.push_back(jaw);
  }
  hand.palm.link = 0;
  return hand;
}

inline hands::HandConfiguration jaws_at(double left, double right) {
  hands::HandConfiguration configuration;
  configuration.q = Eigen::Vector2d(left, right);
  return configuration;
}

/// Returns a pinch of a cube of 40 mm around the origin, pressed with `force` [N] by either jaw;
/// the slides have `slide_stiffness` [N/m].
inline grasp::Grasp pinch(double force, double slide_stiffness = 2000.0) {
  const double touching = 0.04;
  const double pressing = touching + force / slide_stiffness;
  grasp::Grasp result;
  result.configuration = jaws_at(touching, touching);
  result.pre_grasp.emplace();
  result.pre_grasp->configuration = jaws_at(0.03, 0.03);
  result.squeeze.emplace();
  result.squeeze->configuration = jaws_at(pressing, pressing);
  return result;
}

/// Returns a convex solid as its own only piece.
inline geometry::ConvexDecomposition one_piece(const geometry::TriangleMesh& convex) {
  geometry::ConvexDecomposition shape;
  shape.pieces = {convex};
  return shape;
}

inline hold_test::HoldObject convex_object(const geometry::TriangleMesh& mesh) {
  const geometry::MassProperties mass = geometry::mass_properties(mesh);
  return {one_piece(mesh), mass.center_of_mass, mass.inertia / mass.volume, mass.volume, {}};
}

/// Returns a hand whose links are convex.
inline hold_test::HoldHand convex_hand(const hands::HandModel& model) {
  hold_test::HoldHand hand{model, {}};
  for (const hands::Link& link : model.links) hand.links.push_back(one_piece(link.mesh_L));
  return hand;
}

inline hold_test::HoldTest jaws_on_cube(const hold_test::HoldProtocol& protocol) {
  return {convex_hand(two_jaws()), convex_object(geometry::box({0.04, 0.04, 0.04})), protocol};
}

/// Returns a hand of six plates around a closed space from −`half_width` to `half_width`, which
/// cannot move.
inline hands::HandModel closed_room(double half_width) {
  hands::HandModel hand;
  hand.name = "room";
  for (int wall = 0; wall < 6; ++wall) {
    const int axis = wall / 2;
    Eigen::Vector3d size = Eigen::Vector3d::Constant(2.0 * half_width + 0.02);
    size[axis] = 0.01;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    center[axis] = (wall % 2 == 0 ? -1.0 : 1.0) * (half_width + 0.005);
    hands::Link link;
    link.name = "wall_" + std::to_string(wall);
    if (wall > 0) link.parent_link = 0;
    link.mesh_L = geometry::transformed(geometry::box(size),
                                        hands::RigidTransform(Eigen::Translation3d(center)));
    hand.links.push_back(link);
  }
  hand.palm.link = 0;
  return hand;
}

}  // namespace graspfit::testing
