#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hands/pad_samples.hpp"

namespace graspfit::grasp::internal {

/// Lines in the fingers, by the frames of their links to where their pads touch. Voxels do not show
/// that a finger goes through a wall that is thinner than they are; that such a line crosses the
/// surface does. Nothing is decided here that is not looked at exactly later.
class FingerBones {
 public:
  /// Refers to hand and object. The samples are of the hand's pads.
  FingerBones(const hands::HandModel& hand, const geometry::MeshQuery& object,
              const std::vector<const hands::PadSamples*>& samples);

  /// Whether the line to the pad does not cross the surface where the sample has it.
  /// @param samples index into those of the constructor
  bool is_free(std::size_t samples, std::int32_t sample,
               const geometry::RigidTransform& X_OH) const;

  /// Whether none of the lines to these pads does.
  bool are_free(const std::vector<int>& pads,
                const std::vector<geometry::RigidTransform>& X_OL) const;

 private:
  /// Lines to a pad, each of as many points, one line per sample.
  struct Lines {
    Eigen::Index per_sample = 0;
    Eigen::Matrix3Xd points_H;  ///< [m]
  };
  bool crosses(const Eigen::Vector3d& from_O, const Eigen::Vector3d& to_O) const;

  const hands::HandModel& hand_;
  const geometry::MeshQuery& object_;
  std::vector<std::vector<int>> links_;  ///< Per pad, those that move, from the palm on.
  std::vector<Lines> lines_;
};

}  // namespace graspfit::grasp::internal
