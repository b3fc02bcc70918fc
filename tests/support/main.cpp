// Catch2's own main(): most of the cost of compiling Catch2, paid once for all test programs.
#define CATCH_CONFIG_MAIN
#include "support/catch.hpp"
