#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <optional>

#include "cells/hold_cell.hpp"
#include "cells/hold_preparation.hpp"
#include "cells/planning_table.hpp"
#include "dataset/dataset_columns.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/path_text.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/experiments/grasp_dataset.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "graspfit/hold_test/hold_test.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments {
namespace dataset_cell_parts {
namespace {

using namespace internal;
using Clock = std::chrono::steady_clock;
using hold_test::HoldProtocol;
using hold_test::HoldStage;

std::vector<sweep::Column> settings() {
  return {{"protocol", "", std::string("hold test of every grasp; ") + kNoProtocol + ": no test"},
          {"margins", "1", "grasps of a cell, the best, whose smallest failing loads are searched"},
          {kLicenseColumn, "", "of the object's mesh, as its source states it"}};
}

/// A cell's settings.
struct Request {
  PlanningSettings planning;
  std::optional<HoldProtocol> protocol;  ///< Empty: grasps are not tested.
  int margins = 0;
  std::string license;
};

std::optional<HoldProtocol> protocol_of(const base::JsonValue& value) {
  const std::string name = value.name();
  if (name == kNoProtocol) return std::nullopt;
  if (!hold_test::is_available()) {
    value.refuse(std::string("must be ") + kNoProtocol +
                 ": this build has no physics engine; build with MuJoCo");
  }
  const std::vector<std::string> names = hold_test::hold_protocol_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    value.refuse(std::string("must be one of ") + kNoProtocol + '|' +
                 base::list_text(names, {}, "|"));
  }
  return hold_test::hold_protocol(name);
}

Request request_of(const sweep::Cell& cell) {
  Request request;
  request.planning = planning_settings(cell, settings());
  if (!request.planning.object.shape.empty()) {
    throw sweep::SettingError("shape", "has no file; write it as one with graspfit shape");
  }
  request.protocol = protocol_of(sweep::setting(cell, "protocol"));
  const base::JsonValue margins = sweep::setting(cell, "margins");
  request.margins = margins.small_integer();
  if (request.margins < 0) margins.refuse("must be >= 0");
  if (request.margins > 0 && !(request.protocol && request.protocol->has_margins())) {
    margins.refuse("must be 0 with a protocol without margins");
  }
  if (const auto license = sweep::find_setting(cell, kLicenseColumn)) {
    request.license = license->text();
  }
  return request;
}

// Tables.

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"object_file", "", "the object's mesh, as its grasp file records it"},
      {"object_sha256", "", "of that file"},
      {kLicenseColumn, "", "of that file, as given"},
      {"meters_per_file_unit", "m", "by which the file was scaled"},
      {"object_repairs", "", "what was done to the mesh, with how many elements; empty: nothing"},
      {"object_volume_m3", "m3", "of the solid"},
      {kGraspFileColumn, "", "of the cell, in this folder; empty: no grasps"},
      {"held", "1", "grasps that held in the hold test; empty: not tested"},
      {"lost_before_load", "1", "grasps lost between pre-grasp and load"},
      {"lost_under_load", "1", "grasps lost under load"},
      {"rejected", "1", "grasps that could not be tested"}};
  for (sweep::Column& column : planning_columns()) all.push_back(std::move(column));
  return all;
}

std::vector<sweep::Column> timings() {
  std::vector<sweep::Column> all = {
      {"pieces_s", "s", "cutting hand and object, or nothing where the last cells had the same"},
      {"hold_test_s", "s", "testing all grasps"},
      {"margins_s", "s", "searching for margins"}};
  for (sweep::Column& column : planning_timings()) all.push_back(std::move(column));
  return all;
}

std::vector<sweep::Column> details() {
  return {{"rank", "1", "among the cell's grasps, from 1"},
          {"attempt", "1", "of the planner, from 0"},
          {"m", "1", "the paper's M"},
          {"epsilon", "1", "GraspIt!'s convention"},
          {"num_contacts", "1", "N'"},
          {"largest_gap_m", "m", "of a contact that was asked for"},
          {kStageColumn, "",
           "how far it came: rejected, approach, load (lost there) or held; empty: not tested"},
          {"squeeze_force_n", "N", "sum of the normal forces on the object once squeezed"},
          {kMarginColumns[0], "N", "smallest force that fails; empty: not searched for"},
          {kMarginColumns[1], "N m", "smallest torque that fails"},
          {"reason", "", "of a rejection, or of a simulation that went wrong"}};
}

// Work.

std::string repairs_text(const grasp::ObjectRecord& record) {
  std::string text;
  for (const geometry::RepairStep& step : record.repairs) {
    text += (text.empty() ? "" : "; ") + step.what + ' ' + std::to_string(step.count);
  }
  return text;
}

void fill_object(const Planned& planned, const Request& request, sweep::ResultRow& row) {
  const grasp::ObjectRecord& record = planned.object_file->record;
  row.set("object_file", base::path_text(record.file));
  row.set("object_sha256", record.sha256);
  row.set(kLicenseColumn, request.license);
  row.set("meters_per_file_unit", record.meters_per_file_unit);
  row.set("object_repairs", repairs_text(record));
  row.set("object_volume_m3", planned.object.mass.volume);
}

