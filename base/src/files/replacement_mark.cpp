#include "graspfit/base/replacement_mark.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "graspfit/base/errors.hpp"

namespace graspfit::base {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".graspfit-replacing";

}  // namespace

void set_replacement_mark(const fs::path& folder) {
  const int descriptor = ::open((folder / kMark).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw IoError(std::strerror(errno));
  ::close(descriptor);
}

void remove_replacement_mark(const fs::path& folder) {
  std::error_code error;
  fs::remove(folder / kMark, error);
  if (error) throw IoError(error.message());
}

void require_no_replacement_mark(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder / kMark, error))) return;
  throw IoError(file.string() + ": " + folder.string() +
                " holds files of two runs: one that was to replace them was killed, or is still at "
                "it; run it again");
}

}  // namespace graspfit::base
