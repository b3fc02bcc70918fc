#include "graspfit/contact/min_weight.hpp"
#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {

std::vector<GraspMetric> min_weight_metrics() {
  return {{.name = "min_weight",
           .group = "wrench space",
           .unit = "1",
           .meaning = "edges times l*, the least weight of an even balance; > 0: closure (rank 6)",
           .better = BetterValue::Larger,
           .value = [](const GraspMetricInput& input) -> std::optional<double> {
             if (!input.convention()) return std::nullopt;
             const contact::MinWeight found = contact::min_weight(
                 contact::contact_wrenches(input.touching(), *input.convention()));
             if (found.rank < 6 || !found.weight) return std::nullopt;
             return found.normalized;
           },
           .convention = describe_convention}};
}

}  // namespace graspfit::grasp::internal
