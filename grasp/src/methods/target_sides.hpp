#pragma once

#include <optional>
#include <vector>

#include "graspfit/grasp/grasp_guidance.hpp"

namespace graspfit::grasp::internal {

/// Assigned targets and the side from which to reach for them.
struct TargetSide {
  TargetContacts targets;
  PalmPlacement placement;
  int imbalance = 0;  ///< Imbalance of the set, where that counts.
  double misfit = 0.0;
  std::optional<hands::HandConfiguration> goal = {};  ///< Where to bring the hand: `fitting_goal`
                                                      ///< if it was asked for, or as `is_at_goal`.
  /// Whether fingers cross at the start from this side, where that counts.
  bool do_fingers_cross = false;
  bool is_at_goal = false;  ///< The goal is a posture from which to refine, without closing.
  std::optional<double> promised_firmness = {};  ///< As in `GuidedStart`.
};

/// Sides of sets that balance first where that counts, then those from which fingers need not
/// cross, then those that suit the fingertips.
bool by_misfit(const TargetSide& a, const TargetSide& b);

/// The sides from which to reach for a set, in the order of their placements; judged by how they
/// suit the fingertips if `are_judged`.
std::vector<TargetSide> sides_of(const TargetContacts& targets, const GuidanceScene& scene,
                                 bool are_judged);

/// A start for each of the first `max_placements` sides; the starts refer to the scene.
std::vector<GuidedStart> starts_from(std::vector<TargetSide> sides, const GuidanceScene& scene);

}  // namespace graspfit::grasp::internal
