#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/motion/motion_io.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/viewer/motion_page.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
using geometry::RigidTransform;

/// Smallest step between frames [m]: smaller steps show nothing new, and take hours.
constexpr double kLeastStep = 1e-5;

Command motion_command() {
  Command command{
      "motion", "MOTION.json",
      "Checks the motion of a hand that moves objects about on a table, and shows it.\n",
      option_group("Options"),
      "Every segment between two keyframes is proven free of collisions anew, and looked at by "
      "exact\ntests on frames between which no point moves by more than --step-mm. Exit code 4: "
      "one is not.\n"};
  add_option(command.options, "meshes", "DIR", std::nullopt,
             "what the names of object files are relative to (default: $GRASPFIT_DATA, or shared "
             "beside the sources)");
  add_option(command.options, "step-mm", "NUMBER", "5",
             "largest motion between two frames [mm], at least " +
                 base::shortest_decimal(1000.0 * kLeastStep));
  add_option(command.options, "html", "FILE", std::nullopt,
             "write a page that replays the motion, for any browser");
  add_option(command.options, "gif", "FILE", std::nullopt,
             "write an animated picture (needs python3-vtk9 and python3-pil)");
  add_option(command.options, "png", "FILE", std::nullopt,
             "write a picture of what comes of every phase of every move (needs python3-vtk9 and "
             "python3-pil)");
  add_switch(command.options, "no-check", "only show it");
  return command;
}

/// Result of checking the frames of a move.
struct CheckedMove {
  std::int64_t frames = 0;
  /// Smallest clearance of the hand, and of the carried object [m].
  double hand = std::numeric_limits<double>::infinity();
  double object = std::numeric_limits<double>::infinity();
  std::vector<std::string> findings;  ///< What is wrong: "lift: bunny and mug".
};

/// Whether segments of a phase must keep the file's clearance; those of the other phases touch
/// something by their nature.
bool keeps_clearance(motion::MotionPhase phase) {
  return phase == motion::MotionPhase::Reach || phase == motion::MotionPhase::Transport ||
         phase == motion::MotionPhase::Retreat;
}

/// Number of frames of a segment on which a point travels `travel`, without the frame of its start.
int num_frames(double travel, double step) {
  constexpr double kMost = 1e6;
  const double frames = std::max(1.0, std::ceil(travel / step));
  if (!(frames <= kMost)) {
    throw base::InvalidInput("a segment of " + base::shortest_decimal(travel) +
                             " m has more than 1000000 frames; a larger --step-mm makes fewer");
  }
  return static_cast<int>(frames);
}

CheckedMove checked(const motion::TableScene& scene, const std::vector<RigidTransform>& X_WO,
                    const motion::RecordedMove& move, double clearance, double step) {
  CheckedMove result;
  for (const motion::MotionSegment& segment : move.segments) {
    const std::string phase = motion::phase_name(segment.phase);
    // Poses of a file are rounded, at most by this much.
    constexpr double kRounding = 1e-12;
    const double wanted =
        keeps_clearance(segment.phase) ? std::max(0.0, clearance - kRounding) : 0.0;
    if (const auto met = motion::find_collision(scene, X_WO, segment, wanted)) {
      result.findings.push_back(phase + ": not proven free, " + met->text());
    }
    const double travel = motion::largest_travel(scene, segment);
    const int parts = num_frames(travel, step);
    bool has_overlap = false;
    for (int i = 0; i <= parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      const motion::MotionClearance here = motion::clearance_at(scene, X_WO, segment, share);
      result.hand = std::min(result.hand, here.hand);
      result.object = std::min(result.object, here.object);
      ++result.frames;
      if (has_overlap) continue;
      if (const auto met = motion::find_overlap(scene, X_WO, segment, share)) {
        has_overlap = true;
        result.findings.push_back(phase + ": overlap of " + met->text());
      }
    }
  }
  return result;
}

std::string millimeters(double length) {
  return std::isfinite(length) ? fixed_decimal(1000.0 * length, 3) : "-";
}

