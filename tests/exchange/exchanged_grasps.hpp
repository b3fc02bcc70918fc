#pragma once

#include <Eigen/Geometry>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/temporary_folder.hpp"

namespace graspfit::testing {

/// Returns a grasp file of `count` random configurations of a hand around a box, couplings kept;
/// nothing is measured. In every second one the joints of a clutch have gone on closing.
inline grasp::GraspFile random_grasps(const hands::HandModel& hand, const TemporaryFolder& folder,
                                      int count) {
  const std::filesystem::path object = folder.path() / "a box.off";
  geometry::write_mesh(object, geometry::box({0.04, 0.02, 0.03}));
  grasp::GraspFile file;
  file.object = grasp::read_object_file(object).record;
  file.hand = hand;
  base::Random random(7);
  for (int i = 0; i < count; ++i) {
    grasp::Grasp grasp;
    hands::HandConfiguration& configuration = grasp.configuration;
    configuration.q.resize(static_cast<Eigen::Index>(hand.joints.size()));
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      const hands::Joint& joint = hand.joints[j];
      const bool stays = i % 2 == 0 && joint.coupling.has_value();
      const double open = joint.closing_sign > 0 ? joint.lower : joint.upper;
      configuration.q[static_cast<Eigen::Index>(j)] =
          stays ? open : random.uniform(joint.lower, joint.upper);
    }
    hands::apply_couplings(hand, configuration.q);
    const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    configuration.X_OH =
        Eigen::Translation3d(random.uniform(-0.2, 0.2), 1e-17 * random.uniform(1, 9), 0.0) *
        Eigen::AngleAxisd(random.uniform(-3.14, 3.14), axis.normalized());
    grasp.quality.m = random.uniform(0, 3);
    if (i % 3 == 0) {
      grasp.pre_grasp = grasp::PreGrasp{configuration, 0.01, 0.5, 0.0};
      hands::HandConfiguration open = hands::open_configuration(hand);
      grasp.pre_grasp->configuration.q = open.q;
    }
    file.grasps.push_back(grasp);
  }
  return file;
}

}  // namespace graspfit::testing
