#pragma once

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// How far below a pad's modeled surface its link's mesh may lie and still count as the pad [m].
/// Pads follow the meshes of shipped hands within 0.4 mm; inner walls lie deeper.
inline constexpr double kPadDepth = 1e-3;

/// The part of a link's mesh that is a pad, in the link's frame: its faces that point along the
/// pad's z (normal z > 0 in C), cut along the prism over the outline, without those that lie
/// entirely deeper than `kPadDepth` below the pad. The surface is open, and rounded.
///
/// Where the mesh has no such face (the link has no mesh, or the pad floats in front of it), the
/// result is the pad's modeled surface: the outline, or the upper side of the bulge. It is never
/// empty. Cost: linear in the link's faces. @throws InvalidInput for a pad that the hand does not
/// have.
TriangleMesh pad_surface_L(const HandModel& model, int pad);

}  // namespace graspfit::hands
