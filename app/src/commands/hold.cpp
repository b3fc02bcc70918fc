#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/object_difference.hpp"
#include "graspfit/hold_test/hold_batch.hpp"
#include "graspfit/hold_test/hold_report.hpp"
#include "graspfit/hold_test/hold_test.hpp"
#include "graspfit/viewer/replay_page.hpp"
#include "input/hold_flags.hpp"
#include "input/object_loading.hpp"
#include "input/recorded_files.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using base::shortest_decimal;
using hold_test::TestedGrasp;

Command hold_command() {
  const geometry::ConvexDecompositionOptions pieces;
  Command command{
      "hold", "GRASPS.json",
      "Tests in physics (MuJoCo) whether the grasps of a file hold: the hand closes from the "
      "pre-grasp,\nsqueezes, and the object is pulled, under a named protocol that is written down "
      "with every parameter.\n",
      option_group(),
      "Held: under every load the object stays within the protocol's largest shift and turn at "
      "every check.\nOtherwise the stage says where it was lost: rejected (too deep at the "
      "pre-grasp, or no pre-grasp),\napproach (before the load), load. The base of the hand is "
      "fixed. Table and obstacles of the grasp\nfile are not simulated.\n"};
  po::options_description which = option_group("Grasps");
  add_option(which, "grasp", "N,...", std::nullopt, "test these only, by their ranks in the file");
  add_switch(
      which, "margin",
      "also the smallest force and the smallest torque that fail, in newtons and newton "
      "meters; 10 to 60 more loads are simulated for each of the two; not for protocols that "
      "lift");
  add_switch(
      which, "quick",
      "do not look whether 0.9 or 1.1 times the load changes a verdict, for which up to twice "
      "as many loads are simulated");
  add_option(which, "jobs", "INTEGER", "0",
             "grasps side by side; 0: as many as the machine has processors; the verdicts do not "
             "depend on it");
  add_object_flag(which);
  po::options_description shape = option_group("Convex pieces of object and links");
  add_option(shape, "pieces", "INTEGER", std::to_string(pieces.max_pieces),
             "wanted limit for each; up to three times as many where a solid's parts lie apart");
  add_option(shape, "deviation", "METERS", shortest_decimal(pieces.largest_deviation),
             "how far pieces may reach out of the solid; where --pieces do not suffice, the worst "
             "places come first");
  po::options_description output = option_group("Output");
  add_option(output, "out", "DIR", std::nullopt,
             "write hold.json and hold.csv there; without it only the table is printed");
  add_option(output, "replay", "N,...", std::nullopt,
             "also replay_NNN.html for these grasps: a page that plays the test");
  add_switch(output, "gif",
             "also replay_NNN.gif: the load that says most, animated (needs python3-vtk9 and "
             "python3-pil)");
  add_switch(output, "quiet", "no progress bar and no table");
  command.options.add(hold_protocol_options()).add(which).add(shape).add(output);
  return command;
}

/// Step at which a single grasp is judged, unless one is given [s]: from 4 ms to this one or two
/// verdicts in a hundred change, which is little for a rate and much for one grasp.
constexpr double kStepOfSingle = 0.001;

bool is_hold_file(const std::string& name) {
  static const std::regex pattern(R"(hold\.(json|csv)|replay_\d{3,}\.(html|gif))");
  return std::regex_match(name, pattern);
}

/// What the command is to do, without the files that it reads.
struct Request {
  hold_test::HoldProtocol protocol;
  hold_test::HoldBatchOptions run;
  geometry::ConvexDecompositionOptions pieces;
  std::vector<std::size_t> replays;  ///< Indices of the grasps to replay.
  bool gif = false;
};

Request read_request(const Flags& flags) {
  Request request;
  request.protocol = read_hold_protocol(flags);
  request.run.indices = flags.indices("grasp");
  request.run.margin = flags.has("margin");
  request.run.near_limit = !flags.has("quick");
  if (request.run.margin && !request.protocol.has_margins()) {
    throw UsageError("--margin: protocol " + request.protocol.name +
                     " does not pull six ways from the same state");
  }
  request.run.num_threads = flags.integer("jobs");
  if (request.run.num_threads < 0) {
    throw UsageError("--jobs " + flags.text("jobs") + " is not a number from 0");
  }
  request.pieces.max_pieces = flags.integer("pieces", base::at_least(1));
  request.pieces.largest_deviation = flags.number("deviation", base::above(0));
  request.pieces.validate();
  request.replays = flags.indices("replay");
  request.gif = flags.has("gif");
  if (!flags.has("out") && !request.replays.empty()) throw UsageError("--replay needs --out DIR");
  if (request.gif && request.replays.empty()) throw UsageError("--gif needs --replay N");
  return request;
}

/// Throws UsageError unless the file has the requested grasps, and those to replay are tested.
void require_grasps(const Request& request, std::size_t num_grasps) {
  const auto& tested = request.run.indices;
  for (const auto* indices : {&tested, &request.replays}) {
    for (const std::size_t index : *indices) {
      if (index < num_grasps) continue;
      throw UsageError((indices == &tested ? "--grasp " : "--replay ") + std::to_string(index + 1) +
                       ": the file has " + std::to_string(num_grasps) + " grasps");
    }
  }
  for (const std::size_t index : request.replays) {
    if (tested.empty() || std::binary_search(tested.begin(), tested.end(), index)) continue;
    throw UsageError("--replay " + std::to_string(index + 1) + " is not among --grasp");
  }
}

