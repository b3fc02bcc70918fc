#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "scene/hand_motion.hpp"
#include "support/catch.hpp"

namespace test_hand_motion {

using namespace graspfit;
using Breakaway = grasp::internal::MotionEntries::Breakaway;
using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;
using grasp::internal::HandMotion;
using grasp::internal::MotionEntries;
using hands::RigidTransform;

namespace {

/// A configuration in the middle of the joints' ranges; breakaway joints are at their couplings, or
/// beyond them.
hands::HandConfiguration half_closed(const hands::HandModel& hand, double beyond) {
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (!joint.coupling)
      configuration.q[static_cast<Index>(j)] = 0.6 * joint.lower + 0.4 * joint.upper;
  }
  hands::apply_couplings(hand, configuration.q);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.coupling && joint.coupling->breakaway) {
      configuration.q[static_cast<Index>(j)] += joint.closing_sign * beyond;
    }
  }
  configuration.X_OH = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
  configuration.X_OH.translation() = Vector3d(0.1, -0.2, 0.05);
  return configuration;
}

}  // namespace

TEST_CASE("Rows of a hand's motion are what a small motion does", "[grasp][hand_motion]") {
  for (const char* name : {"barrett", "human_hand", "parallel_gripper"}) {
    for (const Breakaway breakaway : {Breakaway::Alone, Breakaway::Beyond}) {
      CAPTURE(name, breakaway == Breakaway::Beyond);
      const hands::HandModel hand = hands::find_hand(name);
      const MotionEntries entries(hand, true, true, breakaway);
      const hands::HandConfiguration from = half_closed(hand, 0.1);
      const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, from);
      const HandMotion motion(entries, from, X_OL, Vector3d(0.1, 0.0, 0.1));
      base::Random random(7);
      for (int trial = 0; trial < 20; ++trial) {
        VectorXd small(motion.size());
        for (double& x : small) x = 1e-6 * random.uniform(-1.0, 1.0);
        const std::vector<RigidTransform> moved =
            hands::forward_kinematics(hand, motion.moved(small));
        const auto link = static_cast<int>(random.index(hand.links.size()));
        const Vector3d point_L(0.01, 0.02, -0.01);
        const Vector3d direction = Vector3d(1, -1, 0.5).normalized();
        const auto number = static_cast<std::size_t>(link);
        const double way =
            direction.dot(Vector3d(moved[number] * point_L) - Vector3d(X_OL[number] * point_L));
        CHECK(std::abs(motion.row(link, X_OL[number] * point_L, direction) * small - way) < 1e-10);
        const Eigen::AngleAxisd turn(
            Eigen::Matrix3d(moved[number].linear() * X_OL[number].linear().transpose()));
        CHECK(std::abs(motion.turn_row(link, direction) * small -
                       turn.angle() * turn.axis().dot(direction)) < 1e-9);
      }
    }
  }
}

TEST_CASE("A breakaway joint whose entry is what it moves beyond its coupling follows its leader",
          "[grasp][hand_motion]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const MotionEntries entries(hand, true, true, Breakaway::Beyond);
  const hands::HandConfiguration from = half_closed(hand, 0.0);
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, from);
  const HandMotion motion(entries, from, X_OL, Vector3d::Zero());
  // Whatever a motion within its bounds is, no joint is set back onto its coupling afterwards: it
  // ends where the rows say.
  const HandMotion::Bounds bounds = motion.bounds(0.01);
  base::Random random(3);
  int num_breakaway = 0;
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd step(motion.size());
    for (Index i = 0; i < step.size(); ++i) {
      step[i] = bounds.lower[i] + random.uniform() * (bounds.upper[i] - bounds.lower[i]);
    }
    const hands::HandConfiguration to = motion.moved(step);
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      const hands::Joint& joint = hand.joints[j];
      if (!joint.coupling || !joint.coupling->breakaway) continue;
      ++num_breakaway;
      CHECK(joint.closing_sign *
                (to.q[static_cast<Index>(j)] - hands::followed_position(joint, to.q)) >=
            -1e-12);
    }
  }
  CHECK(num_breakaway > 0);
  CHECK((motion.moved(VectorXd::Zero(motion.size())).q - from.q).norm() < 1e-12);
}

}  // namespace test_hand_motion
