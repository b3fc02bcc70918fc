#include "graspfit/geometry/atomic_file.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include "graspfit/geometry/errors.hpp"

namespace graspfit::geometry {
namespace {

std::string reason() { return std::strerror(errno); }

// A temporary file that is closed and removed unless `release` is called.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& beside) {
    // Unlike mkstemp, open gives the file the mode of any new one without asking for the umask,
    // which could only be read by changing it under other threads.
    static std::atomic<std::uint64_t> next{0};
    do {
      name_ = beside.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(next++);
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    const int error = errno;
    close();
    if (created() && !released_) ::unlink(name_.c_str());
    errno = error;
  }

  bool created() const { return created_ || descriptor_ >= 0; }
  const char* name() const { return name_.c_str(); }

  bool write(std::string_view content) {
    created_ = true;
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0) {
        if (errno == EINTR) continue;
        return false;
      }
      content.remove_prefix(static_cast<std::size_t>(written));
    }
    return ::fsync(descriptor_) == 0;
  }
  bool close() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    return descriptor < 0 || ::close(descriptor) == 0;
  }
  void release() { released_ = true; }

 private:
  std::string name_;
  int descriptor_ = -1;
  bool created_ = false;
  bool released_ = false;
};

}  // namespace

void write_file_atomically(const std::filesystem::path& file, std::string_view content) {
  const auto fail = [&](const std::string& what) {
    throw IoError("cannot write " + file.string() + ": " + what);
  };
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) fail("it is a folder");
  TemporaryFile temporary(file);
  if (!temporary.created()) fail(reason());
  if (!temporary.write(content) || !temporary.close()) fail(reason());
  if (::rename(temporary.name(), file.c_str()) != 0) fail(reason());
  temporary.release();
}

std::string read_file(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) {
    throw IoError("cannot read " + file.string() + ": " + what);
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail("no such file");
  if (std::filesystem::is_directory(status)) fail("it is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(reason());
  std::string content;
  const auto size = std::filesystem::file_size(file, error);
  if (!error) {
    content.resize(size);
    stream.read(content.data(), static_cast<std::streamsize>(size));
    content.resize(static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) fail(reason());
    if (stream.eof()) return content;
  }
  // Pipes and files that grow have no size to trust.
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()), stream.gcount() > 0) {
    content.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) fail(reason());
  return content;
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::bad_alloc();  // The only way in which hashing memory fails.
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

std::string shortest_decimal(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace graspfit::geometry
