#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "graspfit/geometry/errors.hpp"
#include "interrupts.hpp"

namespace graspfit::app {
namespace {

const char* const kUsage =
    "Usage: graspfit COMMAND ... | --help | --version\n"
    "\n"
    "Plans grasps of an object with an articulated hand by hand-object geometric fitting.\n"
    "\n"
    "  graspfit plan OBJECT          grasps of a mesh: file, table, posed meshes, pictures\n"
    "  graspfit inspect OBJECT       what a mesh is like: repairs, voxels, contact scores\n"
    "  graspfit evaluate GRASPS.json computes contacts and measures of a grasp file again\n"
    "  graspfit shape NAME           writes a mesh of a mug, a bottle, ...: see shape --list\n"
    "\n"
    "graspfit COMMAND --help lists a command's options with their defaults and units.\n";

void print_error(const std::string& command, const std::string& what) {
  std::string line = "graspfit" + (command.empty() ? "" : ' ' + command) + ": " + what;
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::fprintf(stderr, "%s\n", line.c_str());
}

ExitCode run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw UsageError("no command given; there are plan, inspect, evaluate and shape (see --help)");
  }
  const std::string& command = arguments[0];
  const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
  if (command == "plan") return run_plan(rest);
  if (command == "inspect") return run_inspect(rest);
  if (command == "evaluate") return run_evaluate(rest);
  if (command == "shape") return run_shape(rest);
  if (command == "--help" || command == "-h" || command == "help") {
    std::fputs(kUsage, stdout);
    return kSuccess;
  }
  if (command == "--version") {
    std::fputs(version_text().c_str(), stdout);
    return kSuccess;
  }
  throw UsageError("unknown command \"" + command +
                   "\"; there are plan, inspect, evaluate and shape");
}

/// Every exception ends here as one line and an exit code.
ExitCode run_and_report(const std::vector<std::string>& arguments) {
  const bool has_command =
      !arguments.empty() && (arguments[0] == "plan" || arguments[0] == "inspect" ||
                             arguments[0] == "evaluate" || arguments[0] == "shape");
  const std::string command = has_command ? arguments[0] : "";
  try {
    return run(arguments);
  } catch (const UsageError& error) {
    print_error(command, error.what());
  } catch (const geometry::Error& error) {
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

}  // namespace
}  // namespace graspfit::app

int main(int argc, char** argv) {
  graspfit::app::watch_interrupts();
  const graspfit::app::ExitCode code =
      graspfit::app::run_and_report(std::vector<std::string>(argv + 1, argv + argc));
  // A full disk or a closed pipe shows only now.
  if (std::fflush(stdout) != 0 && code == graspfit::app::kSuccess) {
    std::fputs("graspfit: standard output could not be written\n", stderr);
    return graspfit::app::kInternalError;
  }
  return code;
}
