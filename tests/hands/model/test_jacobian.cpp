#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "support/catch.hpp"

namespace test_jacobian {

namespace {

using namespace graspfit;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using hands::HandConfiguration;
using hands::HandModel;
using hands::RigidTransform;

/// Returns a chain with everything: a turn, a fixed link, a slide, and a turn that follows the
/// slide.
HandModel mixed_chain() {
  HandModel hand;
  hand.name = "chain";
  hand.links.resize(5);
  const auto add_joint = [&](int link, hands::JointType type, const Vector3d& axis) {
    hands::Joint joint;
    joint.type = type;
    joint.parent_link = link - 1;
    joint.child_link = link;
    joint.X_PJ.translation() = Vector3d(0.03, -0.01, 0.02);
    joint.X_PJ.linear() =
        Eigen::AngleAxisd(0.6, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    joint.axis_J = axis.normalized();
    joint.lower = -2.0;
    joint.upper = 2.0;
    hand.links[static_cast<std::size_t>(link)].parent_joint = static_cast<int>(hand.joints.size());
    hand.joints.push_back(joint);
  };
  for (int link = 1; link < 5; ++link)
    hand.links[static_cast<std::size_t>(link)].parent_link = link - 1;
  add_joint(1, hands::JointType::Revolute, {0.2, -1, 0.4});
  hand.links[2].X_PL_fixed.translation() = Vector3d(0.1, 0, 0.05);
  hand.links[2].X_PL_fixed.linear() = Eigen::AngleAxisd(-1.1, Vector3d::UnitY()).toRotationMatrix();
  add_joint(3, hands::JointType::Prismatic, {1, 1, 0.3});
  add_joint(4, hands::JointType::Revolute, {0, 0.3, 1});
  hand.joints[2].coupling = hands::Coupling{.leader = 1, .ratio = -1.7, .offset = 0.2};
  return hand;
}

/// Returns the central difference of the point's position and of its link's rotation over
/// `direction`, a change of joint positions.
Eigen::Matrix<double, 6, 1> difference(const HandModel& hand, const HandConfiguration& at, int link,
                                       const Vector3d& point_L, const Eigen::VectorXd& direction) {
  // The error of second order is 1e-10, that of rounding 1e-16 / 1e-5.
  constexpr double kStep = 1e-5;
  HandConfiguration plus = at, minus = at;
  plus.q += kStep * direction;
  minus.q -= kStep * direction;
  const RigidTransform X_plus =
      hands::forward_kinematics(hand, plus)[static_cast<std::size_t>(link)];
  const RigidTransform X_minus =
      hands::forward_kinematics(hand, minus)[static_cast<std::size_t>(link)];
  const Eigen::AngleAxisd turn(X_plus.linear() * X_minus.linear().transpose());
  Eigen::Matrix<double, 6, 1> result;
  result << (X_plus * point_L - X_minus * point_L) / (2 * kStep),
      turn.angle() * turn.axis() / (2 * kStep);
  return result;
}

void check_against_differences(const HandModel& hand, base::Random& random) {
  HandConfiguration c;
  c.q.resize(static_cast<Eigen::Index>(hand.joints.size()));
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    c.q[static_cast<Eigen::Index>(j)] = random.uniform(hand.joints[j].lower, hand.joints[j].upper);
  }
  c.X_OH.linear() =
      Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d(2, -1, 1).normalized()).toRotationMatrix();
  c.X_OH.translation() = Vector3d(0.2, -0.4, 0.1);
  const Vector3d point_L(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.05);
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, c);
  for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
    CAPTURE(hand.name, link);
    const auto jacobian = hands::point_jacobian(hand, X_OL, link, point_L);
    REQUIRE(jacobian.cols() == c.q.size());
    for (Eigen::Index j = 0; j < c.q.size(); ++j) {
      const auto expected =
          difference(hand, c, link, point_L, Eigen::VectorXd::Unit(c.q.size(), j));
      CHECK((jacobian.col(j) - expected).norm() < 1e-8);
    }
    // When the Jacobian is folded, moving an independent joint moves its followers by their ratios.
    const MatrixXd independent = hands::folded(hand, jacobian);
    const std::vector<int> leaders = hands::independent_joints(hand);
    REQUIRE(independent.cols() == static_cast<Eigen::Index>(hand.num_intrinsic_dof()));
    for (std::size_t k = 0; k < leaders.size(); ++k) {
      Eigen::VectorXd direction = Eigen::VectorXd::Unit(c.q.size(), leaders[k]);
      for (std::size_t j = 0; j < hand.joints.size(); ++j) {
        const auto& coupling = hand.joints[j].coupling;
        if (coupling && coupling->leader == leaders[k]) {
          direction[static_cast<Eigen::Index>(j)] = coupling->ratio;
        }
      }
      const auto expected = difference(hand, c, link, point_L, direction);
      CHECK((independent.col(static_cast<Eigen::Index>(k)) - expected).norm() < 1e-8);
    }
  }
}

TEST_CASE(
    "Jacobians are the derivative of forward kinematics for turning, sliding and coupled joints",
    "[hands][jacobian]") {
  base::Random random(3);
  const HandModel chain = mixed_chain();
  for (int k = 0; k < 20; ++k) check_against_differences(chain, random);
}

