#include "graspfit/base/number_text.hpp"
#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {
namespace {

using Value = std::optional<double>;

std::string noise_of(const GraspMetricInput& input) {
  const auto number = [](double value) { return base::shortest_decimal(value); };
  const PoseRobustnessOptions options;
  return std::to_string(options.num_samples) + " poses, seed " + std::to_string(options.seed) +
         ", Gaussian: " + number(options.translation_deviation) + " m and " +
         number(options.rotation_deviation) + " rad per axis, pads move up to " +
         number(options.reach) + " m along their contact's normal; " + describe_convention(input);
}

GraspMetric of_robustness(std::string name, std::string meaning,
                          Value (*value)(const PoseRobustness&)) {
  return {.name = std::move(name),
          .group = "pose robustness",
          .unit = "1",
          .meaning = std::move(meaning),
          .better = BetterValue::Larger,
          .value = [value](const GraspMetricInput& input) -> Value {
            const PoseRobustness* found = input.robustness();
            if (found == nullptr) return std::nullopt;
            return value(*found);
          },
          .convention = noise_of};
}

}  // namespace

std::vector<GraspMetric> pose_robustness_metrics() {
  return {of_robustness("robust_usable_share", "share of poses off by noise that keep M > 0",
                        [](const PoseRobustness& found) { return found.usable_share; }),
          of_robustness("robust_closed_share", "share of poses off by noise with force closure",
                        [](const PoseRobustness& found) -> Value { return found.closed_share; }),
          of_robustness("robust_epsilon", "mean epsilon over poses off by noise, 0 where open",
                        [](const PoseRobustness& found) -> Value { return found.mean_epsilon; })};
}

}  // namespace graspfit::grasp::internal
