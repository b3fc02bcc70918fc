#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// A position that a fingertip's contact point reaches, in H, and the pad's normal there.
struct TipPose {
  Eigen::Vector3d point_H;
  Eigen::Vector3d normal_H;  ///< Unit normal of the pad, toward the touched object.
};

/// The positions that the contact point of one fingertip reaches, in H, and the directions that its
/// pad faces there. For each of 14 directions it holds the cells of a lattice that the contact
/// point visits while the pad's normal is within 50° of that direction.
///
/// The reach is approximate: the finger's independent joints are sampled on a grid, coupled joints
/// follow, and a breakaway joint goes no farther than its coupling. Self-collision is allowed.
class TipReach {
 public:
  /// Marks the cells, `cell` wide [m], that hold one of `poses`, of which there must be at least
  /// one.
  TipReach(const std::vector<TipPose>& poses, double cell);

  /// Distance from the cell that holds `point_H` to the nearest cell visited with the pad facing
  /// along `normal_H` [m], from center to center; 0 in a visited cell, infinite if there is none.
  ///
  /// The error is at most a cell's diagonal inside the box of the visited cells; outside this box
  /// the distance is a lower bound. Poses whose pad normal is within 14° of `normal_H` count, poses
  /// whose normal is 86° off do not: the nearest of the 14 directions is at most 36° away.
  double distance(const Eigen::Vector3d& point_H, const Eigen::Vector3d& normal_H) const;

  /// Centers of all visited cells, each once, whatever direction the pad faces there; `cell` is the
  /// width of the cells [m].
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
/// hand's tips, up to 20 mm at a human hand's. Cells are 6 mm wide. Cost: tenths of a second.
/// @throws InvalidInput as the model's `validate`.
std::vector<std::optional<TipReach>> tip_reaches(const HandModel& model);

}  // namespace graspfit::hands
