#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/squeeze.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "support/catch.hpp"

namespace test_squeeze {

using namespace graspfit;
using namespace graspfit::contact;
using base::InvalidInput;
using base::Random;
using Eigen::Vector3d;
using Eigen::VectorXd;
using hands::HandConfiguration;
using hands::HandModel;
using Contacts = std::vector<Contact>;

namespace {

Contact link_contact(int link, const Vector3d& point_O, const Vector3d& inward_normal_O) {
  Contact contact = testing::contact_at(point_O, inward_normal_O);
  contact.link = link;
  return contact;
}

Contact finger_contact(const HandModel& hand, const char* link, const Vector3d& point_O,
                       const Vector3d& inward_normal_O) {
  return link_contact(hand.link_index(link), point_O, inward_normal_O);
}

/// Puts coupled joints where their leaders put them, so that none has broken away.
void follow_leaders(const HandModel& hand, VectorXd& q) {
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const auto& coupling = hand.joints[j].coupling;
    if (!coupling) continue;
    q[static_cast<Eigen::Index>(j)] = coupling->ratio * q[coupling->leader] + coupling->offset;
  }
}

/// Returns Σ f · δp of the contacts, as points of their links, when one independent joint moves by
/// ±step and the others follow. It comes from forward kinematics alone.
double virtual_work(const HandModel& hand, const HandConfiguration& grasp, const Contacts& contacts,
                    const Eigen::Matrix3Xd& forces, int joint) {
  constexpr double kStep = 1e-6;
  const auto X = hands::forward_kinematics(hand, grasp);
  double work = 0.0;
  for (const double sign : {1.0, -1.0}) {
    HandConfiguration moved = grasp;
    moved.q[joint] += sign * kStep;
    follow_leaders(hand, moved.q);
    const auto X_moved = hands::forward_kinematics(hand, moved);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const auto link = static_cast<std::size_t>(contacts[i].link);
      work += sign * forces.col(static_cast<Eigen::Index>(i))
                         .dot(X_moved[link] * (X[link].inverse() * contacts[i].point_O));
    }
  }
  return work / (2.0 * kStep);
}

/// Returns a hand of `count` fingers around z at equal angles. Each is one link that turns about
/// the tangent through its foot at (radius, 0) and reaches up to z = lever.
HandModel ring_hand(int count, double radius) {
  HandModel hand;
  hand.name = "ring";
  hand.links.resize(static_cast<std::size_t>(count) + 1);
  hand.palm.link = 0;
  for (int i = 0; i < count; ++i) {
    hands::Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.parent_link = 0;
    joint.child_link = i + 1;
    joint.X_PJ.linear() =
        Eigen::AngleAxisd(2.0 * std::numbers::pi * i / count, Vector3d::UnitZ()).toRotationMatrix();
    joint.X_PJ.translation() = joint.X_PJ.linear() * Vector3d(radius, 0.0, 0.0);
    joint.axis_J = -Vector3d::UnitY();  // As q grows, the finger leans inward.
    joint.lower = -1.0;
    joint.upper = 1.0;
    joint.closing_sign = 1;
    hand.joints.push_back(joint);
    hand.links[static_cast<std::size_t>(i) + 1].parent_link = 0;
    hand.links[static_cast<std::size_t>(i) + 1].parent_joint = i;
  }
  return hand;
}

}  // namespace

TEST_CASE("A pad that does not touch is not pressed", "[contact][squeeze]") {
  const HandModel hand = ring_hand(3, 0.05);
  HandConfiguration grasp = hands::open_configuration(hand);
  Contacts contacts;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 3.0;
    const Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
    contacts.push_back(link_contact(i + 1, 0.05 * outward + 0.1 * Vector3d::UnitZ(), -outward));
  }
  Contacts four = contacts;
  four.insert(four.begin() + 1, link_contact(0, Vector3d(0, 0, 0.05), Vector3d::UnitZ()));
  four[1].gap = 0.001;
  const Vector3d center(0, 0, 0.1);
  const Squeeze of_three = squeeze_configuration(hand, grasp, contacts, {center, 0.05, 0.4});
  const Squeeze of_four = squeeze_configuration(hand, grasp, four, {center, 0.05, 0.4, 0.0005});
  REQUIRE(of_four.forces_O.cols() == 4);
  CHECK(of_four.forces_O.col(1).norm() == 0.0);
  CHECK(of_four.forces_O.col(0) == of_three.forces_O.col(0));
  CHECK(of_four.forces_O.col(3) == of_three.forces_O.col(2));
  CHECK(of_four.configuration.q == of_three.configuration.q);
  CHECK(of_four.residual == of_three.residual);
  four[0].gap = four[2].gap = four[3].gap = 0.001;
  CHECK_THROWS_AS(squeeze_configuration(hand, grasp, four, {center, 0.05, 0.4, 0.0005}),
                  InvalidInput);
}

