// Question: what is known of a candidate (a set of targets and a side from which the hand reaches
// for it) before it is fitted and refined, and how well does it tell the candidates that become
// grasps that close? And what share of the targets that the object's rules admit can the hand reach
// squarely at all?
//
// Answered by running the planner with the strongest of many candidates kept, and looking at every
// candidate: epsilon of its targets as they are, epsilon of contacts where the fingertips would be
// at these targets were there no object, how far they would miss and lean there; and, after fitting
// and refinement, closure and epsilon of the contacts that touch. A row correlates them over the
// candidates of one object and hand, the details hold every candidate. An attempt fits the most
// promising of the sides that it draws (targets that balance, fingers that do not cross, pads that
// lie flat): the correlations are over those. The share of reachable targets is of random sets,
// from all sides, none of which is fitted.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cells/planning_table.hpp"
#include "cells/prediction_statistics.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/geometry/angle.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/sweep/setting_value.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace candidate_prediction_parts {
namespace {

using Eigen::Vector3d;

// A finger reaches a target squarely that it does not miss and on which its pad hardly leans.
constexpr double kSquareMiss = 0.005;                           // [m]
constexpr double kSquareLean = 15.0 * base::kRadiansPerDegree;  // [rad]
// A distance that counts as a radian, as where the planner chooses among sides [m].
constexpr double kMissPerRadian = 0.015;

/// What is known of a candidate before it is fitted, smaller or larger being better, and what
/// became of it.
struct Candidate {
  double targets_epsilon = 0.0;
  double posture_epsilon = 0.0;
  double miss = 0.0;  ///< [m]
  double lean = 0.0;  ///< [rad]
  bool is_valid = false;
  bool is_closed = false;
  double epsilon = 0.0;
};

/// A predictor by name; larger values promise more.
struct Predictor {
  const char* name;
  const char* meaning;
  double (*value)(const Candidate&);
};

constexpr Predictor kPredictors[] = {
    {"targets", "epsilon of the targets",
     [](const Candidate& candidate) { return candidate.targets_epsilon; }},
    {"posture", "epsilon where the fingertips would be at the targets",
     [](const Candidate& candidate) { return candidate.posture_epsilon; }},
    {"reach", "how squarely the fingertips would be at the targets",
     [](const Candidate& candidate) { return -candidate.lean - candidate.miss / kMissPerRadian; }}};

std::vector<sweep::Column> own_settings() {
  return {{"reach_attempts", "1",
           "attempts whose random sets are looked at for the share of reachable targets, >= 0"}};
}

int reach_attempts_of(const sweep::Cell& cell) {
  const base::JsonValue attempts = sweep::setting(cell, "reach_attempts");
  if (attempts.small_integer() < 0) attempts.refuse("must be >= 0");
  return attempts.small_integer();
}

PlanningSettings settings_of(const sweep::Cell& cell) {
  PlanningSettings settings = planning_settings(cell, own_settings());
  const grasp::PlannerOptions& options = settings.options;
  if (!grasp::planning_methods().at(options.planner).has_targets) {
    throw sweep::SettingError("planner", "must be one whose hands are fitted to targets");
  }
  if (options.targets.search != grasp::TargetSearch::Random) {
    throw sweep::SettingError("target-search", "must be random: other sets are no sample");
  }
  if (options.target_draws < 2) {
    throw sweep::SettingError("target-draws", "must be at least 2: else not all have a posture");
  }
  if (options.kept != grasp::KeptCandidate::Strongest) {
    throw sweep::SettingError("keep", "must be strongest: else candidates are left out");
  }
  return settings;
}

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"object_extent_m", "m", "longest edge of the object's bounding box"},
      {"attempts", "1", "attempts made"},
      {"candidates", "1",
       "candidates fitted: of the sides drawn, those that the planner tries first"},
      {"valid", "1", "of these without penetration, every requested part in contact"},
      {"closed", "1", "of these force closed by contacts that touch, at option friction"},
      {"median_epsilon", "1",
       "median epsilon of the valid ones within the squeeze's cones, at most 0 without closure"}};
  for (const Predictor& predictor : kPredictors) {
    const std::string by = std::string("_by_") + predictor.name;
    const std::string meaning = predictor.meaning;
    all.push_back({"rank_correlation" + by, "1",
                   "of " + meaning + " with epsilon after refinement, over valid candidates"});
    all.push_back({"auc" + by, "1",
                   "how often " + meaning +
                       " is larger of a valid candidate that closes than of "
                       "one that does not"});
    all.push_back({"best_quarter_valid" + by, "1",
                   "share of valid ones in the quarter of candidates that is best in " + meaning});
    all.push_back({"best_quarter_closed" + by, "1", "share of closed ones in that quarter"});
  }
  all.push_back({"reach_sides", "1", "sides of random sets looked at"});
  all.push_back({"reach_square_share", "1",
                 "of these reached squarely: no fingertip (or palm) misses by more than 5 mm, none "
                 "leans by more than 15 degrees"});
  all.push_back({"reach_median_miss_m", "m", "median of the largest distance from a target"});
  all.push_back({"reach_median_lean_rad", "rad", "median of the largest lean of a pad"});
  return all;
}

