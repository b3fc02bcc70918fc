// Question: can a hand tidy a table (the paper's Fig. 20): take objects that stand or lie
// somewhere, each by a planned grasp, turn them in the air and put them down upright at their
// goals, so that nothing touches anything else on the way? In which order, at what clearances, and
// where not, why?
//
// Answered by one row per table and seed, and in its details by one row per move and phase of the
// motion (reach, approach, lift, transport, place, release, retreat), measured on frames between
// which no point moves by more than `frame_step_mm`; `overlaps` counts frames in which exact tests
// find two bodies with a common point. An object that could not be moved has a row with the reason.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <system_error>

#include "cells/planning_table.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/rest_pose.hpp"
#include "graspfit/motion/motion_io.hpp"
#include "list/experiment_list.hpp"
#include "settings/table_settings.hpp"

namespace graspfit::experiments::internal {
namespace table_tidying_parts {
namespace {

using geometry::RigidTransform;
using Clock = std::chrono::steady_clock;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<sweep::Column> columns() {
  return {
      {"objects", "1", "objects on the table"},
      {"at_goal", "1", "of these brought to their goals"},
      {"moves", "1", "moves made; more than objects where one was put down in between"},
      {"order", "", "the objects in the order of the moves"},
      {"mean_m", "1", "mean M of the moves' grasps"},
      {"least_m", "1", "smallest M of the moves' grasps"},
      {"frames", "1", "frames measured"},
      {"overlaps", "1", "of these with two bodies that share a point, decided exactly"},
      {"hand_clearance_m", "m",
       "smallest distance of the hand from the table and from objects it does not handle"},
      {"object_clearance_m", "m",
       "smallest distance of a carried object from standing ones, and in the air the table"},
      {"proven_clearance_m", "m", "which no place of reach, transport and retreat falls short of"},
      {"goal_error_m", "m", "largest distance of a center of mass from its goal, at the end"},
      {"goal_error_rad", "rad", "largest angle of an object from its goal, at the end"},
      {"moves_tried", "1", "moves planned, failures included"},
      {"planner_attempts", "1", "target sets fitted for them"},
      {"grasps_tried", "1", "valid grasps tried"},
      {"segments_tried", "1", "straight segments of motion tried"},
      {"unmoved", "", "objects that stay short of their goals, and why"}};
}

std::vector<sweep::Column> details() {
  return {{"move", "1", "number of the move, from 1; empty for an object that is not moved"},
          {"object", "", "the one that is moved"},
          {"phase", "", "reach, approach, lift, transport, place, release or retreat"},
          {"segments", "1", "straight segments of this phase"},
          {"frames", "1", "frames measured"},
          {"travel_m", "m", "upper bound of the way of the fastest point"},
          {"hand_clearance_m", "m",
           "smallest distance of the hand from table and objects, the handled one aside where it "
           "is touched"},
          {"object_clearance_m", "m",
           "smallest distance of the carried object from standing ones, and from the table in "
           "transport"},
          {"overlaps", "1", "frames in which two bodies share a point, decided exactly"},
          {"grasp_m", "1", "M of the move's grasp"},
          {"num_contacts", "1", "N' of the move's grasp"},
          {"planner_attempts", "1", "target sets fitted for the move"},
          {"grasps_tried", "1", "grasps tried for the move, the one taken included"},
          {"segments_tried", "1", "segments tried for the move"},
          {"failures", "", "why earlier grasps and segments of the move were refused"}};
}

std::vector<sweep::Column> timings() {
  return {{"load_s", "s", "reading objects and hand"},
          {"plan_s", "s", "orders, grasps and motions"},
          {"measure_s", "s", "measuring the frames"}};
}

/// The scene of a table, the records of its objects and their poses.
struct Table {
  motion::TableScene scene;
  std::vector<motion::MotionObject> objects;
  std::vector<RigidTransform> X_WO_start;
  std::vector<RigidTransform> X_WO_goal;
};

Table load_table(const TableSettings& settings) {
  std::vector<motion::SceneObject> objects;
  std::vector<motion::MotionObject> records;
  std::vector<RigidTransform> start;
  std::vector<RigidTransform> goal;
  for (const TableObject& object : settings.objects) {
    const auto file = load_object(object.object);
    const Eigen::Vector3d center = geometry::mass_properties(file->mesh).center_of_mass;
    const auto rest_poses = geometry::rest_poses(file->mesh, center);
    const auto pose = [&](const RestSettings& rest) {
      return geometry::standing_pose(file->mesh,
                                     geometry::nearest_rest_pose(rest_poses, rest.up_O).up_O,
                                     rest.turn, center, rest.place_W);
    };
    start.push_back(pose(object.start));
    goal.push_back(pose(object.goal));
    objects.push_back({object.name, geometry::MeshQuery(file->mesh), center});
    const std::string& in_data_folder = object.object.file;
    records.push_back({object.name, in_data_folder.empty() ? file->record.file : in_data_folder,
                       file->record.sha256, file->record.meters_per_file_unit, start.back(),
                       goal.back()});
  }
  return {motion::TableScene(*load_hand(settings.hand), std::move(objects)), std::move(records),
          std::move(start), std::move(goal)};
}

/// Measurements over the frames of some segments.
struct Measured {
  std::int64_t segments = 0;
  std::int64_t frames = 0;
  double travel = 0.0;
  motion::MotionClearance clearance{kInfinity, kInfinity};
  std::int64_t overlaps = 0;

