#pragma once

#include <vector>

#include "graspfit/grasp/grasp_measure.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {

/// `measure_grasp` in four steps, each of which takes what the one before returned: most attempts
/// of the planner end after the first, which is by far the cheapest, and the last one is needed of
/// grasps only that an attempt keeps.

/// A grasp that is being measured, with the link poses of its configuration.
struct PosedGrasp {
  Grasp grasp;
  std::vector<hands::RigidTransform> X_OL;
};

/// Contacts and M.
PosedGrasp with_contacts(const MeasuringScene& scene, const hands::HandConfiguration& configuration,
                         const RequestedParts& requested);

/// Adds how deep the hand penetrates itself.
PosedGrasp with_self_penetration(const MeasuringScene& scene, PosedGrasp measured);

/// Adds the penetration of everything else.
PosedGrasp with_penetration(const MeasuringScene& scene, PosedGrasp measured);

/// Adds ε.
Grasp with_wrench_quality(const MeasuringScene& scene, Grasp grasp);

}  // namespace graspfit::grasp::internal
