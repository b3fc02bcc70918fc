#include <cmath>
#include <limits>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_range.hpp"
#include "graspfit/base/number_text.hpp"
#include "support/catch.hpp"

namespace test_number_range {

using namespace graspfit::base;

TEST_CASE("A range ends where its text says", "[base][number_range]") {
  const NumberRange half_open = {.least = 0, .most = 1, .has_most = false};
  CHECK(half_open.text() == "in [0, 1)");
  CHECK(half_open.contains(0.0));
  CHECK_FALSE(half_open.contains(1.0));
  CHECK(half_open.contains(std::nextafter(1.0, 0.0)));
  CHECK_FALSE(half_open.contains(std::nextafter(0.0, -1.0)));

  CHECK(above(0).text() == "> 0");
  CHECK_FALSE(above(0).contains(0.0));
  CHECK(at_least(2).text() == ">= 2");
  CHECK(at_least(2).contains(2.0));
  CHECK(between(4, 512).text() == "in [4, 512]");
  CHECK(between(4, 512).contains(512.0));
  CHECK(NumberRange{.most = 90, .has_most = false}.text() == "< 90");
  CHECK(NumberRange{}.text() == "finite");
}

TEST_CASE("Plain decimals have an exponent only where they are huge or tiny",
          "[base][number_range]") {
  CHECK(plain_decimal(100000) == "100000");
  CHECK(plain_decimal(0.0009) == "0.0009");
  CHECK(plain_decimal(-0.1) == "-0.1");
  CHECK(plain_decimal(0) == "0");
  CHECK(plain_decimal(1e30) == "1e+30");
  CHECK(plain_decimal(2.5e-7) == "2.5e-07");
  CHECK(plain_decimal(1e-6).size() <= 30);
  CHECK(std::stod(plain_decimal(999999999999999.9)) == 999999999999999.9);
  CHECK(between(1, 1000000).text() == "in [1, 1000000]");
}

TEST_CASE("Nothing that is not finite is in a range", "[base][number_range]") {
  for (const NumberRange& range : {NumberRange{}, at_least(0), above(0)}) {
    CHECK_FALSE(range.contains(std::numeric_limits<double>::infinity()));
    CHECK_FALSE(range.contains(std::numeric_limits<double>::quiet_NaN()));
  }
}

TEST_CASE("A value outside is refused by name, value and range", "[base][number_range]") {
  CHECK(between(0, 1).checked("--share", 0.25) == 0.25);
  CHECK_THROWS_WITH(between(0, 0.01).checked("--weld", -1), "--weld is -1, must be in [0, 0.01]");
  CHECK_THROWS_AS(above(0).checked("--step", 0), InvalidInput);
}

}  // namespace test_number_range
