#include "cells/hold_cell.hpp"

#include <algorithm>
#include <chrono>
#include <optional>

#include "cells/grasp_measures.hpp"
#include "cells/hold_preparation.hpp"
#include "cells/planning_table.hpp"
#include "cells/prediction_statistics.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "graspfit/hold_test/hold_test.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments::internal {
namespace hold_cell_parts {
namespace {

using Clock = std::chrono::steady_clock;
using hold_test::HoldStage;
using Protocols = std::span<const TestedProtocol>;

std::vector<sweep::Column> own_settings() {
  return {{"margins", "1", "grasps of a cell whose margins are searched for, the first found"}};
}

int num_margins(const sweep::Cell& cell) {
  const base::JsonValue value = sweep::setting(cell, "margins");
  if (value.small_integer() < 0) value.refuse("must be >= 0");
  return value.small_integer();
}

/// Reads the planner's settings and refuses those by which it would keep some grasps from the test.
PlanningSettings settings_of(const sweep::Cell& cell) {
  PlanningSettings settings = planning_settings(cell, own_settings());
  const grasp::PlannerOptions& options = settings.options;
  if (options.count < options.max_attempts) {
    throw sweep::SettingError("count", "must be at least max-attempts: no grasp is left out");
  }
  if (options.search != grasp::SearchRule::Best) {
    throw sweep::SettingError("search", "must be best: all attempts are made");
  }
  if (options.acceptance != grasp::Acceptance::Valid) {
    throw sweep::SettingError("accept", "must be valid: these are tested");
  }
  return settings;
}

// Tables.

std::vector<sweep::Column> protocol_columns(const TestedProtocol& protocol) {
  const std::string prefix = protocol.prefix;
  const std::string under = std::string(" under ") + protocol.name;
  return {{prefix + "held", "1", "grasps held" + under},
          {prefix + "held_per_attempt", "1", "of all attempts of the planner"},
          {prefix + "held_per_grasp", "1", "of the grasps that it returned"},
          {prefix + "rejected", "1",
           "grasps not simulated: too deep at the pre-grasp, or without pre-grasp or squeeze"},
          {prefix + "lost_before_load", "1", "grasps lost between pre-grasp and load"},
          {prefix + "lost_under_load", "1", "grasps lost under load"}};
}

std::vector<sweep::Column> columns(Protocols protocols, const HoldColumns& more) {
  std::vector<sweep::Column> all = {
      {"object_pieces", "1", "convex pieces that stand for the object"},
      {"object_outward_deviation_m", "m", "farthest that a piece reaches out of the object"},
      {"object_inward_deviation_m", "m", "farthest point of the surface from the pieces"},
      {"object_volume_error", "1", "volume of all pieces together over the object's, less 1"},
      {"hand_pieces", "1", "convex pieces that stand for the hand"},
      {"hand_outward_deviation_m", "m", "farthest that a piece reaches out of its link"}};
  for (const TestedProtocol& protocol : protocols) {
    for (sweep::Column& column : protocol_columns(protocol)) all.push_back(std::move(column));
  }
  for (sweep::Column& column : margin_columns()) all.push_back(std::move(column));
  for (sweep::Column& column : planning_columns()) all.push_back(std::move(column));
  all.insert(all.end(), more.columns.begin(), more.columns.end());
  return all;
}

std::vector<sweep::Column> timings() {
  std::vector<sweep::Column> all = {
      {"pieces_s", "s", "cutting hand and object, or nothing where the last cells had the same"},
      {"hold_test_s", "s", "testing all grasps under all protocols"},
      {"margins_s", "s", "searching for margins"},
      {"measures_s", "s", "measures beside the planner's own"}};
  for (sweep::Column& column : planning_timings()) all.push_back(std::move(column));
  return all;
}

std::vector<sweep::Column> details(Protocols protocols) {
  std::vector<sweep::Column> all = {{"attempt", "1", "of the planner, from 0"}};
  for (sweep::Column& column : grasp_measure_columns()) all.push_back(std::move(column));
  all.push_back(
      {"squeeze_residual", "1", "unbalanced wrench of the squeeze over its normal forces"});
  for (const TestedProtocol& protocol : protocols) {
    all.push_back({std::string(protocol.prefix) + kStageColumn, "",
                   std::string("how far it came under ") + protocol.name +
                       ": rejected, approach, load (lost there) or held"});
  }
  all.push_back({"squeeze_force_n", "N", "sum of the normal forces on the object once squeezed"});
  all.push_back({kMarginColumns[0], "N", "smallest force that fails; empty: not searched for"});
  all.push_back({kMarginColumns[1], "N m", "smallest torque that fails"});
  all.push_back({"reason", "", "of a rejection, or of a simulation that went wrong"});
  return all;
}

// Work.

void fill_pieces(const hold_test::HoldHand& hand, const hold_test::HoldObject& object,
                 sweep::ResultRow& row) {
  row.set("object_pieces", field(object.shape.pieces.size()));
  row.set("object_outward_deviation_m", object.shape.outward_deviation);
  row.set("object_inward_deviation_m", object.shape.inward_deviation);
  row.set("object_volume_error", object.shape.volume_error);
  std::size_t pieces = 0;
  double deviation = 0.0;
  for (const geometry::ConvexDecomposition& link : hand.links) {
    pieces += link.pieces.size();
    deviation = std::max(deviation, link.outward_deviation);
  }
  row.set("hand_pieces", field(pieces));
  row.set("hand_outward_deviation_m", deviation);
}

/// What the simulator says of one grasp.
struct TestedGrasp {
  const grasp::Grasp* grasp = nullptr;
  GraspMeasures measures;
  std::vector<hold_test::HoldVerdict> verdicts;  ///< Per tested protocol.
  std::optional<hold_test::HoldMargin> margin;   ///< Margin under the first protocol.
};

/// The returned grasps in the order in which they were found.
std::vector<TestedGrasp> grasps_as_found(const Planned& planned) {
  std::vector<TestedGrasp> tested;
  for (const grasp::Grasp& grasp : planned.result.grasps) tested.push_back({&grasp, {}, {}, {}});
  std::sort(tested.begin(), tested.end(), [](const TestedGrasp& a, const TestedGrasp& b) {
    return a.grasp->attempt < b.grasp->attempt;
  });
  return tested;
}

void test_all(Protocols protocols, const hold_test::HoldHand& hand,
              const hold_test::HoldObject& object, int num_margins,
              std::vector<TestedGrasp>& grasps, sweep::ResultRow& timings) {
  double test_s = 0.0;
  double margins_s = 0.0;
  for (const TestedProtocol& protocol : protocols) {
    if (grasps.empty()) break;
    const Clock::time_point start = Clock::now();
    hold_test::HoldTest test(hand, object, hold_test::hold_protocol(protocol.name));
    for (TestedGrasp& tested : grasps) tested.verdicts.push_back(test.test(*tested.grasp));
    test_s += base::seconds_since(start);
    if (&protocol != &protocols.front()) continue;
    const Clock::time_point margins_start = Clock::now();
    const auto count = std::min(grasps.size(), static_cast<std::size_t>(num_margins));
    for (std::size_t i = 0; i < count; ++i) grasps[i].margin = test.margin(*grasps[i].grasp);
    margins_s += base::seconds_since(margins_start);
  }
  timings.set("hold_test_s", test_s);
  timings.set("margins_s", margins_s);
}

void fill_verdicts(Protocols protocols, const std::vector<TestedGrasp>& grasps,
                   std::int64_t attempts, sweep::ResultRow& row) {
  for (std::size_t p = 0; p < protocols.size(); ++p) {
    const std::string prefix = protocols[p].prefix;
    const auto count = [&](HoldStage stage) {
      return static_cast<std::int64_t>(std::count_if(
          grasps.begin(), grasps.end(),
          [&](const TestedGrasp& tested) { return tested.verdicts[p].stage == stage; }));
    };
    const std::int64_t held = count(HoldStage::Held);
    row.set(prefix + "held", held);
    if (attempts > 0) {
      row.set(prefix + "held_per_attempt",
              static_cast<double>(held) / static_cast<double>(attempts));
    }
    if (!grasps.empty()) {
      row.set(prefix + "held_per_grasp",
              static_cast<double>(held) / static_cast<double>(grasps.size()));
    }
    row.set(prefix + "rejected", count(HoldStage::Rejected));
    row.set(prefix + "lost_before_load", count(HoldStage::Approach));
    row.set(prefix + "lost_under_load", count(HoldStage::Load));
  }
}

void fill_margins(const std::vector<TestedGrasp>& grasps, sweep::ResultRow& row) {
  std::array<std::vector<double>, kMarginColumns.size()> margins;
  for (const TestedGrasp& tested : grasps) {
    if (!tested.margin) continue;
    margins[0].push_back(tested.margin->force);
    margins[1].push_back(tested.margin->torque);
  }
  row.set("margins", field(margins[0].size()));
  for (std::size_t i = 0; i < margins.size(); ++i) {
    for (const auto& [name, share] : kQuartiles) {
      row.set(std::string(name) + kMarginColumns[i], field(quantile(margins[i], share)));
    }
  }
}

sweep::ResultRow detail_of(Protocols protocols, const TestedGrasp& tested) {
  const grasp::Grasp& grasp = *tested.grasp;
  sweep::ResultRow row(details(protocols));
  row.set("attempt", grasp.attempt);
  for (const auto& [name, value] : tested.measures) row.set(name, field(value));
  if (grasp.squeeze) row.set("squeeze_residual", grasp.squeeze->residual);
  std::string reason;
  for (std::size_t p = 0; p < protocols.size(); ++p) {
    const hold_test::HoldVerdict& verdict = tested.verdicts[p];
    row.set(std::string(protocols[p].prefix) + kStageColumn, stage_name(verdict.stage));
    if (reason.empty()) reason = verdict.reason;
  }
  row.set("reason", reason);
  const hold_test::HoldVerdict& first = tested.verdicts.front();
  if (first.stage != HoldStage::Rejected) row.set("squeeze_force_n", first.squeeze_force);
  if (tested.margin) {
    row.set(kMarginColumns[0], tested.margin->force);
    row.set(kMarginColumns[1], tested.margin->torque);
  }
  return row;
}

sweep::CellResult run(Protocols protocols, const HoldColumns& more, const sweep::Cell& cell,
                      const std::filesystem::path& folder) {
  if (!hold_test::is_available()) {
    throw sweep::MissingData("this build has no physics engine; build with MuJoCo");
  }
  const Planned planned = plan(settings_of(cell));
  sweep::CellResult result{sweep::ResultRow(columns(protocols, more)), sweep::ResultRow(timings())};
  const Clock::time_point start = Clock::now();
  const std::shared_ptr<const hold_test::HoldHand> hand = hold_hand(planned);
  const std::shared_ptr<const hold_test::HoldObject> object = hold_object(planned);
  result.timings.set("pieces_s", base::seconds_since(start));

  std::vector<TestedGrasp> grasps = grasps_as_found(planned);
  test_all(protocols, *hand, *object, num_margins(cell), grasps, result.timings);
  double measures_s = 0.0;
  for (TestedGrasp& tested : grasps) {
    tested.measures = measures_of(planned, *tested.grasp, measures_s);
  }
  result.timings.set("measures_s", measures_s);
  fill_pieces(*hand, *object, result.row);
  fill_verdicts(protocols, grasps, planned.result.statistics.attempts, result.row);
  fill_margins(grasps, result.row);
  fill_planning_columns(planned, result.row);
  if (more.fill) more.fill(planned, result.row);
  fill_planning_timings(planned, result.timings);
  for (const TestedGrasp& tested : grasps) result.details.push_back(detail_of(protocols, tested));
  write_best_grasps(folder, planned, grasps.size());
  return result;
}

/// Axis whose values are also summarized separately.
constexpr const char* kGroupAxis = "grip";
constexpr const char* kAllGroups = "all";

}  // namespace
}  // namespace hold_cell_parts

