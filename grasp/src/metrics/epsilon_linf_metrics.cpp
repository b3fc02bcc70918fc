#include "graspfit/contact/epsilon_linf.hpp"
#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {

std::vector<GraspMetric> epsilon_linf_metrics() {
  return {{.name = "epsilon_linf",
           .group = "wrench space",
           .unit = "1",
           .meaning = "largest ball where each contact presses with at most 1 (L-infinity)",
           .better = BetterValue::Larger,
           .value = [](const GraspMetricInput& input) -> std::optional<double> {
             if (!input.convention()) return std::nullopt;
             return contact::epsilon_linf(input.touching(), *input.convention()).lower;
           },
           .convention = [](const GraspMetricInput& input) -> std::string {
             if (!input.convention()) return {};
             return contact::describe_linf(*input.convention()) + ", certified lower bound";
           }}};
}

}  // namespace graspfit::grasp::internal
