#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace graspfit::hands::internal {

struct MujocoModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};

/// A model as MuJoCo compiles it, and what it warned of meanwhile, a line each.
struct MujocoModel {
  std::unique_ptr<mjModel, MujocoModelDeleter> model;
  std::vector<std::string> warnings;
};

/// Lets MuJoCo load an MJCF file. Nothing is printed or written, and MuJoCo's errors do not end the
/// program. Numbers are read in the C locale whatever the program's is.
///
/// MuJoCo's handlers of errors and warnings belong to the whole program: they are ours meanwhile,
/// then the caller's again; calls of other threads wait for each other. What the program loaded
/// before is no longer there for `mj_saveLastXML`.
/// @throws IoError (file, MuJoCo's words in one line) if it is refused.
MujocoModel load_mujoco_model(const std::filesystem::path& file);

}  // namespace graspfit::hands::internal
