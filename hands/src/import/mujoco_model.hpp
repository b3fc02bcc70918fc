#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace graspfit::hands::internal {

/// An error that MuJoCo reports. MuJoCo's own handler would end the program after it.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// While such an object lives, MuJoCo's errors on its thread are thrown as MujocoErrors (one line),
/// and MuJoCo's warnings are kept instead of printed. MuJoCo's handlers are global to the program:
/// they are ours while any thread has such an object, and the caller's again afterward; meanwhile
/// messages of other threads go to the caller's handlers. A thread may have only one such object at
/// a time.
class MujocoMessages {
 public:
  MujocoMessages();
  ~MujocoMessages();
  MujocoMessages(const MujocoMessages&) = delete;
  MujocoMessages& operator=(const MujocoMessages&) = delete;

  const std::vector<std::string>& warnings() const { return warnings_; }  ///< A line each.

 private:
  std::vector<std::string> warnings_;
};

struct MujocoModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};

/// A model that MuJoCo has compiled, and the warnings of the compilation, a line each.
struct MujocoModel {
  std::unique_ptr<mjModel, MujocoModelDeleter> model;
  std::vector<std::string> warnings;
};

/// Lets MuJoCo load an MJCF file. Nothing is printed or written, and MuJoCo's errors do not end the
/// program. Numbers are read in the C locale whatever the program's is.
///
/// Calls from several threads wait for each other. A model that the program loaded before is no
/// longer available to `mj_saveLastXML`.
/// @throws IoError (file, MuJoCo's words in one line) if MuJoCo refuses the file.
MujocoModel load_mujoco_model(const std::filesystem::path& file);

/// Lets MuJoCo load the text of an MJCF file, as `load_mujoco_model`; errors name it `name`.
MujocoModel load_mujoco_text(const std::string& name, const std::string& text);

}  // namespace graspfit::hands::internal
