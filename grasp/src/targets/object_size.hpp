#pragma once

#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp::internal {

/// Width of the widest fingertip pad among `fingers` [m].
double fingertip_width(const hands::HandModel& hand, const std::vector<int>& fingers);

/// Largest distance between two of the parts [m].
double widest_opening(const PartDistances& distances, const RequestedParts& parts);

/// Why an object could not be held in any pose: it is smaller than one fingertip, or thicker than
/// `widest`, both along the axes of the mesh's own frame. The text states the object's extents and
/// what to do: to name the object's unit or, where no hand has such dimensions, to correct the
/// hand's. Empty: the object may be held.
std::optional<std::string> size_refusal(const geometry::TriangleMesh& mesh,
                                        const hands::HandModel& hand,
                                        const std::vector<int>& fingers, double widest);

}  // namespace graspfit::grasp::internal
