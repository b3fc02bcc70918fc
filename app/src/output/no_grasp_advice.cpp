#include "output/no_grasp_advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/base/number_text.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/geometry/likely_rest_pose.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::app {
namespace {

using grasp::AttemptOutcome;

/// Of a rest pose that is worth a try.
constexpr double kLikely = 0.01;
/// An object that much higher is another one to a hand.
constexpr double kMuchHigher = 1.2;
/// A clearance to the table that takes less of an object's height stops no finger.
constexpr double kNoticed = 0.05;
/// Fewer attempts than these say little.
constexpr int kManyAttempts = 50;

/// A length as text for people, to a tenth of a millimeter.
std::string in_millimeters(double meters) {
  return base::plain_decimal(std::round(meters * 1e4) / 10.0);
}

std::string degrees_text(double radians) {
  return base::plain_decimal(std::round(base::kDegreesPerRadian * radians));
}

/// "the table and the obstacles", of those that there are.
std::string surroundings_text(const grasp::Surroundings& surroundings) {
  const std::string table = surroundings.table_z_O ? "the table" : "";
  if (surroundings.obstacles.empty()) return table;
  return table + (table.empty() ? "" : " and ") + "the obstacles";
}

/// The outcome of most attempts, with their number.
std::pair<AttemptOutcome, std::int64_t> most_frequent(const grasp::PlannerStatistics& statistics) {
  const auto most =
      std::max_element(statistics.outcomes.begin(), statistics.outcomes.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == statistics.outcomes.end()) return {AttemptOutcome::Valid, 0};
  return *most;
}

std::string main_target_failure(const grasp::PlannerStatistics& statistics) {
  const auto& failures = statistics.target_failures;
  const auto most =
      std::max_element(failures.begin(), failures.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == failures.end() || most->second == 0 ? "" : most->first;
}

/// The reach of the fingertips and the object's size: "these get 12 to 90 mm apart, and the object
/// is 60 x 60 x 60 mm".
std::string sizes_text(const geometry::TriangleMesh& object, const hands::HandModel& hand,
                       const grasp::PlannerOptions& options) {
  const grasp::RequestedParts parts = grasp::requested_parts(hand, options);
  const grasp::PartDistances distances = grasp::part_distances(hand, parts);
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (const int a : parts.fingers) {
    for (const int b : parts.fingers) {
      if (a == b) continue;
      const hands::DistanceRange& range = distances.tip_to_tip.at(a).at(b);
      nearest = std::min(nearest, range.smallest);
      farthest = std::max(farthest, range.largest);
    }
  }
  const Eigen::Vector3d size = geometry::bounding_box(object).sizes();
  return "these get " + in_millimeters(nearest) + " to " + in_millimeters(farthest) +
         " mm apart, and the object is " + in_millimeters(size.x()) + " x " +
         in_millimeters(size.y()) + " x " + in_millimeters(size.z()) + " mm";
}

/// Collects what would help, a piece for each flag that can still be changed.
class Remedies {
 public:
  explicit Remedies(const RunWithoutGrasps& run)
      : run_(run),
        options_(run.options),
        around_(run.surroundings),
        parts_(grasp::requested_parts(run.hand.model, run.options)) {}

  Remedies& add(const std::string& remedy) {
    remedies_.push_back(remedy);
    return *this;
  }

  Remedies& fewer_parts() {
    const std::size_t fewest = parts_.palm ? 1 : 2;
    if (parts_.fingers.size() > fewest) {
      add(options_.fingers.empty()
              ? "fewer --contacts (now " + std::to_string(parts_.fingers.size()) + ")"
              : "fewer --fingers");
    }
    if (parts_.palm && parts_.fingers.size() > 1) add("--no-palm");
    return *this;
  }

  Remedies& other_style() {
    if (options_.planner != grasp::PlannerOptions{}.planner) return *this;
    if (options_.targets.search != grasp::TargetSearch::Reach) {
      if (!run_.is_reach_tried) add("--preset strong (targets where the hand can reach)");
    } else if (options_.style != grasp::GraspStyle::Auto) {
      add("--style auto");
    }
    return *this;
  }

  Remedies& other_approach() {
    if (!options_.approach_O) {
      if (around_.table_z_O) add("--approach 0,0,-1 (from above)");
    } else if (options_.approach_angle < std::numbers::pi) {
      add("a wider --approach-angle-deg (now " + degrees_text(options_.approach_angle) + ")");
    }
    return *this;
  }

  Remedies& other_rest_pose() {
    if (!run_.is_in_one_rest_pose) return *this;
    const std::vector<geometry::LikelyRestPose> poses = geometry::likely_rest_poses(
        run_.object_O, geometry::mass_properties(run_.object_O).center_of_mass);
    double highest = kMuchHigher * height();
    std::size_t rank = 0;
    for (std::size_t i = 0; i < poses.size() && poses[i].probability >= kLikely; ++i) {
      const double above = extent_along(poses[i].pose.up_O);
      if (above > highest) {
        highest = above;
        rank = i + 1;
      }
    }
    if (rank > 0) {
      add("--rest-pose " + std::to_string(rank) + " (the object is then " +
          in_millimeters(highest) + " mm high, not " + in_millimeters(height()) + ")");
    }
    return *this;
  }

  /// Where the object is lower than the fingers that go beside it are thick.
  Remedies& raised_object() {
    if (!around_.table_z_O) return *this;
    const auto [thinnest, thickest] = fingertip_thickness();
    if (height() >= thickest + around_.table_clearance) return *this;
    const std::string thickness = in_millimeters(thinnest);
    return add("the object raised or tilted (it is " + in_millimeters(height()) +
               " mm high, and the fingertips are " + thickness +
               (thinnest < thickest ? " to " + in_millimeters(thickest) : "") + " mm thick)");
  }

  Remedies& less_clearance() {
    const double clearance = around_.table_clearance;
    if (around_.table_z_O && clearance > 0.0 && clearance >= kNoticed * height()) {
      add("a smaller --table-clearance-mm (now " + in_millimeters(clearance) + ")");
    }
    return *this;
  }

  Remedies& more_room() {
    if (!around_.obstacles.empty()) add("more room to the obstacles");
    return *this;
  }

  Remedies& lower_scores() {
    if (options_.targets.score_threshold > 0.0) {
      add("a lower --score-threshold (now " +
          base::plain_decimal(options_.targets.score_threshold) + ")");
    }
    return *this;
  }

  Remedies& more_attempts() {
    const bool is_limited = run_.result.stop == grasp::PlannerStop::Attempts;
    if (is_limited && options_.max_attempts < kManyAttempts) {
      add("more --max-attempts (now " + std::to_string(options_.max_attempts) + ")");
    }
    return *this;
  }

  /// "a, b or another --hand".
  std::string text() const {
    std::string text;
    for (const std::string& remedy : remedies_) text += remedy + ", ";
    if (!text.empty()) text.replace(text.size() - 2, 2, " or ");
    return text + "another --hand";
  }

 private:
  double extent_along(const Eigen::Vector3d& direction_O) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& vertex : run_.object_O.vertices) {
      low = std::min(low, vertex.dot(direction_O));
      high = std::max(high, vertex.dot(direction_O));
    }
    return high - low;
  }

