#include <cmath>
#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_forward_kinematics {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::HandConfiguration;
using hands::HandModel;
using hands::RigidTransform;
using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kMillimeter = 1e-3;
// The tip point of the check table is this far from the distal joint (GraspIt!'s mesh has 56 to 59
// mm).
const Vector3d kTip_L(56 * kMillimeter, 0, 0);

const HandModel& barrett() {
  static const HandModel hand = hands::find_hand("barrett");
  return hand;
}

/// Returns the hand with spread s and the proximal joint of each finger; the rest follows.
HandConfiguration configuration(double spread, double finger_1, double finger_2, double thumb) {
  HandConfiguration result = hands::open_configuration(barrett());
  result.q[barrett().joint_index("finger_1_spread")] = spread;
  result.q[barrett().joint_index("finger_1_proximal")] = finger_1;
  result.q[barrett().joint_index("finger_2_proximal")] = finger_2;
  result.q[barrett().joint_index("thumb_proximal")] = thumb;
  hands::apply_couplings(barrett(), result.q);
  return result;
}

Vector3d tip(const std::vector<RigidTransform>& X_OL, const std::string& finger) {
  return X_OL[static_cast<std::size_t>(barrett().link_index(finger + "_distal_link"))] * kTip_L;
}

TEST_CASE("Fingertips of the Barrett hand lie where the published numbers put them",
          "[hands][forward_kinematics]") {
  // The table has the reach x from the palm axis and the height z above the finger's base, from
  // GraspIt!'s BH8-280 numbers: x = 50 + 70 cos t1 + 56 cos t2, z = 70 sin t1 + 56 sin t2, t1 = q -
  // 2.46, t2 = t1 + q/3 + 42.46.
  struct Row {
    double angle_deg, x_mm, z_mm;
  };
  for (const Row row :
       {Row{0, 162.8, 33.0}, Row{30, 121.8, 87.5}, Row{45, 91.9, 102.5}, Row{60, 59.6, 107.6},
        Row{75, 28.1, 102.8}, Row{90, 0.4, 89.1}, Row{105, -21.2, 68.3}, Row{140, -40.1, 6.5}}) {
    CAPTURE(row.angle_deg);
    const double q = row.angle_deg * kDegree;
    const auto X_OL = hands::forward_kinematics(barrett(), configuration(0, q, q, q));
    // The table is rounded to 0.1 mm.
    const double tolerance = 0.0501;
    const Vector3d finger_1 = tip(X_OL, "finger_1") / kMillimeter;
    CHECK(finger_1.y() == Approx(row.x_mm).margin(tolerance));
    CHECK(finger_1.z() + 3.32 == Approx(row.z_mm).margin(tolerance));
    CHECK(finger_1.x() == Approx(25.0).margin(1e-9));
    const Vector3d thumb = tip(X_OL, "thumb") / kMillimeter;
    CHECK(-thumb.y() == Approx(row.x_mm).margin(tolerance));
    CHECK(thumb.z() + 3.05 == Approx(row.z_mm).margin(tolerance));
    CHECK(thumb.x() == Approx(0.8).margin(1e-9));
  }
}

TEST_CASE("Every fingertip agrees with plane trigonometry at any spread, angle and palm pose",
          "[hands][forward_kinematics]") {
  base::Random random(7);
  for (int k = 0; k < 200; ++k) {
    const double spread = random.uniform(0.0, pi);
    const double q[3] = {random.uniform(0.0, 140.0), random.uniform(0.0, 140.0),
                         random.uniform(0.0, 140.0)};
    HandConfiguration c = configuration(spread, q[0] * kDegree, q[1] * kDegree, q[2] * kDegree);
    c.X_OH.linear() =
        Eigen::AngleAxisd(random.uniform(-pi, pi),
                          Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.5).normalized())
            .toRotationMatrix();
    c.X_OH.translation() = Vector3d(random.uniform(), random.uniform(), random.uniform());
    const auto X_OL = hands::forward_kinematics(barrett(), c);
    // At spread s finger 1 points along (sin s, cos s), finger 2 along (-sin s, cos s), the thumb
    // along (0, -1); the knuckle is 50 mm out on fingers 1 and 2, and the thumb's base is its
    // knuckle.
    const Vector3d bases[3] = {{25, 0, -3.32}, {-25, 0, -3.32}, {0.8, -50, -3.05}};
    const Vector3d outward[3] = {{std::sin(spread), std::cos(spread), 0},
                                 {-std::sin(spread), std::cos(spread), 0},
                                 {0, -1, 0}};
    const char* names[3] = {"finger_1", "finger_2", "thumb"};
    for (int f = 0; f < 3; ++f) {
      const double t1 = (q[f] - 2.46) * kDegree;
      const double t2 = t1 + (q[f] / 3 + 42.46) * kDegree;
      const double out = (f == 2 ? 0 : 50) + 70 * std::cos(t1) + 56 * std::cos(t2);
      const double up = 70 * std::sin(t1) + 56 * std::sin(t2);
      const Vector3d expected_H =
          (bases[f] + out * outward[f] + up * Vector3d::UnitZ()) * kMillimeter;
      // Angles in the file have 15 digits.
      CHECK((tip(X_OL, names[f]) - c.X_OH * expected_H).norm() < 1e-12);
    }
  }
}

