#pragma once

#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// A range of distances over a hand's configurations [m]; both 0 where there is none.
struct DistanceRange {
  double smallest = 0.0;
  double largest = 0.0;
};

/// What a hand can reach, whatever it holds: computed once per hand. Couplings are kept, breakaway
/// is not counted, self-collision is.
struct HandWorkspace {
  /// Between the tip pads' centers of two fingers: symmetric, zero on the diagonal and for fingers
  /// without a tip pad (notes A18).
  std::vector<std::vector<DistanceRange>> tip_to_tip;
  std::vector<DistanceRange> palm_to_tip;  ///< Palm center to a finger's tip pad center.
  /// Diameters of balls between two tip pads that face each other, thumb against finger: one range
  /// per finger, zero for the thumb itself; and over all fingers.
  std::vector<DistanceRange> graspable_diameter;
  DistanceRange any_graspable_diameter;
};

/// How the configurations are sampled.
struct WorkspaceOptions {
  int samples_per_joint = 24;  ///< On a grid, per independent joint of one finger, ≥ 2.
  void validate() const;       ///< Throws InvalidInput naming the field and its value.
};

/// The workspace of a hand. Distances are of sampled configurations: inner bounds of the true
/// ranges, in error by at most the arc between neighboring samples. Rounded. Cost: pairs of fingers
/// times samples; milliseconds for the Barrett hand.
/// @throws InvalidInput as the options' and the model's `validate`.
HandWorkspace hand_workspace(const HandModel& model, const WorkspaceOptions& options = {});

/// The same, kept in the user's cache folder by the content of the model and the options.
HandWorkspace cached_hand_workspace(const HandModel& model, const WorkspaceOptions& options = {});

}  // namespace graspfit::hands
