#include "targets/reachable_turns.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kTableCell = 0.006;          // [m], like a cell of the tips' reach
constexpr double kTurn = 2.0 * kPi / kTurns;  // [rad]
// Enlarges the search so that rounding excludes no turn [m] and [rad].
constexpr double kRounding = 1e-9;
constexpr double kMostCells = 0x1p26;  // 64 m squared

/// In [0, kTurns) for any azimuth.
int turn_of(double azimuth) {
  const int turn = static_cast<int>(std::floor(azimuth / kTurn)) % kTurns;
  return turn < 0 ? turn + kTurns : turn;
}

}  // namespace

PalmAxes::PalmAxes(const PalmReach& palm)
    : center_H_(palm.center_H),
      ahead_H_(palm.direction_H.normalized()),
      right_H_(ahead_H_.unitOrthogonal()),
      up_H_(ahead_H_.cross(right_H_)) {}

double PalmAxes::aside(const Vector3d& v) const {
  return std::sqrt(v.dot(up_H_) * v.dot(up_H_) + v.dot(right_H_) * v.dot(right_H_));
}

double PalmAxes::azimuth(const Vector3d& v) const {
  return std::atan2(v.dot(up_H_), v.dot(right_H_));
}

PointFromPalm PalmAxes::place(const Vector3d& from_center_H) const {
  return {ahead(from_center_H), aside(from_center_H), turn_of(azimuth(from_center_H))};
}

ReachableTurns::ReachableTurns(const PalmAxes& palm, const hands::TipReach& tip, double tolerance) {
  // A point is up to half a diagonal from the center of the cell that holds it.
  const double reach = tolerance + 0.5 * std::numbers::sqrt3 * tip.cell() + kRounding;
  double least = std::numeric_limits<double>::infinity();
  double largest = -least;
  double farthest = 0.0;
  for (const Vector3d& point_H : tip.visited_H()) {
    const Vector3d from_center = point_H - palm.center_H();
    least = std::min(least, palm.ahead(from_center));
    largest = std::max(largest, palm.ahead(from_center));
    farthest = std::max(farthest, palm.aside(from_center));
  }
  first_ahead_ = least - reach;
  const double num_ahead = std::ceil((largest - least + 2.0 * reach) / kTableCell) + 1;
  const double num_aside = std::ceil((farthest + reach) / kTableCell) + 1;
  // Written so that NaN fails.
  if (!(num_ahead * num_aside <= kMostCells)) {
    throw base::InvalidInput("ReachableTurns: a tip that gets " + base::shortest_decimal(farthest) +
                             " m away from the palm's axis reaches too far for cells of " +
                             base::shortest_decimal(kTableCell) +
                             " m: the hand's lengths are in another unit");
  }
  num_ahead_ = static_cast<int>(num_ahead);
  num_aside_ = static_cast<int>(num_aside);
  azimuths_.resize(static_cast<std::size_t>(num_ahead_) * static_cast<std::size_t>(num_aside_));
  for (const Vector3d& point_H : tip.visited_H()) {
    const Vector3d from_center = point_H - palm.center_H();
    add(palm.ahead(from_center), palm.aside(from_center), palm.azimuth(from_center), reach);
  }
}

void ReachableTurns::add(double ahead, double aside, double azimuth, double reach) {
  const auto cell_of = [](double length, int count) {
    return base::bounded_integer(std::floor(length / kTableCell), 0, count - 1);
  };
  const int first = cell_of(ahead - reach - first_ahead_, num_ahead_);
  const int last = cell_of(ahead + reach - first_ahead_, num_ahead_);
  for (int i = first; i <= last; ++i) {
    const double from = first_ahead_ + i * kTableCell;
    const double off = std::max({0.0, from - ahead, ahead - from - kTableCell});
    const double across = std::sqrt(std::max(0.0, reach * reach - off * off)) + kRounding;
    // Seen from the axis, a disk of that radius is this wide.
    const double half = across >= aside ? kPi : std::asin(across / aside);
    Turns seen;
    if (half + kTurn >= kPi) {
      seen.set();
    } else {
      const int width = static_cast<int>(std::ceil(2.0 * half / kTurn)) + 1;
      const int start = turn_of(azimuth - half - kRounding);
      for (int k = 0; k <= width; ++k) seen.set(static_cast<std::size_t>((start + k) % kTurns));
    }
    const int near = cell_of(aside - across, num_aside_);
    const int far = cell_of(aside + across, num_aside_);
    for (int j = near; j <= far; ++j) {
      azimuths_[i * num_aside_ + j] |= seen;
    }
  }
}

Turns ReachableTurns::at(const PointFromPalm& point) const {
  const double ahead = (point.ahead - first_ahead_) / kTableCell;
  const double aside = point.aside / kTableCell;
  if (ahead < 0.0 || ahead >= num_ahead_ || aside >= num_aside_) return {};
  const Turns& azimuths = azimuths_[static_cast<int>(ahead) * num_aside_ + static_cast<int>(aside)];
  // Turned by k, the point is at azimuth + k.
  const int by = point.azimuth;
  return (azimuths >> by) | (azimuths << (kTurns - by));
}

}  // namespace graspfit::grasp::internal
