#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_closing.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_hand_closing {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::HandModel;

/// Returns two blocks of 20 mm on a rail along x, with centers at -60 and 60 mm while open; each
/// may travel 100 mm toward the other. `gap` moves the second one out of the first one's way along
/// y.
HandModel rail(double gap) {
  HandModel hand;
  hand.name = "rail";
  hand.links.resize(3);
  hand.links[0].name = "rail";
  hand.palm.link = 0;
  for (int i = 0; i < 2; ++i) {
    hands::Link& block = hand.links[static_cast<std::size_t>(i) + 1];
    block.name = i == 0 ? "left" : "right";
    block.parent_link = 0;
    block.parent_joint = i;
    block.mesh_L = geometry::box({0.02, 0.02, 0.02});
    hands::Joint joint;
    joint.name = block.name + "_slide";
    joint.type = hands::JointType::Prismatic;
    joint.parent_link = 0;
    joint.child_link = i + 1;
    joint.X_PJ.translation() = Vector3d(i == 0 ? -0.06 : 0.06, i * gap, 0);
    joint.axis_J = Vector3d::UnitX();
    joint.lower = i == 0 ? 0.0 : -0.1;
    joint.upper = i == 0 ? 0.1 : 0.0;
    joint.closing_sign = i == 0 ? 1 : -1;
    hand.joints.push_back(joint);
    hands::Finger finger;
    finger.name = block.name;
    finger.links = {i + 1};
    finger.joints = {i};
    hand.fingers.push_back(finger);
  }
  validate(hand);
  return hand;
}

TEST_CASE("Fingers that meet stop a step before they touch", "[hands][hand_closing]") {
  const HandModel hand = rail(0.0);
  // The blocks touch when they have come 100 mm closer together. A step is 100/64 mm: after 32 each
  // they would touch exactly, so that the first, which goes ahead, makes 32 and the second 31.
  const Eigen::VectorXd q = hands::closed_without_overlap(hand, 1.0).q;
  CHECK(q[0] == Approx(0.1 * 32 / 64).epsilon(1e-12));
  CHECK(q[1] == Approx(-0.1 * 31 / 64).epsilon(1e-12));
  // The second one meets the first at its 32nd step, the first one goes no further at its 33rd.
  const std::vector<hands::ClosingStop> stops = hands::closing_stops(hand, 1.0);
  REQUIRE(stops.size() == 2);
  CHECK((stops[0].finger == 1 && stops[0].share == 31.0 / 64));
  CHECK((stops[1].finger == 0 && stops[1].share == 32.0 / 64));
  for (const hands::ClosingStop& stop : stops) CHECK((stop.link_a == 1 && stop.link_b == 2));
  CHECK(hands::closing_stops(rail(0.05), 1.0).empty());
  // Half closed they would just touch, so they make all but the last step of 50/64 mm.
  const Eigen::VectorXd half = hands::closed_without_overlap(hand, 0.5).q;
  CHECK(half[0] == Approx(0.05).epsilon(1e-12));
  CHECK(half[1] == Approx(-0.05 * 63 / 64).epsilon(1e-12));
}

TEST_CASE("Fingers that miss each other close to their limits", "[hands][hand_closing]") {
  const HandModel hand = rail(0.021);
  for (const double share : {0.0, 0.25, 1.0}) {
    CHECK(hands::closed_without_overlap(hand, share).q ==
          hands::closed_configuration(hand, share).q);
  }
}

TEST_CASE("What overlaps while the hand is open does not stop its fingers",
          "[hands][hand_closing]") {
  HandModel hand = rail(0.021);
  // The rail runs through the left block.
  hand.links[0].mesh_L = geometry::box({0.3, 0.01, 0.01});
  REQUIRE(hands::HandCollision(hand)
              .against_self(hands::forward_kinematics(hand, hands::open_configuration(hand)))
              .intersects);
  CHECK(hands::closed_without_overlap(hand, 1.0).q == hands::closed_configuration(hand, 1.0).q);
}

TEST_CASE("The paper's hands close until something stops them, and overlap nowhere",
          "[hands][hand_closing]") {
  for (const std::string name : {"parallel_gripper", "barrett", "human_hand"}) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const hands::HandConfiguration open = hands::open_configuration(hand);
    const hands::HandConfiguration closed = hands::closed_without_overlap(hand, 1.0);
    CHECK_NOTHROW(validate(hand, closed));
    CHECK_FALSE(hands::HandCollision(hand)
                    .against_self(hands::forward_kinematics(hand, closed))
                    .intersects);
    // This is a jaw's stroke, or a radian and more.
    CHECK((closed.q - open.q).cwiseAbs().maxCoeff() > 0.02);
  }
}

TEST_CASE("Shares of closing outside 0 to 1 are refused", "[hands][hand_closing]") {
  for (const double share : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_THROWS_AS(hands::closed_configuration(rail(0), share), base::InvalidInput);
    CHECK_THROWS_AS(hands::closed_without_overlap(rail(0), share), base::InvalidInput);
  }
}

}  // namespace

}  // namespace test_hand_closing
