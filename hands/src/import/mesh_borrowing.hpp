#pragma once

#include <filesystem>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// `description`, in which every link that has no geometry has been given the geometry of the only
/// URDF in the folder of `file`, with mass and inertia where one link of the URDF has them. The
/// joints of both must be in the same positions: every joint axis of the one is, as a line in the
/// root link's frame, a joint axis of the other, and the joints branch alike. Their zero positions
/// may differ. The difference is found from the axis of the next joint, or at the end of a finger
/// from limits of equal width; failing that, both zeros are taken to be the same. Every borrowed
/// mesh is noted; if none could be borrowed, the reason is a suspicious finding, and the
/// description is returned as it was. Throws nothing.
RobotDescription with_borrowed_meshes(const std::filesystem::path& file,
                                      const RobotDescription& description, Findings& findings);

}  // namespace graspfit::hands::internal
