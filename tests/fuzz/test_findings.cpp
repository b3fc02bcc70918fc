#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/random.hpp"
#include "mesh_path.hpp"
#include "seeds.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

using graspfit::base::Random;
using graspfit::testing::take_mesh_path;

namespace {

// Returns the input with a few bytes changed, cut out, doubled, or replaced by a number that
// readers may stumble over.
std::string damaged(std::string input, Random& random) {
  const std::vector<std::string> words = {
      "0",   "-1",  "1e308", "-1e-320",    "nan",
      "inf", "3.5", "\n",    "2147483648", "18446744073709551616"};
  for (std::uint64_t n = 1 + random.index(4); n > 0; --n) {
    const std::size_t at = random.index(input.size());
    const std::size_t length = 1 + random.index(12);
    switch (random.index(4)) {
      case 0:
        input[at] = static_cast<char>(random.index(256));
        break;
      case 1:
        input.erase(at, length);
        break;
      case 2:
        input.insert(at, input.substr(random.index(input.size()), length));
        break;
      default:
        input.replace(at, length, words[random.index(words.size())]);
    }
    if (input.empty()) return input;
  }
  return input;
}

void damage_all_seeds(int times) {
  Random random(1);
  int num_good = 0, num_refused = 0;
  for (int i = 0; i < times; ++i) {
    for (const auto& [name, input] : graspfit::testing::seeds()) {
      const std::string broken = damaged(input, random);
      INFO(name << ", round " << i);
      REQUIRE_NOTHROW(++(take_mesh_path(broken) == "good" ? num_good : num_refused));
    }
  }
  CHECK(num_good > times);
  CHECK(num_refused > times);
}

}  // namespace

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
    CHECK_NOTHROW(take_mesh_path(graspfit::base::read_file(file)));
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

TEST_CASE("Damaged seeds are read or refused in one line", "[geometry][fuzz]") {
  damage_all_seeds(40);
}

TEST_CASE("Many more damaged seeds are read or refused in one line", "[geometry][fuzz][full]") {
  damage_all_seeds(4000);
}
