#include "graspfit/grasp/pre_grasp.hpp"

#include <Eigen/Geometry>
#include <string>

#include "approach/pre_grasp_search.hpp"
#include "graspfit/base/option_check.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {

using hands::HandConfiguration;

namespace {

// Largest number of steps of a retreat that options may ask for; each step costs the distances of
// all links.
constexpr int kMostSteps = 1000;

}  // namespace

void PreGraspOptions::validate() const {
  internal::require_ranges("PreGraspOptions", *this, internal::pre_grasp_rows);
  base::require(largest_retreat / retreat_step <= kMostSteps, "PreGraspOptions", "retreat_step_m",
                retreat_step, "at least a thousandth of largest_retreat_m");
}

HandConfiguration interpolated(const HandConfiguration& from, const HandConfiguration& to,
                               double share) {
  base::require(from.q.size() == to.q.size(), "interpolated", "number of joint positions",
                static_cast<long>(to.q.size()),
                "that of the other configuration, " + std::to_string(from.q.size()));
  base::require(share >= 0.0 && share <= 1.0, "interpolated", "share", share, "in [0, 1]");
  if (share == 0.0) return from;
  if (share == 1.0) return to;
  HandConfiguration result;
  result.q = (1.0 - share) * from.q + share * to.q;
  result.X_OH = from.X_OH;
  if (from.X_OH.linear() != to.X_OH.linear()) {
    const Eigen::Quaterniond start(from.X_OH.linear());
    const Eigen::Quaterniond end(to.X_OH.linear());
    result.X_OH.linear() = start.slerp(share, end).normalized().toRotationMatrix();
  }
  result.X_OH.translation() =
      (1.0 - share) * from.X_OH.translation() + share * to.X_OH.translation();
  return result;
}

std::optional<PreGrasp> find_pre_grasp(const PreGraspScene& scene, const HandConfiguration& grasp,
                                       const PreGraspOptions& options) {
  options.validate();
  hands::validate(scene.hand, grasp);
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(scene.hand, grasp);
  return find_pre_grasp(scene, hands::PosedConfiguration{grasp, X_OL}, options);
}

std::optional<PreGrasp> find_pre_grasp(const PreGraspScene& scene,
                                       const hands::PosedConfiguration& grasp,
                                       const PreGraspOptions& options) {
  options.validate();
  hands::validate(scene.hand, grasp.configuration);
  base::require(grasp.X_OL.size() == scene.hand.links.size(), "find_pre_grasp",
                "number of link poses", grasp.X_OL.size(),
                "one per link of hand " + scene.hand.name);
  return internal::PreGraspSearch(scene, grasp, options).find();
}

}  // namespace graspfit::grasp
