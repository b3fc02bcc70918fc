#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/exchange/dexgraspbench.hpp"
#include "graspfit/exchange/exchange_format.hpp"
#include "graspfit/exchange/graspit_world.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "graspfit/exchange/moveit_grasp.hpp"
#include "graspfit/exchange/posed_glb.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "input/hand_loading.hpp"
#include "input/imported_files.hpp"
#include "input/recorded_files.hpp"
#include "output/grasp_text.hpp"
#include "output/output_folder.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using exchange::ExchangeFormat;

constexpr const char* kOurs = "graspfit";
constexpr const char* kFormatNames = "graspfit|isaac|dexgraspbench|moveit|graspit|glb";

Command convert_command() {
  Command command{
      "convert",
      "IN",
      "Writes grasps for other tools, and reads theirs. IN is a grasp file of graspfit "
      "(grasps.json), an\nisaac_grasp file (.yaml) or arrays under DexGraspBench's names (.npz); "
      "OUT is of the format that its\nextension or --format says:\n"
      "  .json         graspfit       grasp file, for evaluate and hold; from .yaml and .npz\n"
      "  .yaml         isaac          isaac_grasp 1.0\n"
      "  .npz          dexgraspbench  arrays under DexGraspBench's names\n"
      "  .yaml         moveit         messages moveit_msgs/Grasp, with --format moveit\n"
      "  .xml          graspit        GraspIt! world, one grasp a file\n"
      "  .glb          glb            posed hand and object as glTF, one grasp a file\n"
      "Where a file holds one grasp, it is the best one or that of --grasp; an OUT that is a "
      "folder, or has\nno extension, gets one file for each grasp.\n",
      option_group(),
      "What a format cannot carry is printed as notes. Measures of imported grasps are computed "
      "from the\nmeshes; nothing but poses and joints is taken over.\n",
      "OUT"};
  po::options_description general = option_group("Options");
  add_option(general, "format", kFormatNames, std::nullopt,
             "of OUT, where its extension does not say it");
  add_option(general, "grasp", "N,...", std::nullopt, "these grasps only, by their ranks");
  add_option(
      general, "object", "FILE", std::nullopt,
      "of .yaml and .npz: the object; poses are in its frame, or in one in which .npz says where "
      "it is; to glb: the object's file, if it is no longer where the grasp file says");
  add_option(general, "body-file", "PATH", std::nullopt,
             "graspit: the object's body file below $GRASPIT, or a mesh in millimeters");
  add_option(general, "robot-file", "PATH", std::nullopt,
             "graspit: the hand's robot file below $GRASPIT");
  add_switch(general, "quiet", "no table and no notes");
  command.options.add(general).add(import_options());
  return command;
}

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return extension;
}

/// What to write, and where.
struct Target {
  fs::path path;
  std::optional<ExchangeFormat> format;  ///< Empty: our own format.
  bool is_folder = false;                ///< The path is a folder with a file per grasp.
};

Target read_target(const Flags& flags) {
  Target target;
  target.path = flags.second_positional();
  const std::string extension = lower_extension(target.path);
  if (flags.has("format")) {
    const std::string& name = flags.text("format");
    target.format = exchange::format_named(name);
    if (!target.format && name != kOurs) {
      fail_choice("format", name, kFormatNames);
    }
  } else if (extension != ".json") {
    target.format = exchange::format_of(extension.empty() ? fs::path() : fs::path("a" + extension));
    if (!target.format) {
      throw UsageError("what OUT \"" + target.path.string() +
                       "\" is to be, its extension does not say: --format " + kFormatNames);
    }
  }
  std::error_code error;
  const bool is_there = fs::is_directory(target.path, error);
  const bool is_stream =
      fs::is_fifo(target.path, error) || fs::is_character_file(target.path, error);
  target.is_folder = is_there || (extension.empty() && !is_stream);
  if (target.is_folder && !(target.format && exchange::holds_one_grasp(*target.format))) {
    if (is_there) throw UsageError("OUT \"" + target.path.string() + "\" is a folder");
    target.is_folder = false;
  }
  for (const char* flag : {"body-file", "robot-file"}) {
    if (flags.has(flag) && target.format != ExchangeFormat::GraspItWorld) {
      throw UsageError("--" + std::string(flag) + " is for --format graspit");
    }
  }
  return target;
}