/// Prints the table of moves. Returns whether all are free of collisions.
bool check(const viewer::MotionInput& input, double step, ProgressBar& progress) {
  const motion::MotionFile& file = input.file;
  const auto poses = motion::object_poses(file);
  std::vector<std::vector<std::string>> rows = {
      {"move", "object", "M", "segments", "frames", "hand_clear_mm", "object_clear_mm", "free"}};
  std::vector<std::string> findings;
  for (std::int64_t k = 0; k < std::ssize(file.moves); ++k) {
    const motion::RecordedMove& move = file.moves[k];
    const std::string& name = input.scene.object(move.object).name;
    progress.show(k, std::ssize(file.moves), "checking " + name);
    const CheckedMove found = checked(input.scene, poses[k], move, file.clearance, step);
    rows.push_back({std::to_string(k + 1), name, fixed_decimal(move.grasp_m, 4),
                    std::to_string(move.segments.size()), std::to_string(found.frames),
                    millimeters(found.hand), millimeters(found.object),
                    found.findings.empty() ? "yes" : "no"});
    for (const std::string& what : found.findings) {
      findings.push_back("move " + std::to_string(k + 1) + ", " + name + ": " + what);
    }
  }
  progress.clear();
  std::fputs(text_table(rows).c_str(), stdout);
  for (const std::string& what : findings) std::printf("%s\n", what.c_str());
  for (const motion::UnmovedObject& unmoved : file.unmoved) {
    std::printf("not moved: %s: %s\n", input.scene.object(unmoved.object).name.c_str(),
                unmoved.reason.c_str());
  }
  return findings.empty();
}

void require_joints(const motion::MotionFile& file, const hands::HandModel& hand) {
  const bool is_same = std::equal(
      file.joints.begin(), file.joints.end(), hand.joints.begin(), hand.joints.end(),
      [](const std::string& name, const hands::Joint& joint) { return name == joint.name; });
  if (!is_same) {
    throw base::IoError("the joints of the motion are not those of hand " + hand.name);
  }
}

}  // namespace

ExitCode run_motion(const std::vector<std::string>& arguments) {
  const Command command = motion_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const double step = flags.number("step-mm") / 1000.0;
  if (!(step >= kLeastStep)) {
    throw UsageError("--step-mm " + flags.text("step-mm") + " is below " +
                     base::shortest_decimal(1000.0 * kLeastStep) + " mm");
  }
  const fs::path path = flags.positional();
  for (const std::string flag : {"html", "gif", "png"}) {
    if (flags.has(flag)) require_parent_folder("--" + flag, flags.text(flag));
  }
  for (const std::string flag : {"gif", "png"}) {
    if (flags.has(flag)) require_animations("--" + flag);
  }
  ProgressBar progress(true);
  progress.show("reading " + path.string());
  motion::MotionFile file = motion::read_motion(path);
  const fs::path meshes =
      flags.has("meshes") ? fs::path(flags.text("meshes")) : sweep::data_folder();
  viewer::MotionInput input{motion::read_motion_scene(file, meshes), file};
  require_joints(input.file, input.scene.hand());
  progress.clear();
  if (!flags.has("no-check")) {
    const bool is_free = check(input, step, progress);
    input.check = is_free ? viewer::MotionCheck::Free : viewer::MotionCheck::NotFree;
  }
  if (flags.has("html")) {
    viewer::write_motion_page(flags.text("html"), input);
    std::printf("written to %s\n", flags.text("html").c_str());
  }
  for (const std::string flag : {"gif", "png"}) {
    if (!flags.has(flag)) continue;
    progress.show("drawing " + flags.text(flag));
    draw_motion_picture("--" + flag, viewer::motion_scene_json(input), flags.text(flag));
    progress.clear();
    std::printf("written to %s\n", flags.text(flag).c_str());
  }
  return input.check == viewer::MotionCheck::NotFree ? kDiffers : kSuccess;
}

}  // namespace graspfit::app