  void add(const Measured& other) {
    segments += other.segments;
    frames += other.frames;
    travel += other.travel;
    clearance.hand = std::min(clearance.hand, other.clearance.hand);
    clearance.object = std::min(clearance.object, other.clearance.object);
    overlaps += other.overlaps;
  }
};

Measured measure(const motion::TableScene& scene, const std::vector<RigidTransform>& X_WO,
                 const motion::MotionSegment& segment, double step) {
  Measured measured;
  measured.segments = 1;
  measured.travel = motion::largest_travel(scene, segment);
  const double frames = std::max(1.0, std::ceil(measured.travel / step));
  // Written so that NaN fails.
  if (!(frames <= 1e6)) {
    throw base::InvalidInput("a segment of " + base::shortest_decimal(measured.travel) +
                             " m has more than 1000000 frames; a larger frame_step_mm makes "
                             "fewer");
  }
  const auto parts = static_cast<std::int64_t>(frames);
  for (std::int64_t i = 0; i <= parts; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(parts);
    const motion::MotionClearance here = motion::clearance_at(scene, X_WO, segment, share);
    measured.clearance.hand = std::min(measured.clearance.hand, here.hand);
    measured.clearance.object = std::min(measured.clearance.object, here.object);
    if (motion::find_overlap(scene, X_WO, segment, share)) ++measured.overlaps;
    ++measured.frames;
  }
  return measured;
}

constexpr std::array kPhases = {motion::MotionPhase::Reach,  motion::MotionPhase::Approach,
                                motion::MotionPhase::Lift,   motion::MotionPhase::Transport,
                                motion::MotionPhase::Place,  motion::MotionPhase::Release,
                                motion::MotionPhase::Retreat};

/// Returns the rows of the moves' phases and adds all their measurements to `all`.
std::vector<sweep::ResultRow> move_rows(const Table& table, const motion::TidyingResult& result,
                                        double step, Measured& all) {
  std::vector<sweep::ResultRow> rows;
  std::vector<RigidTransform> X_WO = table.X_WO_start;
  for (std::size_t k = 0; k < result.moves.size(); ++k) {
    const motion::PlannedMove& move = result.moves[k];
    for (const motion::MotionPhase phase : kPhases) {
      Measured measured;
      for (const motion::MotionSegment& segment : move.segments) {
        if (segment.phase == phase) measured.add(measure(table.scene, X_WO, segment, step));
      }
      all.add(measured);
      sweep::ResultRow row(details());
      row.set("move", field(k + 1));
      row.set("object", table.scene.object(move.object).name);
      row.set("phase", std::string(motion::phase_name(phase)));
      row.set("segments", measured.segments);
      row.set("frames", measured.frames);
      row.set("travel_m", measured.travel);
      row.set("hand_clearance_m", measured.clearance.hand);
      row.set("object_clearance_m", measured.clearance.object);
      row.set("overlaps", measured.overlaps);
      row.set("grasp_m", move.grasp.quality.m);
      row.set("num_contacts", field(move.grasp.contacts.size()));
      row.set("planner_attempts", move.planner_attempts);
      row.set("grasps_tried", static_cast<std::int64_t>(move.grasps_tried));
      row.set("segments_tried", static_cast<std::int64_t>(move.segments_tried));
      row.set("failures", move.refusals);
      rows.push_back(std::move(row));
    }
    X_WO[move.object] = move.X_WO_to;
  }
  for (const motion::UnmovedObject& unmoved : result.unmoved) {
    sweep::ResultRow row(details());
    row.set("object", table.scene.object(unmoved.object).name);
    row.set("failures", unmoved.reason);
    rows.push_back(std::move(row));
  }
  return rows;
}

void fill_row(const Table& table, const motion::TidyingResult& result,
              const motion::TidyingOptions& options, const Measured& all, sweep::ResultRow& row) {
  std::vector<double> ms;
  std::string order;
  for (const motion::PlannedMove& move : result.moves) {
    ms.push_back(move.grasp.quality.m);
    order += (order.empty() ? "" : ", ") + table.scene.object(move.object).name;
  }
  double error_m = 0.0;
  double error_rad = 0.0;
  for (std::size_t i = 0; i < table.X_WO_goal.size(); ++i) {
    const Eigen::Vector3d& center_O = table.scene.objects()[i].center_of_mass_O;
    const RigidTransform& end = result.X_WO_end[i];
    const RigidTransform& goal = table.X_WO_goal[i];
    error_m = std::max(error_m, (end * center_O - goal * center_O).norm());
    error_rad =
        std::max(error_rad, Eigen::AngleAxisd(goal.linear().transpose() * end.linear()).angle());
  }
  std::string unmoved;
  for (const motion::UnmovedObject& object : result.unmoved) {
    unmoved += (unmoved.empty() ? "" : " | ") + table.scene.object(object.object).name + ": " +
               object.reason;
  }
  const std::size_t num_objects = table.X_WO_goal.size();
  row.set("objects", field(num_objects));
  row.set("at_goal", field(num_objects - result.unmoved.size()));
  row.set("moves", field(result.moves.size()));
  row.set("order", order);
  row.set("mean_m", field(mean(ms)));
  if (!ms.empty()) row.set("least_m", *std::min_element(ms.begin(), ms.end()));
  row.set("frames", all.frames);
  row.set("overlaps", all.overlaps);
  row.set("hand_clearance_m", all.clearance.hand);
  row.set("object_clearance_m", all.clearance.object);
  row.set("proven_clearance_m", options.move.clearance);
  row.set("goal_error_m", error_m);
  row.set("goal_error_rad", error_rad);
  row.set("moves_tried", static_cast<std::int64_t>(result.moves_tried));
  row.set("planner_attempts", result.planner_attempts);
  row.set("grasps_tried", static_cast<std::int64_t>(result.grasps_tried));
  row.set("segments_tried", static_cast<std::int64_t>(result.segments_tried));
  row.set("unmoved", unmoved);
}

void write_motion(const std::filesystem::path& folder, const TableSettings& settings,
                  const Table& table, const motion::TidyingResult& result,
                  const motion::TidyingOptions& options) {
  motion::MotionFile file =
      motion::make_motion_file(table.scene, table.objects, table.X_WO_goal, result, options);
  file.title = settings.title;
  file.hand = settings.hand;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw base::IoError(folder.string() + ": " + error.message());
  base::write_file_atomically(folder / "motion.json", motion::to_json(file));
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const TableSettings settings = table_settings(cell);
  const Clock::time_point start = Clock::now();
  const Table table = load_table(settings);
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  result.timings.set("load_s", base::seconds_since(start));

  const Clock::time_point plan_start = Clock::now();
  motion::TidyingOptions options = settings.tidying;
  options.move.home = home_of(settings, table.scene.hand());
  const motion::TidyingResult tidied =
      motion::tidy_table(table.scene, table.X_WO_start, table.X_WO_goal, options);
  result.timings.set("plan_s", base::seconds_since(plan_start));

  const Clock::time_point measure_start = Clock::now();
  Measured all;
  result.details = move_rows(table, tidied, settings.frame_step, all);
  fill_row(table, tidied, options, all, result.row);
  result.timings.set("measure_s", base::seconds_since(measure_start));
  write_motion(folder, settings, table, tidied, options);
  return result;
}

}  // namespace
}  // namespace table_tidying_parts

sweep::Experiment table_tidying() {
  using namespace table_tidying_parts;
  return {.slug = "table_tidying",
          .columns = columns(),
          .timings = timings(),
          .settings = table_setting_names(),
          .details = details(),
          .check = [](const sweep::Cell& cell) { table_settings(cell); },
          .run = run,
          .inputs = [](const sweep::Cell& cell) { return table_inputs(table_settings(cell)); }};
}

}  // namespace graspfit::experiments::internal
