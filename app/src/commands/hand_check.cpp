#include "graspfit/hands/hand_check.hpp"

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/hand_commands.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "input/hand_loading.hpp"
#include "output/progress_bar.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
using hands::FindingKind;

Command check_command() {
  return {"hand check", "HAND",
          "Reports everything that is missing or suspicious about a hand: shipped name or file.\n"
          "Faults keep it from being used; suspicious is what its author hardly meant; notes say\n"
          "what the reader did. The last line counts them.\n",
          option_group("Options"),
          "Here exit code 2 also means: the hand has faults. What is suspicious alone gives 0.\n"};
}

}  // namespace

ExitCode run_hand_check(const std::vector<std::string>& arguments) {
  const Command command = check_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const fs::path file = hands::find_hand_file(flags.positional());
  const hands::HandCheck check = [&] {
    const SecondsBar seconds(true, "checking " + file.string());
    return hands::check_hand(file);
  }();
  for (const hands::HandFinding& finding : check.findings) {
    std::printf("%s\n", finding_line(finding).c_str());
  }
  const std::size_t faults = check.count(FindingKind::Fault);
  std::printf("%s: %s, %zu suspicious, %s\n", file.c_str(),
              counted(faults, "fault", "faults").c_str(), check.count(FindingKind::Suspicious),
              counted(check.count(FindingKind::Note), "note", "notes").c_str());
  if (faults == 0) return kSuccess;
  std::fprintf(stderr, "graspfit hand check: %s: %s from being used\n", file.c_str(),
               counted(faults, "fault keeps the hand", "faults keep the hand").c_str());
  return kBadInput;
}

}  // namespace graspfit::app