std::vector<sweep::Column> details() {
  return {{"attempt", "1", "number of the attempt"},
          {"start", "1", "number of the candidate in its attempt"},
          {"outcome", "", "what became of it"},
          {"targets_epsilon", "1",
           "epsilon of the targets within the squeeze's cones, at most 0 without closure"},
          {"posture_epsilon", "1",
           "the same of the points of the surface nearest to the fingertips at the targets"},
          {"miss_m", "m", "largest distance of a fingertip (or the palm) there from its target"},
          {"lean_rad", "rad", "largest angle of a pad there with its target's surface"},
          {"closed", "1", "1: contacts that touch close, at option friction"},
          {"epsilon", "1", "of contacts that touch, within the squeeze's cones"},
          {"target_distance_m", "m", "mean distance of contacts from their targets"}};
}

/// How far fingertips are from their targets in a posture, and how much their pads lean there; the
/// largest of each.
struct PostureErrors {
  double miss = 0.0;  ///< [m]
  double lean = 0.0;  ///< [rad]
};

PostureErrors errors_of(const hands::HandModel& hand, const grasp::TargetContacts& targets,
                        const hands::HandConfiguration& posture) {
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(hand, posture);
  PostureErrors errors;
  for (const grasp::TargetContact& target : targets.contacts) {
    if (target.is_palm) {
      const Vector3d palm = posture.X_OH * hand.palm.center_H;
      errors.miss = std::max(errors.miss, (palm - target.point_O).norm());
      continue;
    }
    const int pad = grasp::pad_for(hand, target);
    const Vector3d point = hands::pad_contact_point(hand, pad, X_OL);
    const Vector3d normal = hands::pad_pose(hand, pad, X_OL).linear().col(2);
    errors.miss = std::max(errors.miss, (point - target.point_O).norm());
    errors.lean = std::max(errors.lean, geometry::angle_between(normal, -target.outward_normal_O));
  }
  return errors;
}

/// Contacts at the points of the surface nearest to the fingertips, and to the palm where it has a
/// target.
std::vector<contact::Contact> contacts_in(const hands::HandModel& hand,
                                          const geometry::MeshQuery& object,
                                          const grasp::TargetContacts& targets,
                                          const hands::HandConfiguration& posture) {
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(hand, posture);
  std::vector<contact::Contact> contacts = grasp::contacts_at(targets);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const grasp::TargetContact& target = targets.contacts[i];
    const Vector3d point = target.is_palm
                               ? Vector3d(posture.X_OH * hand.palm.center_H)
                               : hands::pad_contact_point(hand, grasp::pad_for(hand, target), X_OL);
    const geometry::ClosestPoint nearest = object.closest_point(point);
    contacts[i].point_O = nearest.point;
    contacts[i].inward_normal_O = -geometry::face_normal(object.mesh(), nearest.face);
  }
  return contacts;
}

/// Fills the columns of a predictor.
void fill_predictor(const Predictor& predictor, const std::vector<Candidate>& candidates,
                    sweep::ResultRow& row) {
  ScoredOutcomes strengths;
  ScoredOutcomes closures;
  for (const Candidate& candidate : candidates) {
    if (!candidate.is_valid) continue;
    strengths.scores.push_back(predictor.value(candidate));
    strengths.outcomes.push_back(candidate.epsilon);
    closures.scores.push_back(predictor.value(candidate));
    closures.outcomes.push_back(candidate.is_closed ? 1.0 : 0.0);
  }
  std::vector<Candidate> best = candidates;
  std::stable_sort(best.begin(), best.end(), [&](const Candidate& a, const Candidate& b) {
    return predictor.value(a) > predictor.value(b);
  });
  best.resize((best.size() + 3) / 4);
  const auto share = [&](bool Candidate::*is_so) -> sweep::Value {
    if (best.empty()) return {};
    const auto count = std::count_if(best.begin(), best.end(),
                                     [&](const Candidate& candidate) { return candidate.*is_so; });
    return static_cast<double>(count) / static_cast<double>(best.size());
  };
  const std::string by = std::string("_by_") + predictor.name;
  row.set("rank_correlation" + by, field(spearman(strengths)));
  row.set("auc" + by, field(auc(closures)));
  row.set("best_quarter_valid" + by, share(&Candidate::is_valid));
  row.set("best_quarter_closed" + by, share(&Candidate::is_closed));
}

