#include <clocale>
#include <locale>
#include <string>
#include <vector>

#include "exchanged_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "support/catch.hpp"
#include "support/damaged.hpp"
#include "support/temporary_folder.hpp"

namespace test_isaac_grasp {

namespace {

using namespace graspfit;
using exchange::ImportedGrasp;
using exchange::isaac_grasp_yaml;
using exchange::read_isaac_grasps;
using testing::Contains;
using testing::random_grasps;
using testing::TemporaryFolder;

/// The example of the format's documentation [NVIDIA Isaac ROS documentation, "Isaac Grasp File"]
/// for the joints of the shipped parallel gripper, of which only the driven one is stated.
const std::string kExample = R"(format: isaac_grasp
format_version: 1.0

# These reference frames come from a grasp authored in USD.
object_frame: /World/mug
gripper_frame: /World/panda_hand

grasps:
  "grasp_0":
    confidence: 1.0
    position: [-0.04346, 0.06759, 0.19895]
    orientation: {w: 0.00332, xyz: [0.98453, 0.16837, 0.04837]}
    cspace_position:
      right_slide: 0.00943
    pregrasp_cspace_position:
      right_slide: 0.04
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Returns the message with which a text is refused.
std::string refusal(const TemporaryFolder& folder, const hands::HandModel& hand,
                    const std::string& text) {
  try {
    read_isaac_grasps(folder.write("grasps.yaml", text), hand);
  } catch (const base::IoError& error) {
    return error.what();
  }
  return "accepted";
}

struct CommaDecimals : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

}  // namespace

TEST_CASE("isaac_grasp read again has every bit of positions and joints, rotations to 1e-15",
          "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  for (const char* name : {"barrett", "human_hand_coupled", "parallel_gripper"}) {
    const grasp::GraspFile file = random_grasps(hands::find_hand(name), folder, 12);
    const auto path = folder.write("grasps.yaml", isaac_grasp_yaml(file));
    const std::vector<ImportedGrasp> read = read_isaac_grasps(path, file.hand);
    REQUIRE(read.size() == file.grasps.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      const grasp::Grasp& written = file.grasps[i];
      CHECK(read[i].name == "grasp_" + std::to_string(i));
      CHECK(read[i].configuration.q == written.configuration.q);
      CHECK(read[i].configuration.X_OH.translation() == written.configuration.X_OH.translation());
      CHECK((read[i].configuration.X_OH.linear() - written.configuration.X_OH.linear())
                .cwiseAbs()
                .maxCoeff() < 1e-15);
      REQUIRE(read[i].pre_grasp_q.has_value() == written.pre_grasp.has_value());
      if (read[i].pre_grasp_q) CHECK(*read[i].pre_grasp_q == written.pre_grasp->configuration.q);
    }
  }
}

TEST_CASE("The format's own example is read, followers going with their leader",
          "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const auto read = read_isaac_grasps(folder.write("grasps.yml", kExample), hand);
  REQUIRE(read.size() == 1);
  const hands::HandConfiguration& configuration = read[0].configuration;
  CHECK(configuration.X_OH.translation() == Eigen::Vector3d(-0.04346, 0.06759, 0.19895));
  // The quaternion is w = cos(angle/2), xyz = sin(angle/2) axis, normalized.
  const Eigen::Vector4d wxyz = Eigen::Vector4d(0.00332, 0.98453, 0.16837, 0.04837).normalized();
  CHECK(configuration.X_OH.linear()(0, 0) ==
        Approx(wxyz[0] * wxyz[0] + wxyz[1] * wxyz[1] - wxyz[2] * wxyz[2] - wxyz[3] * wxyz[3])
            .epsilon(1e-14));
  CHECK(configuration.X_OH.linear()(1, 0) ==
        Approx(2.0 * (wxyz[1] * wxyz[2] + wxyz[0] * wxyz[3])).epsilon(1e-14));
  const int right = hand.joint_index("right_slide");
  const int left = hand.joint_index("left_slide");
  REQUIRE(hand.joints[static_cast<std::size_t>(left)].coupling);
  const auto& coupling = *hand.joints[static_cast<std::size_t>(left)].coupling;
  CHECK(configuration.q[right] == 0.00943);
  CHECK(configuration.q[left] == coupling.ratio * 0.00943 + coupling.offset);
  CHECK((*read[0].pre_grasp_q)[right] == 0.04);
}

