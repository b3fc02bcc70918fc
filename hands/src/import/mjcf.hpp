#pragma once

#include <filesystem>
#include <string>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Reads MJCF through the MuJoCo library, which resolves includes, defaults, angle units and mesh
/// files; `file` is the path of the text. Poses are MuJoCo's doubles, mesh vertices its single
/// precision (relative 6e-8), which `findings` notes. Joint positions are MuJoCo's qpos: with the
/// same positions every link has the pose of MuJoCo's body of the same name.
///
/// - Links are bodies. A body with several joints, or with an anchor beside its origin, hangs on
///   links `<body>__<joint>` without mass or surface.
/// - The root is the one child of the world with movable joints below it, or the world if such a
///   joint connects to it (MuJoCo's URDF reader makes the URDF's root the world). Bodies that are
///   not below the root are left out, and so is a free joint of the root.
/// - Geoms that can collide are collision geometry, others visual.
/// - Couplings: see `read_mjcf_couplings`. Exclusions: <exclude>, and pairs that contype and
///   conaffinity keep apart.
/// @throws IoError (file, MuJoCo's own words) where MuJoCo refuses the description, or in a build
/// without MuJoCo; as `check_mjcf_files`.
/// @throws InvalidInput (file, item) for what a hand cannot have: ball joints, slides without
/// limits, several free bodies with joints.
RobotDescription parse_mjcf(const std::string& text, const std::filesystem::path& file,
                            Findings& findings);

}  // namespace graspfit::hands::internal
