#include "output/output_folder.hpp"

#include <system_error>
#include <utility>
#include <vector>

#include "cli/interrupts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/replacement_mark.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
  throw base::IoError("output folder " + target.string() + ": " + why);
}

/// The absolute path of a folder, without a trailing slash.
fs::path absolute_path(const fs::path& folder) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

/// The nearest folder above a path that exists.
fs::path existing_ancestor(fs::path path) {
  std::error_code error;
  while (!fs::exists(path, error) && path.has_parent_path() && path != path.parent_path()) {
    path = path.parent_path();
  }
  return path;
}

}  // namespace

OutputFolder::OutputFolder(fs::path target, IsOurs is_ours)
    : target_(std::move(target)), is_ours_(std::move(is_ours)) {
  if (target_.empty()) fail("\"\"", "has no name");
  const fs::path absolute = absolute_path(target_);
  const fs::path existing = existing_ancestor(absolute);
  std::error_code error;
  if (!fs::is_directory(existing, error)) fail(target_, existing.string() + " is not a folder");
  try {
    const WorkingFolder trial(existing);
  } catch (const base::IoError& reason) {
    fail(target_, reason.what());
  }
}

OutputFolder::~OutputFolder() {
  cleanup_.reset();
  discard();
}

void OutputFolder::discard() {
  std::error_code error;
  if (staging_) staging_->remove();
  // Folders made for the target are removed too, unless somebody has put something there.
  if (first_created_.empty()) return;
  fs::path folder = absolute_path(target_).parent_path();
  while (fs::remove(folder, error) && folder != first_created_) folder = folder.parent_path();
}

const fs::path& OutputFolder::staging() {
  if (staging_) return staging_->path();
  const fs::path absolute = absolute_path(target_);
  std::error_code error;
  fs::path beside = absolute;
  if (!fs::is_directory(absolute, error)) {
    const fs::path parent = absolute.parent_path();
    const fs::path existing = existing_ancestor(parent);
    for (fs::path folder = parent; folder != existing; folder = folder.parent_path()) {
      first_created_ = folder;
    }
    fs::create_directories(parent, error);
    if (error) fail(target_, error.message());
    beside = parent;
  }
  try {
    staging_.emplace(beside);
  } catch (const base::IoError& reason) {
    fail(target_, reason.what());
  }
  cleanup_ = std::make_unique<CleanupOnInterrupt>([this] { discard(); });
  return staging_->path();
}

void OutputFolder::commit(const std::string& last_file) {
  staging();
  without_interrupts([&] {
    const fs::path absolute = absolute_path(target_);
    std::error_code error;
    try {
      if (fs::exists(absolute, error)) {
        replace_in(absolute, last_file);
      } else {
        staging_->keep_as(absolute);
      }
    } catch (const base::IoError& reason) {
      fail(target_, reason.what());
    }
    staging_.reset();
    first_created_.clear();
  });
}

void OutputFolder::replace_in(const fs::path& folder, const std::string& last_file) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(staging_->path())) {
    if (entry.path().filename() != last_file) names.push_back(entry.path().filename());
  }
  names.push_back(last_file);
  base::set_replacement_mark(folder);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (is_ours_(name) && !fs::exists(staging_->path() / name)) fs::remove(entry.path(), error);
  }
  for (const std::string& name : names) {
    fs::rename(staging_->path() / name, folder / name, error);
    if (error) throw base::IoError(name + ": " + error.message());
  }
  base::remove_replacement_mark(folder);
}

void require_parent_folder(const std::string& flag, const fs::path& file) {
  std::error_code error;
  fs::path folder = fs::absolute(file).parent_path();
  // `file` may be a link whose target does not exist yet.
  if (fs::is_symlink(file, error) && !fs::exists(file, error)) {
    folder = (folder / fs::read_symlink(file, error)).parent_path();
  }
  if (!file.has_filename() || fs::is_directory(file, error)) {
    throw base::IoError(flag + ' ' + file.string() + ": is a folder, not a file");
  }
  if (!fs::is_directory(folder, error)) {
    throw base::IoError(flag + ' ' + file.string() + ": there is no folder " + folder.string());
  }
}

}  // namespace graspfit::app