TEST_CASE(
    "The version may be a text, frames and confidence may be missing, other keys are passed by",
    "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"format_version: 1.0", "format_version: \"1.0\""},
           {"format_version: 1.0", "format_version: '1'"},
           {"object_frame: /World/mug\n", ""},
           {"object_frame:", "object_frame_link:"},
           {"    confidence: 1.0\n", ""},
           {"object_frame:", "created_with: graspgenx\nobject_scale: 1.0\nobject_frame:"},
           {"    pregrasp_cspace_position:\n      right_slide: 0.04\n", ""},
           {"w: 0.00332", "w: +3.32e-3"},
           // It is a limit in single precision.
           {"right_slide: 0.04", "right_slide: 0.0400000009"}}) {
    CHECK(refusal(folder, hand, replaced(kExample, from, to)) == "accepted");
  }
}

TEST_CASE("A file that cannot be used is refused with file, line, place and value",
          "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const struct {
    const char* from;
    const char* to;
    const char* says;
  } cases[] = {
      {"format: isaac_grasp\n", "", "/format: is missing"},
      {"isaac_grasp", "isaac_grip", "/format: is \"isaac_grip\", not isaac_grasp"},
      {"format_version: 1.0", "format_version: 2.0", "line 2: /format_version: is 2.0"},
      {"format_version: 1.0", "format_version: one", "/format_version: is \"one\", not a finite"},
      {"grasps:", "grips:", "/grasps: is missing"},
      {"confidence: 1.0", "confidence: high", "line 10: /grasps/grasp_0/confidence: is \"high\""},
      {"position: [-0.04346, 0.06759, 0.19895]", "position: [-0.04346, 0.06759]",
       "line 11: /grasps/grasp_0/position: is not a list of three numbers"},
      {"-0.04346", ".nan", "/grasps/grasp_0/position/0: is \".nan\", not a finite number"},
      {"-0.04346", "1e999", "not a finite number"},
      {"0.06759", "0,06759", "is not a list of three numbers"},
      {"    position", "    place", "/grasps/grasp_0/position: is missing"},
      {"w: 0.00332", "w: 0.5",
       "/grasps/grasp_0/orientation: is no unit quaternion, its norm is 1.1"},
      {"{w: 0.00332, ", "{", "/grasps/grasp_0/orientation/w: is missing"},
      {"{w: 0.00332, xyz: [0.98453, 0.16837, 0.04837]}", "[0.00332, 0.98453, 0.16837, 0.04837]",
       "/grasps/grasp_0/orientation: is not a map"},
      {"right_slide: 0.00943", "panda_finger_joint1: 0.00943",
       "/grasps/grasp_0/cspace_position/panda_finger_joint1: hand parallel_gripper has no such "
       "joint; it has right_slide, left_slide"},
      {"right_slide: 0.00943", "left_slide: 0.00943",
       "joint right_slide of hand parallel_gripper is missing"},
      {"right_slide: 0.00943", "right_slide: 0.9", "is 0.9, outside the joint's"},
      {"right_slide: 0.00943", "right_slide: 0.00943\n      left_slide: 0.03",
       "joint left_slide is 0.03, but its leader right_slide puts it at 0.00943"},
      {"right_slide: 0.00943", "right_slide: 0.00943\n      right_slide: 0.01",
       "has right_slide twice"},
      {"    cspace_position:\n      right_slide: 0.00943\n", "",
       "/grasps/grasp_0/cspace_position: is missing"},
      {"right_slide: 0.04", "right_slide: open",
       "/pregrasp_cspace_position/right_slide: is \"open\""},
      {"grasps:\n", "grasps: {}\nothers:\n", "/grasps: holds no grasp"},
      {"grasps:\n", "grasps: [\n", "is not YAML"},
      {"format:", "--- 1\n--- 2\n---\nformat:", "has 3 YAML documents, not one"},
  };
  for (const auto& [from, to, says] : cases) {
    const std::string message = refusal(folder, hand, replaced(kExample, from, to));
    CAPTURE(from, to);
    CHECK_THAT(message, Contains("grasps.yaml: "));
    CHECK_THAT(message, Contains(says));
    CHECK(message.find('\n') == std::string::npos);
  }
  CHECK_THAT(refusal(folder, hand, ""), Contains("YAML documents"));
  CHECK_THAT(refusal(folder, hand, "[1, 2]"), Contains("/: is not a map"));
  CHECK_THROWS_AS(read_isaac_grasps(folder.path() / "none.yaml", hand), base::IoError);
}

