#pragma once

#include <string>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::exchange {

/// Posed hand and object as glTF 2.0 binary (GLB) [Khronos Group, glTF 2.0 specification]: a root
/// node "O" with a node "object" and one per link with faces under its name, posed by translation
/// and rotation (quaternion x, y, z, w).
///
/// Units are meters, and axes those of O. (glTF's convention that +y is up is not imposed on the
/// object.) Meshes are in the links' frames, in single precision as the format has it: rounded to
/// 6e-8 of their extent. Faces are not smoothed. The same input gives the same bytes.
std::string posed_scene_glb(const geometry::TriangleMesh& object, const hands::HandModel& hand,
                            const hands::HandConfiguration& configuration);

}  // namespace graspfit::exchange
