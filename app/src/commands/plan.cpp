#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <optional>
#include <regex>
#include <sstream>
#include <utility>

#include "cli/command_line.hpp"
#include "cli/interrupts.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_measure.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/object_difference.hpp"
#include "graspfit/viewer/page.hpp"
#include "input/hand_loading.hpp"
#include "input/hold_filter.hpp"
#include "input/hold_flags.hpp"
#include "input/object_loading.hpp"
#include "input/planner_flags.hpp"
#include "output/grasp_text.hpp"
#include "output/no_grasp_advice.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

Command plan_command() {
  po::options_description output = option_group("Output");
  add_option(
      output, "out", "DIR", std::nullopt,
      "write grasps.json, grasps.csv, every grasp as grasp_NNN.obj and .ply, and the meshes as "
      "they were used (object.ply, link_NN_NAME.ply, obstacle_N.ply) there; without it only "
      "the table is printed");
  add_switch(output, "pictures", "also grasp_NNN.png (needs python3-vtk9)");
  add_switch(output, "page", "also grasps.html, a page that any browser opens from disk");
  add_switch(output, "export-guidance",
             "also guidance.csv and guidance.ply: the points that guide the planner's method, with "
             "all that it knows of them (fitting: score map; gs: samples; ma: medial balls)");
  add_switch(output, "quiet", "no progress bar and no table");

  po::options_description hold = option_group("Physics");
  add_option(
      hold, "hold", "PROTOCOL", std::nullopt,
      "leave out grasps that do not hold in a physics test under this protocol (see hold --help) "
      "and, without rank, order the others by the smallest force that fails; failures are counted "
      "by stage");

  Command command{
      "plan", "OBJECT",
      "Plans grasps of OBJECT (OFF, OBJ, PLY, STL, glTF or GLB) with a hand.\n"
      "[P]: stated by the paper; [R]: a reading of what it leaves open, by its number in "
      "docs/readings.md.\n",
      option_group(),
      "Lengths are meters and directions are in the object's own frame unless a flag's "
      "name says otherwise.\nUsable: M > 0. Valid: usable, touches, clear. touches: every finger "
      "that was asked for, and the\npalm if it was; with style auto or power what the targets are "
      "for. clear: penetrates nothing on the\ntrue meshes. closed: force closure at --friction. "
      "epsilon: in GraspIt!'s convention, 0 where not\nclosed. epsilon_mu: how hard the grasp is "
      "to break, in graspfit's convention at squeeze-friction,\nnegative where not closed there. "
      "gap_mm: the largest of a requested contact.\n"};
  command.options.add(object_options())
      .add(surroundings_options())
      .add(planner_options())
      .add(score_map_options())
      .add(hold)
      .add(output);
  command.basics = {"preset",    "hand",      "style",        "contacts", "fingers",
                    "approach",  "mesh-unit", "longest",      "table",    "on-table",
                    "rest-pose", "count",     "max-attempts", "seed",     "hold",
                    "out",       "pictures",  "page",         "quiet"};
  return command;
}

/// Outcomes of attempts as text, most frequent first: "missed contact 300, no stable pair 88".
std::string outcomes_text(const grasp::PlannerStatistics& statistics) {
  std::vector<std::pair<std::int64_t, std::string>> counts;
  for (const auto& [outcome, count] : statistics.outcomes) {
    if (count > 0) counts.emplace_back(-count, grasp::outcome_name(outcome));
  }
  for (const auto& [reason, count] : statistics.target_failures) {
    if (count > 0) counts.emplace_back(-count, "of these " + reason);
  }
  if (statistics.duplicates > 0) {
    counts.emplace_back(-statistics.duplicates, "of these left out as too alike");
  }
  std::sort(counts.begin(), counts.end());
  std::string text;
  for (const auto& [count, name] : counts) {
    text += (text.empty() ? "" : ", ") + name + ' ' + std::to_string(-count);
  }
  return text;
}

