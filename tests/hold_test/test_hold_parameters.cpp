#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hold_test/hold_parameters.hpp"
#include "graspfit/hold_test/hold_report.hpp"
#include "support/catch.hpp"

namespace graspfit::test_hold_parameters {
namespace {

using base::shortest_decimal;
using hold_test::HoldProtocol;
using hold_test::parameter_names;
using hold_test::parameter_value;
using hold_test::ParameterValue;
using hold_test::set_parameter;
using testing::Contains;

// Returns the text that a command line has; `change` makes another value of it.
std::string text_of(const ParameterValue& value, bool change) {
  const double by = change ? 1.5 : 0.0;
  if (const auto* number = std::get_if<double>(&value)) return shortest_decimal(*number + by);
  if (const auto* count = std::get_if<int>(&value))
    return std::to_string(*count + (change ? 1 : 0));
  if (const auto* flag = std::get_if<bool>(&value)) return *flag != change ? "yes" : "no";
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    std::string text;
    for (const double number : *numbers) {
      text += (text.empty() ? "" : ",") + shortest_decimal(number + by);
    }
    return text;
  }
  const std::string& choice = std::get<std::string>(value);
  if (!change) return choice;
  if (choice.starts_with("six-")) return "lift";
  if (choice == "lift") return "six-forces";
  return choice == "none" ? "forces" : "none";
}

TEST_CASE("Setting one parameter of a protocol from text changes that one and no other",
          "[hold_test][hold_parameters]") {
  for (const std::string& protocol_name : hold_test::hold_protocol_names()) {
    const HoldProtocol shipped = hold_test::hold_protocol(protocol_name);
    CHECK(hold_test::changed_parameters(shipped).empty());
    for (const std::string& name : parameter_names()) {
      CAPTURE(protocol_name, name);
      HoldProtocol protocol = shipped;
      const ParameterValue before = parameter_value(protocol, name);
      set_parameter(protocol, name, text_of(before, true));
      CHECK(hold_test::changed_parameters(protocol) == std::vector{name});
      set_parameter(protocol, name, text_of(before, false));
      CHECK(parameter_value(protocol, name) == before);
    }
  }
}

TEST_CASE("Parameters that there are not and texts that are no value are refused by name",
          "[hold_test][hold_parameters]") {
  HoldProtocol protocol;
  CHECK_THROWS_WITH(set_parameter(protocol, "mass", "1"),
                    Contains("mass") && Contains("object_mass_kg"));
  CHECK_THROWS_AS(parameter_value(protocol, ""), base::InvalidInput);
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"force_N", ""},
                                                        {"force_N", "1,5"},
                                                        {"force_N", "1x"},
                                                        {"force_N", "inf"},
                                                        {"force_N", "nan"},
                                                        {"noslip_iterations", "1.5"},
                                                        {"hand_solimp", "1,2"},
                                                        {"hand_solimp", "1,2,3,4"},
                                                        {"hand_solref", "1,,2"},
                                                        {"multi_point_contacts", "true"},
                                                        {"squeeze", "Forces"},
                                                        {"load", "six"}}) {
    CAPTURE(name, text);
    CHECK_THROWS_WITH(set_parameter(protocol, name, text),
                      Contains(name) && Contains('"' + text + '"'));
  }
}

}  // namespace
}  // namespace graspfit::test_hold_parameters
