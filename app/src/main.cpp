#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_table.hpp"
#include "cli/exit_codes.hpp"
#include "cli/interrupts.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::app {
namespace {

const char* const kUsage =
    "Usage: graspfit COMMAND ... | --help | --version\n"
    "\n"
    "Plans grasps of an object with an articulated hand by hand-object geometric fitting.\n"
    "\n"
    "  graspfit plan OBJECT          grasps of a mesh: file, table, posed meshes, pictures\n"
    "  graspfit options              all options of the planner, as a page\n"
    "  graspfit inspect OBJECT       what a mesh is like: repairs, voxels, contact scores\n"
    "  graspfit evaluate GRASPS.json computes contacts and measures of a grasp file again\n"
    "  graspfit hold GRASPS.json     tests in physics whether the grasps of a file hold\n"
    "  graspfit compare A B          two sets of grasps on the same objects, side by side\n"
    "  graspfit convert IN OUT       grasp files of other tools: writes five formats, reads two\n"
    "  graspfit motion MOTION.json   checks and shows how a hand moves objects on a table\n"
    "  graspfit shape NAME           writes a mesh of a mug, a bottle, ...: see shape --list\n"
    "  graspfit hand ...             lists, shows, checks, exports and derives hands\n"
    "  graspfit dataset ...          tested grasps of many objects: index, arrays, card\n"
    "  graspfit experiment ...       lists, describes and runs tables of results\n"
    "\n"
    "graspfit COMMAND --help lists a command's options with their defaults and units.\n";

void print_error(const std::string& command, const std::string& what) {
  std::string line = "graspfit" + (command.empty() ? "" : ' ' + command) + ": " + what;
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::fprintf(stderr, "%s\n", line.c_str());
}

constexpr std::array<NamedCommand, 12> kCommands = {{{"plan", run_plan},
                                                     {"options", run_options},
                                                     {"inspect", run_inspect},
                                                     {"evaluate", run_evaluate},
                                                     {"hold", run_hold},
                                                     {"compare", run_compare},
                                                     {"convert", run_convert},
                                                     {"motion", run_motion},
                                                     {"shape", run_shape},
                                                     {"hand", run_hand},
                                                     {"dataset", run_dataset},
                                                     {"experiment", run_experiment}}};

ExitCode run(const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments[0] == "--version") {
    std::fputs(version_text().c_str(), stdout);
    return kSuccess;
  }
  return run_command(kCommands, "", kUsage, arguments);
}

/// The command's name for messages, "hand show"; empty if there is no such command.
std::string name_for_messages(const std::vector<std::string>& arguments) {
  if (arguments.empty() || find_command(kCommands, arguments[0]) == nullptr) return "";
  const bool has_subcommand =
      arguments.size() > 1 &&
      ((arguments[0] == "hand" && is_hand_command(arguments[1])) ||
       (arguments[0] == "dataset" && is_dataset_command(arguments[1])) ||
       (arguments[0] == "experiment" && is_experiment_command(arguments[1])));
  return has_subcommand ? arguments[0] + ' ' + arguments[1] : arguments[0];
}

/// Runs the command; every exception ends here as one line and an exit code.
ExitCode run_and_report(const std::vector<std::string>& arguments) {
  const std::string command = name_for_messages(arguments);
  try {
    return run(arguments);
  } catch (const UsageError& error) {
    print_error(command, error.what());
  } catch (const base::Error& error) {
    print_error(command, error.what());
  } catch (const std::bad_alloc&) {
    print_error(command, "out of memory");
    return kInternalError;
  } catch (const std::exception& error) {
    print_error(command, std::string("internal error: ") + error.what());
    return kInternalError;
  }
  return kBadInput;
}

/// Keeps memory that was freed, up to this much [bytes]: given back and asked for again, every page
/// of it costs a fault.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kKept = 1 << 29;
  constexpr int kStep = 1 << 26;
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_TOP_PAD, kStep);
#endif
}

}  // namespace
}  // namespace graspfit::app

int main(int argc, char** argv) {
  graspfit::app::keep_freed_memory();
  graspfit::app::watch_interrupts();
  graspfit::app::report_file_size_limit();
  const graspfit::app::ExitCode code =
      graspfit::app::run_and_report(std::vector<std::string>(argv + 1, argv + argc));
  // Errors of a full disk or a closed pipe appear only now, or appeared while the buffer was
  // filled.
  const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (!is_written && code == graspfit::app::kSuccess) {
    std::fputs("graspfit: standard output could not be written\n", stderr);
    return graspfit::app::kInternalError;
  }
  return code;
}