sweep::ResultRow detail_of(const grasp::Grasp& grasp, std::size_t rank) {
  sweep::ResultRow row(details());
  row.set("rank", field(rank));
  row.set("attempt", grasp.attempt);
  row.set("m", grasp.quality.m);
  if (grasp.wrench) row.set("epsilon", grasp.epsilon());
  row.set("num_contacts", field(grasp.contacts.size()));
  row.set("largest_gap_m", grasp::largest_requested_gap(grasp));
  return row;
}

/// Tests the grasps of a cell and says in its rows what came out.
void test_grasps(const Planned& planned, const Request& request, sweep::CellResult& result) {
  const Clock::time_point start = Clock::now();
  const auto hand = hold_hand(planned);
  const auto object = hold_object(planned);
  result.timings.set("pieces_s", base::seconds_since(start));
  const Clock::time_point test_start = Clock::now();
  double margins_s = 0.0;
  std::array<std::int64_t, 4> counts{};
  hold_test::HoldTest test(*hand, *object, *request.protocol);
  for (std::size_t i = 0; i < planned.result.grasps.size(); ++i) {
    const grasp::Grasp& grasp = planned.result.grasps[i];
    sweep::ResultRow& row = result.details[i];
    const hold_test::HoldVerdict verdict = test.test(grasp);
    ++counts[static_cast<std::size_t>(verdict.stage)];
    row.set(kStageColumn, stage_name(verdict.stage));
    row.set("reason", verdict.reason);
    if (verdict.stage != HoldStage::Rejected) row.set("squeeze_force_n", verdict.squeeze_force);
    if (i >= static_cast<std::size_t>(request.margins)) continue;
    const Clock::time_point margin_start = Clock::now();
    const hold_test::HoldMargin margin = test.margin(grasp);
    margins_s += base::seconds_since(margin_start);
    row.set(kMarginColumns[0], margin.force);
    row.set(kMarginColumns[1], margin.torque);
  }
  const auto count = [&](HoldStage stage) { return counts[static_cast<std::size_t>(stage)]; };
  result.row.set("held", count(HoldStage::Held));
  result.row.set("lost_before_load", count(HoldStage::Approach));
  result.row.set("lost_under_load", count(HoldStage::Load));
  result.row.set("rejected", count(HoldStage::Rejected));
  result.timings.set("hold_test_s", base::seconds_since(test_start) - margins_s);
  result.timings.set("margins_s", margins_s);
}

/// Where a cell does not say how many contacts are asked for, no more than its hand has fingers.
void limit_contacts(const sweep::Cell& cell, PlanningSettings& settings) {
  if (sweep::find_setting(cell, "contacts") || !settings.options.fingers.empty()) return;
  const auto num_fingers = base::as_index<int>(load_hand(settings.hand)->fingers.size());
  settings.options.num_contacts = std::min(settings.options.num_contacts, num_fingers);
}

/// Reads the object of a cell. A file that is there and is no mesh will be none the next time, too:
/// that is not tried again, as other faults of reading are.
void read_object(const ObjectSettings& object) {
  try {
    load_object(object);
  } catch (const sweep::MissingData&) {
    throw;
  } catch (const base::IoError& error) {
    if (!std::ifstream(sweep::data_file(object.file))) throw;
    throw base::InvalidInput(error.what());
  }
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  Request request = request_of(cell);
  if (!request.planning.object.file.empty()) read_object(request.planning.object);
  limit_contacts(cell, request.planning);
  const Planned planned = plan(request.planning);
  const std::size_t num_grasps = planned.result.grasps.size();
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  for (std::size_t i = 0; i < num_grasps; ++i) {
    result.details.push_back(detail_of(planned.result.grasps[i], i + 1));
  }
  fill_object(planned, request, result.row);
  fill_planning_columns(planned, result.row);
  fill_planning_timings(planned, result.timings);
  if (num_grasps == 0) return result;
  if (request.protocol) test_grasps(planned, request, result);
  write_best_grasps(folder, planned, num_grasps);
  result.row.set(
      kGraspFileColumn,
      (std::filesystem::path("cells") / folder.filename() / kGraspFileName).generic_string());
  return result;
}

}  // namespace
}  // namespace dataset_cell_parts

const sweep::Experiment& dataset_experiment() {
  using namespace dataset_cell_parts;
  static const sweep::Experiment experiment = {
      .slug = kDatasetSlug,
      .columns = columns(),
      .timings = timings(),
      .settings = settings(),
      .shared_settings = planning_setting_names(),
      .details = details(),
      .check = [](const sweep::Cell& cell) { request_of(cell); },
      .run = run,
      .inputs = [](const sweep::Cell& cell) { return planning_inputs(request_of(cell).planning); }};
  return experiment;
}

}  // namespace graspfit::experiments
