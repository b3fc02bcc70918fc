#include "approach/checked_pre_grasp.hpp"

#include "approach/pre_grasp_search.hpp"

namespace graspfit::grasp::internal {

std::optional<PreGrasp> checked_pre_grasp(const PreGraspScene& scene,
                                          const hands::HandConfiguration& start,
                                          const hands::HandConfiguration& grasp,
                                          const PreGraspOptions& options) {
  options.validate();
  hands::validate(scene.hand, start);
  hands::validate(scene.hand, grasp);
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(scene.hand, grasp);
  return PreGraspSearch(scene, {grasp, X_OL}, options).checked(start);
}

}  // namespace graspfit::grasp::internal