TEST_CASE("Jaws press a box with half of the force each, F / kp deep", "[contact][squeeze]") {
  HandModel hand = hands::find_hand("parallel_gripper");
  const double half = 0.02;
  HandConfiguration grasp = hands::open_configuration(hand);
  grasp.q.setConstant(half);
  const auto X = hands::forward_kinematics(hand, grasp);
  Contacts contacts;
  for (const hands::Finger& finger : hand.fingers) {
    const Eigen::Isometry3d X_OC = hands::pad_pose(hand, *finger.tip_pad, X);
    contacts.push_back(link_contact(hand.pads[static_cast<std::size_t>(*finger.tip_pad)].link,
                                    X_OC.translation(), X_OC.linear().col(2)));
  }
  const Vector3d center = 0.5 * (contacts[0].point_O + contacts[1].point_O);
  const SqueezeOptions options{.normal_sum = 12.0, .slide_stiffness = 3000.0};

  SECTION("Jaws that move on their own") {
    for (hands::Joint& joint : hand.joints) joint.coupling.reset();
    const Squeeze squeeze =
        squeeze_configuration(hand, grasp, contacts, {center, 0.05, 0.4}, options);
    for (const double q : squeeze.configuration.q) {
      CHECK(q == Approx(half - 6.0 / 3000.0).epsilon(1e-12));
    }
    CHECK(squeeze.is_balanced);
    CHECK(squeeze.residual < 1e-12);
    CHECK_FALSE(squeeze.is_clamped);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK((squeeze.forces_O.col(static_cast<Eigen::Index>(i)) - 6.0 * contacts[i].inward_normal_O)
                .norm() < 1e-11);
    }
    CHECK(squeeze.configuration.X_OH.matrix() == grasp.X_OH.matrix());
  }
  SECTION("Coupled jaws: one motor exerts both forces") {
    const Squeeze squeeze =
        squeeze_configuration(hand, grasp, contacts, {center, 0.05, 0.4}, options);
    for (const double q : squeeze.configuration.q) {
      CHECK(q == Approx(half - 12.0 / 3000.0).epsilon(1e-12));
    }
  }
  SECTION("What the limits do not leave is said") {
    const Squeeze squeeze = squeeze_configuration(hand, grasp, contacts, {center, 0.05, 0.4},
                                                  {.normal_sum = 100.0, .slide_stiffness = 1000.0});
    CHECK(squeeze.is_clamped);
    CHECK(squeeze.configuration.q.isZero(0.0));
  }
}

TEST_CASE("Fingers around a ball press alike, with a third of the force times lever over kp",
          "[contact][squeeze]") {
  const double radius = 0.04;
  for (const int count : {2, 3, 5}) {
    const HandModel hand = ring_hand(count, radius);
    const HandConfiguration grasp{Eigen::Isometry3d::Identity(), VectorXd::Zero(count)};
    const double lever = 0.07;
    Contacts contacts;
    for (int i = 0; i < count; ++i) {
      const Vector3d outward = hand.joints[static_cast<std::size_t>(i)].X_PJ.linear().col(0);
      contacts.push_back(
          link_contact(i + 1, radius * outward + lever * Vector3d::UnitZ(), -outward));
    }
    const Squeeze squeeze =
        squeeze_configuration(hand, grasp, contacts, {lever * Vector3d::UnitZ(), radius, 0.6},
                              {.normal_sum = 9.0, .stiffness = 4.0});
    for (const double q : squeeze.configuration.q) {
      CHECK(q == Approx(9.0 / count * lever / 4.0).epsilon(1e-6));  // Evenness leaves that much.
    }
    CHECK(squeeze.residual < 1e-6);
    CHECK(squeeze.is_balanced);
  }
}

