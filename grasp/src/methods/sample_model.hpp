#pragma once

#include <vector>

#include "graspfit/geometry/surface_sampling.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"

namespace graspfit::grasp::internal {

/// The sampled geometry, the intermediate model of both readings of GS.
GuidanceModel sample_model(const std::vector<geometry::SurfaceSample>& samples);

}  // namespace graspfit::grasp::internal
