#include "graspfit/grasp/grasp_diversity.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/option_check.hpp"

namespace graspfit::grasp {
namespace {

using Configurations = std::span<const hands::HandConfiguration>;

/// A grasp as a point, with the coordinates that `grasp_diversity` describes.
Eigen::VectorXd point_of(const hands::HandModel& hand, const hands::HandConfiguration& grasp,
                         const DistinctOptions& options) {
  Eigen::VectorXd point = Eigen::VectorXd::Zero(12 + grasp.q.size());
  point.head(3) = grasp.X_OH * hand.palm.center_H / options.translation;
  // Two rotations by an angle apart differ by 2 √2 sin(angle / 2) in the Frobenius norm.
  point.segment(3, 9) = grasp.X_OH.linear().reshaped() / (std::numbers::sqrt2 * options.rotation);
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.coupling) continue;
    const double scale = joint.type == hands::JointType::Prismatic ? options.slide_scale : 1.0;
    point[12 + j] = grasp.q[j] / (options.joints * scale);
  }
  return point;
}

}  // namespace

GraspDiversity grasp_diversity(const hands::HandModel& hand, Configurations configurations,
                               const DistinctOptions& options) {
  options.validate();
  for (const auto& [field, value] :
       {std::pair("translation", options.translation), std::pair("rotation", options.rotation),
        std::pair("joints", options.joints)}) {
    base::require(value > 0.0, "grasp_diversity", field, value, "positive");
  }
  GraspDiversity diversity;
  diversity.num_grasps = diversity.num_clusters = base::as_index<int>(configurations.size());
  if (configurations.empty()) return diversity;
  configuration_distance(hand, configurations[0], configurations[0], options.slide_scale);
  base::DisjointSets clusters(configurations.size());
  for (std::int32_t i = 1; i < std::ssize(configurations); ++i) {
    for (std::int32_t j = 0; j < i; ++j) {
      if (!are_distinct(hand, configurations[i], configurations[j], options) &&
          clusters.unite(i, j)) {
        --diversity.num_clusters;
      }
    }
  }
  Eigen::MatrixXd points(12 + configurations[0].q.size(), configurations.size());
  for (int i = 0; i < std::ssize(configurations); ++i) {
    points.col(i) = point_of(hand, configurations[i], options);
  }
  const Eigen::MatrixXd centered = points.colwise() - points.rowwise().mean();
  const Eigen::VectorXd spread = Eigen::JacobiSVD<Eigen::MatrixXd>(centered).singularValues();
  // What rounding of the mean leaves of equal grasps is no spread.
  if (spread[0] > 1e-12 * points.cwiseAbs().maxCoeff()) {
    diversity.first_axis_share = spread[0] * spread[0] / spread.squaredNorm();
  }
  return diversity;
}

}  // namespace graspfit::grasp