std::vector<sweep::Column> margin_columns() {
  using namespace hold_cell_parts;
  std::vector<sweep::Column> columns = {
      {"margins", "1", "grasps, the first found, whose margins were searched for"}};
  for (const char* const margin : kMarginColumns) {
    const bool is_force = margin == kMarginColumns[0];
    for (const auto& [name, share] : kQuartiles) {
      columns.push_back({std::string(name) + margin, is_force ? "N" : "N m",
                         std::string("of the smallest ") + (is_force ? "force" : "torque") +
                             " that fails; 0 where the grasp is lost without load"});
    }
  }
  return columns;
}

std::size_t column_index(const std::vector<sweep::Column>& columns, const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const sweep::Column& column) { return column.name == name; });
  return static_cast<std::size_t>(found - columns.begin());
}

std::vector<std::pair<std::string, std::vector<const sweep::FinishedCell*>>> cells_by_grip(
    const sweep::ParameterSweep& sweep, const std::vector<sweep::FinishedCell>& cells) {
  using namespace hold_cell_parts;
  std::vector<std::pair<std::string, std::vector<const sweep::FinishedCell*>>> groups = {
      {kAllGroups, {}}};
  for (const sweep::FinishedCell& cell : cells) groups[0].second.push_back(&cell);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (sweep.axes[a].name != kGroupAxis) continue;
    for (const sweep::AxisValue& value : sweep.axes[a].values) {
      groups.emplace_back(value.label, std::vector<const sweep::FinishedCell*>());
      for (const sweep::FinishedCell& cell : cells) {
        if (cell.labels[a] == value.label) groups.back().second.push_back(&cell);
      }
    }
  }
  return groups;
}

sweep::Experiment hold_experiment(const std::string& slug,
                                  std::span<const TestedProtocol> protocols,
                                  const HoldColumns& more) {
  using namespace hold_cell_parts;
  return {.slug = slug,
          .columns = columns(protocols, more),
          .timings = timings(),
          .settings = own_settings(),
          .details = details(protocols),
          .check =
              [](const sweep::Cell& cell) {
                num_margins(cell);
                settings_of(cell);
              },
          .run =
              [protocols, more](const sweep::Cell& cell, const std::filesystem::path& folder) {
                return run(protocols, more, cell, folder);
              },
          .inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); }};
}

}  // namespace graspfit::experiments::internal
