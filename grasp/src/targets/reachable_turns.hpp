#pragma once

#include <Eigen/Core>
#include <bitset>
#include <vector>

#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp::internal {

/// Turns of the hand around the palm's direction that are tried: 5 degrees apart, some 10 mm at a
/// fingertip's distance.
inline constexpr int kTurns = 72;

/// A set of those turns.
using Turns = std::bitset<kTurns>;

/// A point in cylindrical coordinates about the palm's center: the coordinate along the palm's
/// direction, the distance from that axis, and the turn in whose width the azimuth lies.
struct PointFromPalm {
  double ahead = 0.0;  ///< [m]
  double aside = 0.0;  ///< [m], ≥ 0
  int azimuth = 0;     ///< In [0, kTurns).
};

/// The palm's center and direction with two directions that make a right-handed frame of it, from
/// which azimuths are counted.
class PalmAxes {
 public:
  explicit PalmAxes(const PalmReach& palm);
  PointFromPalm place(const Eigen::Vector3d& from_center_H) const;
  const Eigen::Vector3d& center_H() const { return center_H_; }
  double ahead(const Eigen::Vector3d& v) const { return v.dot(ahead_H_); }
  double aside(const Eigen::Vector3d& v) const;
  double azimuth(const Eigen::Vector3d& v) const;  ///< [rad]

 private:
  Eigen::Vector3d center_H_, ahead_H_, right_H_, up_H_;
};

/// A table of the turns of the hand at which a fingertip gets near a point, looked up by the point.
/// No such turn is missing, but some are too many; the direction that the pad faces is ignored.
class ReachableTurns {
 public:
  /// @param tolerance how near [m].
  ReachableTurns(const PalmAxes& palm, const hands::TipReach& tip, double tolerance);

  /// Every turn k at which `hands::TipReach` has a visited cell within the tolerance of the cell
  /// that holds the point turned by k · 2π/kTurns, and possibly further turns.
  Turns at(const PointFromPalm& point) const;

 private:
  /// Adds the azimuths near a visited cell to the table's cells near it.
  void add(double ahead, double aside, double azimuth, double reach);

  double first_ahead_ = 0.0;  ///< Of the table [m].
  int num_ahead_ = 0;
  int num_aside_ = 0;
  std::vector<Turns> azimuths_;  ///< Per cell, aside fastest.
};

}  // namespace graspfit::grasp::internal
