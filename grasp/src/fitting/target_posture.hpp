#pragma once

#include <Eigen/Core>

#include "graspfit/grasp/palm_placement.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// The posture at which the paper's five steps would rest were there no object: fingertips (and
/// palm) at their targets as nearly as the hand can. Steps 2 to 5 move the hand toward it.

namespace graspfit::grasp::internal {

/// A posture and the errors that it leaves.
struct TargetPosture {
  hands::HandConfiguration configuration;
  double largest_miss = 0.0;  ///< Of a fingertip's contact point from its target [m].
  double largest_tilt = 0.0;  ///< Of a fingertip's pad from its target's surface [rad].
};

/// The posture of least squared errors at the targets. Variables are the palm's position along and
/// across the placement's palm direction, its turn about that direction, and the joints of fingers
/// with targets. Errors are the distance of each fingertip from its target and of its normal from
/// the target's reversed normal, and the distance of the palm center from the palm's target. The
/// palm direction is fixed [P]; that the palm center stays `palm_distance` before the targets'
/// centroid is a preference. The method is Levenberg-Marquardt with joint limits; the search is
/// local and starts from the open hand aligned with the targets (section 7), its fingers half way
/// closed.
TargetPosture posture_for(const hands::HandModel& hand, const TargetContacts& targets,
                          const PalmPlacement& placement);

/// The criterion by which the planner chooses among target sets, smaller is better [rad] [R]: how
/// far the hand would be from reaching assigned targets, were there no object. It is computed in
/// `posture`, the posture of these targets: the largest angle between a fingertip pad's normal and
/// its target's inward normal, plus the largest distance of a fingertip from its target, of which
/// 15 mm count as one radian. Where the palm has no target (against which fingers press), half the
/// mean angle by which pairs of fingertips fail to face each other is added. The pairs are those of
/// the seed's finger with every other one, as in selection; a pair's angle is the larger one
/// between a pad's normal and the line to the other pad's contact point. Where pads lie flat their
/// normals are those of the contacts, so that a set with small angles leaves stable pairs even if
/// the fingertips land beside their targets: "the ideal grasp scores high on M" and contacts "the
/// hand can plausibly reach" (paper section 1; no formula there) read through the hand's
/// kinematics.
double reach_misfit(const hands::HandModel& hand, const TargetContacts& targets,
                    const TargetPosture& posture);

}  // namespace graspfit::grasp::internal
