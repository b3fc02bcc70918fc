#include <string>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_sha256 {

using namespace graspfit::base;

TEST_CASE("A file's hash is that of its bytes, whatever its size", "[base][file_hash]") {
  const graspfit::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "bytes";
  // The sizes are around those of the blocks of 64 kB in which a file is read.
  for (const std::size_t size : {0u, 1u, 65535u, 65536u, 65537u, 200000u}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * i % 251);
    write_file_atomically(file, bytes);
    CHECK(sha256_of_file(file) == sha256_hex(bytes));
  }
  // The digest is that of FIPS 180-2, appendix B.1.
  write_file_atomically(file, "abc");
  CHECK(sha256_of_file(file) == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK_THROWS_AS(sha256_of_file(folder.path()), IoError);
  CHECK_THROWS_AS(sha256_of_file(folder.path() / "none"), IoError);
}

}  // namespace test_sha256
