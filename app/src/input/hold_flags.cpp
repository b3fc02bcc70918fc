#include "input/hold_flags.hpp"

#include <algorithm>
#include <string_view>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hold_test/hold_parameters.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using base::shortest_decimal;

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// A flag that changes a parameter.
struct ParameterChange {
  std::string flag;  ///< As it was given: "--set step_s=0.001".
  std::string parameter;
  std::string value;
};

void apply(const ParameterChange& change, hold_test::HoldProtocol& protocol) {
  const std::vector<std::string> names = hold_test::parameter_names();
  try {
    hold_test::set_parameter(protocol, change.parameter, change.value);
  } catch (const base::InvalidInput& error) {
    const bool is_known = std::find(names.begin(), names.end(), change.parameter) != names.end();
    throw UsageError(change.flag + ": " + error.what() +
                     (is_known ? "" : base::did_you_mean(change.parameter, names)));
  }
}

/// What is wrong with a protocol, without the type's name that begins the message of its check;
/// empty if it is valid.
std::string fault_of(const hold_test::HoldProtocol& protocol) {
  try {
    protocol.validate();
    return "";
  } catch (const base::InvalidInput& error) {
    constexpr std::string_view kType = "HoldProtocol: ";
    const std::string what = error.what();
    return what.starts_with(kType) ? what.substr(kType.size()) : what;
  }
}

/// Refuses an invalid protocol. The message names the first change that alone makes it invalid,
/// else all changes.
void require_usable(const hold_test::HoldProtocol& named,
                    const std::vector<ParameterChange>& changes,
                    const hold_test::HoldProtocol& protocol) {
  const std::string fault = fault_of(protocol);
  if (fault.empty()) return;
  std::string all;
  for (const ParameterChange& change : changes) {
    hold_test::HoldProtocol alone = named;
    apply(change, alone);
    if (const std::string own = fault_of(alone); !own.empty()) {
      throw UsageError(change.flag + ": " + own);
    }
    all += (all.empty() ? "" : " ") + change.flag;
  }
  throw UsageError(all + ": " + fault);
}

}  // namespace

po::options_description hold_protocol_options() {
  po::options_description options = option_group("Protocol");
  add_option(options, "protocol", "NAME", hold_test::hold_protocol_names().front(),
             joined(hold_test::hold_protocol_names(), "|"));
  add_option(
      options, "squeeze", "forces|extrapolation|limits|none", std::nullopt,
      "where the squeeze comes from: the grasp file (forces that balance), as far beyond the "
      "grasp as the pre-grasp is before it, shares of the joints' way to their limits, or none; "
      "without it the protocol's");
  add_option(
      options, "step", "SECONDS", std::nullopt,
      "of the simulation, from 0.00001; without it the protocol's, for a single grasp at most "
      "0.001");
  add_repeatable_option(
      options, "set", "PARAMETER=VALUE",
      "another value for a parameter of the protocol, several numbers separated by "
      "commas; may be given several times. Parameters: " +
          joined(hold_test::parameter_names(), ", "));
  return options;
}

hold_test::HoldProtocol hold_protocol_named(const std::string& flag, const std::string& name) {
  try {
    return hold_test::hold_protocol(name);
  } catch (const base::InvalidInput&) {
    fail_choice(flag, name, joined(hold_test::hold_protocol_names(), "|"));
  }
}

bool sets_step(const Flags& flags) {
  const std::vector<std::string> settings = flags.texts("set");
  return flags.has("step") ||
         std::any_of(settings.begin(), settings.end(),
                     [](const std::string& setting) { return setting.starts_with("step_s="); });
}

hold_test::HoldProtocol read_hold_protocol(const Flags& flags) {
  const hold_test::HoldProtocol named = hold_protocol_named("protocol", flags.text("protocol"));
  hold_test::HoldProtocol protocol = named;
  std::vector<ParameterChange> changes;
  if (flags.has("squeeze")) {
    const std::string& rule = flags.text("squeeze");
    changes.push_back({"--squeeze " + rule, "squeeze", rule});
  }
  if (flags.has("step")) {
    const base::NumberRange steps = base::at_least(hold_test::HoldProtocol::kShortestStep);
    const std::string seconds = shortest_decimal(flags.number("step", steps));
    changes.push_back({"--step " + seconds, "step_s", seconds});
  }
  for (const std::string& setting : flags.texts("set")) {
    const std::size_t sign = setting.find('=');
    if (sign == std::string::npos || sign == 0) {
      throw UsageError("--set \"" + setting + "\" is not PARAMETER=VALUE");
    }
    changes.push_back({"--set " + setting, setting.substr(0, sign), setting.substr(sign + 1)});
  }
  for (const ParameterChange& change : changes) apply(change, protocol);
  require_usable(named, changes, protocol);
  return protocol;
}

void require_physics(const std::string& flag) {
  if (hold_test::is_available()) return;
  throw base::InvalidInput((flag.empty() ? "" : flag + ": ") +
                           "this build has no physics engine; configure with MuJoCo 2.2 "
                           "(Debian: libmujoco-dev and libgl-dev)");
}

}  // namespace graspfit::app
