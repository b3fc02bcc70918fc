#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {
namespace {

using Value = std::optional<double>;

/// A metric of the hull of all cone edges' wrenches.
GraspMetric of_space(std::string name, std::string meaning,
                     double (*value)(const contact::GraspWrenchSpace&)) {
  return {.name = std::move(name),
          .group = "wrench space",
          .unit = "1",
          .meaning = std::move(meaning),
          .better = BetterValue::Larger,
          .value = [value](const GraspMetricInput& input) -> Value {
            const contact::GraspWrenchSpace* space = input.wrench_space();
            if (space == nullptr) return std::nullopt;
            return value(*space);
          },
          .convention = describe_convention};
}

std::optional<contact::WrenchConvention> graspit_convention(const GraspMetricInput& input) {
  if (input.touching().empty()) return std::nullopt;
  return contact::wrench_convention(contact::WrenchTool::GraspIt, input.facts().object,
                                    input.touching(), input.facts().friction);
}

}  // namespace

std::vector<GraspMetric> wrench_space_metrics() {
  std::vector<GraspMetric> metrics = {
      of_space("epsilon", "radius of the largest ball around 0 in the wrench space (L1)",
               contact::epsilon_quality),
      of_space("volume", "6-volume of the wrench space (L1)",
               [](const contact::GraspWrenchSpace& space) { return space.hull.volume(); }),
      of_space("force_closure", "1: 0 is strictly within the wrench space, decided exactly; else 0",
               [](const contact::GraspWrenchSpace& space) {
                 return contact::is_force_closure(space) ? 1.0 : 0.0;
               }),
      of_space("wrench_rank", "dimension of the wrench space, 6 for closure; exact",
               [](const contact::GraspWrenchSpace& space) {
                 return static_cast<double>(space.hull.rank());
               })};
  metrics.push_back({.name = "epsilon_graspit",
                     .group = "wrench space",
                     .unit = "1",
                     .meaning = "the same radius in GraspIt!'s convention; -1 without closure",
                     .better = BetterValue::Larger,
                     .value = [](const GraspMetricInput& input) -> Value {
                       const std::optional<contact::WrenchConvention> convention =
                           graspit_convention(input);
                       if (!convention) return std::nullopt;
                       return contact::epsilon_quality(
                           contact::grasp_wrench_space(input.touching(), *convention));
                     },
                     .convention =
                         [](const GraspMetricInput& input) {
                           const std::optional<contact::WrenchConvention> convention =
                               graspit_convention(input);
                           return convention ? contact::describe(*convention) : std::string();
                         }});
  return metrics;
}

}  // namespace graspfit::grasp::internal
