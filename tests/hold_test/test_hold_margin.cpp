#include <limits>

#include "hold_scenes.hpp"
#include "support/catch.hpp"

namespace test_hold_margin {

namespace {

using namespace graspfit;
using namespace graspfit::hold_test;
using testing::jaws_on_cube;
using testing::pinch;

TEST_CASE("The margin of a symmetric pinch is 2 mu N across the jaws", "[hold_test]") {
  HoldProtocol protocol = hold_protocol("dexgraspbench-100g");
  for (const double friction : {0.3, 0.6}) {
    protocol.sliding_friction = friction;
    HoldTest test = jaws_on_cube(protocol);
    for (const double force : {2.0, 5.0}) {
      CAPTURE(friction, force);
      const HoldMargin margin = test.margin(pinch(force));
      CHECK(margin.force > 0.6 * 2 * friction * force);
      CHECK(margin.force < 1.05 * 2 * friction * force);
      CHECK(margin.force_direction_O.x() == 0.0);
      CHECK(margin.torque > 0.0);
    }
  }
}

TEST_CASE("What the margin names fails, and a little less holds", "[hold_test]") {
  HoldProtocol protocol = hold_protocol("dexgraspbench-100g");
  const grasp::Grasp grasp = pinch(3.0);
  const HoldMargin margin = jaws_on_cube(protocol).margin(grasp);
  REQUIRE(margin.force > 0.0);
  protocol.force = margin.force;
  CHECK_FALSE(jaws_on_cube(protocol).test(grasp).held());
  protocol.force = 0.97 * margin.force;
  CHECK(jaws_on_cube(protocol).test(grasp).held());
}

TEST_CASE("A verdict is near a limit within a tenth of the smallest load that fails",
          "[hold_test]") {
  HoldProtocol protocol = hold_protocol("dexgraspbench-100g");
  const grasp::Grasp grasp = pinch(3.0);
  const double failing = jaws_on_cube(protocol).margin(grasp).force;
  struct Case {
    double share;
    bool is_held, is_near_limit;
  };
  for (const Case& c : {Case{0.5, true, false}, Case{0.95, true, true}, Case{1.04, false, true},
                        Case{2.0, false, false}}) {
    CAPTURE(c.share);
    protocol.force = c.share * failing;
    HoldTest test = jaws_on_cube(protocol);
    const HoldVerdict verdict = test.test(grasp);
    CHECK(verdict.held() == c.is_held);
    CHECK(test.is_near_limit(grasp, verdict) == c.is_near_limit);
    CHECK(test.holds_at(grasp, 0.9) == (0.9 * c.share < 0.97));
    CHECK(test.holds_at(grasp, 1.1) == (1.1 * c.share < 0.97));
  }
  for (const double share : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_THROWS_WITH(jaws_on_cube(protocol).holds_at(grasp, share),
                      testing::Contains("HoldTest::holds_at: share"));
  }
}

TEST_CASE("What is lost before the load is near no limit", "[hold_test]") {
  HoldTest test = jaws_on_cube(hold_protocol("dexgraspbench-100g"));
  grasp::Grasp without = pinch(3.0);
  without.pre_grasp.reset();
  const HoldVerdict verdict = test.test(without);
  REQUIRE(verdict.stage == HoldStage::Rejected);
  CHECK_FALSE(test.is_near_limit(without, verdict));
}

TEST_CASE("A margin is zero for what falls by itself, and no more than it was looked for",
          "[hold_test]") {
  HoldTest test = jaws_on_cube(hold_protocol("dexgraspbench-100g"));
  grasp::Grasp open = pinch(0.0);
  open.configuration = open.squeeze->configuration = open.pre_grasp->configuration;
  const HoldMargin none = test.margin(open);
  CHECK(none.force <= 0.05);  // Without a contact any push moves it 5 cm in 2 s.
  const HoldMargin plenty = test.margin(pinch(20.0), 1.0);
  CHECK(plenty.force == 1.0);
  CHECK(plenty.force_direction_O.isZero());
  CHECK_THROWS_WITH(jaws_on_cube(hold_protocol("tabletop-lift")).margin(pinch(5.0)),
                    testing::Contains("tabletop-lift"));
}

}  // namespace

}  // namespace test_hold_margin
