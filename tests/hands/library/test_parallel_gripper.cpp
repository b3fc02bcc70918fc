#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_parallel_gripper {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::HandModel;
using hands::RigidTransform;

struct Jaws {
  RigidTransform right, left;  ///< Pad frames in H.
};

Jaws jaws(const HandModel& hand, double position) {
  hands::HandConfiguration c = hands::open_configuration(hand);
  c.q[hand.joint_index("right_slide")] = position;
  hands::apply_couplings(hand, c.q);
  const auto X_OL = hands::forward_kinematics(hand, c);
  return {hands::pad_pose(hand, *hand.fingers[0].tip_pad, X_OL),
          hands::pad_pose(hand, *hand.fingers[1].tip_pad, X_OL)};
}

struct Row {
  const char* name;
  double stroke, width, length, height;  ///< [m]
};

TEST_CASE("Stroke and pads of the grippers are the published ones", "[hands][parallel_gripper]") {
  for (const Row& row :
       {// Robotiq 2F-85: stroke by its name; pad 22 x 37.5 mm in MuJoCo Menagerie.
        Row{"parallel_gripper", 0.085, 0.022, 0.0375, 0.062},
        // franka_hand.xacro has 0 to 40 mm per finger, a rubber tip 17.5 wide and 18.5 long, and
        // the grasp point 103.4 mm from the flange; our body's top is 65 mm from it.
        Row{"franka_gripper", 0.080, 0.0175, 0.0185, 0.1034 - 0.065}}) {
    CAPTURE(row.name);
    const HandModel hand = hands::find_hand(row.name);
    REQUIRE(hand.joints.size() == 2);
    CHECK(hand.joints[0].type == hands::JointType::Prismatic);
    const double open = hands::open_configuration(hand).q[0];
    const Jaws wide = jaws(hand, open);
    CHECK((wide.right.translation() - wide.left.translation() - Vector3d(row.stroke, 0, 0)).norm() <
          1e-12);
    CHECK((jaws(hand, 0.0).right.translation() - jaws(hand, 0.0).left.translation()).norm() <
          1e-12);
    for (const int finger : {0, 1}) {
      const hands::ContactPad& pad = hand.pads[static_cast<std::size_t>(
          *hand.fingers[static_cast<std::size_t>(finger)].tip_pad)];
      CHECK(hands::pad_area(pad) == Approx(row.width * row.length).epsilon(1e-12));
      CHECK(hands::largest_boundary_distance(pad) ==
            Approx(std::min(row.width, row.length) / 2).epsilon(1e-12));
    }
    CHECK(wide.right.translation().z() == Approx(row.height).epsilon(1e-12));
  }
}

TEST_CASE("Both jaws move alike and face each other at every opening",
          "[hands][parallel_gripper]") {
  for (const char* name : {"parallel_gripper", "franka_gripper"}) {
    const HandModel hand = hands::find_hand(name);
    for (const double share : {0.0, 0.3, 1.0}) {
      const Jaws pads = jaws(hand, share * hand.joints[0].upper);
      CHECK((pads.right.linear().col(2) + Vector3d::UnitX()).norm() < 1e-12);
      CHECK((pads.left.linear().col(2) - Vector3d::UnitX()).norm() < 1e-12);
      CHECK((pads.right.translation() + pads.left.translation()).head<2>().norm() < 1e-12);
    }
    CHECK(hand.joints[0].closing_sign == -1);
    CHECK(hand.joints[1].closing_sign == -1);
  }
}

}  // namespace

}  // namespace test_parallel_gripper
