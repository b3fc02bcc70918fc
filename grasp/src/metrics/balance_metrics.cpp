#include "graspfit/contact/grasp_balance.hpp"
#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {

std::vector<GraspMetric> balance_metrics() {
  return {{.name = "balance_residual",
           .group = "wrench space",
           .unit = "1",
           .meaning = "smallest wrench left by contact forces with normal parts of 1 in all",
           .better = BetterValue::Smaller,
           .value = [](const GraspMetricInput& input) -> std::optional<double> {
             if (!input.convention()) return std::nullopt;
             const contact::WrenchConvention& convention = *input.convention();
             return contact::balance_forces(input.touching(), convention.reference_point_O,
                                            contact::Wrench::Zero(),
                                            {.num_cone_edges = convention.options.num_cone_edges,
                                             .friction = convention.options.friction,
                                             .least_normal_sum = 1.0,
                                             .torque_scale = convention.options.torque_scale})
                 .residual_norm;
           },
           .convention = describe_convention}};
}

}  // namespace graspfit::grasp::internal
