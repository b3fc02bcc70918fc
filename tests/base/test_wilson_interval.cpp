#include <cmath>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/wilson_interval.hpp"
#include "support/catch.hpp"

namespace test_wilson_interval {

using namespace graspfit;
using base::ShareInterval;
using base::wilson_interval;

TEST_CASE("Both ends of the interval are shares that the sample is just compatible with",
          "[base][wilson_interval]") {
  for (const int trials : {1, 3, 20, 1000}) {
    for (int hits = 0; hits <= trials; hits += 1 + trials / 7) {
      const ShareInterval interval = wilson_interval(hits, trials);
      const double share = static_cast<double>(hits) / trials;
      CHECK(interval.low <= share);
      CHECK(share <= interval.high);
      for (const double end : {interval.low, interval.high}) {
        if (end == share) continue;  // 0 of n and n of n end where shares end
        // |share - p| = 1.96 sqrt(p (1 - p) / n), the equation that the ends solve.
        CHECK(std::abs(share - end) ==
              Approx(1.959963984540054 * std::sqrt(end * (1.0 - end) / trials)).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("The interval ends at 0 and 1 and is everything without trials",
          "[base][wilson_interval]") {
  CHECK(wilson_interval(0, 5).low == 0.0);
  CHECK(wilson_interval(5, 5).high == 1.0);
  CHECK(wilson_interval(0, 0).low == 0.0);
  CHECK(wilson_interval(0, 0).high == 1.0);
  CHECK_THROWS_AS(wilson_interval(6, 5), base::InvalidInput);
  CHECK_THROWS_AS(wilson_interval(-1, 5), base::InvalidInput);
  CHECK_THROWS_AS(wilson_interval(0, -1), base::InvalidInput);
}

}  // namespace test_wilson_interval
