#pragma once

#include <string>
#include <variant>
#include <vector>

#include "graspfit/hold_test/hold_protocol.hpp"

namespace graspfit::hold_test {

/// What a protocol's knob may hold: a number, a count, yes or no, several numbers, or the name of a
/// choice.
using KnobValue = std::variant<double, int, bool, std::vector<double>, std::string>;

/// Names of all knobs of a protocol, units in the names: those that files and command lines use, in
/// the order of the struct; its `name` and `source` are not knobs.
const std::vector<std::string>& knob_names();

/// The value of a knob. @throws InvalidInput (with the names there are) for another name.
KnobValue knob_value(const HoldProtocol& protocol, const std::string& name);

/// Sets a knob from text: a number in the C locale, numbers separated by commas, yes or no, or the
/// name of a choice (six-forces|lift, forces|extrapolation|none). The protocol is not validated.
/// @throws InvalidInput naming the knob and the text.
void set_knob(HoldProtocol& protocol, const std::string& name, const std::string& text);

/// "forces", "extrapolation" or "none".
const char* name_of(SqueezeRule rule);

/// "six-forces" or "lift".
const char* name_of(HoldLoad load);

}  // namespace graspfit::hold_test
