#include "cells/planning_table.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <system_error>

#include "graspfit/base/number_text.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/contact/squeeze.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/planner_result.hpp"

namespace graspfit::experiments::internal {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kOutcomes = {
    grasp::AttemptOutcome::Valid,          grasp::AttemptOutcome::UsableOnly,
    grasp::AttemptOutcome::NoTargets,      grasp::AttemptOutcome::InitialCollision,
    grasp::AttemptOutcome::BlockedFinger,  grasp::AttemptOutcome::MissedContact,
    grasp::AttemptOutcome::GapLeft,        grasp::AttemptOutcome::SelfCollision,
    grasp::AttemptOutcome::Rejected,       grasp::AttemptOutcome::NoWayIn,
    grasp::AttemptOutcome::IterationLimit, grasp::AttemptOutcome::Weak,
    grasp::AttemptOutcome::Unstable,       grasp::AttemptOutcome::PoorShape};

std::string snake_case(std::string text) {
  for (char& c : text) {
    if (c == ' ' || c == '-') c = '_';
  }
  return text;
}

std::string outcome_column(grasp::AttemptOutcome outcome) {
  return "attempts_" + snake_case(grasp::outcome_name(outcome));
}

/// Measures of a run's grasps, each in the order of the grasps.
struct Measures {
  std::vector<double> m;
  std::vector<double> epsilon;
  std::vector<double> requested_gaps;
  std::vector<double> num_contacts;
  std::vector<double> target_distances;  ///< Of targets whose parts have a contact.
  double largest_penetration = 0.0;
  std::size_t num_penetrating = 0;
  std::size_t num_closed = 0;
  std::size_t num_balanced = 0;
};

/// Says whether some forces within the friction cones of ε balance and press on every contact; the
/// grasp's own squeeze may be for another friction.
bool is_balanced(const Planned& planned, const grasp::Grasp& grasp, double torque_scale) {
  const grasp::PlannerOptions& options = planned.settings.options;
  return contact::squeeze_configuration(*planned.hand, grasp.configuration, grasp.contacts,
                                        {.center_of_mass_O = planned.object.mass.center_of_mass,
                                         .torque_scale = torque_scale,
                                         .friction = options.friction,
                                         .bearing_gap = grasp::bearing_gap(options)},
                                        options.squeeze)
      .is_balanced;
}

Measures measures_of(const Planned& planned) {
  Measures measures;
  const double torque_scale =
      contact::wrench_object(planned.object.mesh(), planned.object.mass.center_of_mass)
          .largest_radius;
  for (const grasp::Grasp& grasp : planned.result.grasps) {
    measures.m.push_back(grasp.quality.m);
    measures.epsilon.push_back(grasp.epsilon());
    measures.num_contacts.push_back(static_cast<double>(grasp.contacts.size()));
    for (const contact::Contact& contact : grasp.contacts) {
      if (contact.is_target) measures.requested_gaps.push_back(contact.gap);
    }
    for (const double distance : grasp::target_distances(grasp)) {
      if (std::isfinite(distance)) measures.target_distances.push_back(distance);
    }
    measures.largest_penetration =
        std::max(measures.largest_penetration, grasp::largest_penetration(grasp));
    if (grasp.penetration.is_any()) ++measures.num_penetrating;
    if (grasp.is_closed()) ++measures.num_closed;
    if (grasp.squeeze && is_balanced(planned, grasp, torque_scale)) ++measures.num_balanced;
  }
  return measures;
}

std::optional<double> share(std::size_t count, std::size_t total) {
  if (total == 0) return std::nullopt;
  return static_cast<double>(count) / static_cast<double>(total);
}

void require_over_table(const geometry::TriangleMesh& mesh_O, std::optional<double> table_z_O) {
  const double top = geometry::bounding_box(mesh_O).max().z();
  if (!table_z_O || top > *table_z_O) return;
  throw base::InvalidInput("table " + base::shortest_decimal(*table_z_O) +
                           " is above the whole object, whose highest z is " +
                           base::shortest_decimal(top) + " m");
}

}  // namespace

