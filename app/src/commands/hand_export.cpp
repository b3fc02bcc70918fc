#include "graspfit/hands/hand_export.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/hand_commands.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "input/hand_loading.hpp"
#include "output/output_folder.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

Command export_command() {
  Command command{
      "hand export", "HAND",
      "Writes a hand so that every tool can load it: <hand>.urdf and one <link>.obj per link, in\n"
      "the links' own frames and meters, couplings as <mimic>; and <hand>.graspfit.json with what "
      "a\n"
      "URDF cannot say.\n",
      option_group("Options"),
      "Effort and velocity limits in the URDF are placeholders: hands are described without "
      "any.\n"};
  add_option(command.options, "out", "DIR", std::nullopt,
             "the folder; made if need be, files of these names in it are replaced");
  return command;
}

/// Throws IoError if writing to the folder would replace the hand's own files.
void require_other_files(const fs::path& folder, const hands::HandModel& hand) {
  const fs::path urdf = folder / (hand.name + ".urdf");
  std::vector<fs::path> own = {hand.description_file, hand.sidecar_file};
  std::vector<fs::path> written = {urdf, hands::sidecar_file_of(urdf)};
  const fs::path description_folder = fs::weakly_canonical(hand.description_file).parent_path();
  for (const hands::Link& link : hand.links) {
    for (const std::string& file : link.mesh_files) own.push_back(description_folder / file);
    written.push_back(folder / (link.name + ".obj"));
  }
  std::error_code error;
  for (const fs::path& target : written) {
    for (const fs::path& file : own) {
      if (file.empty() || !fs::equivalent(target, file, error) || error) continue;
      throw base::IoError("--out " + folder.string() + ": " + target.filename().string() +
                          " there is a file of the hand itself; choose another folder");
    }
  }
}

}  // namespace

ExitCode run_hand_export(const std::vector<std::string>& arguments) {
  const Command command = export_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const std::string& name = flags.positional();
  if (!flags.has("out")) throw UsageError("no --out DIR given");
  const hands::HandReading reading = load_hand(name);
  require_other_files(flags.text("out"), reading.model);
  // Meshes that a former export left there may belong to another hand: none is removed.
  OutputFolder out(flags.text("out"), [](const std::string&) { return false; });
  const std::vector<fs::path> files = hands::export_hand(reading.model, out.staging());
  out.commit(files.back().filename().string());
  warn_of_findings(command.name, reading);
  const auto meshes = std::count_if(
      files.begin(), files.end(), [](const fs::path& file) { return file.extension() == ".obj"; });
  std::printf("written to %s: %s.urdf, %s.graspfit.json, %td meshes\n", out.target().c_str(),
              reading.model.name.c_str(), reading.model.name.c_str(), meshes);
  return kSuccess;
}

}  // namespace graspfit::app
