#include <cmath>
#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_hand_configuration {

namespace {

using namespace graspfit;
using hands::HandConfiguration;
using hands::HandModel;
using std::numbers::pi;

const HandModel& barrett() {
  static const HandModel hand = hands::find_hand("barrett");
  return hand;
}

double& at(Eigen::VectorXd& q, const std::string& joint) { return q[barrett().joint_index(joint)]; }

TEST_CASE("The open Barrett hand has every joint at zero", "[hands][hand_configuration]") {
  const HandConfiguration open = hands::open_configuration(barrett());
  REQUIRE(open.q.size() == 8);
  CHECK(open.q == Eigen::VectorXd::Zero(8));
  CHECK_NOTHROW(hands::validate(barrett(), open));
}

TEST_CASE("A joint that opens as it grows starts at its upper limit; a neutral one nearest zero",
          "[hands][hand_configuration]") {
  HandModel hand = barrett();
  const auto j = static_cast<std::size_t>(hand.joint_index("thumb_proximal"));
  hand.joints[j].closing_sign = -1;
  const auto spread = static_cast<std::size_t>(hand.joint_index("finger_1_spread"));
  hand.joints[spread].lower = 0.2;
  const HandConfiguration open = hands::open_configuration(hand);
  CHECK(open.q[static_cast<Eigen::Index>(j)] == hand.joints[j].upper);
  CHECK(open.q[static_cast<Eigen::Index>(spread)] == 0.2);
  CHECK(open.q[hand.joint_index("finger_2_spread")] == 0.2);
}

TEST_CASE("Distal joints follow by one third and the second spread joint by one",
          "[hands][hand_configuration]") {
  // The ratio is GraspIt!'s d/3, OpenRAVE's 0.33333, and that of Barrett's gears, 125:1 over
  // 93.75:1 less one.
  Eigen::VectorXd q = Eigen::VectorXd::Zero(8);
  at(q, "finger_1_spread") = 0.9;
  at(q, "finger_1_proximal") = 1.5;
  at(q, "thumb_proximal") = 140.0 / 180.0 * pi;
  hands::apply_couplings(barrett(), q);
  CHECK(at(q, "finger_2_spread") == 0.9);
  CHECK(at(q, "finger_1_distal") == Approx(0.5).epsilon(1e-12));
  CHECK(at(q, "finger_2_distal") == 0.0);
  // The coupled value is 140 / 3 = 46.67 degrees, within the joint's own 48.
  CHECK(at(q, "thumb_distal") == Approx(140.0 / 3.0 / 180.0 * pi).epsilon(1e-12));
}

TEST_CASE(
    "After breakaway a distal joint keeps what it closed beyond its coupling, up to its limit",
    "[hands][hand_configuration]") {
  // In Barrett's TorqueSwitch (support wiki, BH8-262 and BH8-280) a clutch frees a blocked proximal
  // link and the motor goes on closing the distal one; its range of 48 degrees is that of
  // jhu-lcsr/barrett_model.
  Eigen::VectorXd q = Eigen::VectorXd::Zero(8);
  at(q, "finger_1_proximal") = 0.6;  // It asks for 0.2.
  at(q, "finger_1_distal") = 0.7;    // It has gone on.
  at(q, "finger_2_proximal") = 0.6;
  at(q, "finger_2_distal") = 0.1;  // It is less closed than asked for, and follows.
  at(q, "thumb_proximal") = 0.6;
  at(q, "thumb_distal") = 2.0;  // It is beyond its limit of 48 degrees.
  hands::apply_couplings(barrett(), q);
  CHECK(at(q, "finger_1_distal") == 0.7);
  CHECK(at(q, "finger_2_distal") == Approx(0.2).epsilon(1e-12));
  CHECK(at(q, "thumb_distal") == Approx(48.0 / 180.0 * pi).epsilon(1e-12));
  // The spread coupling has no clutch.
  at(q, "finger_2_spread") = 1.0;
  hands::apply_couplings(barrett(), q);
  CHECK(at(q, "finger_2_spread") == 0.0);
}

TEST_CASE("Couplings applied twice are couplings applied once", "[hands][hand_configuration]") {
  base::Random random(3);
  for (int k = 0; k < 100; ++k) {
    Eigen::VectorXd q(8);
    for (int j = 0; j < 8; ++j) q[j] = random.uniform(-1.0, 4.0);
    hands::clamp_to_limits(barrett(), q);
    hands::apply_couplings(barrett(), q);
    Eigen::VectorXd again = q;
    hands::apply_couplings(barrett(), again);
    CHECK(again == q);
    CHECK_NOTHROW(hands::validate(barrett(), HandConfiguration{.q = q}));
  }
}

TEST_CASE("Positions outside the limits are clamped or refused by name and value",
          "[hands][hand_configuration]") {
  HandConfiguration configuration = hands::open_configuration(barrett());
  at(configuration.q, "thumb_proximal") = 3.0;
  CHECK_THROWS_WITH(hands::validate(barrett(), configuration),
                    testing::Contains("joint thumb_proximal at 3 is outside 0 to 2.44"));
  hands::clamp_to_limits(barrett(), configuration.q);
  CHECK(at(configuration.q, "thumb_proximal") == Approx(140.0 / 180.0 * pi).epsilon(1e-12));
  CHECK_NOTHROW(hands::validate(barrett(), configuration));

  at(configuration.q, "thumb_proximal") = std::nan("");
  CHECK_THROWS_AS(hands::validate(barrett(), configuration), base::InvalidInput);
  configuration.q.resize(3);
  CHECK_THROWS_WITH(hands::validate(barrett(), configuration),
                    "hand barrett: 3 joint positions for 8 joints");
  CHECK_THROWS_AS(hands::apply_couplings(barrett(), configuration.q), base::InvalidInput);
}

}  // namespace

}  // namespace test_hand_configuration
