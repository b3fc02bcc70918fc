#include "output_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "graspfit/geometry/errors.hpp"
#include "interrupts.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
  throw geometry::IoError("output folder " + target.string() + ": " + why);
}

/// A new folder with a unique hidden name in `parent`; its mode is that of any new folder.
fs::path make_hidden_folder(const fs::path& parent, const fs::path& target) {
  std::string name = (parent / ".graspfit-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) fail(target, std::strerror(errno));
  const mode_t mask = umask(0);
  umask(mask);
  chmod(name.c_str(), 0777 & ~mask);
  return name;
}

/// The folder's absolute path without a trailing slash.
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
  fs::remove(make_hidden_folder(existing, target_));
}

OutputFolder::~OutputFolder() {
  cleanup_.reset();
  discard();
}

void OutputFolder::discard() {
  std::error_code error;
  if (!staging_.empty()) fs::remove_all(staging_, error);
  // Folders made on the way to the target go too, unless somebody has put something there.
  if (first_created_.empty()) return;
  fs::path folder = absolute_path(target_).parent_path();
  while (fs::remove(folder, error) && folder != first_created_) folder = folder.parent_path();
}

const fs::path& OutputFolder::staging() {
  if (!staging_.empty()) return staging_;
  const fs::path absolute = absolute_path(target_);
  std::error_code error;
  if (fs::is_directory(absolute, error)) {
    staging_ = make_hidden_folder(absolute, target_);
  } else {
    const fs::path parent = absolute.parent_path();
    const fs::path existing = existing_ancestor(parent);
    for (fs::path folder = parent; folder != existing; folder = folder.parent_path()) {
      first_created_ = folder;
    }
    fs::create_directories(parent, error);
    if (error) fail(target_, error.message());
    staging_ = make_hidden_folder(parent, target_);
  }
  cleanup_ = std::make_unique<CleanupOnInterrupt>([this] { discard(); });
  return staging_;
}

void OutputFolder::commit(const std::string& last_file) {
  staging();
  without_interrupts([&] {
    const fs::path absolute = absolute_path(target_);
    std::error_code error;
    if (!fs::exists(absolute, error)) {
      fs::rename(staging_, absolute, error);
      if (error) fail(target_, error.message());
    } else {
      std::vector<std::string> names;
      for (const auto& entry : fs::directory_iterator(staging_)) {
        if (entry.path().filename() != last_file) names.push_back(entry.path().filename());
      }
      names.push_back(last_file);
      for (const auto& entry : fs::directory_iterator(absolute)) {
        const std::string name = entry.path().filename();
        if (is_ours_(name) && !fs::exists(staging_ / name)) fs::remove(entry.path(), error);
      }
      for (const std::string& name : names) {
        fs::rename(staging_ / name, absolute / name, error);
        if (error) fail(target_, name + ": " + error.message());
      }
      fs::remove(staging_, error);
    }
    staging_.clear();
    first_created_.clear();
  });
}

void require_parent_folder(const std::string& flag, const fs::path& file) {
  const fs::path folder = fs::absolute(file).parent_path();
  std::error_code error;
  if (!file.has_filename() || fs::is_directory(file, error)) {
    throw geometry::IoError(flag + ' ' + file.string() + ": is a folder, not a file");
  }
  if (!fs::is_directory(folder, error)) {
    throw geometry::IoError(flag + ' ' + file.string() + ": there is no folder " + folder.string());
  }
}

}  // namespace graspfit::app
