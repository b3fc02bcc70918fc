#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace graspfit::hands::internal {

/// What MuJoCo calls an error, after which its own handler would end the program.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// While it lives, MuJoCo's errors on this thread are MujocoErrors (one line), and its warnings are
/// kept instead of printed. MuJoCo's handlers belong to the whole program: they are ours while any
/// thread has one of these, then the caller's again; meanwhile other threads' messages go to the
/// caller's. At most one per thread at a time.
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

/// A model as MuJoCo compiles it, and what it warned of meanwhile, a line each.
struct MujocoModel {
  std::unique_ptr<mjModel, MujocoModelDeleter> model;
  std::vector<std::string> warnings;
};

/// Lets MuJoCo load an MJCF file. Nothing is printed or written, and MuJoCo's errors do not end the
/// program. Numbers are read in the C locale whatever the program's is.
///
/// Calls of other threads wait for each other. What the program loaded before is no longer there
/// for `mj_saveLastXML`.
/// @throws IoError (file, MuJoCo's words in one line) if it is refused.
MujocoModel load_mujoco_model(const std::filesystem::path& file);

/// The same for the text of an MJCF file, which errors call `name`.
MujocoModel load_mujoco_text(const std::string& name, const std::string& text);

}  // namespace graspfit::hands::internal
