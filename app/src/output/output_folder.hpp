#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "output/working_folder.hpp"

namespace graspfit::app {

class CleanupOnInterrupt;

/// A folder that gets all of a command's files or none.
///
/// Files are written into a hidden temporary folder beside (or, if the folder exists, inside) the
/// target and moved at the end. An existing folder keeps files that are not the command's. The
/// command's files of an earlier run are replaced one by one, each atomically, and those that the
/// new run does not have are removed; meanwhile the folder has a mark (see
/// `base::set_replacement_mark`), which a kill leaves there. Without `commit`, and on an interrupt,
/// nothing is left behind; the next run removes what a kill has left.
class OutputFolder {
 public:
  /// Says whether a file name is one that the command writes.
  using IsOurs = std::function<bool(const std::string& file_name)>;

  /// Checks that files can be written to the target, without leaving a trace. @throws IoError.
  OutputFolder(std::filesystem::path target, IsOurs is_ours);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& target() const { return target_; }

  /// The temporary folder; made at the first call. @throws IoError.
  const std::filesystem::path& staging();

  /// Moves everything to the target; `last_file` (the one that others refer to) goes last.
  /// @throws IoError.
  void commit(const std::string& last_file);

 private:
  void discard();
  void replace_in(const std::filesystem::path& folder, const std::string& last_file);

  std::filesystem::path target_;
  IsOurs is_ours_;
  std::optional<WorkingFolder> staging_;
  std::filesystem::path first_created_;  ///< Topmost folder made for the target's sake, if any.
  std::unique_ptr<CleanupOnInterrupt> cleanup_;
};

/// Throws IoError unless `file` can be written: its folder, links followed, must exist, and it must
/// not be a folder itself. `flag` is the flag that names the file; messages start with it.
void require_parent_folder(const std::string& flag, const std::filesystem::path& file);

}  // namespace graspfit::app
