#include "graspfit/base/file_lock.hpp"

#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>

namespace graspfit::base {

FileLock lock_file(int descriptor, const std::filesystem::path& path) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return errno == EWOULDBLOCK ? FileLock::Others : FileLock::Unavailable;
  }
  struct stat opened {};
  struct stat named {};
  const bool is_same = ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
                       opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
  return is_same ? FileLock::Ours : FileLock::Others;
}

}  // namespace graspfit::base
