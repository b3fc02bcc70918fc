#include <algorithm>
#include <numbers>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_human_hand {

namespace {

using namespace graspfit;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using hands::HandModel;
using hands::RigidTransform;
using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kMillimeter = 1e-3;

const HandModel& human() {
  static const HandModel hand = hands::find_hand("human_hand");
  return hand;
}

/// The numbers are those of GraspIt!, models/robots/HumanHand/HumanHand20DOF.xml, in mm and degrees
/// in its palm frame G.
struct Digit {
  const char* name;
  Vector3d base_G;
  Vector3d bones;
  double abduction;
};
const Digit kFingers[] = {{"index", {-140.06, 11.20, 36.42}, {43.19, 29.56, 25.35}, 20},
                          {"middle", {-145.66, 11.20, 8.40}, {46.20, 30.99, 29.20}, 10},
                          {"ring", {-145.66, 5.60, -19.61}, {39.12, 28.31, 24.48}, 20},
                          {"little", {-134.46, -8.40, -42.02}, {29.91, 21.10, 23.16}, 30}};

/// Takes a point from G (fingers along -x, palm direction -y, thumb side +z) to H (thumb side x,
/// fingers y, palm direction z), whose origin is G's approach reference (-130, -15, 0).
Vector3d in_H(const Vector3d& p_G) { return {p_G.z(), -p_G.x() - 130, -p_G.y() - 15}; }

const hands::Joint& joint(const HandModel& hand, const std::string& name) {
  return hand.joints[static_cast<std::size_t>(hand.joint_index(name))];
}

RigidTransform pose(const HandModel& hand, const hands::HandConfiguration& c,
                    const std::string& link) {
  return hands::forward_kinematics(hand, c)[static_cast<std::size_t>(hand.link_index(link))];
}

TEST_CASE("Bones and limits of the human hand are GraspIt!'s", "[hands][human_hand]") {
  const auto check_limits = [](const std::string& name, double lower_deg, double upper_deg) {
    CAPTURE(name);
    CHECK(joint(human(), name).lower == Approx(lower_deg * kDegree).epsilon(1e-12));
    CHECK(joint(human(), name).upper == Approx(upper_deg * kDegree).epsilon(1e-12));
  };
  for (const Digit& finger : kFingers) {
    const std::string name = finger.name;
    CAPTURE(name);
    check_limits(name + "_abduction", -finger.abduction, finger.abduction);
    for (const char* flexion : {"_mcp", "_pip", "_dip"}) check_limits(name + flexion, -10, 90);
    CHECK(joint(human(), name + "_pip").X_PJ.translation().norm() ==
          Approx(finger.bones[0] * kMillimeter).epsilon(1e-12));
    CHECK(joint(human(), name + "_dip").X_PJ.translation().norm() ==
          Approx(finger.bones[1] * kMillimeter).epsilon(1e-12));
    // The last bone ends in the fingertip.
    const auto& mesh =
        human().links[static_cast<std::size_t>(human().link_index(name + "_distal"))].mesh_L;
    CHECK(geometry::bounding_box(mesh).max().x() ==
          Approx(finger.bones[2] * kMillimeter).margin(0.5e-3));
    CHECK(joint(human(), name + "_abduction").closing_sign == 0);
    CHECK(joint(human(), name + "_mcp").closing_sign == 1);
  }
  check_limits("thumb_abduction", -10, 70);
  check_limits("thumb_cmc", -50, 25);
  check_limits("thumb_mcp", 0, 90);
  check_limits("thumb_ip", 0, 100);
  CHECK(joint(human(), "thumb_mcp").X_PJ.translation().norm() ==
        Approx(52.12 * kMillimeter).epsilon(1e-12));
  CHECK(joint(human(), "thumb_ip").X_PJ.translation().norm() ==
        Approx(40.76 * kMillimeter).epsilon(1e-12));
  CHECK(human().thumb() == human().finger_index("thumb"));
  for (const hands::Finger& finger : human().fingers) {
    CHECK(finger.swing_joint == human().joint_index(finger.name + "_abduction"));
    CHECK(finger.joints.size() == 4);
  }
}

TEST_CASE("Straight and fully bent fingers end where their bones add up to",
          "[hands][human_hand]") {
  hands::HandConfiguration c{.q = Eigen::VectorXd::Zero(20)};
  const auto tip = [&](const Digit& finger) {
    return Vector3d(pose(human(), c, std::string(finger.name) + "_distal") *
                    Vector3d(finger.bones[2] * kMillimeter, 0, 0) / kMillimeter);
  };
  // Straight, the middle finger has its base at (8.40, 15.66, -26.20) and 46.20 + 30.99 + 29.20
  // along y.
  CHECK((tip(kFingers[1]) - Vector3d(8.40, 122.05, -26.20)).norm() < 1e-9);
  CHECK((tip(kFingers[3]) - Vector3d(-42.02, 78.63, -6.60)).norm() < 1e-9);
  // With all three joints at 90 degrees the bones go up, back and down.
  for (const Digit& finger : kFingers) {
    for (const char* flexion : {"_mcp", "_pip", "_dip"}) {
      c.q[human().joint_index(std::string(finger.name) + flexion)] = pi / 2;
    }
    const Vector3d expected =
        in_H(finger.base_G) + Vector3d(0, -finger.bones[1], finger.bones[0] - finger.bones[2]);
    CHECK((tip(finger) - expected).norm() < 1e-9);
  }
}

TEST_CASE("Fingertips agree with trigonometry and the thumb with GraspIt!'s D-H chain",
          "[hands][human_hand]") {
  const auto rotation_z = [](double angle) {
    Matrix4d m = Matrix4d::Identity();
    m.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return m;
  };
  // Returns Rz(theta) Tx(a) Rx(alpha), in mm and degrees.
  const auto dh = [&](double theta, double a, double alpha) {
    Matrix4d m = Matrix4d::Identity();
    m(0, 3) = a;
    m.block<2, 2>(1, 1) << std::cos(alpha * kDegree), -std::sin(alpha * kDegree),
        std::sin(alpha * kDegree), std::cos(alpha * kDegree);
    return Matrix4d(rotation_z(theta * kDegree) * m);
  };
  Matrix4d base = Matrix4d::Identity();
  // The file gives the rotation with four digits; x is as it stands, y is made orthogonal to it.
  Matrix3d in_file;
  in_file << -0.1486, 0.2665, -0.9522, -0.9003, 0.3618, 0.2418, 0.4089, 0.8933, 0.1862;
  const Vector3d x = in_file.col(0).normalized();
  const Vector3d y = (in_file.col(1) - x.dot(in_file.col(1)) * x).normalized();
  base.topLeftCorner<3, 3>() << x, y, x.cross(y);
  // There are nine entries, each off by twice 5e-5.
  REQUIRE((base.topLeftCorner<3, 3>() - in_file).norm() < 3e-4);
  base.topRightCorner<3, 1>() << -50.62, -11.51, 18.93;

  base::Random random(17);
  for (int k = 0; k < 200; ++k) {
    hands::HandConfiguration c{.q = Eigen::VectorXd::Zero(20)};
    for (std::size_t j = 0; j < 20; ++j) {
      c.q[static_cast<Eigen::Index>(j)] =
          random.uniform(human().joints[j].lower, human().joints[j].upper);
    }
    const auto X_OL = hands::forward_kinematics(human(), c);
    const auto q = [&](const std::string& name) { return c.q[human().joint_index(name)]; };
    for (const Digit& finger : kFingers) {
      const std::string name = finger.name;
      // The bone is turned by the abduction toward the thumb (x), then flexed out of the palm's
      // plane (z).
      const double a = q(name + "_abduction");
      double flexion = 0.0;
      Vector3d expected = in_H(finger.base_G);
      int bone = 0;
      for (const char* bend : {"_mcp", "_pip", "_dip"}) {
        flexion += q(name + bend);
        expected +=
            finger.bones[bone++] * Vector3d(std::sin(a) * std::cos(flexion),
                                            std::cos(a) * std::cos(flexion), std::sin(flexion));
      }
      const RigidTransform& X =
          X_OL[static_cast<std::size_t>(human().link_index(name + "_distal"))];
      CHECK((X * Vector3d(finger.bones[2] * kMillimeter, 0, 0) - expected * kMillimeter).norm() <
            1e-12);
    }
    // GraspIt!'s distal frame has the distal bone along its z axis.
    const Matrix4d chain = base * dh(q("thumb_abduction") / kDegree, 0, 90) *
                           dh(q("thumb_cmc") / kDegree + 49.5, 52.12, 44) *
                           dh(q("thumb_mcp") / kDegree + 5, 40.76, 0) *
                           dh(q("thumb_ip") / kDegree + 85, 0, 90);
    const Vector3d tip_G = (chain * Eigen::Vector4d(0, 0, 37, 1)).head<3>();
    const RigidTransform& X = X_OL[static_cast<std::size_t>(human().link_index("thumb_distal"))];
    CHECK((X * Vector3d(37 * kMillimeter, 0, 0) - in_H(tip_G) * kMillimeter).norm() < 1e-12);
  }
}

TEST_CASE("The smaller hands are the human hand scaled to their lengths", "[hands][human_hand]") {
  // The length is from the wrist crease (40 mm from G's origin) to the tip of the middle finger.
  const double native = 145.66 - 40 + 46.20 + 30.99 + 29.20;
  for (const auto& [name, length] :
       {std::pair<std::string, double>{"human_hand_medium", 185}, {"human_hand_small", 165}}) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const double scale = length / native;
    REQUIRE(hand.joints.size() == 20);
    for (std::size_t j = 0; j < 20; ++j) {
      CHECK(hand.joints[j].name == human().joints[j].name);
      CHECK(hand.joints[j].upper == human().joints[j].upper);
      CHECK((hand.joints[j].X_PJ.translation() - scale * human().joints[j].X_PJ.translation())
                .norm() < 1e-11);
    }
    CHECK(hands::largest_reach(hand) ==
          Approx(scale * hands::largest_reach(human())).epsilon(1e-9));
    for (std::size_t p = 0; p < hand.pads.size(); ++p) {
      CHECK(hands::pad_area(hand.pads[p]) ==
            Approx(scale * scale * hands::pad_area(human().pads[p])).epsilon(1e-6));
    }
  }
}

