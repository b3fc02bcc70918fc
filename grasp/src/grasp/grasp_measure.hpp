#pragma once

#include "graspfit/grasp/grasp_measure.hpp"

namespace graspfit::grasp::internal {

/// `measure_grasp` in three steps, each of which takes what the one before returned: most attempts
/// of the planner end after the first, which is by far the cheapest.

/// Contacts and M.
Grasp with_contacts(const MeasuringScene& scene, const hands::HandConfiguration& configuration,
                    const RequestedParts& requested);

/// Adds how deep the hand penetrates itself.
Grasp with_self_penetration(const MeasuringScene& scene, Grasp grasp);

/// Adds the penetration of everything else, and ε.
Grasp with_all_measures(const MeasuringScene& scene, Grasp grasp);

}  // namespace graspfit::grasp::internal
