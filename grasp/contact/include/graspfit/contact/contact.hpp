#pragma once

#include <Eigen/Core>
#include <optional>

namespace graspfit::contact {

/// A real contact between a pad of the hand and the object, in the object frame O.
struct Contact {
  Eigen::Vector3d point_O = Eigen::Vector3d::Zero();  ///< Point on the object's surface [m].
  Eigen::Vector3d inward_normal_O = Eigen::Vector3d::Zero();  ///< Unit normal, into the object.
  double area = 0.0;  ///< Area of the object's surface in the pad's clip volume [m²] (paper: A).
  double pad_boundary_distance = 0.0;  ///< Distance of the point from the pad's outline, in the
                                       ///< pad's plane [m] (paper: d).
  double gap = 0.0;  ///< Distance between the pad's surface on its link's mesh and the object [m],
                     ///< ≥ 0: `pad_gap`.
  int link = -1;     ///< Index of the link in the hand model.
  std::optional<int> pad;  ///< Index of the pad in the hand model; empty only for points that stand
                           ///< for contacts, such as targets.
  std::optional<int> finger;  ///< Index of the finger in the hand model; empty for the palm.
  bool is_target = false;     ///< The pad had a target contact.
  std::optional<bool> weak;   ///< Whether it is on a weak feature of the object (paper: S = 0);
                              ///< empty while unknown, which counts as not weak.
};

}  // namespace graspfit::contact
