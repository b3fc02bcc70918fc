#include "hold_flags.hpp"

#include "graspfit/geometry/errors.hpp"
#include "graspfit/hold_test/hold_knobs.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace

po::options_description hold_protocol_options() {
  po::options_description options = option_group("Protocol");
  add_option(options, "protocol", "NAME", hold_test::hold_protocol_names().front(),
             joined(hold_test::hold_protocol_names(), "|"));
  add_option(
      options, "squeeze", "forces|extrapolation|none", std::nullopt,
      "where the squeeze comes from: the grasp file (forces that balance), as far beyond the "
      "grasp as the pre-grasp is before it, or none; without it the protocol's");
  add_option(options, "step", "SECONDS", std::nullopt,
             "of the simulation; without it the protocol's");
  add_repeatable_option(options, "set", "KNOB=VALUE",
                        "another value for a knob of the protocol, several numbers separated by "
                        "commas; may be given several times. Knobs: " +
                            joined(hold_test::knob_names(), ", "));
  return options;
}

hold_test::HoldProtocol read_hold_protocol(const Flags& flags) {
  hold_test::HoldProtocol protocol = hold_test::hold_protocol(flags.text("protocol"));
  if (flags.has("squeeze")) hold_test::set_knob(protocol, "squeeze", flags.text("squeeze"));
  if (const auto step = flags.optional_number("step")) protocol.step = *step;
  for (const std::string& setting : flags.texts("set")) {
    const std::size_t sign = setting.find('=');
    if (sign == std::string::npos || sign == 0) {
      throw UsageError("--set \"" + setting + "\" is not KNOB=VALUE");
    }
    hold_test::set_knob(protocol, setting.substr(0, sign), setting.substr(sign + 1));
  }
  protocol.validate();
  return protocol;
}

void require_physics(const std::string& flag) {
  if (hold_test::is_available()) return;
  throw geometry::InvalidInput((flag.empty() ? "" : flag + ": ") +
                               "this build has no physics engine; configure with MuJoCo 2.2 "
                               "(Debian: libmujoco-dev and libgl-dev)");
}

}  // namespace graspfit::app
