#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/grasp/finger_assignment.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"

/// \file
/// Scenes for tests of fitting: an object, a hand, and targets that are given by the test.

namespace graspfit::testing {

/// An object prepared for a hand (with the planner's options), and the hand prepared for it.
struct Scene {
  explicit Scene(const geometry::TriangleMesh& mesh, const std::string& hand_name = "barrett",
                 const grasp::PlannerOptions& options = {})
      : hand(hands::find_hand(hand_name)),
        object(grasp::prepare_object(mesh, hand, options)),
        fitting_hand(hand, grasp::FittingOptions{}.sample_spacing * object.grid.lattice.voxel_size),
        collision(hand),
        parts(grasp::requested_parts(hand, options)),
        nothing(hand, {}) {
    contact_options.clip_thickness = grasp::clip_thickness({}, object.grid.lattice.voxel_size);
  }

  double voxel_size() const { return object.grid.lattice.voxel_size; }

  grasp::TargetContacts assigned(const grasp::TargetContacts& targets,
                                 const grasp::PalmPlacement& placement) const {
    return grasp::assign_fingers(hand, targets, parts, placement);
  }
  grasp::FittingResult fit(const grasp::TargetContacts& assigned_targets,
                           const grasp::PalmPlacement& placement,
                           const grasp::FittingOptions& options = {},
                           grasp::GraspStyle style = grasp::GraspStyle::Precision) const {
    return grasp::fit_hand(grasp_scene(), style, assigned_targets, placement, options);
  }
  grasp::GraspScene grasp_scene() const { return {fitting_hand, object, nothing, contact_options}; }
  /// Returns the contacts of all pads where the hand has ended, those of requested parts marked as
  /// targets.
  std::vector<contact::Contact> contacts(const grasp::FittingResult& result) const {
    std::vector<contact::Contact> contacts = contact::estimate_contacts(
        hand, hands::forward_kinematics(hand, result.configuration), object.query, contact_options);
    const std::vector<int> pads = grasp::requested_pads(hand, parts);
    for (contact::Contact& contact : contacts) {
      contact.is_target = std::find(pads.begin(), pads.end(), contact.pad) != pads.end();
    }
    return contacts;
  }

  hands::HandModel hand;
  grasp::ObjectModel object;
  grasp::FittingHand fitting_hand;
  hands::HandCollision collision;
  contact::ContactEstimationOptions contact_options;
  grasp::RequestedParts parts;  ///< The parts have the thumb first.
  grasp::SurroundingsCollision nothing;
};

inline grasp::TargetContacts targets_at(const std::vector<Eigen::Vector3d>& points,
                                        const std::vector<Eigen::Vector3d>& outward_normals) {
  grasp::TargetContacts targets;
  for (std::size_t i = 0; i < points.size(); ++i) {
    grasp::TargetContact target;
    target.point_O = points[i];
    target.outward_normal_O = outward_normals[i].normalized();
    target.score = 1.0;
    targets.contacts.push_back(target);
  }
  return targets;
}

/// Returns three targets 120° apart on the circle of radius `radius` around `X_OT`'s z axis, with
/// radial normals and the seed at angle `turn`.
inline grasp::TargetContacts equilateral_targets(
    double radius, double turn,
    const geometry::RigidTransform& X_OT = geometry::RigidTransform::Identity()) {
  std::vector<Eigen::Vector3d> points, normals;
  for (int i = 0; i < 3; ++i) {
    const double angle = turn + i * 2.0 * std::numbers::pi / 3.0;
    const Eigen::Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
    points.push_back(X_OT * Eigen::Vector3d(radius * radial));
    normals.push_back(X_OT.linear() * radial);
  }
  return targets_at(points, normals);
}

/// Moves targets onto the surface and gives each the patch nearest to it.
inline grasp::TargetContacts on_surface(const grasp::ObjectModel& object,
                                        grasp::TargetContacts targets) {
  for (grasp::TargetContact& target : targets.contacts) {
    target.point_O = object.query.closest_point(target.point_O).point;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < object.patches.size(); ++i) {
      const double distance = (object.patches[i].centroid - target.point_O).norm();
      if (distance < nearest) {
        nearest = distance;
        target.patch = static_cast<int>(i);
      }
    }
  }
  return targets;
}

/// Returns points on every triangle of a mesh, on a grid not wider than `spacing`, corners
/// included.
inline std::vector<Eigen::Vector3d> dense_points(const geometry::TriangleMesh& mesh,
                                                 double spacing) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = geometry::corners(mesh, face);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        points.push_back(a + (b - a) * (double(i) / n) + (c - a) * (double(j) / n));
      }
    }
  }
  return points;
}

}  // namespace graspfit::testing
