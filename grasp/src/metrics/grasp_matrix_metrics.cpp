#include "graspfit/base/number_text.hpp"
#include "graspfit/contact/grasp_matrix_quality.hpp"
#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {
namespace {

std::string scaling_of(const GraspMetricInput& input) {
  if (!input.convention()) return {};
  const auto number = [](double value) { return base::shortest_decimal(value); };
  const Eigen::Vector3d& c = input.convention()->reference_point_O;
  return "forces along unit axes, torques about (" + number(c.x()) + ", " + number(c.y()) + ", " +
         number(c.z()) + ") m over " + number(*input.convention()->options.torque_scale) + " m";
}

GraspMetric of_matrix(std::string name, std::string meaning,
                      double (contact::GraspMatrixQuality::*value)() const) {
  return {.name = std::move(name),
          .group = "grasp matrix",
          .unit = "1",
          .meaning = std::move(meaning),
          .better = BetterValue::Larger,
          .value = [value](const GraspMetricInput& input) -> std::optional<double> {
            if (!input.convention()) return std::nullopt;
            const contact::WrenchConvention& convention = *input.convention();
            return (contact::grasp_matrix_quality(input.touching(), convention.reference_point_O,
                                                  *convention.options.torque_scale).*
                    value)();
          },
          .convention = scaling_of};
}

}  // namespace

std::vector<GraspMetric> grasp_matrix_metrics() {
  return {of_matrix("sigma_min", "smallest of the six singular values of the grasp matrix",
                    &contact::GraspMatrixQuality::smallest),
          of_matrix("sigma_product", "product of the six singular values",
                    &contact::GraspMatrixQuality::product),
          of_matrix("sigma_ratio", "smallest over largest singular value, isotropy",
                    &contact::GraspMatrixQuality::ratio)};
}

}  // namespace graspfit::grasp::internal
