#include "hands/mjcf_reading.hpp"

namespace test_mjcf_files {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

TEST_CASE("MJCF: the root is what the hand hangs on, and scenery stays away", "[hands][mjcf]") {
  struct Case {
    std::string worldbody;
    std::vector<std::string> links;
  };
  const std::string joint = R"(<joint axis="0 0 1"/><geom size=".1"/>)";
  const std::string finger = R"(<body name="f">)" + joint + "</body>";
  const std::vector<Case> cases = {
      // This is a hand that floats, over a floor, with a ball and a table.
      {R"(<geom type="plane" size="1 1 1"/><body name="palm"><freejoint/><geom size=".1"/>)" +
           finger + R"(</body><body name="ball"><freejoint/><geom size=".1"/></body>
           <body name="table"><geom type="box" size="1 1 .1"/></body>)",
       {"palm", "f"}},
      // This is a mount without joints.
      {R"(<geom type="box" size="1 1 .1"/><body name="mount"><body name="palm"><geom size=".1"/>)" +
           finger + "</body></body>",
       {"mount", "palm", "f"}},
      // This is as MuJoCo's URDF reader leaves it: the palm is the world's, one fingertip is fixed
      // to it.
      {R"(<geom type="box" size=".1 .1 .1"/>)" + finger + R"(<body name="g">)" + joint +
           R"(</body><body name="bump"><geom size=".1"/></body><body name="target" mocap="true"/>)",
       {"world", "f", "g", "bump"}},
      {finger, {"world", "f"}}};
  const TemporaryFolder folder;
  for (const Case& expected : cases) {
    CAPTURE(expected.worldbody);
    const Reading reading = read(folder.write("hand.xml", mjcf(expected.worldbody)));
    std::vector<std::string> links;
    for (const DescribedLink& link : reading.robot.links) links.push_back(link.name);
    CHECK(links == expected.links);
  }
  const Reading first = read(folder.write("hand.xml", mjcf(cases[0].worldbody)));
  CHECK(first.has(FindingKind::Note, "body ball, body table"));
  CHECK(first.has(FindingKind::Note, "link palm: its free joint is left out"));
}

/// Writes numbers as 1.234,5.
struct CommaNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_CASE("MJCF: a program whose C++ locale has decimal commas reads the same numbers",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("hand.xml", mjcf(kTwoFingers));
  const double plain = read(file).joint("jb").X_PJ.translation().z();
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaNumbers));
  const Reading reading = read(file);
  const bool is_restored =
      std::use_facet<std::numpunct<char>>(std::locale()).decimal_point() == ',';
  std::locale::global(before);
  CHECK(reading.joint("jb").X_PJ.translation().z() == plain);
  CHECK(plain == 0.05);
  CHECK(is_restored);
}

TEST_CASE("MJCF: threads read at once what each reads alone, faults included", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const fs::path good = folder.write("good.xml", random_tree(7));
  const fs::path bad = folder.write("bad.xml", mjcf("<body><geom size=\"0\"/></body>"));
  const Poses expected = link_poses(read(good).robot, {});
  std::array<double, 4> differences{};
  std::array<int, 4> refused{};
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 25; ++i) {
        Findings findings(Findings::AtFault::Throw);
        const RobotDescription robot =
            hands::internal::parse_mjcf(base::read_file(good), good, findings);
        differences[t] += robot.joints.size() == 0 ? 1.0 : 0.0;
        differences[t] += largest_difference(
            robot.joints.back().X_PJ,
            hands::internal::parse_mjcf(base::read_file(good), good, findings).joints.back().X_PJ);
        try {
          hands::internal::parse_mjcf(base::read_file(bad), bad, findings);
        } catch (const IoError&) {
          ++refused[t];
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < 4; ++t) {
    CHECK(differences[t] == 0.0);
    CHECK(refused[t] == 25);
  }
  CHECK(mju_user_error == nullptr);
  CHECK(mju_user_warning == nullptr);
}

