#include "hands/mjcf_reading.hpp"

namespace test_mjcf_constraints {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

TEST_CASE("MJCF: linear equalities become couplings that MuJoCo's constraints accept",
          "[hands][mjcf]") {
  struct Case {
    std::string constraint;
    std::string follower;
    std::string leader;
    double ratio;
    double offset;
  };
  // The refs are ja 0, jb 0.25 and jc −0.5.
  const std::vector<Case> cases = {
      {R"(<equality><joint joint1="ja" joint2="jb"/></equality>)", "ja", "jb", 1.0, -0.25},
      {R"(<equality><joint joint1="jb" joint2="jc" polycoef=".1 -2 0 0 0"/></equality>)", "jb",
       "jc", -2.0, 0.25 + 0.1 + 2.0 * -0.5},
      // The equation is 2 (ja − 0) + 4 (jb − 0.25) = 0.4.
      {R"(<tendon><fixed name="t"><joint joint="ja" coef="2"/><joint joint="jb" coef="4"/></fixed></tendon>
          <equality><tendon tendon1="t" polycoef=".4 0 0 0 0"/></equality>)",
       "jb", "ja", -0.5, 0.25 + 0.1},
      // The equation is 2 (jc + 0.5) = 0.1 + 3 · 4 (ja − 0).
      {R"(<tendon><fixed name="t"><joint joint="jc" coef="2"/></fixed>
                  <fixed name="u"><joint joint="ja" coef="4"/></fixed></tendon>
          <equality><tendon tendon1="t" tendon2="u" polycoef=".1 3 0 0 0"/></equality>)",
       "jc", "ja", 6.0, -0.5 + 0.05}};
  const TemporaryFolder folder;
  for (const Case& expected : cases) {
    CAPTURE(expected.constraint);
    const fs::path file = folder.write("hand.xml", mjcf(kTwoFingers, expected.constraint));
    const Reading reading = read(file);
    const auto& coupling = reading.joint(expected.follower).coupling;
    REQUIRE(coupling.has_value());
    CHECK(coupling->joint == expected.leader);
    CHECK(coupling->multiplier == Approx(expected.ratio).epsilon(1e-14));
    CHECK(coupling->offset == Approx(expected.offset).epsilon(1e-14));
    CHECK_FALSE(coupling->breakaway);
    Mujoco mujoco(file);
    for (const double q : {-0.7, 0.0, 0.4}) {
      mujoco.set({{expected.leader, q}, {expected.follower, expected.ratio * q + expected.offset}});
      const std::vector<double> missed = mujoco.missed();
      REQUIRE(missed.size() == 1);
      CHECK(std::abs(missed[0]) < 1e-14);
    }
  }
}

TEST_CASE("MJCF: a curved equality becomes the nearest line, and is said to", "[hands][mjcf]") {
  const TemporaryFolder folder;
  // The equation is jb − 0.25 = ja²; over 0 to 1 the nearest line to x² is x − 1/6, off by 1/6 at
  // both ends.
  const Reading square = read(folder.write(
      "square.xml",
      mjcf(
          kTwoFingers,
          R"(<equality><joint name="e" joint1="jb" joint2="ja" polycoef="0 0 1 0 0"/></equality>)")));
  CHECK(square.joint("jb").coupling->multiplier == Approx(1.0).epsilon(1e-14));
  CHECK(square.joint("jb").coupling->offset == Approx(0.25 - 1.0 / 6).epsilon(1e-14));
  CHECK(square.has(FindingKind::Suspicious, "equality e: is a curve between joints ja and jb"));
  CHECK(square.has(FindingKind::Suspicious, "up to 0.1666"));
  // The polynomial has all powers of x = jb − 0.25; the reference is the normal equations of many
  // samples of jb from 0 to 2.
  const Reading quartic = read(folder.write(
      "quartic.xml",
      mjcf(
          kTwoFingers,
          R"(<equality><joint joint1="ja" joint2="jb" polycoef=".1 .2 -.3 .4 -.05"/></equality>)")));
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double q = 2.0 * (i + 0.5) / kSamples;
    const double x = q - 0.25;
    const double y = 0.1 + x * (0.2 + x * (-0.3 + x * (0.4 - 0.05 * x)));
    normal += Eigen::Vector2d(q, 1.0) * Eigen::RowVector2d(q, 1.0);
    right += y * Eigen::Vector2d(q, 1.0);
  }
  const Eigen::Vector2d line = normal.ldlt().solve(right);
  // The midpoint rule with 20000 samples is off by less than 1e-8.
  CHECK(quartic.joint("ja").coupling->multiplier == Approx(line[0]).margin(1e-7));
  CHECK(quartic.joint("ja").coupling->offset == Approx(line[1]).margin(1e-7));
}

