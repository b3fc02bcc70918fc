#pragma once

#include <string>
#include <variant>
#include <vector>

#include "graspfit/hold_test/hold_protocol.hpp"

namespace graspfit::hold_test {

/// What a protocol's parameter may hold: a number, a count, yes or no, several numbers, or the name
/// of a choice.
using ParameterValue = std::variant<double, int, bool, std::vector<double>, std::string>;

/// Names of all parameters of a protocol, with units, as files and command lines use them, in the
/// order of the struct. The protocol's `name` and `source` are not parameters.
const std::vector<std::string>& parameter_names();

/// The value of a parameter. @throws InvalidInput (with the names there are) for another name.
ParameterValue parameter_value(const HoldProtocol& protocol, const std::string& name);

/// Sets a parameter from text: a number in the C locale, numbers separated by commas, yes or no, or
/// the name of a choice (six-forces|six-in-turn|lift, forces|extrapolation|limits|none). The
/// protocol is not validated.
/// @throws InvalidInput naming the parameter and the text.
void set_parameter(HoldProtocol& protocol, const std::string& name, const std::string& text);

/// "forces", "extrapolation", "limits" or "none".
const char* name_of(SqueezeRule rule);

/// "six-forces", "six-in-turn" or "lift".
const char* name_of(HoldLoad load);

}  // namespace graspfit::hold_test