/// The load that failed first, as text: "+y after 0.4 s"; "-" if none did.
std::string first_failure(const hold_test::HoldVerdict& verdict,
                          const std::vector<std::string>& loads) {
  std::string text = "-";
  double earliest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < verdict.directions.size(); ++i) {
    const std::optional<double>& failed_at = verdict.directions[i].failed_at;
    if (!failed_at || *failed_at >= earliest) continue;
    earliest = *failed_at;
    text = loads[i] + " after " + fixed_decimal(earliest, 2) + " s";
  }
  return text;
}

std::string table_of(const hold_test::HoldReport& report) {
  std::vector<std::vector<std::string>> rows = {{"rank", "stage", "near limit", "loads",
                                                 "first lost", "shift_mm", "turn_deg", "margin_N",
                                                 "margin_Nm"}};
  const std::vector<std::string> loads = hold_test::load_names(report.protocol);
  for (const TestedGrasp& tested : report.tested) {
    const auto& directions = tested.verdict.directions;
    const auto held = std::count_if(directions.begin(), directions.end(), [](const auto& one) {
      return one.stage == hold_test::HoldStage::Held;
    });
    double shift = 0.0;
    double turn = 0.0;
    for (const hold_test::DirectionVerdict& direction : directions) {
      shift = std::max(shift, direction.largest_shift);
      turn = std::max(turn, direction.largest_turn);
    }
    rows.push_back({std::to_string(tested.index + 1), hold_test::name_of(tested.verdict.stage),
                    tested.is_near_limit ? (*tested.is_near_limit ? "yes" : "no") : "-",
                    std::to_string(held) + '/' + std::to_string(loads.size()),
                    first_failure(tested.verdict, loads), fixed_decimal(1000.0 * shift, 1),
                    fixed_decimal(base::kDegreesPerRadian * turn, 1),
                    tested.margin ? fixed_decimal(tested.margin->force, 2) : "-",
                    tested.margin ? fixed_decimal(tested.margin->torque, 4) : "-"});
  }
  return text_table(rows);
}

/// The report in one line: "12 of 30 grasps held (40.0 %) under dexgraspbench-100g: load 15,
/// approach 2, rejected 1".
std::string rate_text(const hold_test::HoldReport& report) {
  const auto counts = hold_test::count_stages(report.tested);
  const std::size_t held = counts.at(hold_test::HoldStage::Held);
  std::string text =
      std::to_string(held) + " of " + std::to_string(report.tested.size()) + " grasps held";
  if (!report.tested.empty()) {
    text += " (" +
            fixed_decimal(
                100.0 * static_cast<double>(held) / static_cast<double>(report.tested.size()), 1) +
            " %)";
  }
  text += " under " + report.protocol.name;
  for (const std::string& parameter : report.changed_parameters) {
    text +=
        (&parameter == &report.changed_parameters.front() ? " with another " : ", ") + parameter;
  }
  std::string lost;
  for (const auto stage : {hold_test::HoldStage::Load, hold_test::HoldStage::Approach,
                           hold_test::HoldStage::Rejected}) {
    if (counts.at(stage) == 0) continue;
    lost += (lost.empty() ? ": " : ", ") + std::string(hold_test::name_of(stage)) + ' ' +
            std::to_string(counts.at(stage));
  }
  text += lost;
  const auto near = std::count_if(report.tested.begin(), report.tested.end(), [](const auto& one) {
    return one.is_near_limit.value_or(false);
  });
  if (near > 0) {
    text +=
        "; " + std::to_string(near) + " near a limit: 0.9 or 1.1 times the load decides otherwise";
  }
  return text;
}

std::string pieces_text(const hold_test::HoldReport& report) {
  const hold_test::PiecesReport& object = report.object;
  std::size_t links = 0;
  double deviation = 0.0;
  for (const hold_test::PiecesReport& link : report.links) {
    links += link.num_pieces;
    deviation = std::max(deviation, link.outward_deviation);
  }
  return "object in " + std::to_string(object.num_pieces) + " convex pieces (" +
         fixed_decimal(1000.0 * object.outward_deviation, 2) + " mm out, " +
         fixed_decimal(1000.0 * object.inward_deviation, 2) + " mm in, volume " +
         fixed_decimal(100.0 * object.volume_error, 1) + " %), links in " + std::to_string(links) +
         " (" + fixed_decimal(1000.0 * deviation, 2) + " mm out)";
}

std::string replay_name(std::size_t index) {
  const std::string rank = std::to_string(index + 1);
  return "replay_" + std::string(rank.size() < 3 ? 3 - rank.size() : 0, '0') + rank;
}

/// The prepared inputs of a hold test.
struct Bench {
  grasp::GraspFile file;
  geometry::TriangleMesh mesh_O;
  hold_test::HoldHand hand;
  hold_test::HoldObject object;
};