TEST_CASE("Mirrored fingers of the Barrett hand get equal torques", "[contact][squeeze]") {
  const HandModel hand = hands::find_hand("barrett");
  const HandConfiguration grasp = hands::open_configuration(hand);
  const Vector3d center(0.0, 0.0, 0.1);
  const double radius = 0.05;
  const double s = std::sqrt(0.75);
  // A ball is over the palm; fingers 1 and 2 mirror each other in x, the thumb presses along y.
  Contacts contacts;
  const std::vector<std::pair<const char*, Vector3d>> touches = {
      {"finger_1_distal_link", {s, 0.5, 0.0}},
      {"finger_2_distal_link", {-s, 0.5, 0.0}},
      {"thumb_distal_link", {0.0, -1.0, 0.0}}};
  for (const auto& [link, outward] : touches) {
    contacts.push_back(finger_contact(hand, link, center + radius * outward, -outward));
  }
  const Squeeze squeeze = squeeze_configuration(hand, grasp, contacts, {center, radius, 0.5});
  const VectorXd change = squeeze.configuration.q - grasp.q;
  const auto of = [&](const char* joint) { return change[hand.joint_index(joint)]; };
  CHECK(of("finger_1_proximal") == Approx(of("finger_2_proximal")).epsilon(1e-6));
  CHECK(of("finger_1_proximal") > 0.0);
  CHECK(of("thumb_proximal") > 0.0);
  CHECK(of("finger_1_distal") == Approx(of("finger_1_proximal") / 3.0).epsilon(1e-9));
  CHECK(squeeze.residual < 1e-6);
}

TEST_CASE("Stiffness times displacement is the contact forces' virtual work on every joint",
          "[contact][squeeze]") {
  Random random(23);
  int num_unbalanced = 0;
  for (const char* name : {"barrett", "human_hand", "human_hand_coupled"}) {
    const HandModel hand = hands::find_hand(name);
    for (int trial = 0; trial < 10; ++trial) {
      HandConfiguration grasp = hands::open_configuration(hand);
      grasp.X_OH.translation() = 0.1 * testing::random_direction(random);
      for (std::size_t j = 0; j < hand.joints.size(); ++j) {
        const hands::Joint& joint = hand.joints[j];
        grasp.q[static_cast<Eigen::Index>(j)] =
            joint.lower + random.uniform(0.3, 0.6) * (joint.upper - joint.lower);
      }
      follow_leaders(hand, grasp.q);
      Contacts contacts;
      for (int i = 0; i < 4; ++i) {
        const Vector3d outward = testing::random_direction(random);
        contacts.push_back(link_contact(static_cast<int>(random.index(hand.links.size())),
                                        0.05 * outward, -outward));
      }
      // The joints are so stiff that no command reaches a limit.
      const SqueezeOptions options{.normal_sum = 5.0, .stiffness = 100.0};
      const Squeeze squeeze =
          squeeze_configuration(hand, grasp, contacts, {Vector3d::Zero(), 0.05, 0.4}, options);
      REQUIRE_FALSE(squeeze.is_clamped);
      num_unbalanced += squeeze.is_balanced ? 0 : 1;
      double pressing = 0.0;
      for (const int joint : hands::independent_joints(hand)) {
        const double change = squeeze.configuration.q[joint] - grasp.q[joint];
        const double work = virtual_work(hand, grasp, contacts, squeeze.forces_O, joint);
        // Differences of 1e-6 rad are off by 1e-10 of the forces, which is about 1e-9 N m.
        CHECK(100.0 * change == Approx(work).margin(1e-7));
        pressing += change * work;
      }
      CHECK(pressing >= 0.0);  // The commanded motion presses along the forces, never against them.
    }
  }
  CHECK(num_unbalanced > 0);
}

TEST_CASE("Contacts that cannot balance are said to leave their force over", "[contact][squeeze]") {
  const HandModel hand = ring_hand(3, 0.04);
  const HandConfiguration grasp{Eigen::Isometry3d::Identity(), VectorXd::Zero(3)};
  const Contacts one = {link_contact(1, {0.04, 0.0, 0.07}, {-1.0, 0.0, 0.0})};
  // Alone the contact pushes with the whole force, through the center of mass.
  const Squeeze squeeze =
      squeeze_configuration(hand, grasp, one, {{0.0, 0.0, 0.07}, 0.04, 0.0}, {.normal_sum = 2.0});
  CHECK(squeeze.residual == Approx(1.0));
  CHECK_FALSE(squeeze.is_balanced);
  CHECK(squeeze.configuration.q[0] == Approx(2.0 * 0.07 / 5.0));
  CHECK(squeeze.configuration.q.tail(2).isZero(0.0));
  // A palm contact takes its share and asks nothing of the joints.
  const Contacts with_palm = {one[0], link_contact(0, {-0.04, 0.0, 0.07}, {1.0, 0.0, 0.0})};
  const Squeeze held = squeeze_configuration(hand, grasp, with_palm, {{0.0, 0.0, 0.07}, 0.04, 0.0},
                                             {.normal_sum = 2.0});
  CHECK(held.is_balanced);
  CHECK(held.configuration.q[0] == Approx(1.0 * 0.07 / 5.0));
}