/// The grasps to write, and what was noticed in reading them.
struct Source {
  grasp::GraspFile file;
  std::optional<geometry::TriangleMesh> mesh_O;  ///< Object of imported grasps.
  std::vector<std::string> names;                ///< Names of imported grasps.
  std::vector<std::string> notes;
};

Source read_source(const Flags& flags, const Target& target) {
  const auto format = exchange::format_of(flags.positional());
  if (is_importable(flags.positional())) {
    ImportedFile imported = import_file("convert", flags, flags.positional());
    return {std::move(imported.file), std::move(imported.mesh_O), std::move(imported.names),
            std::move(imported.notes)};
  }
  if (format) {
    throw UsageError("IN \"" + flags.positional() + "\": files of " +
                     std::string(exchange::name_of(*format)) +
                     " are written, not read; grasps.json, isaac_grasp (.yaml) and DexGraspBench's "
                     "arrays (.npz) are");
  }
  refuse_import_flags(flags,
                      "is for .yaml and .npz files; a grasp file of graspfit says it itself");
  if (!target.format) {
    throw UsageError("IN and OUT are both grasp files of graspfit; there is nothing to convert");
  }
  if (flags.has("object") && target.format != ExchangeFormat::PosedGlb) {
    throw UsageError("--object is for .yaml and .npz files and for --format glb; " +
                     std::string(exchange::name_of(*target.format)) +
                     " has no mesh that it could say the file of");
  }
  return {grasp::read_grasps(flags.positional()), {}, {}, {}};
}

/// Leaves only the grasps of --grasp.
void select(const Flags& flags, Source& source) {
  const std::vector<std::size_t> indices = flags.indices("grasp");
  if (indices.empty()) return;
  std::vector<grasp::Grasp> grasps;
  std::vector<std::string> names;
  for (const std::size_t index : indices) {
    if (index >= source.file.grasps.size()) {
      throw UsageError("--grasp " + std::to_string(index + 1) + ": there are " +
                       std::to_string(source.file.grasps.size()) + " grasps");
    }
    grasps.push_back(source.file.grasps[index]);
    if (!source.names.empty()) names.push_back(source.names[index]);
  }
  source.file.grasps = std::move(grasps);
  source.names = std::move(names);
}

/// The content of a file: of grasp `index`, for a format of single grasps, or of all grasps.
std::string content(const Flags& flags, ExchangeFormat format, const grasp::GraspFile& file,
                    const geometry::TriangleMesh& mesh_O, std::size_t index) {
  switch (format) {
    case ExchangeFormat::IsaacGrasp:
      return exchange::isaac_grasp_yaml(file);
    case ExchangeFormat::DexGraspBench:
      return exchange::dexgraspbench_npz(file);
    case ExchangeFormat::MoveItGrasp:
      return exchange::moveit_grasps_yaml(file);
    case ExchangeFormat::GraspItWorld:
      return exchange::graspit_world_xml(
          file, index,
          {.body_file = flags.has("body-file") ? flags.text("body-file") : std::string(),
           .robot_file = flags.has("robot-file") ? flags.text("robot-file") : std::string()});
    case ExchangeFormat::PosedGlb:
      break;
  }
  return exchange::posed_scene_glb(mesh_O, file.hand, file.grasps.at(index).configuration);
}

std::string file_name(std::size_t index, ExchangeFormat format) {
  const std::string rank = std::to_string(index + 1);
  return "grasp_" + std::string(rank.size() < 3 ? 3 - rank.size() : 0, '0') + rank + '.' +
         std::string(exchange::extension_of(format));
}