hold_test::HoldReport make_report(const Flags& flags, const Request& request, const Bench& bench) {
  hold_test::HoldReport report;
  report.grasp_file = flags.positional();
  report.grasp_sha256 = base::sha256_hex(base::read_file(flags.positional()));
  report.object_sha256 = bench.file.object.sha256;
  report.hand_name = bench.file.hand.name;
  report.protocol = request.protocol;
  report.changed_parameters = hold_test::changed_parameters(request.protocol);
  report.decomposition = request.pieces;
  report.object = hold_test::pieces_report(bench.file.object.file, bench.object.shape);
  for (std::size_t i = 0; i < bench.hand.links.size(); ++i) {
    if (bench.hand.links[i].pieces.empty()) continue;
    report.links.push_back(
        hold_test::pieces_report(bench.file.hand.links[i].name, bench.hand.links[i]));
  }
  report.num_grasps = bench.file.grasps.size();
  return report;
}

void write_replays(const Request& request, const Bench& bench,
                   const std::vector<TestedGrasp>& tested, const fs::path& folder,
                   ProgressBar& progress) {
  hold_test::HoldTest test(bench.hand, bench.object, request.protocol);
  for (const std::size_t index : request.replays) {
    const std::string rank = std::to_string(index + 1);
    progress.show("replaying grasp " + rank);
    const hold_test::HoldVerdict& verdict =
        std::find_if(tested.begin(), tested.end(), [&](const TestedGrasp& one) {
          return one.index == index;
        })->verdict;
    if (verdict.directions.empty()) {
      progress.clear();
      std::fprintf(stderr, "graspfit hold: grasp %s was rejected, there is nothing to replay: %s\n",
                   rank.c_str(), verdict.reason.c_str());
      continue;
    }
    viewer::ReplayInput replay;
    replay.title = fs::path(bench.file.object.file).stem().string() + ", " + bench.file.hand.name +
                   " hand, grasp " + rank;
    replay.note = grasp::difference_from_file(bench.file.object).value_or("");
    replay.object_O = bench.mesh_O;
    replay.object = bench.object;
    replay.hand = bench.hand;
    replay.protocol = request.protocol;
    replay.verdict = verdict;
    for (int d = 0; d < std::ssize(verdict.directions); ++d) {
      replay.replays.push_back(test.replay(bench.file.grasps[index], d));
    }
    viewer::write_replay_page(folder / (replay_name(index) + ".html"), replay);
    if (!request.gif) continue;
    progress.show("drawing grasp " + rank);
    draw_replay_picture(viewer::replay_scene_json(replay), folder / (replay_name(index) + ".gif"));
  }
}

}  // namespace

ExitCode run_hold(const std::vector<std::string>& arguments) {
  const Command command = hold_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  Request request = read_request(flags);
  const bool is_step_set = sets_step(flags);
  flags.positional();
  require_physics();
  std::optional<OutputFolder> out;
  if (flags.has("out")) out.emplace(flags.text("out"), is_hold_file);
  if (request.gif) require_animations("--gif");

  ProgressBar progress(!flags.has("quiet"));
  progress.show("reading " + flags.positional());
  Bench bench;
  bench.file = grasp::read_grasps(flags.positional());
  require_grasps(request, bench.file.grasps.size());
  const bool is_single = request.run.indices.size() == 1 || bench.file.grasps.size() == 1;
  if (is_single && !is_step_set) {
    request.protocol.step = std::min(request.protocol.step, kStepOfSingle);
  }
  bench.mesh_O = load_recorded_object(flags, bench.file);
  progress.clear();
  warn_of_differences("hold", bench.file.object);
  progress.show("convex pieces");
  bench.hand = hold_test::prepare_hold_hand(bench.file.hand, request.pieces);
  bench.object = hold_test::prepare_hold_object(bench.mesh_O, request.pieces);
  hold_test::HoldReport report = make_report(flags, request, bench);

  const auto start = std::chrono::steady_clock::now();
  report.tested = hold_test::test_grasps(
      bench.hand, bench.object, request.protocol, bench.file.grasps, request.run,
      [&](std::size_t done, std::size_t total) {
        progress.show(static_cast<std::int64_t>(done), static_cast<std::int64_t>(total),
                      std::to_string(done) + " of " + std::to_string(total) + " grasps");
      });
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  if (out) {
    progress.show("writing files");
    const fs::path& folder = out->staging();
    base::write_file_atomically(folder / "hold.json", hold_test::to_json(report));
    base::write_file_atomically(folder / "hold.csv", hold_test::to_csv(report));
    if (!request.replays.empty()) {
      write_replays(request, bench, report.tested, folder, progress);
    }
    out->commit("hold.json");
  }
  progress.clear();
  if (!flags.has("quiet")) {
    std::printf("%s%s\n%s; %s s\n", table_of(report).c_str(), rate_text(report).c_str(),
                pieces_text(report).c_str(), fixed_decimal(duration.count(), 1).c_str());
    if (out) std::printf("written to %s\n", out->target().c_str());
  }
  return kSuccess;
}

}  // namespace graspfit::app
