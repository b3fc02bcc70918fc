#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// A place that a fingertip's contact point gets to, in H.
struct TipPose {
  Eigen::Vector3d point_H;
  Eigen::Vector3d normal_H;  ///< Of the pad there, unit: toward what it touches.
};

/// Where the contact point of one fingertip gets, in H, and which way its pad looks there: for each
/// of 14 directions the cells of a lattice that it visits with the pad's normal within 50° of it.
///
/// Approximate: sampled on a grid of the finger's independent joints, couplings kept, a breakaway
/// joint no farther than its coupling. The hand may touch itself there.
class TipReach {
 public:
  /// Marks the cells, `cell` wide [m], that hold one of `poses`; at least one.
  TipReach(const std::vector<TipPose>& poses, double cell);

  /// Distance from the cell that holds `point_H` to the nearest cell visited with the pad looking
  /// along `normal_H` [m], center to center; 0 in a visited cell, infinite without one.
  ///
  /// Off by at most a cell's diagonal inside the visited cells' box; outside, a bound from below. A
  /// pad within 14° of `normal_H` counts, one 86° off does not: the nearest of the 14 directions is
  /// at most 36° away.
  double distance(const Eigen::Vector3d& point_H, const Eigen::Vector3d& normal_H) const;

  /// Centers of all cells visited, whichever way the pad looks there, each once; and their width
  /// [m].
  const std::vector<Eigen::Vector3d>& visited_H() const { return visited_H_; }
  double cell() const { return cell_; }

 private:
  double cell_ = 0.0;
  std::vector<Eigen::Vector3d> visited_H_;
  std::vector<std::optional<geometry::SignedDistanceMap>> maps_H_;  ///< One per direction.
};

/// The reach of every finger's tip; empty for fingers without a tip pad.
///
/// Every finger gets at most 2¹⁴ samples and at most 128 per joint: some 6 mm apart at the Barrett
/// hand's tips, up to 20 mm at a human hand's. Cells are 6 mm. Cost: tenths of a second. @throws
/// InvalidInput as the model's `validate`.
std::vector<std::optional<TipReach>> tip_reaches(const HandModel& model);

}  // namespace graspfit::hands