/// Whether a file name is one of a run that wrote the same format; files of other formats stay.
bool is_convert_file(const std::string& name, ExchangeFormat format) {
  static const std::regex pattern(R"(grasp_\d{3,}\.(.*))");
  std::smatch match;
  return std::regex_match(name, match, pattern) && match[1].str() == exchange::extension_of(format);
}

void write(const Flags& flags, const Target& target, const Source& source) {
  const grasp::GraspFile& file = source.file;
  if (!target.format) {
    grasp::write_grasps(target.path, file);
    return;
  }
  if (exchange::holds_one_grasp(*target.format) && file.grasps.empty()) {
    throw UsageError("IN \"" + flags.positional() + "\" has no grasp to write");
  }
  geometry::TriangleMesh mesh_O;
  if (*target.format == ExchangeFormat::PosedGlb) {
    mesh_O = source.mesh_O ? *source.mesh_O : load_recorded_object(flags, file);
  }
  if (!target.is_folder) {
    base::write_file_atomically(target.path, content(flags, *target.format, file, mesh_O, 0));
    return;
  }
  OutputFolder out(target.path, [format = *target.format](const std::string& name) {
    return is_convert_file(name, format);
  });
  for (std::size_t i = 0; i < file.grasps.size(); ++i) {
    base::write_file_atomically(out.staging() / file_name(i, *target.format),
                                content(flags, *target.format, file, mesh_O, i));
  }
  out.commit(file_name(0, *target.format));
}

/// The table of our measures of imported grasps.
std::string table_of(const Source& source) {
  std::vector<std::vector<std::string>> rows = {
      {"rank", "name", "M", "epsilon", "contacts", "gap_mm", "penetration_mm", "valid"}};
  for (std::size_t i = 0; i < source.file.grasps.size(); ++i) {
    const grasp::Grasp& grasp = source.file.grasps[i];
    rows.push_back({std::to_string(i + 1), source.names[i], fixed_decimal(grasp.quality.m, 4),
                    epsilon_text(grasp, 4), std::to_string(grasp.contacts.size()),
                    fixed_decimal(1000.0 * grasp::largest_requested_gap(grasp), 4),
                    fixed_decimal(1000.0 * grasp::largest_penetration(grasp), 3),
                    grasp.is_valid() ? "yes" : "no"});
  }
  return text_table(rows);
}

void report(const Target& target, const Source& source, std::size_t num_grasps_read) {
  if (!source.names.empty()) std::fputs(table_of(source).c_str(), stdout);
  const bool is_single = target.format && exchange::holds_one_grasp(*target.format);
  const std::size_t num_written = is_single && !target.is_folder ? 1 : source.file.grasps.size();
  std::printf("%s of %s written to %s\n", std::to_string(num_written).c_str(),
              counted(num_grasps_read, "grasp", "grasps").c_str(), target.path.c_str());
  std::vector<std::string> notes = source.notes;
  if (target.format) {
    const auto limits = exchange::limits_of(*target.format, source.file);
    notes.insert(notes.end(), limits.begin(), limits.end());
  }
  for (const std::string& note : notes) std::printf("note: %s\n", note.c_str());
}

}  // namespace

ExitCode run_convert(const std::vector<std::string>& arguments) {
  const Command command = convert_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  flags.positional();
  const Target target = read_target(flags);
  std::error_code error;
  if (fs::equivalent(flags.positional(), target.path, error)) {
    throw UsageError("OUT \"" + target.path.string() + "\" is IN, which would be lost");
  }
  Source source = read_source(flags, target);
  const std::size_t num_grasps_read = source.file.grasps.size();
  select(flags, source);
  write(flags, target, source);
  if (!flags.has("quiet")) report(target, source, num_grasps_read);
  return kSuccess;
}

}  // namespace graspfit::app
