#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "graspfit/geometry/atomic_file.hpp"
#include "mesh_path.hpp"
#include "seeds.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

using graspfit::testing::take_mesh_path;

TEST_CASE("What fuzzing once found is read or refused in one line", "[geometry][fuzz]") {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           graspfit::testing::source_directory() / "tests/fuzz/findings")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  REQUIRE(!files.empty());
  for (const auto& file : files) {
    INFO(file);
    CHECK_NOTHROW(take_mesh_path(graspfit::geometry::read_file(file)));
  }
}

TEST_CASE("Fuzzing starts from meshes that reach every stage", "[geometry][fuzz]") {
  std::map<std::string, int> outcomes;
  for (const auto& [name, input] : graspfit::testing::seeds()) {
    INFO(name);
    CHECK_NOTHROW(++outcomes[take_mesh_path(input)]);
  }
  CHECK(outcomes["good"] > 30);
  CHECK(outcomes.size() > 2);
}

TEST_CASE("Every prefix of every seed is read or refused in one line", "[geometry][fuzz]") {
  for (const auto& [name, input] : graspfit::testing::seeds()) {
    INFO(name);
    for (std::size_t size = 0; size < input.size(); size += 7) {
      REQUIRE_NOTHROW(take_mesh_path(input.substr(0, size)));
    }
  }
}