std::string table_of(const grasp::GraspFile& file, const grasp::ObjectModel& object) {
  const contact::WrenchObject wrench_object =
      contact::wrench_object(object.mesh(), object.mass.center_of_mass);
  const auto yes_or_no = [](bool is_so) { return is_so ? "yes" : "no"; };
  std::vector<std::vector<std::string>> rows = {
      {"rank", "M", "M1", "M2", "M3", "epsilon",
       "epsilon_mu" + base::plain_decimal(file.options.squeeze_friction), "closed", "contacts",
       "gap_mm", "penetration_mm", "touches", "clear"}};
  for (const grasp::Grasp& grasp : file.grasps) {
    const double epsilon = grasp.is_closed() ? grasp.epsilon() : 0.0;
    const double strength = grasp::grasp_strength(
        grasp, wrench_object, file.options.squeeze_friction, grasp::bearing_gap(file));
    rows.push_back({std::to_string(rows.size()), fixed_decimal(grasp.quality.m, 4),
                    fixed_decimal(grasp.quality.m1, 4), fixed_decimal(grasp.quality.m2, 4),
                    fixed_decimal(grasp.quality.m3, 4), fixed_decimal(epsilon, 4),
                    fixed_decimal(strength, 4), yes_or_no(grasp.is_closed()),
                    std::to_string(grasp.contacts.size()),
                    fixed_decimal(1000.0 * grasp::largest_requested_gap(grasp), 4),
                    fixed_decimal(1000.0 * grasp::largest_penetration(grasp), 3),
                    yes_or_no(grasp.has_all_contacts), yes_or_no(!grasp.penetration.is_any())});
  }
  if (file.hold && !file.hold->margins.empty()) {
    rows[0].push_back("margin_N");
    for (std::size_t i = 1; i < rows.size(); ++i) {
      rows[i].push_back(fixed_decimal(file.hold->margins[i - 1], 2));
    }
  }
  return text_table(rows);
}

std::string grasp_name(std::size_t rank) {
  std::ostringstream name;
  name << "grasp_" << std::setw(3) << std::setfill('0') << rank;
  return name.str();
}

bool is_plan_file(const std::string& name) {
  static const std::regex pattern(
      R"(grasps\.(json|csv|html)|grasp_\d{3,}\.(obj|ply|png)|guidance\.(csv|ply))"
      R"(|object\.ply|obstacle_\d+\.ply|link_\d{2,}_[A-Za-z0-9_-]*\.ply)");
  return std::regex_match(name, pattern);
}

/// Why the search ended, for the last line.
const char* stop_text(grasp::PlannerStop stop) {
  switch (stop) {
    case grasp::PlannerStop::Count:
      return "stopped at the wanted number";
    case grasp::PlannerStop::Attempts:
      return "all attempts made";
    case grasp::PlannerStop::Exhausted:
      return "every start tried";
    case grasp::PlannerStop::WallClock:
      return "stopped at the wall-clock limit";
    case grasp::PlannerStop::Iterations:
      return "all iterations made";
    case grasp::PlannerStop::Interrupted:
      return "interrupted";
  }
  return "";
}

