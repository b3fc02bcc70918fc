// The main() of Catch2 2, which is a header: most of the cost of compiling it, paid once for all
// test programs. Version 3 comes compiled, and this file is left out.
#define CATCH_CONFIG_MAIN
// GCC 12 with sanitizers takes std::regex, which Catch2 compiles here, for uninitialized (its bug
// 105562).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include "support/catch.hpp"
