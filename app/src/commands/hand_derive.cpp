#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/hand_commands.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "input/hand_loading.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

Command derive_command() {
  Command command{"hand derive", "HAND",
                  "Writes the sidecar <description>.graspfit.json beside a hand's description: "
                  "fingers, thumb,\n"
                  "pads, palm, closing directions and collision exclusions as derived from tree "
                  "and meshes, to\n"
                  "look at and to edit. From then on the file counts, not the derivation.\n",
                  option_group("Options"),
                  "With --force, what the file says is kept and what it leaves out is derived: "
                  "delete a member\n"
                  "to have it derived again.\n"};
  add_option(command.options, "out", "FILE", std::nullopt,
             "write to another file; only the default place is read with the hand");
  add_switch(command.options, "force", "replace a file that is there");
  return command;
}

}  // namespace

ExitCode run_hand_derive(const std::vector<std::string>& arguments) {
  const Command command = derive_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const fs::path file = hands::find_hand_file(flags.positional());
  const hands::HandReading reading = hands::read_hand(file);
  const hands::HandModel& hand = reading.model;
  const fs::path sidecar =
      flags.has("out") ? fs::path(flags.text("out")) : hands::sidecar_file_of(file);
  const std::string holds =
      counted(hand.fingers.size(), "finger", "fingers") + ", " +
      counted(hand.pads.size(), "pad", "pads") + ", " +
      counted(hand.exclusions.size(), "collision exclusion", "collision exclusions");
  std::error_code error;
  if (fs::exists(sidecar, error) && !flags.has("force")) {
    const bool is_read =
        !hand.sidecar_file.empty() && fs::equivalent(sidecar, hand.sidecar_file, error);
    throw base::IoError(sidecar.string() + ": is there already" +
                        (is_read ? " (with it the hand has " + holds + ")" : "") +
                        "; --force replaces it");
  }
  base::write_file_atomically(sidecar, hands::derived_sidecar_text(file));
  for (const hands::HandFinding& finding : reading.findings) {
    std::printf("%s\n", finding_line(finding).c_str());
  }
  std::printf("%s: %s\n", sidecar.c_str(), holds.c_str());
  return kSuccess;
}

}  // namespace graspfit::app
