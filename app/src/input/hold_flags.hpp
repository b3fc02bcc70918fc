#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>

#include "cli/command_line.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"

namespace graspfit::app {

/// The flags that choose a hold protocol and change its parameters.
boost::program_options::options_description hold_protocol_options();

/// The protocol named `name`. @throws UsageError that names the flag and the protocols.
hold_test::HoldProtocol hold_protocol_named(const std::string& flag, const std::string& name);

/// The protocol that the flags of `hold_protocol_options` give, validated. @throws UsageError.
hold_test::HoldProtocol read_hold_protocol(const Flags& flags);

/// Whether one of these flags sets the step of the simulation.
bool sets_step(const Flags& flags);

/// Throws InvalidInput unless this build can test grasps in physics; `flag`, if any, starts the
/// message.
void require_physics(const std::string& flag = {});

}  // namespace graspfit::app