void write_files(grasp::GraspFile& file, const grasp::ObjectModel& object,
                 const grasp::Surroundings& surroundings, const Flags& flags, OutputFolder& out,
                 ProgressBar& progress) {
  const fs::path& folder = out.staging();
  progress.show("writing files");
  file.used_meshes = grasp::write_used_meshes(folder, file.hand, object.mesh(), surroundings);
  grasp::write_grasps(folder / "grasps.json", file);
  base::write_file_atomically(folder / "grasps.csv", grasp::to_csv(file));
  for (std::size_t i = 0; i < file.grasps.size(); ++i) {
    const hands::HandConfiguration& configuration = file.grasps[i].configuration;
    const std::string name = grasp_name(i + 1);
    base::write_file_atomically(folder / (name + ".obj"),
                                grasp::posed_scene_obj(object.mesh(), file.hand, configuration));
    geometry::write_mesh(folder / (name + ".ply"),
                         grasp::posed_scene(object.mesh(), file.hand, configuration));
  }
  if (flags.has("export-guidance")) {
    const grasp::GuidanceModel model =
        grasp::guidance_model(object, file.hand, file.options, surroundings);
    base::write_file_atomically(folder / "guidance.csv", grasp::to_csv(model));
    base::write_file_atomically(folder / "guidance.ply", grasp::to_ply(model));
  }
  if (flags.has("page")) {
    progress.show("writing page");
    viewer::PageInput page;
    page.title = fs::path(file.object.file).stem().string() + ", " + file.hand.name + " hand";
    page.object_O = object.mesh();
    page.hand = file.hand;
    page.grasps = file.grasps;
    page.model = &object;
    page.clip_thickness = file.clip_thickness;
    page.surroundings = &surroundings;
    page.note = grasp::difference_from_file(file.object).value_or("");
    viewer::write_page(folder / "grasps.html", page);
  }
  if (flags.has("pictures")) {
    progress.show("drawing pictures");
    try {
      draw_pictures(folder, grasp::difference_from_file(file.object).value_or(""));
    } catch (const base::IoError& error) {
      // If pictures cannot be drawn, the results of minutes of planning are kept all the same.
      out.commit("grasps.json");
      throw base::IoError(std::string(error.what()) + "; all other files are in " +
                          out.target().string());
    }
  }
  out.commit("grasps.json");
}

/// Refuses what the hand cannot do, before any work.
void require_possible(const Flags& flags, const hands::HandModel& hand,
                      const grasp::PlannerOptions& options) {
  const bool has_palm = options.palm.value_or(options.style == grasp::GraspStyle::Power);
  if (has_palm && !hand.palm.pad) {
    throw base::InvalidInput("hand " + hand.name + " has no pad on its palm to touch with" +
                             (flags.has("palm") ? "" : "; --no-palm asks for none"));
  }
  grasp::requested_parts(hand, options);
}

int num_threads_of(const Flags& flags) {
  const int num_threads = flags.integer("threads");
  if (num_threads < 0) {
    throw UsageError("--threads " + flags.text("threads") + " is not a number from 0");
  }
  return num_threads;
}

void require_means_of_output(const Flags& flags) {
  if (!flags.has("out") &&
      (flags.has("pictures") || flags.has("page") || flags.has("export-guidance"))) {
    throw UsageError("--pictures, --page and --export-guidance need --out DIR");
  }
  if (flags.has("pictures")) require_pictures("--pictures");
}

/// A function that shows the planner's progress: attempts or, if the planner stops at the first
/// grasps, grasps.
grasp::PlannerProgress shown_by(ProgressBar& bar, const grasp::PlannerOptions& options) {
  return [&bar, &options](std::int64_t attempts, std::int64_t grasps) {
    const std::string attempt =
        "attempt " + std::to_string(attempts) + " of " + std::to_string(options.max_attempts);
    const std::string found = std::to_string(grasps) + " grasps";
    if (options.search == grasp::SearchRule::Best) {
      bar.show(attempts, options.max_attempts, attempt + ", " + found);
    } else {
      bar.show(grasps, options.count,
               found + " of " + std::to_string(options.count) + ", " + attempt);
    }
  };
}

/// The attempts as text, with what the method found: "in 50 attempts (all attempts made): valid 12,
/// missed contact 38".
std::string attempts_text(const grasp::PlannerResult& result) {
  std::string text = "in " + std::to_string(result.statistics.attempts) + " attempts (" +
                     stop_text(result.stop) + "): " + outcomes_text(result.statistics);
  std::string found;
  for (const auto& [what, count] : result.statistics.guidance) {
    if (what == grasp::kNarrowestPinch || what == grasp::kWidestPinch) continue;  // `grip_text`
    if (count > 0) found += (found.empty() ? "" : ", ") + what + ' ' + std::to_string(count);
  }
  return found.empty() ? text : text + "; guided by " + found;
}