  /// Of the object over the table [m].
  double height() const {
    return geometry::bounding_box(run_.object_O).max().z() - *around_.table_z_O;
  }

  /// The smallest extents of the links with the requested fingertips, the least and the largest of
  /// them [m].
  std::pair<double, double> fingertip_thickness() const {
    const hands::HandModel& hand = run_.hand.model;
    std::pair<double, double> range = {std::numeric_limits<double>::infinity(), 0.0};
    for (const int finger : parts_.fingers) {
      const std::optional<int>& pad = hand.fingers[finger].tip_pad;
      if (!pad) continue;
      const Eigen::Vector3d size =
          geometry::bounding_box(hand.links[hand.pads[*pad].link].mesh_L).sizes();
      range.first = std::min(range.first, size.minCoeff());
      range.second = std::max(range.second, size.minCoeff());
    }
    return range;
  }

  const RunWithoutGrasps& run_;
  const grasp::PlannerOptions& options_;
  const grasp::Surroundings& around_;
  grasp::RequestedParts parts_;
  std::vector<std::string> remedies_;
};

/// Why there were no targets, and what would help.
std::string target_advice(const std::string& failure, const RunWithoutGrasps& run) {
  const grasp::PlannerOptions& options = run.options;
  const auto sizes = [&] { return sizes_text(run.object_O, run.hand.model, options); };
  if (failure == "no seed" && run.surroundings.table_z_O) {
    Remedies remedies(run);
    remedies.other_rest_pose().raised_object().less_clearance().lower_scores();
    return "no place of the object has a contact score above the threshold where a pad gets above "
           "the table: " +
           remedies.add("a higher --resolution").text();
  }
  if (failure == "no seed") {
    return "no place of the object has a contact score above the threshold: lower "
           "--score-threshold, or raise --resolution (graspfit inspect shows the scores)";
  }
  if (failure == "no second") {
    return "no two places of the object face each other within the fingertips' reach: " + sizes() +
           "; --mesh-unit or --longest gives the object another size, a lower --score-threshold "
           "or a larger --theta-max-deg more places to choose from";
  }
  if (failure == "no further" && options.targets.search == grasp::TargetSearch::Reach) {
    const std::string around = surroundings_text(run.surroundings);
    Remedies remedies(run);
    remedies.fewer_parts().other_style().lower_scores().other_rest_pose().raised_object();
    if (options.approach_O) remedies.other_approach();
    remedies.less_clearance().more_room().more_attempts();
    return "no posture was found in which the hand's pads lie on places of the object, links stay "
           "out of it" +
           (around.empty() ? "" : " and clear of " + around) +
           " and the palm comes from where it may: " + sizes() + "; " + remedies.text();
  }
  if (failure == "no further") {
    return "two places are found, but none for a further finger beside them: fewer --contacts, or "
           "a larger --edge-tolerance or --centroid-limit";
  }
  if (failure == "no palm") {
    return "places for the fingers are found, but none for the palm between them: --no-palm, "
           "--style precision, or a larger --palm-reach-tolerance-mm";
  }
  return "";
}

