#include "support/skip.hpp"

#include <iostream>

namespace graspfit::testing {

void report_skip(std::string_view why) { std::cout << "\nSKIPPED: " << why << std::endl; }

}  // namespace graspfit::testing
