#pragma once

#include <Eigen/Core>
#include <optional>

namespace graspfit::contact {

/// A real contact between a pad of the hand and the object, in the object frame O.
struct Contact {
  Eigen::Vector3d point_O = Eigen::Vector3d::Zero();          ///< On the object's surface [m].
  Eigen::Vector3d inward_normal_O = Eigen::Vector3d::Zero();  ///< Unit, into the object.
  double area = 0.0;  ///< Object surface inside the pad's clip volume [m²] (paper: A).
  double pad_boundary_distance = 0.0;  ///< From the outline, in the pad's plane [m] (paper: d).
  double gap =
      0.0;  ///< Between the pad's surface on its link's mesh and the object [m], ≥ 0: `pad_gap`.
  int link = -1;              ///< Of the hand model.
  int pad = -1;               ///< Of the hand model.
  std::optional<int> finger;  ///< Of the hand model; empty: the palm.
  bool is_target = false;     ///< The pad had a target contact.
  std::optional<bool> weak;   ///< On a weak feature of the object (paper: S = 0); empty while
                              ///< unknown, which counts as not weak.
};

}  // namespace graspfit::contact
