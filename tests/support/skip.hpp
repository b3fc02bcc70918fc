#pragma once

#include <string_view>

namespace graspfit::testing {

/// Prints `SKIPPED: why` on a line of its own; ctest then counts the test as skipped, not passed.
void report_skip(std::string_view why);

}  // namespace graspfit::testing

/// Leaves the test case because it cannot run here. Say what is missing and how to get it:
/// `GRASPFIT_SKIP_TEST("meshes/paper/mug.obj is not there; set GRASPFIT_DATA")`.
#define GRASPFIT_SKIP_TEST(why)            \
  do {                                     \
    ::graspfit::testing::report_skip(why); \
    return;                                \
  } while (false)
