#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/command_table.hpp"
#include "commands/commands.hpp"
#include "commands/hand_commands.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "input/hand_loading.hpp"

namespace graspfit::app {
namespace {

const char* const kHandUsage =
    "Usage: graspfit hand COMMAND ... | --help\n"
    "\n"
    "Hands: the shipped ones, and anybody's own. HAND is the name of a shipped hand or the file "
    "of\n"
    "a description: URDF, MJCF or GraspIt! XML. What these cannot say (fingers, pads, palm, "
    "closing\n"
    "directions) is in <description>.graspfit.json beside it; what no such file says is derived.\n"
    "\n"
    "  graspfit hand list            the shipped hands\n"
    "  graspfit hand show HAND       joints, fingers, pads as tables, a picture or a page\n"
    "  graspfit hand reach HAND      widths that it pinches squarely: tables, a picture or a page\n"
    "  graspfit hand check HAND      everything missing or suspicious about a description\n"
    "  graspfit hand derive HAND     writes what was derived to <description>.graspfit.json to "
    "edit\n"
    "  graspfit hand export HAND     URDF and one OBJ per link, for other tools\n"
    "\n"
    "Your own hand in three steps: check my_hand.urdf, look at show my_hand.urdf --html "
    "hand.html,\n"
    "and where the derivation guessed wrong, derive my_hand.urdf and edit the file that it "
    "writes.\n"
    "\n"
    "graspfit hand COMMAND --help lists a command's options with their defaults and units.\n";

constexpr std::array<NamedCommand, 6> kHandCommands = {{{"list", run_hand_list},
                                                        {"show", run_hand_show},
                                                        {"reach", run_hand_reach},
                                                        {"check", run_hand_check},
                                                        {"derive", run_hand_derive},
                                                        {"export", run_hand_export}}};

Command hand_list_command() {
  return {"hand list", "", "Lists the shipped hands with what they have and where they are.\n",
          option_group("Options"), ""};
}

}  // namespace

bool is_hand_command(const std::string& name) {
  return find_command(kHandCommands, name) != nullptr;
}

ExitCode run_hand(const std::vector<std::string>& arguments) {
  return run_command(kHandCommands, "hand", kHandUsage, arguments);
}

ExitCode run_hand_list(const std::vector<std::string>& arguments) {
  const Command command = hand_list_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  ExitCode code = kSuccess;
  for (const std::string& name : hands::shipped_hands()) {
    try {
      const hands::HandReading reading = load_hand(name);
      const hands::HandModel& hand = reading.model;
      std::printf("%s: %zu fingers, %zu joints, %d independent, %zu pads%s\n", name.c_str(),
                  hand.fingers.size(), hand.joints.size(), hand.num_intrinsic_dof(),
                  hand.pads.size(), hand.palm.pad ? ", one on the palm" : "");
      if (!reading.description.empty()) std::printf("  %s\n", reading.description.c_str());
      std::printf("  %s\n", hand.description_file.c_str());
    } catch (const base::Error& error) {
      // The other hands are listed all the same.
      std::fprintf(stderr, "graspfit hand list: %s\n", error.what());
      code = kBadInput;
    }
  }
  return code;
}

}  // namespace graspfit::app
