#pragma once

#include <string>

namespace graspfit::base {

/// The shortest decimal text that reads back as exactly `value`, in the C locale whatever the
/// program's locale is (`std::to_chars`).
std::string shortest_decimal(double value);

/// A number as people write it: shortest round-trip digits, without an exponent from 1e-6 to 1e15.
std::string plain_decimal(double value);

}  // namespace graspfit::base
