// This is the main() of Catch2 2. It is a header that takes most of the time of compiling a test,
// which all test programs together spend once here. Version 3 comes compiled, and this file is left
// out.
#define CATCH_CONFIG_MAIN
#include "support/catch.hpp"