TEST_CASE("MJCF: bad files give one clear line and leave no log behind", "[hands][mjcf]") {
  struct Case {
    std::string text;
    bool is_unreadable;  ///< IoError, else InvalidInput.
    std::string words;
  };
  const std::string f = R"(<body name="p"><geom size=".1"/><body name="f">)";
  const std::vector<Case> cases = {
      {"<mujoco><worldbody><bodi/></worldbody></mujoco>", true,
       "MuJoCo: XML Error: Schema violation: unrecognized element; Element 'bodi', line 1"},
      {mjcf(f + "<joint name=\"j\" axis=\"0 0 0\"/><geom size=\".1\"/></body></body>"), true,
       "axis too small"},
      {mjcf(f + R"(<joint name="j" type="ball"/><geom size=".1"/></body></body>)"), false,
       "joint j: is a ball joint"},
      {mjcf(f + R"(<joint name="j" type="slide"/><geom size=".1"/></body></body>)"), false,
       "joint j: no limits"},
      {mjcf(f + R"(<joint/><geom size=".1" pos="0 nan 0"/></body></body>)"), false,
       "line 1: <geom> pos \"0 nan 0\" is not finite"},
      {mjcf(f + R"(<joint range="0 inf"/><geom size=".1"/></body></body>)"), false,
       "<joint> range \"0 inf\" is not finite"},
      {mjcf(f + R"(<joint/><geom size=".1"/><body name="p"/></body></body>)"), true,
       "repeated name in body array"},
      {mjcf(f + R"(<joint/><geom type="mesh" mesh="m"/></body></body>)",
            R"(<asset><mesh name="m" file="none.stl"/></asset>)"),
       true, "<mesh> none.stl is not there"},
      {mjcf(f + "</body></body>", R"(<asset><mesh name="m" file="../outside.stl"/></asset>)"),
       false, "<mesh> ../outside.stl lies outside the description's package"},
      {mjcf(f + "</body></body>",
            R"(<compiler meshdir="/"/><asset><mesh name="m" file="etc/passwd"/></asset>)"),
       false, "<mesh> etc/passwd lies outside"},
      {mjcf(f + "</body></body>", R"(<asset><texture type="2d" file="/etc/passwd"/></asset>)"),
       false, "<texture> /etc/passwd lies outside"},
      {mjcf(f + "</body></body>", R"(<include file="../x.xml"/>)"), false,
       "<include> ../x.xml lies outside"},
      {mjcf(f + "</body></body>", R"(<include file="x.xml"/>)"), true,
       "<include> x.xml is not there"},
      {mjcf(f + "</body></body>", R"(<include file="hand.xml"/>)"), true, "MuJoCo: XML Error"},
      {mjcf(f + "</body></body>", R"(<asset><mesh name="m" file="junk.stl"/></asset>)"), true,
       "MuJoCo: Error:"},
      {mjcf(
           R"(<body name="p"><freejoint/><geom size=".1"/><body><joint/><geom size=".1"/></body></body>
               <body name="o"><geom size=".1"/><body><joint/><geom size=".1"/></body></body>)"),
       false, "body p moves freely of body o"}};
  const TemporaryFolder folder;
  folder.write("junk.stl", "not a mesh");
  for (const Case& bad : cases) {
    CAPTURE(bad.text);
    const fs::path file = folder.write("hand.xml", bad.text);
    std::string message;
    bool is_unreadable = false;
    try {
      read(file);
    } catch (const IoError& error) {
      message = error.what();
      is_unreadable = true;
    } catch (const InvalidInput& error) {
      message = error.what();
    }
    CAPTURE(message);
    CHECK(is_unreadable == bad.is_unreadable);
    CHECK(message.rfind(file.string() + ": ", 0) == 0);
    CHECK(message.find(bad.words) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  }
  CHECK_FALSE(fs::exists("MUJOCO_LOG.TXT"));
}

TEST_CASE("MJCF: read_hand takes a hand in MJCF with its sidecar", "[hands][mjcf]") {
  const TemporaryFolder folder;
  folder.write("hand.graspfit.json", R"({
    "format": {"name": "graspfit hand sidecar", "version": 1},
    "fingers": [{"name": "one", "links": ["a", "b"], "joints": ["ja", "jb"]},
                {"name": "two", "links": ["c"], "joints": ["jc"]}],
    "pads": [], "palm": {"link": "palm", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
    "closing": {"ja": 1, "jc": -1}, "exclusions": []})");
  const fs::path file = folder.write(
      "hand.xml",
      mjcf(kTwoFingers,
           R"(<equality><joint joint1="jb" joint2="ja" polycoef="0 2 0 0 0"/></equality>)"));
  const hands::HandReading reading = hands::read_hand(file);
  const hands::HandModel& hand = reading.model;
  CHECK(hand.num_intrinsic_dof() == 2);
  CHECK(hand.joints[static_cast<std::size_t>(hand.joint_index("jb"))].closing_sign == 1);
  CHECK(geometry::signed_volume(hand.links[0].mesh_L) == Approx(0.2 * 0.2 * 0.02));
  Mujoco mujoco(file);
  base::Random random(1);
  for (int i = 0; i < 100; ++i) {
    hands::HandConfiguration configuration{RigidTransform::Identity(), Eigen::VectorXd::Zero(3)};
    Positions q;
    for (std::size_t j = 0; j < 3; ++j) {
      configuration.q[static_cast<Eigen::Index>(j)] = q[hand.joints[j].name] =
          random.uniform(hand.joints[j].lower, hand.joints[j].upper);
    }
    mujoco.set(q);
    const auto X_OL = hands::forward_kinematics(hand, configuration);
    Poses poses;
    for (std::size_t l = 0; l < X_OL.size(); ++l) poses[hand.links[l].name] = X_OL[l];
    CHECK(largest_difference(poses, mujoco.poses("palm"), 4) < 1e-12);
  }
}

}  // namespace

}  // namespace test_mjcf_files