TEST_CASE("End joints of the coupled hand follow by two thirds, the thumb's is free",
          "[hands][human_hand]") {
  const HandModel hand = hands::find_hand("human_hand_coupled");
  hands::HandConfiguration c = hands::open_configuration(hand);
  c.q[hand.joint_index("ring_pip")] = 0.9;
  hands::apply_couplings(hand, c.q);
  CHECK(c.q[hand.joint_index("ring_dip")] == Approx(0.6).epsilon(1e-12));
  for (const hands::Joint& j : hand.joints) {
    CHECK(j.coupling.has_value() == j.name.ends_with("_dip"));
  }
}

TEST_CASE("Pads of the human hand are convex, about regular and on the closing side",
          "[hands][human_hand]") {
  for (const hands::ContactPad& pad : human().pads) {
    CAPTURE(pad.name);
    CHECK(pad.outline.size() == 12);
    CHECK(hands::pad_height(pad) > 1e-3);
    // In a regular polygon with n corners and inradius r the area is n r^2 tan(pi/n); an ellipse of
    // ratio 1.65 or less keeps at least a good half of that.
    const double n = static_cast<double>(pad.outline.size());
    const double r = hands::largest_boundary_distance(pad);
    CHECK(n * r * r * std::tan(pi / n) / hands::pad_area(pad) > 0.6);
    const Vector3d normal_L = pad.X_LC.linear().col(2);
    CHECK((pad.finger ? normal_L.y() : normal_L.z()) > 0.9);
  }
}

}  // namespace

}  // namespace test_human_hand
