#include <set>
#include <vector>

#include "graspfit/base/random.hpp"
#include "support/catch.hpp"

namespace test_random {

using namespace graspfit::base;

TEST_CASE("The generator is SplitMix64", "[base][random]") {
  // These are the first outputs for seed 1234567 of the public reference implementation by S.
  // Vigna.
  Random random(1234567);
  CHECK(random.next() == 6457827717110365317U);
  CHECK(random.next() == 3203168211198807973U);
  CHECK(random.next() == 9817491932198370423U);
  CHECK(random.next() == 4593380528125082431U);
  CHECK(random.next() == 16408922859458223821U);
}

TEST_CASE("Uniform numbers fill their interval evenly", "[base][random]") {
  Random random(61);
  std::vector<int> bins(10, 0);
  for (int i = 0; i < 100000; ++i) {
    const double x = random.uniform();
    REQUIRE(x >= 0.0);
    REQUIRE(x < 1.0);
    ++bins[static_cast<std::size_t>(10 * x)];
  }
  // Each bin is expected to hold 10000 with a standard deviation of 95.
  for (const int count : bins) CHECK(std::abs(count - 10000) < 500);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    CHECK(x >= -2.0);
    CHECK(x < 3.0);
  }
}

TEST_CASE("Indices are below their count and all are drawn", "[base][random]") {
  Random random(62);
  for (const std::uint64_t count : {1U, 2U, 3U, 7U, 10U}) {
    std::set<std::uint64_t> seen;
    for (int i = 0; i < 300; ++i) seen.insert(random.index(count));
    CHECK(seen.size() == count);
    CHECK(*seen.rbegin() == count - 1);
  }
  // With the largest such count about half of the draws are repeated.
  for (int i = 0; i < 100; ++i) CHECK(random.index((1ULL << 63) + 1) <= (1ULL << 63));
}

TEST_CASE("Streams depend on seed and index alone", "[base][random]") {
  CHECK(Random::stream(5, 3).next() == Random::stream(5, 3).next());
  std::set<std::uint64_t> firsts;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::uint64_t index = 0; index < 30; ++index) {
      firsts.insert(Random::stream(seed, index).next());
    }
  }
  CHECK(firsts.size() == 900);
}

}  // namespace test_random