/// Whether targets by reach are only asked for by the preset that nobody asked for: where voxels
/// are large beside what the hand is to hold, as a gripper a long thin handle, random targets may
/// do.
bool is_search_of_default(const Flags& flags, const grasp::PlannerOptions& options) {
  const bool is_auto_asked_for =
      !flags.is_default("style") && options.style == grasp::GraspStyle::Auto;
  return !flags.has("preset") && flags.is_default("target-search") && !is_auto_asked_for &&
         options.targets.search == grasp::TargetSearch::Reach;
}

/// Exit code of the program: that of an interrupt, if one requested a stop, else `code`.
ExitCode ended_with(ExitCode code) {
  const std::optional<int> signal = interrupt_heard();
  return signal ? static_cast<ExitCode>(kInterrupted + *signal) : code;
}

/// What a run is asked for, but for the object.
struct PlanRequest {
  const Flags& flags;
  const hands::HandReading& hand;
  grasp::PlannerOptions options;
  std::optional<hold_test::HoldProtocol> protocol;
  int num_threads = 0;
};

/// Plans for one object, prints and writes.
ExitCode plan_object(const PlanRequest& request, const grasp::ObjectFile& object_file,
                     std::optional<OutputFolder>& out) {
  const Flags& flags = request.flags;
  const hands::HandModel& hand = request.hand.model;
  grasp::PlannerOptions options = request.options;
  ProgressBar progress(!flags.has("quiet"));
  std::string name = flags.positional();
  if (const auto& laid = object_file.record.laid) {
    name += " in rest pose " + std::to_string(laid->rank);
  }
  require_solid(object_file);
  const LoadedSurroundings around = load_surroundings(flags, object_file.mesh);
  progress.clear();
  warn_of_differences("plan", object_file.record, around.record.obstacles);
  progress.show("voxels and contact scores");
  const grasp::ObjectModel object =
      grasp::prepare_object(object_file.mesh, hand, options, {.is_on = true});
  grasp::PlannerResult result;
  bool is_reach_tried = false;
  {
    const StopOnInterrupt stop(
        "graspfit plan: interrupted: the attempts under way are finished; once more ends at once");
    const auto planned = [&] {
      return grasp::plan_grasps(object, hand, options, around.surroundings,
                                {.num_threads = request.num_threads,
                                 .progress = shown_by(progress, options),
                                 .stop = stop.token()});
    };
    result = planned();
    if (result.grasps.empty() && !interrupt_heard() && is_search_of_default(flags, options)) {
      is_reach_tried = true;
      if (options.style == grasp::GraspStyle::Auto) options.style = grasp::GraspStyle::Precision;
      options.targets.search = grasp::TargetSearch::Random;
      result = planned();
      progress.clear();
      if (!result.grasps.empty()) {
        std::fprintf(stderr,
                     "graspfit plan: %s: no grasp at targets by the hand's reach; these are at "
                     "random targets (--target-search random)\n",
                     name.c_str());
      }
    }
  }
  progress.clear();

  if (result.grasps.empty()) {
    const std::string accepted(grasp::name_of(options.acceptance));
    const bool is_in_one_rest_pose = object_file.record.laid && !asks_for_all_rest_poses(flags);
    const std::string advice =
        no_grasp_advice({result, options, object.mesh(), request.hand, around.surroundings,
                         is_in_one_rest_pose, is_reach_tried});
    std::fprintf(stderr, "graspfit plan: %s: no %s grasp by hand %s %s%s%s\n", name.c_str(),
                 accepted.c_str(), hand.name.c_str(), attempts_text(result).c_str(),
                 advice.empty() ? "" : "; ", advice.c_str());
    return ended_with(kNoGrasp);
  }
  std::optional<grasp::HoldRecord> hold;
  if (request.protocol) {
    const bool by_margin = flags.is_default("rank") || options.rank == grasp::RankRule::Margin;
    HeldGrasps held = held_grasps(object.mesh(), hand, *request.protocol, request.num_threads,
                                  std::move(result.grasps), by_margin, progress);
    progress.clear();
    if (held.grasps.empty()) {
      std::fprintf(stderr, "graspfit plan: %s: no grasp by hand %s holds: %s\n", name.c_str(),
                   hand.name.c_str(), hold_text(held.record).c_str());
      return ended_with(kNoGrasp);
    }
    result.grasps = std::move(held.grasps);
    hold = std::move(held.record);
  }
  grasp::GraspFile file =
      grasp::make_grasp_file(object_file.record, hand, options, object, result, around.record);
  file.hold = std::move(hold);
  file.preset = preset_name(flags);
  if (out) write_files(file, object, around.surroundings, flags, *out, progress);
  progress.clear();
  if (!flags.has("quiet")) {
    if (const auto& laid = object_file.record.laid) {
      std::printf("on the table in rest pose %d, in which it lands in %s of falls\n", laid->rank,
                  probability_text(laid->probability).c_str());
    }
    std::printf("%s%zu of %d grasps, %s, %s\n", table_of(file, object).c_str(), file.grasps.size(),
                options.count, closed_text(file).c_str(), attempts_text(result).c_str());
    if (const std::string grips = grip_text(file); !grips.empty()) {
      std::printf("%s\n", grips.c_str());
    }
    if (file.hold) std::printf("%s\n", hold_text(*file.hold).c_str());
    if (out) std::printf("written to %s\n", out->target().c_str());
  }
  return ended_with(kSuccess);
}

}  // namespace

