#include "graspfit/base/errors.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "support/catch.hpp"

namespace test_hold_protocol {

namespace {

using namespace graspfit::hold_test;
using graspfit::base::InvalidInput;

TEST_CASE("Every shipped protocol has its name, says where its numbers come from, and is valid",
          "[hold_test]") {
  REQUIRE(hold_protocol_names().size() == 5);
  CHECK(hold_protocol_names().front() == "dexgraspbench-100g");
  for (const std::string& name : hold_protocol_names()) {
    CAPTURE(name);
    const HoldProtocol protocol = hold_protocol(name);
    CHECK(protocol.name == name);
    CHECK(protocol.source.size() > 40);
    CHECK_NOTHROW(protocol.validate());
  }
}

TEST_CASE("A protocol that there is not is refused with the names there are", "[hold_test]") {
  CHECK_THROWS_WITH(hold_protocol("gravity"), graspfit::testing::Contains("\"gravity\"") &&
                                                  graspfit::testing::Contains("dexonomy-hard") &&
                                                  graspfit::testing::Contains("tabletop-lift"));
}

TEST_CASE("Published numbers stand in the protocols", "[hold_test]") {
  // DexGraspBench has 100 g, 10 N/kg, 4 ms, friction 0.6 and 0.02; Dexonomy has 5 cm and 15
  // degrees.
  const HoldProtocol bench = hold_protocol("dexgraspbench-100g");
  CHECK(bench.force == Approx(10.0 * bench.object_mass));
  CHECK(bench.step == 0.004);
  CHECK(bench.largest_turn == Approx(15.0 * 3.14159265358979 / 180.0));
  // The hard mode of Dexonomy has half the friction, a tenth of the torsional one, noslip 0,
  // impratio 1 and 9.8 N/kg.
  const HoldProtocol hard = hold_protocol("dexonomy-hard");
  CHECK(hard.sliding_friction == Approx(bench.sliding_friction / 2));
  CHECK(hard.torsional_friction == Approx(bench.torsional_friction / 10));
  CHECK(hard.noslip_iterations == 0);
  CHECK(hard.impratio == 1.0);
  CHECK(hard.force == Approx(9.8 * hard.object_mass));
  // GenDexGrasp has 0.5 m/s2 and 2 cm.
  const HoldProtocol weak = hold_protocol("gendexgrasp");
  CHECK(weak.force == Approx(0.5 * weak.object_mass));
  CHECK(weak.largest_shift == 0.02);
  // D(R,O) has that of 500 kg/m3 at friction 3, for 1 s each way, and looks once, at the end.
  const HoldProtocol dro = hold_protocol("dro");
  CHECK(dro.force == Approx(0.5 * dro.object_mass));
  CHECK(dro.object_density == 500.0);
  CHECK(dro.sliding_friction == 3.0);
  CHECK(dro.approach_time + dro.squeeze_time == 1.0);
  CHECK(dro.hold_time == 6.0);
  CHECK(dro.check_interval == dro.hold_time);
  CHECK(dro.largest_shift == 0.02);
  CHECK((dro.opening_share == 0.25 && dro.closing_share == 0.15));
  CHECK_FALSE(dro.has_margins());
  CHECK(bench.has_margins());
}

TEST_CASE("A protocol is found by its former name, too, and has today's", "[hold_test]") {
  CHECK(hold_protocol("multidex-0.05g").name == "gendexgrasp");
}

TEST_CASE("A bad parameter is refused by name", "[hold_test]") {
  struct Case {
    const char* field;
    void (*set)(HoldProtocol&);
  };
  const Case cases[] = {
      {"step", [](HoldProtocol& p) { p.step = 0.0; }},
      {"step", [](HoldProtocol& p) { p.step = 1e-12; }},
      {"hold_time", [](HoldProtocol& p) { p.hold_time = 1e9; }},
      {"sliding_friction", [](HoldProtocol& p) { p.sliding_friction = -0.1; }},
      {"object_mass", [](HoldProtocol& p) { p.object_mass = 0.0; }},
      {"solimp", [](HoldProtocol& p) { p.hand_solimp[1] = 1.5; }},
      {"object_density", [](HoldProtocol& p) { p.object_density = -1.0; }},
      {"opening_share", [](HoldProtocol& p) { p.opening_share = 1.1; }},
      {"closing_share", [](HoldProtocol& p) { p.closing_share = -0.1; }},
      {"stiffness", [](HoldProtocol& p) { p.stiffness = -5.0; }},
      {"check_interval", [](HoldProtocol& p) { p.check_interval = p.step / 2; }},
      {"largest_shift", [](HoldProtocol& p) { p.largest_shift = 0.0; }},
      {"force", [](HoldProtocol& p) { p.force = 1.0 / 0.0; }},
  };
  for (const Case& bad : cases) {
    HoldProtocol protocol = hold_protocol("dexgraspbench-100g");
    bad.set(protocol);
    CHECK_THROWS_WITH(protocol.validate(), graspfit::testing::Contains(bad.field));
    CHECK_THROWS_AS(protocol.validate(), InvalidInput);
  }
}

}  // namespace

}  // namespace test_hold_protocol
