// This is the target of libFuzzer, which tests/fuzz/run builds.
#include <cstddef>
#include <cstdint>

#include "mesh_path.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  graspfit::testing::take_mesh_path({reinterpret_cast<const char*>(data), size});
  return 0;
}
