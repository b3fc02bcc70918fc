#pragma once

// Only this header includes those of Catch2 and knows what versions 2 and 3 call differently.
// Version 3 has many headers, which are slow to compile all together: this one includes those that
// tests use.

#include <string>

#if __has_include(<catch2/catch_test_macros.hpp>)

#include <catch2/catch_approx.hpp>
#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

using Catch::Approx;

namespace graspfit::testing {

/// Matches texts that hold `part`. Version 2 of Catch2 has it by this name; in version 3 this name
/// is a matcher of ranges.
inline auto Contains(const std::string& part) { return Catch::Matchers::ContainsSubstring(part); }

}  // namespace graspfit::testing

#else

#include <catch2/catch.hpp>

namespace graspfit::testing {
using Catch::Matchers::Contains;
}  // namespace graspfit::testing

#endif

namespace graspfit::testing {
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
}  // namespace graspfit::testing
