#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/hands/hand_model.hpp"

/// \file
/// What a hand can pinch squarely: how much its pads must lean to the line between them, by the
/// width of what is between them. Kinematics alone, whatever the object.

namespace graspfit::hands {

/// Which pads press against each other.
enum class PinchKind {
  Tips,  ///< The thumb's tip pad (`HandModel::thumb`) and that of another finger.
  /// The thumb's tip pad and those of two other fingers, neighbors in the model's order, side by
  /// side: their normals are at most 15° apart. They close alike: their independent joints, counted
  /// from the tips, stand at the same shares of their ranges, from where these open the hand;
  /// swinging joints whose ranges are mirror images ([-a, b] and [-b, a]), at mirrored positions.
  TwoFingers,
  Palm,      ///< The pad of a fingertip and the palm's.
  Proximal,  ///< A pad of the thumb and a pad of another finger, at least one of them no tip's.
};

/// All of them, in this order.
inline constexpr PinchKind kPinchKinds[] = {PinchKind::Tips, PinchKind::TwoFingers, PinchKind::Palm,
                                            PinchKind::Proximal};

/// A configuration in which pads face each other.
struct Pinch {
  /// Distance between the contact points of the pads (`pad_contact_point`); of two fingers, from
  /// the point in the middle between theirs [m].
  double opening = 0.0;
  /// Largest angle between a pad's normal and the line from its side's point to the other's [rad].
  /// An object with parallel faces is held only with a friction of at least its tangent.
  double lean = 0.0;
  std::vector<int> pads;  ///< The thumb's or palm's pad first.
  Eigen::VectorXd q;      ///< One position per joint.
};

struct PinchChartOptions {
  double step = 0.005;  ///< Width of a class of openings [m], > 0.
  /// Largest number of configurations per set of pads, ≥ 2; a grid in their independent joints.
  std::int64_t max_configurations = std::int64_t{1} << 20;
  /// Overlap of links up to which they count as touching [m], > 0; a deeper one is noticed from 1.5
  /// times this depth on (`HandCollision::overlaps_self`).
  double touch_depth = 1e-4;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// The pinches of least lean, by opening.
struct PinchChart {
  static constexpr int kMostClasses = 2000;  ///< Of openings.
  PinchKind kind = PinchKind::Tips;
  double step = 0.0;  ///< [m]
  int num_sets = 0;   ///< Sets of pads looked at; 0: the hand has none for this kind.
  /// Number k is for openings in [k · step, (k + 1) · step); empty where every configuration that
  /// was looked at leans by 80° or more, or brings links into each other.
  std::vector<std::optional<Pinch>> pinches;
};

/// The pinch of least lean of all openings; null without any.
const Pinch* squarest(const PinchChart& chart);

/// The chart of one kind of pinch. The thumb is `HandModel::thumb`, the first finger where none is
/// marked. Fingers that do not take part are open. Coupled joints follow their leaders; a breakaway
/// joint goes no farther than its coupling.
///
/// Approximate: per class of openings, set of pads and 4° of lean, the configuration of a grid that
/// leans least is kept; the least of these whose links do not overlap by more than `touch_depth` is
/// improved by local search, also from the pinches of its neighbors. The lean is that of a
/// configuration that was found, so the least one is no larger. Deterministic. Cost: some seconds
/// for a hand with five fingers, and in proportion to the number of classes.
/// @throws InvalidInput as the options' and the model's `validate`, and where openings have more
/// than `PinchChart::kMostClasses`.
PinchChart pinch_chart(const HandModel& model, PinchKind kind,
                       const PinchChartOptions& options = {});

/// The result of `pinch_chart`, kept in the user's cache. Its key is made of kind, options, and of
/// all of the model that a chart depends on (not its name or files).
PinchChart cached_pinch_chart(const HandModel& model, PinchKind kind,
                              const PinchChartOptions& options = {},
                              const base::ContentCache& cache = {});

/// A range of openings [m].
struct OpeningRange {
  double smallest = 0.0;
  double largest = 0.0;
  bool operator==(const OpeningRange&) const = default;
};

/// Widths that are pinched squarely: the ranges of openings, between whole steps of the chart,
/// whose least lean is at most atan(friction), ascending.
std::vector<OpeningRange> square_widths(const PinchChart& chart, double friction);

}  // namespace graspfit::hands