Planned plan(const PlanningSettings& settings, const StartObserver& observer) {
  const Clock::time_point start = Clock::now();
  std::shared_ptr<const grasp::ObjectFile> file = load_object(settings.object);
  std::shared_ptr<const hands::HandModel> hand = load_hand(settings.hand);
  grasp::requested_parts(*hand, settings.options);  // What the hand cannot do is said first.
  require_over_table(file->mesh, settings.table_z_O);
  const double load_s = base::seconds_since(start);
  const Clock::time_point prepare_start = Clock::now();
  grasp::ObjectModel object =
      grasp::prepare_object(file->mesh, *hand, settings.options, {.is_on = true});
  const double prepare_s = base::seconds_since(prepare_start);

  Planned planned{
      settings, std::move(file), std::move(hand), std::move(object), {}, load_s, prepare_s, 0.0, {},
      {}};
  const Clock::time_point plan_start = Clock::now();
  const double cpu_start = base::thread_cpu_s();
  grasp::TriedStartObserver tried_start;
  if (observer) {
    tried_start = [&](const grasp::TriedStart& tried) {
      observer(tried, *planned.hand, planned.object);
    };
  }
  planned.result =
      grasp::plan_grasps(planned.object, *planned.hand, settings.options, surroundings_of(settings),
                         {.num_threads = 1,
                          .progress =
                              [&](std::int64_t, std::int64_t grasps) {
                                planned.attempt_cpu_s.push_back(base::thread_cpu_s() - cpu_start);
                                if (grasps > 0 && !planned.first_s)
                                  planned.first_s = base::seconds_since(plan_start);
                              },
                          .tried_start = tried_start});
  planned.plan_s = base::seconds_since(plan_start);
  return planned;
}

std::vector<sweep::Column> planning_columns() {
  std::vector<sweep::Column> columns = {
      {"object_extent_m", "m", "longest edge of the object's bounding box"},
      {"attempts", "1", "target sets fitted"},
      {"usable", "1", "attempts that ended in a grasp with M > 0"},
      {"valid", "1",
       "of these without penetration, every requested part in contact, a free way in"},
      {"usable_rate", "1", "usable over attempts"},
      {"rejected_rate", "1", "rejected for their deviation or their M, over attempts"},
      {"valid_rate", "1", "valid over attempts"},
      {"grasps", "1", "distinct grasps returned; the following are about these"},
      {"best_m", "1", "largest M"},
      {"mean_m", "1", "mean M"},
      {"best_num_contacts", "1", "N' of the grasp with the largest M"},
      {"mean_num_contacts", "1", "mean N'"},
      {"best_epsilon", "1", "epsilon of the grasp with the largest M, GraspIt!'s convention"},
      {"median_epsilon", "1", "median of epsilon"},
      {"force_closed_share", "1",
       "share with force closure (epsilon above 1e-9) at the friction of epsilon"},
      {"balanced_share", "1",
       "share whose contacts can press and balance one another at the friction of epsilon"},
      {"num_penetrating", "1", "grasps that touch with what must not touch, decided exactly"},
      {"largest_penetration_m", "m", "deepest overlap with the object or of the hand with itself"},
      {"mean_target_distance_m", "m",
       "mean distance of the contacts from the targets that they were meant for"},
      {"mean_gap_m", "m", "mean gap of the contacts that were asked for"},
      {"largest_gap_m", "m", "largest gap of the contacts that were asked for"},
      {"duplicates", "1", "accepted grasps left out as too like another"}};
  for (const grasp::AttemptOutcome outcome : kOutcomes) {
    columns.push_back({outcome_column(outcome), "1",
                       std::string("attempts that ended so: ") + grasp::outcome_name(outcome)});
  }
  columns.push_back({"target_failures", "", "why there were no targets, with how often"});
  columns.push_back({"seeds_tried", "1", "of target sets"});
  columns.push_back({"fitting_iterations", "1", "of the adjustment loop"});
  columns.push_back({"refinement_iterations", "1", "of contact refinement"});
  return columns;
}

