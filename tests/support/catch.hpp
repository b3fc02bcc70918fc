#pragma once

// The one place that names Catch2's headers, and what its versions 2 and 3 call differently.
// Version 3 keeps its headers apart, and all of them together are slow to compile: here is what
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

/// Matches texts that hold `part`. It is a name of Catch2 2; in version 3 that is about ranges.
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
