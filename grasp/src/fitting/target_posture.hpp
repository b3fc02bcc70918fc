#pragma once

#include <Eigen/Core>

#include "graspfit/grasp/palm_placement.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// The posture at which the paper's five steps would rest were there no object: fingertips (and
/// palm) at their targets as nearly as the hand can. Steps 2 to 5 move the hand toward it.

namespace graspfit::grasp::internal {

/// A posture and what it leaves.
struct TargetPosture {
  hands::HandConfiguration configuration;
  double largest_miss = 0.0;  ///< Of a fingertip's contact point from its target [m].
  double largest_tilt = 0.0;  ///< Of a fingertip's pad from its target's surface [rad].
};

/// Least squares over the palm's place along and across the placement's palm direction, its turn
/// about that direction, and the joints of fingers with targets: distance of each fingertip from
/// its target and of its normal from the target's reversed one; the palm center from the palm's
/// target. The palm direction is kept [P]; the palm center stays `palm_room` before the targets'
/// centroid as a preference. Levenberg-Marquardt with joint limits; local: from the open hand
/// aligned with the targets (section 7), its fingers half way closed.
TargetPosture posture_for(const hands::HandModel& hand, const TargetContacts& targets,
                          const PalmPlacement& placement);

/// By what the planner chooses among target sets, smaller is better [rad] [R]: how far the hand
/// would be from reaching assigned targets, were there no object. In `posture`, that of these
/// targets: the largest angle between a fingertip pad's normal and its target's inward normal, plus
/// the largest miss, 15 mm of it counting as one radian; and, where the palm has no target (against
/// which fingers press), half the mean angle by which pairs of fingertips miss looking at each
/// other. The pairs are those of the seed's finger with every other one, as in selection; a
/// pair's angle is the larger one between a pad's normal and the line to the other pad's contact
/// point. Where pads lie flat their normals are those of the contacts, so that a set with small
/// angles leaves stable pairs even if the fingertips land beside their targets: "the ideal grasp
/// scores high on M" and contacts "the hand can plausibly reach" (paper section 1; no formula
/// there) read through the hand's kinematics.
double reach_misfit(const hands::HandModel& hand, const TargetContacts& targets,
                    const TargetPosture& posture);

}  // namespace graspfit::grasp::internal
