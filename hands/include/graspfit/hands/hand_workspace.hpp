#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// A range of distances over a hand's configurations [m]; both ends 0 where there is none.
///
/// Both ends belong to configurations that were found, so the true range is no smaller (up to
/// rounding), and larger by at most `error` at either end.
struct DistanceRange {
  double smallest = 0.0;
  double largest = 0.0;
  double error = 0.0;  ///< [m]; infinite where no bound is known.
  bool operator==(const DistanceRange&) const = default;
};

/// One range per pair of fingers, `[a][b]`.
using TipDistances = std::vector<std::vector<DistanceRange>>;

/// What a hand can reach, whatever it holds: computed once per hand. Couplings are kept; a
/// breakaway joint goes no farther than its coupling.
struct HandWorkspace {
  /// Between the tip pads' contact points of two fingers, where a pad's surface is over the origin
  /// of its frame (the origin itself, if it is flat): symmetric, zero on the diagonal and for
  /// fingers without a tip pad. The hand may touch itself.
  TipDistances tip_to_tip;
  /// Palm center to a finger's tip pad; zero without one. The hand may touch itself.
  std::vector<DistanceRange> palm_to_tip;
  /// Widths that fit between the tip pads of the thumb (`HandModel::thumb`) and of a finger where
  /// they face each other: one range per finger, zero for the thumb itself and where the pads never
  /// do; and over all fingers. No `error` is known (infinite).
  ///
  /// Pads face each other at distance D where both contact points look along the line between them
  /// within `facing_angle`, so that a ball of diameter D, or a wall D thick, held there is held by
  /// forces inside both friction cones. The hand is clear of itself: no two links overlap deeper
  /// than 0.1 mm (pads that close on each other just touch); the other fingers stand open.
  /// In between there may be gaps that a range does not show.
  std::vector<DistanceRange> graspable_diameter;
  DistanceRange any_graspable_diameter;
  bool operator==(const HandWorkspace&) const = default;
};

/// How configurations are sampled.
struct WorkspaceOptions {
  /// On a grid from limit to limit, per independent joint that moves one tip against the other,
  /// ≥ 2.
  int samples_per_joint = 24;
  /// Most grid points per pair of tips, ≥ 4: with more joints, fewer samples per joint. 2²³ leaves
  /// the Barrett hand its 24 (also with 7 DOFs, five of them per pair) and human fingers, eight
  /// joints per pair, 7.
  std::int64_t max_configurations = std::int64_t{1} << 23;
  /// Between a pad's normal and the line to the other pad [rad], in (0, π/2): by default the
  /// paper's friction cone of 45° (`grasp::TargetOptions::theta_max`), the planner's own condition
  /// for two targets.
  double facing_angle = std::numbers::pi / 4;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Ranges of the distances between fingertips, `HandWorkspace::tip_to_tip` alone.
///
/// Approximate: the ends of a grid in the independent joints of each pair of fingers. Joints that
/// carry both tips alike (a wrist) count for nothing, and the tips' positions are found once per
/// finger for each position of the joints that they share (Barrett's spread). Where the grid is
/// coarser than `samples_per_joint`, the best few of its points at either end are moved on, joint
/// by joint, until nothing gains: then the ends are usually right to 0.1 mm.
///
/// `error` is a bound, not an estimate: half a grid step of every joint, times the tips' largest
/// distances from its axis. It does not count what moving on gains.
///
/// A finger gets at most 2¹⁴ points of the grid; with more than 23 joints per pair, where not even
/// 2 samples each fit, configurations are random (seeded). Cost: one distance per grid point, some
/// nanoseconds each: milliseconds for the Barrett hand, half a second for a human hand.
/// @throws InvalidInput as the options' and the model's `validate`.
TipDistances tip_distances(const HandModel& model, const WorkspaceOptions& options = {});

/// Ranges of the distances from the palm's center to the fingertips, `HandWorkspace::palm_to_tip`
/// alone: a few thousand poses per finger. @throws InvalidInput as `tip_distances`.
std::vector<DistanceRange> palm_distances(const HandModel& model,
                                          const WorkspaceOptions& options = {});

/// The whole workspace of a hand. Ends of `graspable_diameter` are always moved on, as long as the
/// pads face each other and the hand is clear of itself; whether it is, is tested for one
/// configuration per millimeter of distance, the one whose pads face each other best, from either
/// end, and for each step from there.
/// @throws InvalidInput as the options' and the model's `validate`.
HandWorkspace hand_workspace(const HandModel& model, const WorkspaceOptions& options = {});

/// The same, kept in the user's cache by all of the model that it depends on (not its name or
/// files) and the options.
HandWorkspace cached_hand_workspace(const HandModel& model, const WorkspaceOptions& options = {},
                                    const base::ContentCache& cache = {});

}  // namespace graspfit::hands