void fill_reach(const Planned& planned, int num_attempts, sweep::ResultRow& row) {
  grasp::PlannerOptions options = planned.settings.options;
  options.max_placements = 1000;  // more than an attempt's sets have sides
  std::vector<double> misses;
  std::vector<double> leans;
  std::size_t num_square = 0;
  grasp::visit_starts(
      planned.object, *planned.hand, options, num_attempts, [&](const grasp::GuidedStart& start) {
        const PostureErrors errors = errors_of(*planned.hand, start.targets, *start.posture);
        misses.push_back(errors.miss);
        leans.push_back(errors.lean);
        if (errors.miss <= kSquareMiss && errors.lean <= kSquareLean) ++num_square;
      });
  row.set("reach_sides", field(misses.size()));
  if (!misses.empty()) {
    row.set("reach_square_share",
            static_cast<double>(num_square) / static_cast<double>(misses.size()));
  }
  row.set("reach_median_miss_m", field(median(misses)));
  row.set("reach_median_lean_rad", field(median(leans)));
}

/// Collects the candidates of a run and their rows.
class Collector {
 public:
  explicit Collector(const PlanningSettings& settings) : options_(settings.options) {}

  void add(const grasp::TriedStart& tried, const hands::HandModel& hand,
           const grasp::ObjectModel& object) {
    const contact::WrenchObject wrench_object =
        contact::wrench_object(object.mesh(), object.mass.center_of_mass);
    const auto epsilon = [&](const std::vector<contact::Contact>& contacts) {
      return contact::signed_epsilon(contacts, wrench_object, options_.squeeze_friction);
    };
    const grasp::GuidedStart& start = tried.start;
    Candidate candidate;
    candidate.targets_epsilon = epsilon(grasp::contacts_at(start.targets));
    candidate.posture_epsilon =
        epsilon(contacts_in(hand, object.query, start.targets, *start.posture));
    const PostureErrors errors = errors_of(hand, start.targets, *start.posture);
    candidate.miss = errors.miss;
    candidate.lean = errors.lean;
    sweep::ResultRow row(details());
    num_starts_ = tried.attempt == attempt_ ? num_starts_ + 1 : 0;
    attempt_ = tried.attempt;
    row.set("attempt", tried.attempt);
    row.set("start", num_starts_);
    row.set("outcome", std::string(grasp::outcome_name(tried.outcome)));
    row.set("targets_epsilon", candidate.targets_epsilon);
    row.set("posture_epsilon", candidate.posture_epsilon);
    row.set("miss_m", candidate.miss);
    row.set("lean_rad", candidate.lean);
    if (tried.grasp && tried.grasp->is_valid()) {
      candidate.is_valid = true;
      candidate.is_closed = tried.grasp->is_closed();
      candidate.epsilon =
          epsilon(contact::touching_contacts(tried.grasp->contacts, grasp::bearing_gap(options_)));
      row.set("closed", std::int64_t{candidate.is_closed ? 1 : 0});
      row.set("epsilon", candidate.epsilon);
      row.set("target_distance_m", field(mean(grasp::target_distances(*tried.grasp))));
    }
    candidates_.push_back(candidate);
    rows_.push_back(std::move(row));
  }

  const std::vector<Candidate>& candidates() const { return candidates_; }
  std::vector<sweep::ResultRow> take_rows() { return std::move(rows_); }

 private:
  const grasp::PlannerOptions& options_;
  std::vector<Candidate> candidates_;
  std::vector<sweep::ResultRow> rows_;
  std::optional<std::int64_t> attempt_;  // of the last candidate
  std::int64_t num_starts_ = 0;
};

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path&) {
  const PlanningSettings settings = settings_of(cell);
  Collector collector(settings);
  const Planned planned =
      plan(settings, [&](const grasp::TriedStart& tried, const hands::HandModel& hand,
                         const grasp::ObjectModel& object) { collector.add(tried, hand, object); });
  const std::vector<Candidate>& candidates = collector.candidates();
  std::vector<double> epsilons;
  std::size_t num_closed = 0;
  for (const Candidate& candidate : candidates) {
    if (!candidate.is_valid) continue;
    epsilons.push_back(candidate.epsilon);
    if (candidate.is_closed) ++num_closed;
  }
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(planning_timings())};
  result.row.set("object_extent_m", geometry::longest_extent(planned.object_file->mesh));
  result.row.set("attempts", planned.result.statistics.attempts);
  result.row.set("candidates", field(candidates.size()));
  result.row.set("valid", field(epsilons.size()));
  result.row.set("closed", field(num_closed));
  result.row.set("median_epsilon", field(median(epsilons)));
  for (const Predictor& predictor : kPredictors) fill_predictor(predictor, candidates, result.row);
  fill_reach(planned, reach_attempts_of(cell), result.row);
  fill_planning_timings(planned, result.timings);
  result.details = collector.take_rows();
  return result;
}

}  // namespace
}  // namespace candidate_prediction_parts

sweep::Experiment candidate_prediction() {
  using namespace candidate_prediction_parts;
  return {.slug = "candidate_prediction",
          .columns = columns(),
          .timings = planning_timings(),
          .settings = own_settings(),
          .details = details(),
          .check =
              [](const sweep::Cell& cell) {
                reach_attempts_of(cell);
                settings_of(cell);
              },
          .run = run,
          .inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); }};
}

}  // namespace graspfit::experiments::internal
