// Catch2's own main(): most of the cost of compiling Catch2, paid once for all test programs.
#define CATCH_CONFIG_MAIN
// GCC 12 with sanitizers takes std::regex, which Catch2 compiles here, for uninitialized (its bug
// 105562).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include "support/catch.hpp"
