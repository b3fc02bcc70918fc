#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/exchange/imported_grasps.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/hand_model.hpp"

/// \file
/// Arrays under the names that DexGraspBench reads [Mingrui-Yu/DexGraspBench, README and
/// src/task/eval_func/base.py], in a NumPy NPZ file. DexGraspBench itself loads one pickled
/// dictionary per grasp; plain arrays need no pickle, and README.md shows the two lines that turn
/// the arrays into such dictionaries, and those that turn such dictionaries into arrays.

namespace graspfit::exchange {

/// Returns the bytes of an NPZ file, which are the same for the same grasp file. For N grasps of a
/// hand with dof joints it holds:
///
/// | array | shape, type | holds |
/// | --- | --- | --- |
/// | `obj_path` | text | the object's file, as recorded |
/// | `obj_scale` | double | meters per unit of that file |
/// | `obj_pose` | [7] doubles | pose of the file's own frame in the world, which is O: 0 0 0, 1 0 0
/// 0 unless the object was laid down | | `pregrasp_qpos`, `grasp_qpos`, `squeeze_qpos` | [N, 7 +
/// dof] doubles | position [m] and quaternion w, x, y, z of the hand's root link in O, joints [rad
/// or m] | | `joint_names` | [dof] texts | the order of the joints: the hand model's |
///
/// Rows of grasps without pre-grasp or squeeze are NaN.
std::string dexgraspbench_npz(const grasp::GraspFile& file);

/// What a file of such arrays says.
struct DexGraspBenchGrasps {
  std::vector<ImportedGrasp> grasps;  ///< Named "grasp_0", ... by their rows; X_OH is in the
                                      ///< object's own frame, that of its file.
  std::optional<double> meters_per_file_unit;  ///< `obj_scale`; empty: the file has none.
  std::vector<std::string> notes;  ///< For people: rows left out, joints without names, pre-grasps
                                   ///< that are not taken over.
};

/// Reads arrays as `dexgraspbench_npz` writes them, ours or another tool's, stored or deflated, of
/// single or double precision. `hand` must be the hand whose root link they pose.
///
/// | array | if missing |
/// | --- | --- |
/// | `grasp_qpos` [N, 7 + dof] or [7 + dof] | refused |
/// | `pregrasp_qpos`, of the same shape | no pre-grasps |
/// | `joint_names` [dof] | the order of the hand's joints, or of its independent ones, whichever
/// are as many; a note says so |
/// | `obj_pose` [7] or [N, 7]: the object in the frame of all poses | the identity |
/// | `obj_scale`: one number, or N that are equal | `meters_per_file_unit` is empty |
///
/// Other arrays are not looked at; squeezes are computed anew. A grasp whose row has a NaN is left
/// out, with a note. A pre-grasp is taken over if its palm is where the grasp's is, to 1e-6 (of
/// meters, and of the entries of the rotation); otherwise a note says so. Of joints the same is
/// required as by `read_isaac_grasps`.
/// @throws IoError (file, array, row, what) for anything else: no archive, an array cut off, of
/// another shape, with Python objects or in Fortran order, above 1 GiB, infinite numbers, a
/// quaternion that is no unit quaternion, a joint beyond its limits; nothing is ever unpickled.
DexGraspBenchGrasps read_dexgraspbench(const std::filesystem::path& path,
                                       const hands::HandModel& hand,
                                       const ImportTolerances& tolerances = {});

}  // namespace graspfit::exchange
