#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {
namespace {

GraspMetric of_penetration(std::string name, std::string unit, std::string meaning,
                           double (*value)(const GraspPenetration&)) {
  return {.name = std::move(name),
          .group = "penetration",
          .unit = std::move(unit),
          .meaning = std::move(meaning),
          .better = BetterValue::Smaller,
          .value = [value](const GraspMetricInput& input) -> std::optional<double> {
            if (input.facts().grasp == nullptr) return std::nullopt;
            return value(input.facts().grasp->penetration);
          },
          .convention = nullptr};
}

}  // namespace

std::vector<GraspMetric> penetration_metrics() {
  return {
      of_penetration("penetration", "m", "deepest overlap of hand and object found; true meshes",
                     [](const GraspPenetration& p) { return p.object_depth; }),
      of_penetration("penetration_bound", "m", "the true depth is at most this",
                     [](const GraspPenetration& p) { return p.object_depth_bound; }),
      of_penetration("self_penetration", "m", "deepest overlap of two links found; true meshes",
                     [](const GraspPenetration& p) { return p.self_depth; }),
      of_penetration("penetrates", "1",
                     "1: hand meets object, itself, table or obstacle, decided exactly; else 0",
                     [](const GraspPenetration& p) { return p.is_any() ? 1.0 : 0.0; })};
}

}  // namespace graspfit::grasp::internal