TEST_CASE("Jacobians of every shipped hand are the derivative of its forward kinematics",
          "[hands][jacobian]") {
  base::Random random(5);
  for (const std::string& name : hands::shipped_hands()) {
    const HandModel hand = hands::find_hand(name);
    for (int k = 0; k < 3; ++k) check_against_differences(hand, random);
  }
}

TEST_CASE("A folded Jacobian is what apply_couplings does away from limits", "[hands][jacobian]") {
  const HandModel hand = hands::find_hand("barrett");
  const int leader = hand.joint_index("thumb_proximal");
  const int link = hand.link_index("thumb_distal_link");
  const Vector3d tip(0.056, 0, 0);
  HandConfiguration c = hands::open_configuration(hand);
  const auto at = [&](double q) {
    // The joints start from the open hand, as a breakaway joint that was further closed would stay
    // there.
    HandConfiguration result = hands::open_configuration(hand);
    result.q[leader] = q;
    hands::apply_couplings(hand, result.q);
    return result;
  };
  c = at(0.7);
  const Vector3d moved =
      (hands::forward_kinematics(hand, at(0.7 + 1e-5))[static_cast<std::size_t>(link)] * tip -
       hands::forward_kinematics(hand, at(0.7 - 1e-5))[static_cast<std::size_t>(link)] * tip) /
      2e-5;
  const std::vector<int> joints = hands::independent_joints(hand);
  const auto column = std::find(joints.begin(), joints.end(), leader) - joints.begin();
  const MatrixXd jacobian =
      hands::point_jacobian(hand, hands::forward_kinematics(hand, c), link, tip);
  const MatrixXd folded = hands::folded(hand, jacobian);
  CHECK((folded.col(column).head<3>() - moved).norm() < 1e-8);
  // The coupled distal joint adds a third of its own motion, so that the motion is not the plain
  // column.
  CHECK((jacobian.col(leader).head<3>() - moved).norm() > 0.01);
}

TEST_CASE("Followers at a limit of their own fold into their leader's column as is asked",
          "[hands][jacobian]") {
  // Joint 2 is led to -0.5 q1, at most to 0.25.
  HandModel hand = mixed_chain();
  hand.joints[2].lower = -1.0;
  hand.joints[2].upper = 0.25;
  hand.joints[2].coupling = hands::Coupling{.leader = 1, .ratio = -0.5, .offset = 0.0};
  const MatrixXd columns = (MatrixXd(1, 3) << 10.0, 20.0, 4.0).finished();
  const auto column_of_leader = [&](double leader, double follower, hands::Followers followers) {
    const Vector3d q(0.0, leader, follower);
    const MatrixXd folded = hands::folded(hand, columns, q, followers);
    REQUIRE(folded.cols() == 2);
    CHECK(folded(0, 0) == 10.0);
    CHECK(hands::ratio_to_leader(hand, 0, q, followers) == 1.0);
    CHECK_FALSE(hands::follows_leader(hand, 0, q, followers));
    CHECK(20.0 + 4.0 * hands::ratio_to_leader(hand, 2, q, followers) == folded(0, 1));
    return folded(0, 1);
  };
  using hands::Followers;
  struct Case {
    double leader, follower;
    bool within, between, in_place;
  };
  for (const Case& c : {Case{-0.3, 0.15, true, true, true},     // between its limits
                        Case{-0.5, 0.25, true, false, true},    // led exactly onto its limit
                        Case{-0.9, 0.25, false, false, false},  // led beyond it, and held there
                        Case{-0.3, 0.2, true, true, false}}) {  // has broken away
    CAPTURE(c.leader, c.follower);
    CHECK(column_of_leader(c.leader, c.follower, Followers::All) == 18.0);
    CHECK(column_of_leader(c.leader, c.follower, Followers::WithinLimits) ==
          (c.within ? 18.0 : 20.0));
    CHECK(column_of_leader(c.leader, c.follower, Followers::BetweenLimits) ==
          (c.between ? 18.0 : 20.0));
    CHECK(column_of_leader(c.leader, c.follower, Followers::InPlace) == (c.in_place ? 18.0 : 20.0));
  }
  CHECK_THROWS_AS(hands::folded(hand, columns, Eigen::VectorXd::Zero(2), Followers::InPlace),
                  base::InvalidInput);
}

TEST_CASE("A Jacobian asks for a link and positions of its own hand", "[hands][jacobian]") {
  const HandModel hand = mixed_chain();
  const HandConfiguration c{.q = Eigen::VectorXd::Zero(3)};
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, c);
  CHECK_THROWS_AS(hands::point_jacobian(hand, X_OL, 5, Vector3d::Zero()), base::InvalidInput);
  CHECK_THROWS_AS(hands::point_jacobian(hand, X_OL, -1, Vector3d::Zero()), base::InvalidInput);
  CHECK_THROWS_AS(hands::point_jacobian(hand, {}, 1, Vector3d::Zero()), base::InvalidInput);
  CHECK_THROWS_AS(hands::folded(hand, MatrixXd::Zero(6, 2)), base::InvalidInput);
}

}  // namespace

}  // namespace test_jacobian
