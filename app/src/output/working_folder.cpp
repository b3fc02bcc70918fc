#include "output/working_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/file_lock.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
using base::FileLock;

constexpr const char* kPrefix = ".graspfit-";

int open_folder(const fs::path& folder) {
  return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

void remove_abandoned(const fs::path& parent) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with(kPrefix)) found.push_back(entry->path());
  }
  for (const fs::path& folder : found) {
    const int descriptor = open_folder(folder);
    if (descriptor < 0) continue;
    if (base::lock_file(descriptor, folder) == FileLock::Ours) fs::remove_all(folder, error);
    ::close(descriptor);
  }
}

}  // namespace

WorkingFolder::WorkingFolder(const fs::path& parent) {
  remove_abandoned(parent);
  for (;;) {
    std::string name = (parent / (std::string(kPrefix) + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr) throw base::IoError(std::strerror(errno));
    // The folder is to have the mode of any new folder.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::chmod(name.c_str(), 0777 & ~mask);
    path_ = name;
    lock_ = open_folder(path_);
    if (lock_ < 0) throw base::IoError(std::strerror(errno));
    // Where there are no locks, nobody takes the folder for abandoned.
    if (base::lock_file(lock_, path_) != FileLock::Others) return;
    // Somebody took the folder for abandoned before it was locked.
    ::close(lock_);
  }
}

WorkingFolder::~WorkingFolder() {
  remove();
  if (lock_ >= 0) ::close(lock_);
}

void WorkingFolder::remove() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
  path_.clear();
}

void WorkingFolder::keep_as(const fs::path& path) {
  std::error_code error;
  fs::rename(path_, path, error);
  if (error) throw base::IoError(error.message());
  path_.clear();
}

}  // namespace graspfit::app