TEST_CASE("Fingers 1 and 2 mirror each other at any spread", "[hands][forward_kinematics]") {
  for (const double spread : {0.0, 0.4, pi / 2, 2.5, pi}) {
    const auto X_OL = hands::forward_kinematics(barrett(), configuration(spread, 0.8, 0.8, 0.3));
    const Vector3d one = tip(X_OL, "finger_1");
    const Vector3d two = tip(X_OL, "finger_2");
    CHECK((one - Vector3d(-two.x(), two.y(), two.z())).norm() < 1e-12);
  }
  // The finger is opposite the thumb at 0 and beside it at pi, without crossing in between.
  CHECK(tip(hands::forward_kinematics(barrett(), configuration(0, 0, 0, 0)), "finger_1").y() > 0.1);
  CHECK(tip(hands::forward_kinematics(barrett(), configuration(pi, 0, 0, 0)), "finger_1").y() <
        -0.1);
  CHECK(tip(hands::forward_kinematics(barrett(), configuration(pi / 2, 0, 0, 0)), "finger_1").x() >
        0.1);
}

TEST_CASE("Opposed fingertips meet near 90 degrees and open to about 325 mm",
          "[hands][forward_kinematics]") {
  const auto opening = [](double q) {
    const auto X_OL = hands::forward_kinematics(barrett(), configuration(0, q, q, q));
    return tip(X_OL, "finger_1").y() - tip(X_OL, "thumb").y();
  };
  CHECK(opening(0.0) == Approx(0.325).margin(0.001));  // This is 2 x 162.8.
  double meets = 0.0;
  while (opening(meets) > 0.0) meets += 0.1 * kDegree;
  CHECK(meets / kDegree == Approx(90.0).margin(1.0));
}

TEST_CASE("Pads face the closing direction: up when open, toward the palm axis half closed",
          "[hands][forward_kinematics]") {
  const auto normal = [](double q, const char* finger) {
    const auto X_OL = hands::forward_kinematics(barrett(), configuration(0, q, q, q));
    const int pad =
        *barrett().fingers[static_cast<std::size_t>(barrett().finger_index(finger))].tip_pad;
    return Vector3d(hands::pad_pose(barrett(), pad, X_OL).linear().col(2));
  };
  CHECK(normal(0, "finger_1").z() > 0.7);
  CHECK(normal(60 * kDegree, "finger_1").y() < -0.9);
  CHECK(normal(60 * kDegree, "thumb").y() > 0.9);
}

TEST_CASE("A joint moves the links beyond it and, through couplings, those of its followers",
          "[hands][forward_kinematics]") {
  const HandModel& hand = barrett();
  const auto names = [&](const std::string& joint) {
    std::vector<std::string> result;
    for (const int link : hands::links_moved_by(hand, hand.joint_index(joint))) {
      result.push_back(hand.links[static_cast<std::size_t>(link)].name);
    }
    return result;
  };
  CHECK(names("thumb_distal") == std::vector<std::string>{"thumb_distal_link"});
  CHECK(names("thumb_proximal") ==
        std::vector<std::string>{"thumb_proximal_link", "thumb_distal_link"});
  CHECK(names("finger_1_spread").size() == 6);
  CHECK_THROWS_AS(hands::links_moved_by(hand, 8), base::InvalidInput);
  CHECK_THROWS_AS(hands::links_moved_by(hand, -1), base::InvalidInput);

  // The links that are listed are exactly those whose pose changes.
  for (int joint = 0; joint < 8; ++joint) {
    if (hand.joints[static_cast<std::size_t>(joint)].coupling) continue;
    HandConfiguration before = configuration(0.5, 0.3, 0.3, 0.3);
    HandConfiguration after = before;
    after.q[joint] += 0.1;
    hands::apply_couplings(hand, after.q);
    const auto X_before = hands::forward_kinematics(hand, before);
    const auto X_after = hands::forward_kinematics(hand, after);
    std::vector<int> changed;
    for (std::size_t i = 0; i < X_before.size(); ++i) {
      if (!X_before[i].isApprox(X_after[i], 1e-12)) changed.push_back(static_cast<int>(i));
    }
    CHECK(changed == hands::links_moved_by(hand, joint));
  }
}

TEST_CASE("Fixed links move with their parent and prismatic joints translate",
          "[hands][forward_kinematics]") {
  HandModel hand;
  hand.name = "slide";
  hand.links.resize(3);
  hand.links[1].parent_link = 0;
  hand.links[1].parent_joint = 0;
  hand.links[2].parent_link = 1;
  hand.links[2].X_PL_fixed.translation() = Vector3d(0, 0, 0.5);
  hands::Joint joint;
  joint.type = hands::JointType::Prismatic;
  joint.parent_link = 0;
  joint.child_link = 1;
  joint.X_PJ.linear() = Eigen::AngleAxisd(pi / 2, Vector3d::UnitX()).toRotationMatrix();
  joint.axis_J = Vector3d::UnitZ();
  joint.upper = 1.0;
  hand.joints.push_back(joint);
  const auto X_OL =
      hands::forward_kinematics(hand, HandConfiguration{.q = Eigen::VectorXd::Constant(1, 0.25)});
  // The z axis of the joint frame is -y of the parent.
  CHECK((X_OL[1].translation() - Vector3d(0, -0.25, 0)).norm() < 1e-15);
  CHECK((X_OL[2].translation() - Vector3d(0, -0.75, 0)).norm() < 1e-15);
  CHECK_THROWS_AS(hands::forward_kinematics(hand, HandConfiguration{}), base::InvalidInput);
}

}  // namespace

}  // namespace test_forward_kinematics
