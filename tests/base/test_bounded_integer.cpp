#include <cmath>
#include <cstdint>
#include <limits>

#include "graspfit/base/bounded_integer.hpp"
#include "support/catch.hpp"

namespace test_bounded_integer {

using graspfit::base::bounded_integer;

TEST_CASE("A double within the bounds loses its fraction, any other becomes a bound",
          "[base][bounded_integer]") {
  CHECK(bounded_integer(3.99, 0, 10) == 3);
  CHECK(bounded_integer(-3.99, -10, 10) == -3);
  CHECK(bounded_integer(0.0, 0, 10) == 0);
  CHECK(bounded_integer(10.0, 0, 10) == 10);
  CHECK(bounded_integer(10.5, 0, 10) == 10);
  CHECK(bounded_integer(-1e-300, 0, 10) == 0);
  CHECK(bounded_integer(1e300, 0, 10) == 10);
  CHECK(bounded_integer(std::numeric_limits<double>::infinity(), 0, 10) == 10);
  CHECK(bounded_integer(-std::numeric_limits<double>::infinity(), 0, 10) == 0);
  CHECK(bounded_integer(std::nan(""), 1, 10) == 1);
}

TEST_CASE("Bounds that no double holds are kept", "[base][bounded_integer]") {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();  // As a double this is 2^63.
  CHECK(bounded_integer(0x1p63, kLeast, kMost) == kMost);
  CHECK(bounded_integer(std::nextafter(0x1p63, 0.0), kLeast, kMost) == kMost - 1023);
  CHECK(bounded_integer(-0x1p63, kLeast, kMost) == kLeast);
  CHECK(bounded_integer(1e19, kLeast, kMost) == kMost);
}

}  // namespace test_bounded_integer