TEST_CASE("A follower that has broken away neither counts nor moves by itself",
          "[contact][squeeze]") {
  const HandModel hand = hands::find_hand("barrett");
  HandConfiguration grasp = hands::open_configuration(hand);
  const int proximal = hand.joint_index("thumb_proximal");
  const int distal = hand.joint_index("thumb_distal");
  grasp.q[proximal] = 0.3;
  grasp.q[distal] = 0.5;  // By its coupling it would be 0.1.
  const auto X = hands::forward_kinematics(hand, grasp);
  const int link = hand.link_index("thumb_distal_link");
  const Vector3d point = X[static_cast<std::size_t>(link)] * Vector3d(0.03, 0.0, 0.0);
  const Contacts contacts = {link_contact(link, point, Vector3d::UnitY())};
  const Squeeze squeeze =
      squeeze_configuration(hand, grasp, contacts, {point, 0.05, 0.0}, {.normal_sum = 1.0});
  const auto jacobian =
      hands::point_jacobian(hand, X, link, X[static_cast<std::size_t>(link)].inverse() * point);
  CHECK(squeeze.configuration.q[distal] == 0.5);
  CHECK(squeeze.configuration.q[proximal] - 0.3 == Approx(jacobian(1, proximal) / 5.0));
  // Link poses that are known already make no difference.
  const auto squeezed_at = [&](const std::vector<hands::RigidTransform>& X_OL) {
    return squeeze_configuration(hand, hands::PosedConfiguration{grasp, X_OL}, contacts,
                                 {point, 0.05, 0.0}, {.normal_sum = 1.0});
  };
  CHECK(squeezed_at(X).configuration.q == squeeze.configuration.q);
  CHECK_THROWS_AS(squeezed_at({}), base::InvalidInput);
}

TEST_CASE("A squeeze refuses what makes no sense", "[contact][squeeze]") {
  const HandModel hand = ring_hand(2, 0.04);
  const HandConfiguration grasp{Eigen::Isometry3d::Identity(), VectorXd::Zero(2)};
  const Contacts contacts = {link_contact(1, {0.04, 0.0, 0.0}, {-1.0, 0.0, 0.0})};
  const auto squeeze = [&](const HandConfiguration& configuration, const Contacts& with,
                           double scale, double friction, const SqueezeOptions& options) {
    return squeeze_configuration(hand, configuration, with, {Vector3d::Zero(), scale, friction},
                                 options);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const SqueezeOptions& bad :
       {SqueezeOptions{.normal_sum = 0.0}, SqueezeOptions{.stiffness = nan},
        SqueezeOptions{.slide_stiffness = -1.0}, SqueezeOptions{.largest_residual = -0.1}}) {
    CHECK_THROWS_AS(squeeze(grasp, contacts, 0.04, 0.4, bad), InvalidInput);
  }
  CHECK_THROWS_WITH(squeeze(grasp, {}, 0.04, 0.4, {}),
                    testing::Contains("number of contacts that touch = 0"));
  CHECK_THROWS_WITH(
      squeeze(grasp, {link_contact(3, {0.04, 0, 0}, {-1, 0, 0})}, 0.04, 0.4, {}),
      testing::Contains("link of a contact = 3") && testing::Contains("3 of hand ring"));
  CHECK_THROWS_AS(squeeze(grasp, {link_contact(1, {0.04, 0, 0}, {-2, 0, 0})}, 0.04, 0.4, {}),
                  InvalidInput);
  CHECK_THROWS_AS(squeeze(grasp, contacts, 0.0, 0.4, {}), InvalidInput);
  CHECK_THROWS_AS(squeeze(grasp, contacts, 0.04, -0.1, {}), InvalidInput);
  CHECK_THROWS_WITH(squeeze_configuration(hand, grasp, contacts, {.friction = 0.4}),
                    testing::Contains("torque_scale = nan, must be set"));
  CHECK_THROWS_AS(squeeze({grasp.X_OH, VectorXd::Constant(2, 1.5)}, contacts, 0.04, 0.4, {}),
                  InvalidInput);
}

}  // namespace test_squeeze