void fill_planning_columns(const Planned& planned, sweep::ResultRow& row) {
  const grasp::PlannerStatistics& statistics = planned.result.statistics;
  const std::vector<grasp::Grasp>& grasps = planned.result.grasps;
  const Measures measures = measures_of(planned);
  const auto attempts = static_cast<std::size_t>(statistics.attempts);
  row.set("object_extent_m", geometry::longest_extent(planned.object_file->mesh));
  row.set("attempts", statistics.attempts);
  row.set("usable", statistics.usable());
  row.set("valid", statistics.valid());
  row.set("usable_rate", field(share(static_cast<std::size_t>(statistics.usable()), attempts)));
  row.set(
      "rejected_rate",
      field(share(static_cast<std::size_t>(statistics.outcomes.at(grasp::AttemptOutcome::Rejected)),
                  attempts)));
  row.set("valid_rate", field(share(static_cast<std::size_t>(statistics.valid()), attempts)));
  row.set("grasps", field(grasps.size()));
  row.set("best_m", field(largest(measures.m)));
  row.set("mean_m", field(mean(measures.m)));
  if (!grasps.empty()) {
    const grasp::Grasp& best = *std::max_element(
        grasps.begin(), grasps.end(),
        [](const grasp::Grasp& a, const grasp::Grasp& b) { return a.quality.m < b.quality.m; });
    row.set("best_num_contacts", field(best.contacts.size()));
    row.set("best_epsilon", best.epsilon());
    row.set("largest_penetration_m", measures.largest_penetration);
  }
  row.set("mean_num_contacts", field(mean(measures.num_contacts)));
  row.set("median_epsilon", field(median(measures.epsilon)));
  row.set("force_closed_share", field(share(measures.num_closed, grasps.size())));
  row.set("balanced_share", field(share(measures.num_balanced, grasps.size())));
  row.set("num_penetrating", field(measures.num_penetrating));
  row.set("mean_target_distance_m", field(mean(measures.target_distances)));
  row.set("mean_gap_m", field(mean(measures.requested_gaps)));
  row.set("largest_gap_m", field(largest(measures.requested_gaps)));
  row.set("duplicates", statistics.duplicates);
  for (const grasp::AttemptOutcome outcome : kOutcomes) {
    const auto found = statistics.outcomes.find(outcome);
    row.set(outcome_column(outcome),
            found == statistics.outcomes.end() ? std::int64_t{0} : found->second);
  }
  std::string failures;
  for (const auto& [reason, count] : statistics.target_failures) {
    if (count == 0) continue;
    failures += (failures.empty() ? "" : "; ") + reason + ' ' + std::to_string(count);
  }
  row.set("target_failures", failures);
  row.set("seeds_tried", statistics.seeds_tried);
  row.set("fitting_iterations", statistics.fitting_iterations);
  row.set("refinement_iterations", statistics.refinement_iterations);
}

std::vector<sweep::Column> planning_timings() {
  return {{"load_s", "s", "reading object and hand, or nothing where the last cells had the same"},
          {"prepare_s", "s", "building the object's model; what the cache has of it is read"},
          {"plan_s", "s", "the planner by the clock"},
          {"first_grasp_s", "s", "from its start to the first accepted grasp"},
          {"per_grasp_s", "s", "the planner's time over the valid grasps, failures included"},
          {"targets_s", "s", "of that: target contacts"},
          {"fitting_s", "s", "of that: the adjustment loop"},
          {"refinement_s", "s", "of that: contact refinement"},
          {"measure_s", "s", "of that: contacts, measures and exact tests"},
          {"pre_grasp_s", "s", "of that: ways in and squeezes"}};
}

void fill_planning_timings(const Planned& planned, sweep::ResultRow& row) {
  const grasp::PlannerTimings& timings = planned.result.timings;
  row.set("load_s", planned.load_s);
  row.set("prepare_s", planned.prepare_s);
  row.set("plan_s", planned.plan_s);
  row.set("first_grasp_s", field(planned.first_s));
  if (const auto valid = planned.result.statistics.valid(); valid > 0) {
    row.set("per_grasp_s", planned.plan_s / static_cast<double>(valid));
  }
  row.set("targets_s", timings.targets_s);
  row.set("fitting_s", timings.fitting_s);
  row.set("refinement_s", timings.refinement_s);
  row.set("measure_s", timings.measure_s);
  row.set("pre_grasp_s", timings.pre_grasp_s);
}

std::optional<double> largest(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::max_element(values.begin(), values.end());
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle];
  return (values[middle - 1] + values[middle]) / 2.0;
}

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> standard_deviation(const std::vector<double>& values) {
  if (values.size() < 2) return std::nullopt;
  const double middle = *mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

sweep::Value field(const std::optional<double>& value) {
  return value ? sweep::Value(*value) : sweep::Value();
}

sweep::Value field(std::size_t count) { return static_cast<std::int64_t>(count); }

void write_best_grasps(const std::filesystem::path& folder, const Planned& planned,
                       std::size_t count) {
  // A grasp file records how its object is read from a file: a shape has no file, and a turned
  // object no such record.
  const ObjectSettings& object = planned.settings.object;
  if (planned.result.grasps.empty() || !object.shape.empty()) return;
  if (!object.rotation_xyz.isZero(0.0)) return;
  const grasp::Surroundings around = surroundings_of(planned.settings);
  grasp::PlannerResult best = planned.result;
  best.grasps.resize(std::min(count, best.grasps.size()));
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw base::IoError(folder.string() + ": " + error.message());
  grasp::GraspFile file = grasp::make_grasp_file(
      planned.object_file->record, *planned.hand, planned.settings.options, planned.object, best,
      {.table_z_O = around.table_z_O, .obstacles = {}, .table_clearance = around.table_clearance});
  file.preset = planned.settings.preset;
  grasp::write_grasps(folder / "grasps.json", file);
}

}  // namespace graspfit::experiments::internal
