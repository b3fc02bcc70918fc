#include "graspfit/geometry/atomic_file_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "graspfit/geometry/errors.hpp"

namespace graspfit::geometry {
namespace {

constexpr std::size_t kBlockSize = std::size_t{1} << 16;

std::string reason() { return std::strerror(errno); }

}  // namespace

void AtomicFileWriter::fail(const std::string& what) const {
  throw IoError("cannot write " + file_.string() + ": " + what);
}

AtomicFileWriter::AtomicFileWriter(const std::filesystem::path& file) : file_(file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) fail("it is a folder");
  // Unlike mkstemp, open gives the file the mode of any new one without asking for the umask,
  // which could only be read by changing it under other threads.
  static std::atomic<std::uint64_t> next{0};
  do {
    temporary_ = file.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(next++);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail(reason());
}

AtomicFileWriter::~AtomicFileWriter() {
  if (temporary_.empty()) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  ::unlink(temporary_.c_str());
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
  if (::fsync(descriptor_) != 0) fail(reason());
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail(reason());
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) fail(reason());
  temporary_.clear();
}

}  // namespace graspfit::geometry