/// What ended attempts that had targets, and what would help; empty if nothing does.
std::string outcome_advice(AttemptOutcome outcome, const RunWithoutGrasps& run) {
  const grasp::PlannerOptions& options = run.options;
  const std::string around = surroundings_text(run.surroundings);
  Remedies remedies(run);
  std::string what;
  switch (outcome) {
    case AttemptOutcome::Valid:
    case AttemptOutcome::NoTargets:
      return "";
    case AttemptOutcome::InitialCollision:
      what = "the open hand meets the object or " + around + " from every side";
      remedies.other_approach().other_style().other_rest_pose().raised_object();
      remedies.less_clearance().more_room();
      break;
    case AttemptOutcome::BlockedFinger:
      what = "a finger is stopped by the object or " + around + " before its pad touches";
      remedies.fewer_parts().other_style().other_rest_pose().raised_object();
      remedies.less_clearance().more_room();
      break;
    case AttemptOutcome::MissedContact:
      what = "a finger closes past the object";
      remedies.fewer_parts().other_style().other_rest_pose().raised_object();
      break;
    case AttemptOutcome::GapLeft:
      what = "not all pads come to touch while links stay clear of " + around;
      remedies.fewer_parts().other_style().other_rest_pose().raised_object();
      remedies.less_clearance().more_room();
      break;
    case AttemptOutcome::SelfCollision:
      what = "fingers run into one another, as they do on what is narrow";
      remedies.fewer_parts().other_style();
      if (!options.fitting.guard_self) remedies.add("--guard-self yes");
      remedies.other_rest_pose();
      break;
    case AttemptOutcome::NoWayIn:
      what = "no straight way in is free of " + around;
      remedies.other_approach().other_rest_pose();
      remedies.add("a smaller --pre-grasp-clearance-mm (now " +
                   in_millimeters(options.pre_grasp.clearance) + ")");
      remedies.less_clearance().more_room().fewer_parts();
      remedies.add("--pre-grasps no (asks for no way in)");
      break;
    case AttemptOutcome::UsableOnly:
      what = "grasps are usable but not valid";
      if (options.approach_O) remedies.other_approach();
      if (options.contact_score_threshold.value_or(0.0) > 0.0) {
        remedies.add("a lower --contact-score-threshold");
      }
      remedies.fewer_parts().add("--accept usable");
      break;
    case AttemptOutcome::Rejected:
      what = "grasps are not as --reject wants them";
      remedies.add("--reject none").other_style();
      break;
    case AttemptOutcome::IterationLimit:
      what = "the hand does not come to rest at its targets";
      remedies.fewer_parts().other_style();
      break;
    case AttemptOutcome::Weak:
      what = "all contacts are on fragile features";
      remedies.add("--no-weak").other_rest_pose();
      break;
    case AttemptOutcome::Unstable:
      what = "no two contacts face each other";
      remedies.other_style().other_rest_pose().add("a larger --theta-max-deg");
      break;
    case AttemptOutcome::PoorShape:
      what = "contacts do not surround the object's center of mass";
      remedies.other_style().other_rest_pose();
      break;
  }
  return what + ": " + remedies.more_attempts().text();
}

}  // namespace

std::string no_grasp_advice(const RunWithoutGrasps& run) {
  const grasp::PlannerStatistics& statistics = run.result.statistics;
  const auto [outcome, count] = most_frequent(statistics);
  std::string advice;
  if (outcome == AttemptOutcome::NoTargets) {
    advice = target_advice(main_target_failure(statistics), run);
  } else if (!run.surroundings.is_empty()) {
    advice = outcome_advice(outcome, run);
  }
  if (!advice.empty() && !run.surroundings.is_empty()) {
    advice = std::to_string(count) + " of " + std::to_string(statistics.attempts) +
             " attempts: " + advice;
  }
  const bool is_suspicious = std::any_of(
      run.hand.findings.begin(), run.hand.findings.end(),
      [](const auto& finding) { return finding.kind == hands::FindingKind::Suspicious; });
  if (is_suspicious) {
    advice += std::string(advice.empty() ? "" : "; ") +
              "what is suspicious about the hand, above, may be why";
  }
  return advice;
}

}  // namespace graspfit::app
