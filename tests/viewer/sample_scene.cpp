#include "sample_scene.hpp"

#include <cmath>
#include <numbers>

#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/hand_closing.hpp"

namespace graspfit::testing {
namespace {

using geometry::RigidTransform;

constexpr double kBallRadius = 0.04;
constexpr double kFingerThickness = 0.012;
constexpr double kFingerLength = 0.09;
constexpr double kPalmHeight = 0.02;

RigidTransform translation(const Eigen::Vector3d& p) {
  RigidTransform X = RigidTransform::Identity();
  X.translation() = p;
  return X;
}

// Returns a hand whose palm is a box below the plane z = 0 of H and looks along +z.
hands::HandModel three_finger_hand() {
  hands::HandModel hand;
  hand.name = "sample";
  hands::Link palm;
  palm.name = "palm";
  palm.mesh_L = geometry::transformed(geometry::box({0.09, 0.09, kPalmHeight}),
                                      translation({0.0, 0.0, -kPalmHeight / 2}));
  hand.links.push_back(palm);
  hand.palm.link = 0;

  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    // The link frame has z along the finger and x toward the palm's axis, so that the pad's plane
    // is the plane x = thickness / 2, at the ball's radius from the axis.
    hands::Joint joint;
    joint.name = "joint_" + std::to_string(i + 1);
    joint.parent_link = 0;
    joint.child_link = i + 1;
    joint.X_PJ = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                 translation({kBallRadius + kFingerThickness / 2, 0.0, 0.0}) *
                 Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
    joint.axis_J = Eigen::Vector3d::UnitY();
    joint.lower = -0.8;
    joint.upper = 0.8;
    joint.closing_sign = 1;
    hand.joints.push_back(joint);

    hands::Link link;
    link.name = "finger_" + std::to_string(i + 1);
    link.parent_link = 0;
    link.parent_joint = i;
    link.mesh_L = geometry::transformed(geometry::box({kFingerThickness, 0.02, kFingerLength}),
                                        translation({0.0, 0.0, kFingerLength / 2}));
    hand.links.push_back(link);

    hands::ContactPad pad;
    pad.name = link.name + "_pad";
    pad.link = i + 1;
    pad.finger = i;
    pad.X_LC.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // This puts C's z along the link's x.
    pad.X_LC.translation() = Eigen::Vector3d(kFingerThickness / 2, 0.0, 0.065);
    pad.outline = {{-0.01, -0.02}, {0.01, -0.02}, {0.01, 0.02}, {-0.01, 0.02}};
    hand.pads.push_back(pad);

    hands::Finger finger;
    finger.name = i == 0 ? "thumb" : "finger_" + std::to_string(i);
    finger.links = {i + 1};
    finger.joints = {i};
    finger.tip_pad = i;
    finger.is_thumb = i == 0;
    hand.fingers.push_back(finger);
  }
  return hand;
}

// Returns a grasp with the fingers turned by `q`, and contacts on the equator at the first
// `num_contacts`.
grasp::Grasp grasp_at(double q, int num_contacts) {
  grasp::Grasp grasp;
  // The palm is below the ball, the pads' centers are at the height of the ball's center.
  grasp.configuration.X_OH = translation({0.0, 0.0, -0.065});
  grasp.configuration.q = Eigen::VectorXd::Constant(3, q);
  for (int i = 0; i < num_contacts; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
    contact::Contact contact;
    contact.point_O = kBallRadius * outward;
    contact.inward_normal_O = -outward;
    contact.area = 40e-6 + 10e-6 * i;
    contact.pad_boundary_distance = 0.008 + 0.0005 * i;
    contact.gap = 0.0002 * i;
    contact.link = i + 1;
    contact.pad = i;
    contact.finger = i;
    contact.is_target = true;
    grasp.contacts.push_back(contact);
    grasp.quality.terms.push_back({0.8 + 0.05 * i, 0.05 + 0.0125 * i, 1.0});
    grasp::TargetContact target;
    target.point_O = kBallRadius * (outward + Eigen::Vector3d(0.0, 0.0, 0.25)).normalized();
    target.outward_normal_O = target.point_O.normalized();
    target.score = 0.9;
    target.finger = i;
    grasp.targets.contacts.push_back(target);
  }
  // The lines of an equilateral triangle make 30° with the normals.
  for (int i = 0; i < num_contacts; ++i) {
    for (int j = i + 1; j < num_contacts; ++j) {
      grasp.quality.stable_pairs.push_back({i, j, std::numbers::pi / 6});
    }
  }
  grasp.quality.regularity = 1.0;
  grasp.has_all_contacts = num_contacts == 3;
  return grasp;
}

}  // namespace

