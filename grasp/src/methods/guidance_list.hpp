#pragma once

#include <memory>

#include "graspfit/grasp/grasp_guidance.hpp"

/// \file
/// The functions that make each method's guidance, in the sources of their names.

namespace graspfit::grasp::internal {

std::unique_ptr<GraspGuidance> fitting_guidance(const GuidanceScene& scene);
std::unique_ptr<GraspGuidance> sample_target_guidance(const GuidanceScene& scene);
std::unique_ptr<GraspGuidance> sampling_guidance(const GuidanceScene& scene);
std::unique_ptr<GraspGuidance> medial_guidance(const GuidanceScene& scene);
std::unique_ptr<GraspGuidance> medial_guidance_with_full_retreat(const GuidanceScene& scene);

}  // namespace graspfit::grasp::internal
