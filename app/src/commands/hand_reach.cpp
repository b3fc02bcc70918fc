#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/hand_commands.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/hands/pinch_chart.hpp"
#include "graspfit/sweep/result_table.hpp"
#include "graspfit/viewer/reach_page.hpp"
#include "input/hand_loading.hpp"
#include "output/output_folder.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

using hands::Pinch;
using hands::PinchChart;

Command reach_command() {
  Command command{
      "hand reach", "HAND",
      "Shows what a hand, a shipped name or a file, can pinch squarely: how much its pads must "
      "lean\n"
      "to the line between them, by the width of what is between them, for fingertips, for the\n"
      "thumb against two fingers, for a fingertip against the palm, and for other pads:\n"
      "proximal ones, and fingers' ends.\n",
      option_group("Options"),
      "Kinematics alone: no object, no links in one another. What leans by more than the angle of\n"
      "friction slips off parallel faces. Widths are those that were found: up to a step more may\n"
      "do, too.\n"};
  add_option(command.options, "friction", "NUMBER", "0.4",
             "Coulomb's mu at which widths count as square, >= 0");
  add_option(command.options, "step-mm", "NUMBER", "5", "width of a class of openings, > 0");
  add_option(command.options, "csv", "FILE", std::nullopt,
             "write the leans, and the joints that have them, as a table");
  add_option(command.options, "svg", "FILE", std::nullopt, "write a picture");
  add_option(command.options, "html", "FILE", std::nullopt, "write a page");
  return command;
}

void print_widths(const viewer::ReachScene& scene) {
  std::vector<std::vector<std::string>> rows = {
      {"pinch", "squarely_mm", "least_lean_deg", "at_mm", "pads"}};
  for (const PinchChart& chart : scene.charts) {
    const Pinch* const best = hands::squarest(chart);
    rows.push_back({viewer::pinch_name(chart.kind),
                    viewer::square_widths_text(chart, scene.friction),
                    best ? fixed_decimal(best->lean / base::kRadiansPerDegree, 1) : "-",
                    best ? fixed_decimal(1e3 * best->opening, 0) : "-",
                    best ? viewer::pads_text(scene.hand, *best, ", ") : "-"});
  }
  std::printf("%s", indented_table(rows).c_str());
}

void print_leans(const viewer::ReachScene& scene) {
  std::vector<std::vector<std::string>> rows = {{"opening_mm"}};
  std::size_t num_rows = 0;
  for (const PinchChart& chart : scene.charts) {
    std::string name = viewer::pinch_name(chart.kind);
    std::replace(name.begin(), name.end(), ' ', '_');
    rows.front().push_back(name + "_deg");
    num_rows = std::max(num_rows, chart.pinches.size());
  }
  for (std::size_t k = 0; k < num_rows; ++k) {
    std::vector<std::string> row = {viewer::opening_text(scene.charts.front(), k)};
    for (const PinchChart& chart : scene.charts) {
      const bool has_pinch = k < chart.pinches.size() && chart.pinches[k];
      row.push_back(has_pinch ? fixed_decimal(chart.pinches[k]->lean / base::kRadiansPerDegree, 1)
                              : "-");
    }
    rows.push_back(std::move(row));
  }
  std::printf("\n%s", text_table(rows).c_str());
}

/// A row per pinch: kind, opening, lean, pads, and the position of every joint with its unit.
std::string csv_of(const viewer::ReachScene& scene) {
  std::string text = "pinch,opening_m,lean_rad,pads";
  for (const hands::Joint& joint : scene.hand.joints) {
    const char* const unit = joint.type == hands::JointType::Revolute ? "_rad" : "_m";
    text += ',' + sweep::csv_field("joint_" + joint.name + unit);
  }
  text += '\n';
  for (const PinchChart& chart : scene.charts) {
    for (const std::optional<Pinch>& pinch : chart.pinches) {
      if (!pinch) continue;
      text += viewer::pinch_name(chart.kind) + ',' + base::shortest_decimal(pinch->opening) + ',' +
              base::shortest_decimal(pinch->lean) + ',' +
              sweep::csv_field(viewer::pads_text(scene.hand, *pinch, "; "));
      for (const double q : pinch->q) text += ',' + base::shortest_decimal(q);
      text += '\n';
    }
  }
  return text;
}

}  // namespace

ExitCode run_hand_reach(const std::vector<std::string>& arguments) {
  const Command command = reach_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  viewer::ReachScene scene;
  scene.friction = flags.number("friction", base::at_least(0));
  hands::PinchChartOptions options;
  options.step = 1e-3 * flags.number("step-mm", base::above(0));
  for (const std::string flag : {"csv", "svg", "html"}) {
    if (flags.has(flag)) require_parent_folder("--" + flag, flags.text(flag));
  }
  hands::HandReading reading = load_hand(flags.positional());
  warn_of_findings(command.name, reading);
  scene.hand = std::move(reading.model);
  for (const hands::PinchKind kind : hands::kPinchKinds) {
    const SecondsBar seconds(true, viewer::pinch_name(kind) + " of " + scene.hand.name);
    scene.charts.push_back(hands::cached_pinch_chart(scene.hand, kind, options));
  }

  if (flags.has("csv")) base::write_file_atomically(flags.text("csv"), csv_of(scene));
  if (flags.has("svg")) viewer::write_reach_chart(flags.text("svg"), scene);
  if (flags.has("html")) viewer::write_reach_page(flags.text("html"), scene);
  std::printf("%s at friction %s: pads may lean by %s degrees; the thumb is %s\n",
              scene.hand.name.c_str(), base::shortest_decimal(scene.friction).c_str(),
              fixed_decimal(std::atan(scene.friction) / base::kRadiansPerDegree, 1).c_str(),
              scene.hand.fingers[scene.hand.thumb()].name.c_str());
  print_widths(scene);
  print_leans(scene);
  for (const std::string flag : {"csv", "svg", "html"}) {
    if (flags.has(flag)) std::printf("written to %s\n", flags.text(flag).c_str());
  }
  return kSuccess;
}

}  // namespace graspfit::app
