// The libFuzzer target: tests/fuzz/run.
#include <cstddef>
#include <cstdint>

#include "mesh_path.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  graspfit::testing::take_mesh_path({reinterpret_cast<const char*>(data), size});
  return 0;
}
