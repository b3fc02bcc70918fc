#include <limits>
#include <string>

#include "graspfit/base/option_check.hpp"
#include "support/catch.hpp"

namespace test_option_check {

using namespace graspfit::base;

TEST_CASE("A value out of its range is refused with place, field, value and rule",
          "[base][option_check]") {
  CHECK_NOTHROW(require(true, "Options", "count", 3, "at least 1"));
  CHECK_THROWS_WITH(require(false, "Options", "count", 0, "at least 1"),
                    "Options: count = 0, must be at least 1");
  CHECK_THROWS_WITH(require(false, "Options", "name", std::string("?"), "a word"),
                    "Options: name = ?, must be a word");
  CHECK_NOTHROW(require_between(1, 3, "Options", "count", 1));
  CHECK_NOTHROW(require_between(0.5, 1.0, "Options", "share", 1.0));
  CHECK_THROWS_WITH(require_between(1, 3, "Options", "count", 4),
                    "Options: count = 4, must be in [1, 3]");
  CHECK_THROWS_WITH(require_between(1e-4, 1.0, "Options", "share", 1.5),
                    "Options: share = 1.5, must be in [1e-04, 1]");
  CHECK_THROWS_AS(
      require_between(0.0, 1.0, "Options", "share", std::numeric_limits<double>::quiet_NaN()),
      InvalidInput);
}

}  // namespace test_option_check
