#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "graspfit/base/file_lock.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_file_lock {

using namespace graspfit::base;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

/// Opens a file or folder that exists and closes it at the end.
class Opened {
 public:
  explicit Opened(const fs::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    REQUIRE(descriptor_ >= 0);
  }
  ~Opened() { ::close(descriptor_); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  FileLock lock() const { return lock_file(descriptor_, path_); }

 private:
  fs::path path_;
  int descriptor_;
};

}  // namespace

TEST_CASE("A file or folder is locked by one until that one closes it", "[base][file_lock]") {
  const TemporaryFolder folder;
  for (const fs::path& path : {folder.write("a.txt", "a"), folder.path()}) {
    const Opened second(path);
    {
      const Opened first(path);
      CHECK(first.lock() == FileLock::Ours);
      CHECK(first.lock() == FileLock::Ours);
      CHECK(second.lock() == FileLock::Others);
    }
    CHECK(second.lock() == FileLock::Ours);
  }
}

TEST_CASE("What was removed or replaced after it was opened is nobody's to lock",
          "[base][file_lock]") {
  const TemporaryFolder folder;
  const fs::path removed = folder.write("removed.txt", "a");
  const fs::path replaced = folder.write("replaced.txt", "a");
  const Opened first(removed);
  const Opened second(replaced);
  fs::remove(removed);
  fs::rename(folder.write("new.txt", "b"), replaced);
  CHECK(first.lock() == FileLock::Others);
  CHECK(second.lock() == FileLock::Others);
}

}  // namespace test_file_lock
