#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// A range of distances over a hand's configurations [m]; both ends are 0 where there is no range.
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

/// What a hand can reach, whatever it holds; it is computed once per hand. Coupled joints follow
/// their leaders; a breakaway joint goes no farther than its coupling.
struct HandWorkspace {
  /// Distances between the contact points of two fingers' tip pads (`pad_contact_point`). The
  /// matrix is symmetric, and zero on the diagonal and for fingers without a tip pad.
  /// Self-collision is allowed.
  TipDistances tip_to_tip;
  /// Distances from the palm center to the contact point of each finger's tip pad; zero for a
  /// finger without tip pad. Self-collision is allowed.
  std::vector<DistanceRange> palm_to_tip;
  /// Widths that fit between the tip pads of the thumb (`HandModel::thumb`) and of a finger where
  /// these pads face each other. There is one range per finger, zero for the thumb itself and for
  /// fingers whose pads never face the thumb's; `any_graspable_diameter` is the range over all
  /// fingers. No `error` is known (infinite).
  ///
  /// Pads face each other at distance D if each pad's normal is within `facing_angle` of the
  /// direction to the other pad's contact point, so that forces inside both friction cones hold a
  /// ball of diameter D, or a wall D thick, between them. No two links overlap deeper than 0.1 mm
  /// in these configurations (pads that close on each other just touch), and the other fingers are
  /// open. A range does not show gaps between its ends.
  std::vector<DistanceRange> graspable_diameter;
  DistanceRange any_graspable_diameter;
  bool operator==(const HandWorkspace&) const = default;
};

/// How configurations are sampled.
struct WorkspaceOptions {
  /// Number of samples per independent joint that moves one tip relative to the other, on a grid
  /// from limit to limit; ≥ 2.
  int samples_per_joint = 24;
  /// Largest number of grid points per pair of tips, ≥ 4: with more joints there are fewer samples
  /// per joint. With 2²³ points the Barrett hand keeps its 24 samples (also with 7 DOFs, five of
  /// them per pair), and human fingers, with eight joints per pair, get 7.
  std::int64_t max_configurations = std::int64_t{1} << 23;
  /// Largest angle between a pad's normal and the line to the other pad [rad], in (0, π/2). The
  /// default is the paper's friction cone of 45° (`grasp::TargetOptions::theta_max`), the planner's
  /// own condition for two targets.
  double facing_angle = std::numbers::pi / 4;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Ranges of the distances between fingertips, `HandWorkspace::tip_to_tip` alone.
///
/// The ranges are approximate: their ends are the best points of a grid in the independent joints
/// of each pair of fingers. Joints that carry both tips alike (a wrist) are not sampled, and the
/// tips' positions are computed once per finger for each position of the joints that they share
/// (Barrett's spread). Where the grid is coarser than `samples_per_joint`, the best few of its
/// points at either end are improved by local search, one joint at a time, until no step gains;
/// then the ends are usually right to 0.1 mm.
///
/// `error` is a bound, not an estimate: the sum, over the joints, of half a grid step times the
/// tips' largest distances from the joint's axis. It does not take the gain of the local search
/// into account.
///
/// A finger gets at most 2¹⁴ points of the grid; with more than 23 joints per pair, where not even
/// 2 samples per joint fit, configurations are random (seeded). Cost: one distance per grid point,
/// some nanoseconds each: milliseconds for the Barrett hand, half a second for a human hand.
/// @throws InvalidInput as the options' and the model's `validate`.
TipDistances tip_distances(const HandModel& model, const WorkspaceOptions& options = {});

/// Ranges of the distances from the palm's center to the fingertips, `HandWorkspace::palm_to_tip`
/// alone: a few thousand poses per finger. @throws InvalidInput as `tip_distances`.
std::vector<DistanceRange> palm_distances(const HandModel& model,
                                          const WorkspaceOptions& options = {});

/// The whole workspace of a hand. The ends of `graspable_diameter` are always improved by local
/// search, as long as the pads face each other and no links overlap. Overlap is tested from either
/// end of the range for one configuration per millimeter of distance, the one whose pads face each
/// other best, and for each step of the search from there.
/// @throws InvalidInput as the options' and the model's `validate`.
HandWorkspace hand_workspace(const HandModel& model, const WorkspaceOptions& options = {});

/// The result of `hand_workspace`, kept in the user's cache. Its key is made of the options and of
/// all of the model that the workspace depends on (not its name or files).
HandWorkspace cached_hand_workspace(const HandModel& model, const WorkspaceOptions& options = {},
                                    const base::ContentCache& cache = {});

}  // namespace graspfit::hands