TEST_CASE("MJCF: a tendon with an actuator closes its joints together, and lets one go on",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  const std::string pulls =
      R"(<tendon><fixed name="t"><joint joint="ja" coef="1"/><joint joint="jb" coef="1"/><joint joint="jc" coef="-1"/></fixed></tendon>)";
  const Reading driven = read(folder.write(
      "hand.xml",
      mjcf(kTwoFingers, pulls + R"(<actuator><position name="m" tendon="t"/></actuator>)")));
  CHECK(!driven.joint("ja").coupling.has_value());
  const auto& same_way = driven.joint("jb").coupling;  // The ranges are 0..1 and 0..2.
  REQUIRE(same_way.has_value());
  CHECK(same_way->joint == "ja");
  CHECK(same_way->multiplier == 2.0);
  CHECK(same_way->offset == 0.0);
  CHECK(same_way->breakaway);
  const auto& other_way = driven.joint("jc").coupling;  // The ranges are 0..1 and 0..−1.
  REQUIRE(other_way.has_value());
  CHECK(other_way->multiplier == -1.0);
  CHECK(other_way->offset == 0.0);
  CHECK(driven.has(FindingKind::Note, "tendon t: is driven by actuator m and shared by joints ja"));

  // Joints with actuators or leaders of their own stay as they are; so does an idle tendon.
  const Reading own = read(folder.write(
      "own.xml", mjcf(kTwoFingers, pulls + R"(<equality><joint joint1="jb" joint2="ja"/></equality>
                      <actuator><motor tendon="t"/><motor joint="jc"/></actuator>)")));
  CHECK(own.joint("jb").coupling->multiplier == 1.0);
  CHECK_FALSE(own.joint("jb").coupling->breakaway);
  CHECK(!own.joint("jc").coupling.has_value());
  const Reading idle = read(folder.write("idle.xml", mjcf(kTwoFingers, pulls)));
  for (const DescribedJoint& joint : idle.robot.joints) CHECK(!joint.coupling.has_value());
}

TEST_CASE("MJCF: constraints that no coupling says are held, left out, and said", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& rest) {
    return read(folder.write("hand.xml", mjcf(kTwoFingers, rest)));
  };
  const Reading held = with(R"(<equality><joint joint1="jb" joint2="ja" polycoef="0 2 0 0 0"/>
      <joint joint1="ja" polycoef=".5 0 0 0 0"/></equality>)");
  // Since ja is held at 0.5, its follower is at 0.25 + 1.
  CHECK(held.joint("ja").type == DescribedJoint::Type::Fixed);
  CHECK(held.joint("jb").type == DescribedJoint::Type::Fixed);
  const Reading loose = with("");
  const Poses X = link_poses(held.robot, {});
  const Poses Y = link_poses(loose.robot, {{"ja", 0.5}, {"jb", 1.25}});
  CHECK(largest_difference(X, Y, 4) < 1e-15);

  CHECK(with(R"(<equality><connect name="k" body1="b" body2="c" anchor="0 0 0"/></equality>)")
            .has(FindingKind::Suspicious, "equality k: joins body b and body c: closed loops"));
  CHECK(with(R"(<equality><weld body1="palm"/></equality>)")
            .has(FindingKind::Note, "not both of the hand"));
  const Reading inactive =
      with(R"(<equality><joint name="off" active="false" joint1="jb" joint2="ja"/></equality>)");
  CHECK(!inactive.joint("jb").coupling.has_value());
  CHECK(inactive.has(FindingKind::Note, "equality off: is not active"));
  const Reading mutual = with(R"(<equality><joint joint1="jb" joint2="ja"/>
      <joint joint1="ja" joint2="jb"/><joint joint1="jb" joint2="jc"/></equality>)");
  CHECK(mutual.joint("jb").coupling->joint == "ja");
  CHECK(!mutual.joint("ja").coupling.has_value());
  CHECK(mutual.has(FindingKind::Suspicious, "joint jb follows ja already; that it follows jc"));
  CHECK(mutual.has(FindingKind::Suspicious, "joint jb follows ja already; the other way round"));
  const std::string three =
      R"(<tendon><fixed name="t"><joint joint="ja" coef="1"/><joint joint="jb" coef="1"/><joint joint="jc" coef="1"/></fixed></tendon>)";
  CHECK(with(three + R"(<equality><tendon tendon1="t"/></equality>)")
            .has(FindingKind::Suspicious, "joins 3 joints by one equation"));
}

TEST_CASE("MJCF: <exclude>, contype and conaffinity exclude pairs, <pair> includes them",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  // The bits are: a 1/1, b 2/2, c 1/2 (which meets both), d none (which is only seen).
  const std::string bodies = R"(
    <body name="a"><geom name="ga" size=".1" contype="1" conaffinity="1"/>
      <body name="b"><joint name="jb" axis="0 0 1"/><geom name="gb" size=".1" contype="2" conaffinity="2"/></body>
      <body name="c"><joint name="jc" axis="0 0 1"/><geom size=".1" contype="1" conaffinity="2"/></body>
      <body name="d"><joint name="jd" axis="0 0 1"/><geom size=".1" contype="0" conaffinity="0"/></body>
    </body>)";
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  const auto exclusions = [&](const std::string& contact) {
    return read(folder.write("hand.xml", mjcf(bodies, contact))).robot.exclusions;
  };
  CHECK(exclusions("") == Pairs{{"a", "b"}});
  CHECK(exclusions(R"(<contact><exclude body1="d" body2="c"/></contact>)") ==
        Pairs{{"c", "d"}, {"a", "b"}});
  CHECK(exclusions(R"(<contact><pair geom1="gb" geom2="ga"/></contact>)").empty());
}

}  // namespace

}  // namespace test_mjcf_constraints
