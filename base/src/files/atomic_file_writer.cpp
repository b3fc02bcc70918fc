#include "graspfit/base/atomic_file_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <system_error>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/file_lock.hpp"

namespace graspfit::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockSize = std::size_t{1} << 16;

std::string reason() { return std::strerror(errno); }

/// The file to which the bytes of a path are written.
struct Destination {
  fs::path path;                ///< All links followed, unless it is a stream.
  bool is_stream = false;       ///< A pipe, a device, or an open file: not to be replaced.
  const char* fault = nullptr;  ///< Why nothing can be written there.
};

Destination destination_of(const fs::path& file) {
  std::error_code error;
  switch (fs::status(file, error).type()) {
    case fs::file_type::directory:
      return {file, false, "it is a folder"};
    case fs::file_type::block:
      return {file, false, "it is a block device"};
    case fs::file_type::socket:
      return {file, false, "it is a socket"};
    case fs::file_type::character:
    case fs::file_type::fifo:
      return {file, true};
    default:
      break;
  }
  constexpr int kMostLinks = 40;  // as many as Linux follows
  fs::path path = file;
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
    // Links in /proc lead to open files, which may have another path by now, or none.
    if (*std::next(fs::absolute(path).begin()) == "proc") return {file, true};
    if (links == kMostLinks) return {file, false, "too many symbolic links"};
    const fs::path target = fs::read_symlink(path, error);
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return {path, false};
}

/// Opens a new file at `path`, or the file that a killed writer has left there; living writers have
/// locked theirs. Returns −1, with the reason in errno, if this fails: EEXIST if somebody else has
/// the file.
int open_own(const std::string& path) {
  int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  const bool is_new = descriptor >= 0;
  if (!is_new) {
    if (errno != EEXIST) return -1;
    descriptor = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    errno = EEXIST;
    if (descriptor < 0) return -1;
  }
  const FileLock lock = lock_file(descriptor, path);
  // Where the file system has no locks, only a new file is known to be ours.
  const bool is_ours = lock == FileLock::Ours || (lock == FileLock::Unavailable && is_new);
  if (is_ours && ::ftruncate(descriptor, 0) == 0) return descriptor;
  ::close(descriptor);
  errno = EEXIST;
  return -1;
}

}  // namespace

void AtomicFileWriter::fail(const std::string& what) const {
  throw IoError("cannot write " + file_.string() + ": " + what);
}

AtomicFileWriter::AtomicFileWriter(const fs::path& file) : file_(file) {
  const Destination destination = destination_of(file);
  if (destination.fault != nullptr) fail(destination.fault);
  if (destination.is_stream) {
    descriptor_ = ::open(file.c_str(), O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) fail(reason());
    return;
  }
  replaced_ = destination.path;
  // Unlike mkstemp, open gives the file the mode of any new one without asking for the umask,
  // which could only be read by changing it under other threads.
  constexpr int kMostWriters = 1000;  // of one file at once, and names that others have taken
  for (int number = 0; descriptor_ < 0 && number < kMostWriters; ++number) {
    temporary_ = replaced_.string() + ".part" + std::to_string(number);
    descriptor_ = open_own(temporary_);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) fail(reason());
}

AtomicFileWriter::~AtomicFileWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFileWriter::write_to_disk(std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor_, content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail(reason());
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFileWriter::flush() {
  write_to_disk(block_);
  block_.clear();
}

void AtomicFileWriter::write(std::string_view content) {
  if (block_.size() + content.size() >= kBlockSize) flush();
  if (content.size() >= kBlockSize) {
    write_to_disk(content);
  } else {
    block_ += content;
  }
}

void AtomicFileWriter::commit() {
  flush();
  // Only files are flushed to disk, not pipes and devices.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail(reason());
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail(reason());
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), replaced_.c_str()) != 0) fail(reason());
  temporary_.clear();
}

}  // namespace graspfit::base
