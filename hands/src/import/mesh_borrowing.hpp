#pragma once

#include <filesystem>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Gives every link of `description` that has no geometry that of the only URDF in the folder of
/// its file, with mass and inertia where one link of the URDF has them, if the joints of both stand
/// in the same places: every joint axis of the one is, as a line in the root link's frame, one of
/// the other's, branching alike. Where a joint's angle is counted from does not matter: it is found
/// from the axis that comes next, or at the end of a finger from limits of equal width; failing
/// that both zeros are taken to be the same. Every mesh taken is noted; why none could be is
/// suspicious. Throws nothing.
void borrow_meshes(const std::filesystem::path& file, RobotDescription& description,
                   Findings& findings);

}  // namespace graspfit::hands::internal
