// The main() of Catch2 2, which is a header: most of the cost of compiling it, paid once for all
// test programs. Version 3 comes compiled, and this file is left out.
#define CATCH_CONFIG_MAIN
#include "support/catch.hpp"
