#include <algorithm>
#include <cstdint>
#include <vector>

#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/random.hpp"
#include "support/catch.hpp"

namespace test_disjoint_sets {

using graspfit::base::DisjointSets;
using graspfit::base::Random;

TEST_CASE("Items begin apart, and no items are no sets", "[base][disjoint_sets]") {
  CHECK(DisjointSets(0).numbered().empty());
  CHECK(DisjointSets(3).numbered() == std::vector<std::int32_t>{0, 1, 2});
}

TEST_CASE("Sets are named and numbered by their smallest members, however they were united",
          "[base][disjoint_sets]") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const std::size_t size = 1 + random.index(20);
    DisjointSets sets(size);
    // The oracle relabels every item of the one set by the smaller label of the two.
    std::vector<std::int32_t> label(size);
    for (std::size_t i = 0; i < size; ++i) label[i] = static_cast<std::int32_t>(i);
    for (std::uint64_t k = random.index(2 * size); k > 0; --k) {
      const auto a = static_cast<std::int32_t>(random.index(size));
      const auto b = static_cast<std::int32_t>(random.index(size));
      const std::int32_t low = std::min(label[a], label[b]);
      const std::int32_t high = std::max(label[a], label[b]);
      CHECK(sets.unite(a, b) == (low != high));
      std::replace(label.begin(), label.end(), high, low);
    }
    const std::vector<std::int32_t> number = sets.numbered();
    std::int32_t num_sets = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto item = static_cast<std::int32_t>(i);
      CHECK(sets.root(item) == label[i]);
      CHECK(number[i] == (label[i] == item ? num_sets++ : number[label[i]]));
    }
  }
}

}  // namespace test_disjoint_sets
