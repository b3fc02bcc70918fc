#include <filesystem>
#include <limits>
#include <random>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/atomic_file_writer.hpp"
#include "graspfit/geometry/errors.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;
namespace fs = std::filesystem;

namespace {

struct ScratchFolder {
  fs::path path =
      fs::temp_directory_path() / ("graspfit_atomic_" + std::to_string(std::random_device{}()));
  ScratchFolder() { fs::create_directories(path); }
  ~ScratchFolder() { fs::remove_all(path); }
};

}  // namespace

TEST_CASE("What is written is read back byte for byte", "[geometry][atomic_file]") {
  const ScratchFolder folder;
  const fs::path file = folder.path / "some file";
  for (const std::string& content : {std::string(), std::string("text\r\n"),
                                     std::string("\0\xff\n", 3), std::string(300000, 'x')}) {
    write_file_atomically(file, content);
    CHECK(read_file(file) == content);
  }
  // Nothing but the file itself is there.
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("A file written in pieces appears whole or not at all", "[geometry][atomic_file]") {
  const ScratchFolder folder;
  const fs::path file = folder.path / "table";
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
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("A file that cannot be written or read is named with the reason",
          "[geometry][atomic_file]") {
  const ScratchFolder folder;
  const fs::path missing = folder.path / "no/such";
  CHECK_THROWS_WITH(write_file_atomically(missing, "x"),
                    "cannot write " + missing.string() + ": No such file or directory");
  CHECK_THROWS_WITH(write_file_atomically(folder.path, "x"),
                    "cannot write " + folder.path.string() + ": it is a folder");
  CHECK_THROWS_WITH(read_file(missing), "cannot read " + missing.string() + ": no such file");
  CHECK_THROWS_AS(read_file(folder.path), IoError);
  CHECK(fs::is_empty(folder.path));
}

TEST_CASE("SHA-256 is that of FIPS 180-4", "[geometry][atomic_file]") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("Decimals are the shortest that read back", "[geometry][atomic_file]") {
  CHECK(shortest_decimal(0.1) == "0.1");
  CHECK(shortest_decimal(1.0) == "1");
  CHECK(shortest_decimal(-2.5e-7) == "-2.5e-07");
  for (const double x : {1.0 / 3.0, 1e308, std::numeric_limits<double>::denorm_min()}) {
    CHECK(std::stold(shortest_decimal(x)) == Approx(x));
    CHECK(std::strtod(shortest_decimal(x).c_str(), nullptr) == x);
  }
}
