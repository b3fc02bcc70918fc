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

/// Why an object could not be held in any pose: along the axes of the mesh's own frame it is
/// smaller than one fingertip, or thicker than the parts of the hand can be apart. The text states
/// the object's extents and what to do: to name the object's unit or, where no hand has such
/// dimensions, to correct the hand's. Empty: the object may be held.
std::optional<std::string> size_refusal(const geometry::TriangleMesh& mesh,
                                        const hands::HandModel& hand, const RequestedParts& parts);

}  // namespace graspfit::grasp::internal
