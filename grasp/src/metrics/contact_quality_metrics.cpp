#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {
namespace {

GraspMetric part_of_m(std::string name, std::string meaning,
                      double contact::ContactQuality::*part) {
  return {.name = std::move(name),
          .group = "the paper's measure",
          .unit = "1",
          .meaning = std::move(meaning),
          .better = BetterValue::Larger,
          .value = [part](const GraspMetricInput& input) -> std::optional<double> {
            const contact::ContactQuality* quality = input.quality();
            if (quality == nullptr) return std::nullopt;
            return quality->*part;
          },
          .convention = nullptr};
}

}  // namespace

std::vector<GraspMetric> contact_quality_metrics() {
  return {part_of_m("m", "the paper's measure M = M1^w1 M2^w2 M3^w3; 0: unusable",
                    &contact::ContactQuality::m),
          part_of_m("m1", "sustainability: mean of (d + alpha A) S over the contacts",
                    &contact::ContactQuality::m1),
          part_of_m("m2", "stability: sum of 1 - theta / theta_max over stable pairs",
                    &contact::ContactQuality::m2),
          part_of_m("m3", "form: regularity less beta times the centroid's distance",
                    &contact::ContactQuality::m3)};
}

}  // namespace graspfit::grasp::internal