SampleScene sample_scene() {
  SampleScene scene{geometry::ball(kBallRadius, 4), three_finger_hand(), {}, {}};

  grasp::Grasp valid = grasp_at(0.0, 3);
  valid.quality.m1 = 0.4;
  valid.quality.m2 = 1.0;
  valid.quality.m3 = 1.0;
  valid.quality.m = 0.4;
  valid.ideal_m = 0.7;
  valid.attempt = 4;
  grasp::PreGrasp start;
  start.configuration = valid.configuration;
  start.configuration.X_OH.translation().z() -= 0.03;
  start.configuration.q.setConstant(-0.4);
  start.clearance = 0.0065;
  start.opening = 0.5;
  start.retreat = 0.03;
  valid.pre_grasp = start;
  contact::Squeeze squeeze;
  squeeze.configuration = valid.configuration;
  squeeze.configuration.q.setConstant(0.1);
  squeeze.forces_O = Eigen::Matrix3Xd::Zero(3, 3);
  squeeze.residual = 0.012;
  squeeze.is_balanced = true;
  valid.squeeze = squeeze;
  valid.wrench.emplace();
  valid.wrench->epsilon = 0.1234;
  valid.wrench->is_force_closure = true;
  valid.wrench->convention.options.torque_scale = kBallRadius;
  valid.iterations = 61;

  grasp::Grasp penetrating = grasp_at(0.12, 3);
  // This is as of two contacts that are opposite each other but for rounding.
  penetrating.wrench.emplace();
  penetrating.wrench->epsilon = 1e-17;
  penetrating.wrench->is_force_closure = true;
  penetrating.wrench->convention.options.torque_scale = kBallRadius;
  penetrating.quality.m1 = 0.6;
  penetrating.quality.m2 = 1.0;
  penetrating.quality.m3 = 1.0;
  penetrating.quality.m = 0.6;
  penetrating.penetration.object_intersects = true;
  penetrating.penetration.object_depth = 0.0047;
  penetrating.penetration.object_depth_bound = 0.0049;
  penetrating.penetration.object_link = 1;

  grasp::Grasp open = grasp_at(-0.3, 2);
  open.quality.stable_pairs.clear();

  scene.grasps = {valid, penetrating, open};
  scene.surroundings.table_z_O = -0.12;
  scene.surroundings.obstacles.emplace_back(
      geometry::transformed(geometry::box({0.03, 0.03, 0.03}), translation({0.11, 0.0, -0.1})));
  return scene;
}

viewer::HandScene sample_hand_scene() {
  viewer::HandScene scene;
  scene.hand = three_finger_hand();
  scene.hand.joints[1].coupling = hands::Coupling{0, 0.5, 0.1, false};
  scene.hand.joints[2].coupling = hands::Coupling{0, 0.5, 0.1, true};
  scene.hand.joints[2].type = hands::JointType::Prismatic;
  scene.hand.joints[2].axis_J = Eigen::Vector3d(0.6, 0.0, 0.8);
  scene.description = "A sentence with <signs> & marks.";
  scene.clip_thickness = 0.003;
  for (const double share : {0.0, 1.0}) {
    scene.poses.push_back(
        {share == 0.0 ? "open" : "closed", hands::closed_configuration(scene.hand, share).q});
  }
  return scene;
}

}  // namespace graspfit::testing
