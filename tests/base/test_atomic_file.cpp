#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/atomic_file_writer.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_atomic_file {

using namespace graspfit::base;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("What is written is read back byte for byte", "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "some file";
  for (const std::string& content : {std::string(), std::string("text\r\n"),
                                     std::string("\0\xff\n", 3), std::string(300000, 'x')}) {
    write_file_atomically(file, content);
    CHECK(read_file(file) == content);
  }
  // The folder holds nothing but the file itself.
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("A file written in pieces appears whole or not at all", "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "table";
  write_file_atomically(file, "old");
  std::string expected;
  {
    AtomicFileWriter writer(file);
    for (const std::size_t size : {1u, 65535u, 70000u, 3u, 200000u}) {
      const std::string piece(size, static_cast<char>('a' + size % 26));
      writer.write(piece);
      expected += piece;
    }
    CHECK(read_file(file) == "old");
    writer.commit();
  }
  CHECK(read_file(file) == expected);
  { AtomicFileWriter(file).write("given up"); }
  CHECK(read_file(file) == expected);
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("What is behind a link is written, and the link stays", "[base][atomic_file]") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "far");
  fs::create_symlink("far/file", folder.path() / "near");
  fs::create_symlink(folder.path() / "near", folder.path() / "nearer");
  for (const char* content : {"made", "replaced"}) {
    write_file_atomically(folder.path() / "nearer", content);
    CHECK(fs::is_symlink(folder.path() / "nearer"));
    CHECK(fs::is_symlink(folder.path() / "near"));
    CHECK(fs::is_regular_file(fs::symlink_status(folder.path() / "far/file")));
    CHECK(read_file(folder.path() / "far/file") == content);
  }
  // The temporary file was beside the file, not beside the links.
  CHECK(std::distance(fs::recursive_directory_iterator(folder.path()),
                      fs::recursive_directory_iterator()) == 4);
  fs::create_symlink("circle", folder.path() / "circle");
  CHECK_THROWS_WITH(
      write_file_atomically(folder.path() / "circle", "x"),
      "cannot write " + (folder.path() / "circle").string() + ": too many symbolic links");
  fs::create_symlink("far", folder.path() / "folder");
  CHECK_THROWS_WITH(write_file_atomically(folder.path() / "folder", "x"),
                    "cannot write " + (folder.path() / "folder").string() + ": it is a folder");
}

TEST_CASE("A pipe is written into", "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink(pipe, folder.path() / "link");
  const std::string content(100000, 'x');
  for (const char* name : {"pipe", "link"}) {
    std::string got;
    std::thread reader([&] {
      std::ifstream stream(pipe, std::ios::binary);
      got.assign(std::istreambuf_iterator<char>(stream), {});
    });
    write_file_atomically(folder.path() / name, content);
    reader.join();
    CHECK(got == content);
    CHECK(fs::is_fifo(pipe));
  }
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 2);
}

TEST_CASE("A device is written into, and what it says is reported", "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path full = folder.path() / "full";
  if (::mknod(full.c_str(), S_IFCHR | 0600, ::makedev(1, 7)) != 0 ||
      ::access(full.c_str(), W_OK) != 0 || ::close(::open(full.c_str(), O_WRONLY)) != 0) {
    WARN("SKIPPED in part: no device can be made here (only root can)");
    return;
  }
  CHECK_THROWS_WITH(write_file_atomically(full, "x"),
                    "cannot write " + full.string() + ": No space left on device");
  CHECK(fs::is_character_file(full));
  const fs::path null = folder.path() / "null";
  REQUIRE(::mknod(null.c_str(), S_IFCHR | 0600, ::makedev(1, 3)) == 0);
  write_file_atomically(null, "x");
  CHECK(fs::is_character_file(null));
  const fs::path disk = folder.path() / "disk";
  // No driver has this number, so that even a write that should not come would go nowhere.
  if (::mknod(disk.c_str(), S_IFBLK | 0600, ::makedev(240, 99)) == 0) {
    CHECK_THROWS_WITH(write_file_atomically(disk, "x"),
                      "cannot write " + disk.string() + ": it is a block device");
  }
}

TEST_CASE("An open file is written into by its descriptor's name", "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
  REQUIRE(descriptor >= 0);
  REQUIRE(::write(descriptor, "before ", 7) == 7);
  write_file_atomically("/proc/self/fd/" + std::to_string(descriptor), "after");
  ::close(descriptor);
  CHECK(read_file(file) == "before after");
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("Writers of one file do not meet, and what a killed one left is taken over",
          "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "table";
  {
    AtomicFileWriter first(file);
    AtomicFileWriter second(file);
    first.write("first");
    second.write("second");
    second.commit();
    CHECK(read_file(file) == "second");
    first.commit();
    CHECK(read_file(file) == "first");
  }
  // These files are as after a kill: nobody has locked them.
  for (const char* name : {"table.part0", "table.part1"}) {
    std::ofstream(folder.path() / name) << "longer than what follows";
  }
  write_file_atomically(file, "new");
  CHECK(read_file(file) == "new");
  CHECK_FALSE(fs::exists(folder.path() / "table.part0"));
  // Names that others have taken are left alone.
  fs::remove(folder.path() / "table.part1");
  fs::create_directory(folder.path() / "table.part0");
  fs::create_symlink("table", folder.path() / "table.part1");
  write_file_atomically(file, "newer");
  CHECK(read_file(file) == "newer");
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 3);
}

TEST_CASE("A file that cannot be written or read is named with the reason", "[base][atomic_file]") {
  const TemporaryFolder folder;
  const fs::path missing = folder.path() / "no/such";
  CHECK_THROWS_WITH(write_file_atomically(missing, "x"),
                    "cannot write " + missing.string() + ": No such file or directory");
  CHECK_THROWS_WITH(write_file_atomically(folder.path(), "x"),
                    "cannot write " + folder.path().string() + ": it is a folder");
  CHECK_THROWS_WITH(read_file(missing), "cannot read " + missing.string() + ": no such file");
  CHECK_THROWS_AS(read_file(folder.path()), IoError);
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("SHA-256 is that of FIPS 180-4", "[base][atomic_file]") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("Decimals are the shortest that read back", "[base][atomic_file]") {
  CHECK(shortest_decimal(0.1) == "0.1");
  CHECK(shortest_decimal(1.0) == "1");
  CHECK(shortest_decimal(-2.5e-7) == "-2.5e-07");
  for (const double x : {1.0 / 3.0, 1e308, std::numeric_limits<double>::denorm_min()}) {
    CHECK(std::stold(shortest_decimal(x)) == Approx(x));
    CHECK(std::strtod(shortest_decimal(x).c_str(), nullptr) == x);
  }
}

}  // namespace test_atomic_file