TEST_CASE("A clutch lets its joint close further, not less", "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("barrett");
  std::size_t follower = 0;
  while (follower < hand.joints.size() &&
         !(hand.joints[follower].coupling && hand.joints[follower].coupling->breakaway)) {
    ++follower;
  }
  REQUIRE(follower < hand.joints.size());
  grasp::GraspFile file = random_grasps(hand, folder, 1);
  Eigen::VectorXd& q = file.grasps[0].configuration.q;
  const hands::Joint& joint = hand.joints[follower];
  const auto put_leader = [&](double share) {
    const hands::Joint& leader = hand.joints[static_cast<std::size_t>(joint.coupling->leader)];
    q[joint.coupling->leader] = leader.lower + share * (leader.upper - leader.lower);
  };
  REQUIRE(joint.closing_sign == 1);
  file.grasps[0].pre_grasp.reset();
  put_leader(0.5);
  hands::apply_couplings(hand, q);
  q[static_cast<Eigen::Index>(follower)] += 0.05;
  CHECK(
      read_isaac_grasps(folder.write("a.yaml", isaac_grasp_yaml(file)), hand)[0].configuration.q ==
      q);
  q[static_cast<Eigen::Index>(follower)] -= 0.1;
  CHECK_THAT(refusal(folder, hand, isaac_grasp_yaml(file)),
             Contains("joint " + joint.name + " is ") && Contains("but its leader"));
}

TEST_CASE("isaac_grasp is written and read alike in a locale with decimal commas",
          "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = random_grasps(hands::find_hand("barrett"), folder, 4);
  const std::string text = isaac_grasp_yaml(file);
  const auto path = folder.write("grasps.yaml", text);
  const std::locale old = std::locale::global(std::locale(std::locale(), new CommaDecimals));
  const std::string old_c = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // This has no effect where the locale is not installed.
  const std::string german = isaac_grasp_yaml(file);
  const auto read = read_isaac_grasps(path, file.hand);
  std::setlocale(LC_ALL, old_c.c_str());
  std::locale::global(old);
  CHECK(german == text);
  CHECK(read[1].configuration.q == file.grasps[1].configuration.q);
}

TEST_CASE("Damaged isaac_grasp files are read or refused, never more", "[exchange][isaac_grasp]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const std::vector<std::string> words = {
      "{",     "}",   "[",  "]", ": ", "&a ",  "*a", "<<: ", "|",    "\n",  "- ", "---",
      "!!int", "1e9", "\"", "'", "\t", "\xff", "?",  "~",    ".inf", "0x1", "%",  "\0"};
  base::Random random(3);
  int num_refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = kExample;
    for (std::uint64_t n = 1 + random.index(4); n > 0; --n) {
      text = testing::damaged(text, words, random);
    }
    num_refused += refusal(folder, hand, text) == "accepted" ? 0 : 1;
  }
  CHECK(num_refused > 1000);
  CHECK(num_refused < 2000);
}

}  // namespace test_isaac_grasp
