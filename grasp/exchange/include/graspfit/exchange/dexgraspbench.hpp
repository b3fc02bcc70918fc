#pragma once

#include <string>

#include "graspfit/grasp/grasp_io.hpp"

/// \file
/// Arrays under the names that DexGraspBench reads [Mingrui-Yu/DexGraspBench, README and
/// src/task/eval_func/base.py], in a NumPy NPZ file. DexGraspBench itself loads one pickled
/// dictionary per grasp; plain arrays need no pickle, and README.md shows the two lines that turn
/// the arrays into such dictionaries.

namespace graspfit::exchange {

/// Returns the bytes of an NPZ file, which are the same for the same grasp file. For N grasps of a
/// hand with dof joints it holds:
///
/// | array | shape, type | holds |
/// | --- | --- | --- |
/// | `obj_path` | text | the object's file, as recorded |
/// | `obj_scale` | double | meters per unit of that file |
/// | `obj_pose` | [7] doubles | pose of O in the world, which is O: 0 0 0, 1 0 0 0 |
/// | `pregrasp_qpos`, `grasp_qpos`, `squeeze_qpos` | [N, 7 + dof] doubles | position [m] and
/// quaternion w, x, y, z of the hand's root link in O, joints [rad or m] |
/// | `joint_names` | [dof] texts | the order of the joints: the hand model's |
///
/// Rows of grasps without pre-grasp or squeeze are NaN.
std::string dexgraspbench_npz(const grasp::GraspFile& file);

}  // namespace graspfit::exchange
