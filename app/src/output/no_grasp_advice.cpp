#include "output/no_grasp_advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graspfit/base/number_range.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::app {
namespace {

using grasp::AttemptOutcome;

/// A length as text for people, to a tenth of a millimeter.
std::string in_millimeters(double meters) {
  return base::plain_decimal(std::round(meters * 1e4) / 10.0);
}

/// The outcome of most attempts.
AttemptOutcome most_frequent(const grasp::PlannerStatistics& statistics) {
  const auto most =
      std::max_element(statistics.outcomes.begin(), statistics.outcomes.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == statistics.outcomes.end() ? AttemptOutcome::Valid : most->first;
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

std::string target_advice(const std::string& failure, const geometry::TriangleMesh& object,
                          const hands::HandModel& hand, const grasp::PlannerOptions& options) {
  if (failure == "no seed") {
    return "no place of the object has a contact score above the threshold: lower "
           "--score-threshold, or raise --resolution (graspfit inspect shows the scores)";
  }
  if (failure == "no second") {
    return "no two places of the object face each other within the fingertips' reach: " +
           sizes_text(object, hand, options) +
           "; --mesh-unit or --longest gives the object another size, a lower --score-threshold "
           "or a larger --theta-max-deg more places to choose from";
  }
  if (failure == "no further" && options.targets.search == grasp::TargetSearch::Reach) {
    return "no posture was found in which the hand's pads lie on places of the object, links "
           "stay out of it and the palm comes from where it may: " +
           sizes_text(object, hand, options) +
           "; more --max-attempts, --style auto, a wider --approach-angle-deg or a lower "
           "--score-threshold";
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

}  // namespace

std::string no_grasp_advice(const grasp::PlannerResult& result,
                            const grasp::PlannerOptions& options,
                            const geometry::TriangleMesh& object, const hands::HandReading& hand) {
  std::string advice;
  if (most_frequent(result.statistics) == AttemptOutcome::NoTargets) {
    advice = target_advice(main_target_failure(result.statistics), object, hand.model, options);
  }
  const bool is_suspicious = std::any_of(
      hand.findings.begin(), hand.findings.end(),
      [](const auto& finding) { return finding.kind == hands::FindingKind::Suspicious; });
  if (is_suspicious) {
    advice += std::string(advice.empty() ? "" : "; ") +
              "what is suspicious about the hand, above, may be why";
  }
  return advice;
}

}  // namespace graspfit::app
