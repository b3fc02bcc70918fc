#include <cstdio>

#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/hand_library.hpp"

int main() {
  using namespace graspfit;
  const geometry::TriangleMesh ring = geometry::torus(0.05, 0.02);  // meters
  const hands::HandModel hand = hands::find_hand("barrett");
  const grasp::PlannerOptions options{.count = 3, .seed = 1};

  const grasp::ObjectModel object = grasp::prepare_object(ring, hand, options);
  const grasp::PlannerResult result = grasp::plan_grasps(object, hand, options);
  for (const grasp::Grasp& grasp : result.grasps) {
    const Eigen::Vector3d palm_O = grasp.configuration.X_OH.translation();
    std::printf("M = %.3f  %zu contacts  palm at (%.3f, %.3f, %.3f) m\n", grasp.quality.m,
                grasp.contacts.size(), palm_O.x(), palm_O.y(), palm_O.z());
  }
  return result.grasps.empty() ? 1 : 0;
}
