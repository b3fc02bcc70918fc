#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/exchange/imported_grasps.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/hand_model.hpp"

/// \file
/// isaac_grasp 1.0, the grasp files of NVIDIA's Isaac Sim and Isaac ROS [NVIDIA Isaac ROS
/// documentation, "Isaac Grasp File"; Isaac Sim documentation, "Grasp Editor"].
///
/// A YAML map: `format`, `format_version`, the names of two frames (`object_frame_link` and
/// `gripper_frame_link` in Isaac Sim's page, `object_frame` and `gripper_frame` in Isaac ROS's;
/// both are for people, programs are told not to rely on them), and `grasps` by name: `confidence`
/// from 0 to 1, `position` and `orientation` {w, xyz} of the gripper's frame in the object's,
/// `cspace_position` and `pregrasp_cspace_position` by joint. Meters and radians.

namespace graspfit::exchange {

/// The text of an isaac_grasp 1.0 file: X_OH of every grasp, all joints (coupled ones too), the
/// joints of the pre-grasp where there is one. Names are "grasp_0", "grasp_1", ... in the file's
/// order; the gripper's frame is the hand's root link, the object's frame O.
///
/// `confidence` is M / (1 + M): in the format's range and ordered as M is, but no probability.
/// Numbers are shortest round-trip decimals that YAML 1.1 readers too take for numbers.
std::string isaac_grasp_yaml(const grasp::GraspFile& file);

/// Tolerances of reading a file.
using IsaacReadOptions = ImportTolerances;

/// Reads an isaac_grasp file written for `hand`, whose root link must be the file's gripper frame.
///
/// The version may be the number 1.0 or the text "1.0". Every independent joint of the hand must be
/// given, coupled ones may be left out, names that the hand does not have are refused. Joints that
/// a clutch lets go on closing (`Coupling::breakaway`) keep their positions. Keys that are not of
/// the format are ignored; `confidence` must be a number and is not used otherwise. A
/// `pregrasp_cspace_position` may be missing.
/// @throws IoError (file, line, place, what) for anything else.
std::vector<ImportedGrasp> read_isaac_grasps(const std::filesystem::path& path,
                                             const hands::HandModel& hand,
                                             const IsaacReadOptions& options = {});

}  // namespace graspfit::exchange
