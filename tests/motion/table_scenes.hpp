#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/motion/table_motion.hpp"

/// \file
/// Objects on a table for the tests of motions.

namespace graspfit::testing {

using geometry::RigidTransform;
using motion::Collision;
using motion::MotionSegment;
using motion::SceneObject;
using motion::TableScene;

inline SceneObject scene_object(std::string name, geometry::TriangleMesh mesh) {
  const Eigen::Vector3d center = geometry::mass_properties(mesh).center_of_mass;
  return {std::move(name), geometry::MeshQuery(std::move(mesh)), center};
}

inline RigidTransform at(const Eigen::Vector3d& place, double turn_about_z = 0.0) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = Eigen::AngleAxisd(turn_about_z, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X.translation() = place;
  return X;
}

/// Returns an overlap at one of `samples` + 1 evenly spaced points of a segment, if there is one;
/// exact tests decide.
inline std::optional<Collision> sampled_overlap(const TableScene& scene,
                                                const std::vector<RigidTransform>& X_WO,
                                                const MotionSegment& segment, int samples) {
  for (int i = 0; i <= samples; ++i) {
    if (auto met = motion::find_overlap(scene, X_WO, segment, static_cast<double>(i) / samples))
      return met;
  }
  return std::nullopt;
}

}  // namespace graspfit::testing