ExitCode run_plan(const std::vector<std::string>& arguments) {
  const Command command = plan_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command, !flags.wants_all_help()).c_str(), stdout);
    return kSuccess;
  }
  grasp::PlannerOptions options = read_planner_flags(flags);
  const hands::HandReading reading = load_hand(flags.text("hand"));
  const hands::HandModel& hand = reading.model;
  if (flags.is_default("contacts") && !flags.has("fingers")) {
    options.num_contacts = std::min(options.num_contacts, base::as_index<int>(hand.fingers.size()));
  }
  require_possible(flags, hand, options);
  const int num_threads = num_threads_of(flags);
  if (flags.has("out")) OutputFolder(flags.text("out"), is_plan_file);  // refused before any work
  require_means_of_output(flags);
  std::optional<hold_test::HoldProtocol> protocol;
  if (options.rank == grasp::RankRule::Margin && !flags.has("hold")) {
    throw UsageError("--rank margin needs --hold PROTOCOL, whose test finds margins");
  }
  if (flags.has("hold")) {
    protocol = hold_protocol_named("hold", flags.text("hold"));
    require_physics("--hold");
    if (options.rank == grasp::RankRule::Margin && !protocol->has_margins()) {
      throw UsageError("--rank margin: protocol " + protocol->name + " finds no margins");
    }
  }
  warn_of_findings("plan", reading);

  const PlanRequest request{flags, reading, std::move(options), std::move(protocol), num_threads};
  const std::vector<grasp::ObjectFile> objects = load_placed_objects(flags, flags.positional());
  ExitCode code = kNoGrasp;
  for (const grasp::ObjectFile& object : objects) {
    std::optional<OutputFolder> out;
    if (flags.has("out")) {
      fs::path folder = flags.text("out");
      if (asks_for_all_rest_poses(flags)) {
        folder /= "rest_pose_" + std::to_string(object.record.laid->rank);
      }
      out.emplace(folder, is_plan_file);
    }
    const ExitCode found = plan_object(request, object, out);
    if (found != kNoGrasp) code = found;
    if (interrupt_heard()) break;
  }
  return code;
}

}  // namespace graspfit::app
