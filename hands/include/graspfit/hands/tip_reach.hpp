#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Where the contact point of one fingertip gets, in H: the cells of a lattice that it visits.
///
/// Approximate: sampled on a grid of the finger's independent joints, couplings kept, a breakaway
/// joint no farther than its coupling. The hand may touch itself there.
class TipReach {
 public:
  /// Marks the cells, `cell` wide [m], that hold one of `points_H`; at least one point.
  TipReach(const std::vector<Eigen::Vector3d>& points_H, double cell);

  /// Distance from the cell that holds `point_H` to the nearest visited one, center to center [m];
  /// 0 in a visited cell. Off by at most a cell's diagonal.
  double distance(const Eigen::Vector3d& point_H) const;

  /// Box of the visited cells, in H.
  const Eigen::AlignedBox3d& box_H() const { return box_H_; }

 private:
  geometry::SignedDistanceMap map_H_;
  Eigen::AlignedBox3d box_H_;
};

/// The reach of every finger's tip; empty for fingers without a tip pad.
///
/// Every finger gets at most 2¹⁴ samples and at most 128 per joint: 6 mm apart at the Barrett
/// hand's tips, up to a few cells at a human hand's. Cells are 6 mm. Cost: a tenth of a second for
/// a hand of four joints per finger. @throws InvalidInput as the model's `validate`.
std::vector<std::optional<TipReach>> tip_reaches(const HandModel& model);

}  // namespace graspfit::hands
