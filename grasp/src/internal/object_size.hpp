#pragma once

#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp::internal {

/// Width of the widest fingertip pad among `fingers` [m].
double fingertip_width(const hands::HandModel& hand, const std::vector<int>& fingers);

/// Largest distance between two of the parts [m].
double widest_opening(const PartDistances& distances, const RequestedParts& parts);

/// Refuses objects that could not be held whatever their pose: smaller than one fingertip, or
/// thicker than `widest` in every direction. @throws InvalidInput with the extents.
void check_object_size(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                       const std::vector<int>& fingers, double widest);

}  // namespace graspfit::grasp::internal
