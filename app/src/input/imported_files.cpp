#include "input/imported_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/exchange/dexgraspbench.hpp"
#include "graspfit/exchange/exchange_format.hpp"
#include "graspfit/exchange/imported_grasps.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "input/hand_loading.hpp"
#include "input/object_loading.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using base::shortest_decimal;
using exchange::ExchangeFormat;

/// Largest share by which two scales of an object differ that are the same: single precision.
constexpr double kSameScale = 1e-6;

/// What a file says.
struct StatedGrasps {
  std::string format;  ///< As grasp files record it.
  std::vector<exchange::ImportedGrasp> grasps;
  std::optional<double> meters_per_file_unit;  ///< Of the object's file; empty: not stated.
  std::vector<std::string> notes;
};

StatedGrasps read_stated(const std::string& file, const hands::HandModel& hand) {
  if (exchange::format_of(file) == ExchangeFormat::DexGraspBench) {
    exchange::DexGraspBenchGrasps read = exchange::read_dexgraspbench(file, hand);
    return {"DexGraspBench arrays", std::move(read.grasps), read.meters_per_file_unit,
            std::move(read.notes)};
  }
  return {"isaac_grasp 1.0", exchange::read_isaac_grasps(file, hand), {}, {}};
}

grasp::PlannerOptions measuring_options(const Flags& flags, const hands::HandModel& hand) {
  grasp::PlannerOptions options;
  if (flags.has("fingers")) options.fingers = flags.words("fingers");
  options.num_contacts = flags.integer("contacts", base::at_least(1));
  if (flags.is_default("contacts") && !flags.has("fingers")) {
    options.num_contacts = std::min(options.num_contacts, base::as_index<int>(hand.fingers.size()));
  }
  if (flags.has("palm")) options.palm = true;
  return options;
}

/// Reads the object, by flags or, without flags that say its size, by the scale that `stated` has.
grasp::ObjectFile read_sized_object(const Flags& flags, StatedGrasps& stated) {
  grasp::ObjectReadOptions options = object_read_options(flags);
  const bool is_size_given = flags.has("mesh-unit") || flags.has("longest");
  const std::optional<double>& scale = stated.meters_per_file_unit;
  if (scale && !is_size_given) options.meters_per_file_unit = *scale;
  grasp::ObjectFile object = load_object(flags, flags.text("object"), options);
  const double used = object.record.meters_per_file_unit;
  if (scale && std::abs(used - *scale) > kSameScale * *scale) {
    stated.notes.push_back("the file's obj_scale is " + shortest_decimal(*scale) + ", but by --" +
                           (flags.has("longest") ? "longest" : "mesh-unit") + " a unit of " +
                           object.record.file + " is " + shortest_decimal(used) +
                           " m; the flag is followed");
  }
  require_solid(object);
  return object;
}

}  // namespace

po::options_description import_options() {
  const grasp::PlannerOptions defaults;
  po::options_description options = option_group("Grasps of other tools (.yaml, .npz)");
  add_option(options, "hand", "NAME|FILE", std::nullopt,
             "the hand: a shipped one (graspfit hand list) or any description; its root link is "
             "what the file's poses are of");
  add_option(options, "fingers", "A,B,...", std::nullopt,
             "the fingers that must touch for a grasp to be valid");
  add_option(options, "contacts", "INTEGER", std::to_string(defaults.num_contacts),
             "without --fingers: how many fingers must touch, the thumb first; if not given, no "
             "more than the hand has");
  add_switch(options, "palm", "the palm must touch too");
  return options.add(object_options());
}

void refuse_import_flags(const Flags& flags, const std::string& why) {
  const po::options_description of_imports = import_options();
  for (const auto& option : of_imports.options()) {
    const std::string& flag = option->long_name();
    if (flags.has(flag) && !flags.is_default(flag)) throw UsageError("--" + flag + ' ' + why);
  }
}

bool is_importable(const std::string& file) {
  const auto format = exchange::format_of(file);
  return format == ExchangeFormat::IsaacGrasp || format == ExchangeFormat::DexGraspBench;
}

ImportedFile import_file(const std::string& command, const Flags& flags, const std::string& file) {
  for (const char* flag : {"hand", "object"}) {
    if (!flags.has(flag)) {
      throw UsageError(file + ": names neither hand nor object: --" + std::string(flag) +
                       (std::string(flag) == "hand" ? " NAME|FILE" : " FILE") + " says which");
    }
  }
  const hands::HandReading reading = load_hand(flags.text("hand"));
  StatedGrasps stated = read_stated(file, reading.model);
  const grasp::PlannerOptions options = measuring_options(flags, reading.model);
  warn_of_findings(command, reading);
  const grasp::ObjectFile object = read_sized_object(flags, stated);
  exchange::ImportResult result = exchange::import_grasps(
      object, reading.model, stated.grasps,
      {.format = stated.format, .file = file, .sha256 = base::sha256_hex(base::read_file(file))},
      options);
  ImportedFile imported{std::move(result.file), object.mesh, {}, std::move(stated.notes)};
  imported.notes.insert(imported.notes.end(), result.notes.begin(), result.notes.end());
  for (const std::size_t index : result.sources) {
    imported.names.push_back(stated.grasps[index].name);
  }
  return imported;
}

}  // namespace graspfit::app
