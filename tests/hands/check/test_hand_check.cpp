#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/hand_check.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "hands/sidecar_text.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_hand_check {

namespace {

using namespace graspfit;
using hands::FindingKind;
using hands::HandCheck;
using hands::HandFinding;
using testing::TemporaryFolder;
using testing::with;

/// The description of two fingers of two boxes that bend toward each other over a palm.
const std::string kPinch = R"(<robot name="pinch">
  <link name="base">
    <collision><origin xyz="0 0 -0.011"/><geometry><box size="0.1 0.04 0.02"/></geometry></collision>
    <inertial><origin xyz="0 0 -0.011"/><mass value="0.2"/><inertia ixx="3.3e-5" iyy="1.7e-4" izz="1.9e-4"/></inertial>
  </link>
  <link name="a1">
    <collision><origin xyz="0 0 0.022"/><geometry><box size="0.01 0.02 0.038"/></geometry></collision>
    <inertial><origin xyz="0 0 0.022"/><mass value="0.05"/><inertia ixx="7.7e-6" iyy="6.4e-6" izz="2.1e-6"/></inertial>
  </link>
  <link name="a2">
    <collision><origin xyz="0 0 0.022"/><geometry><box size="0.01 0.02 0.038"/></geometry></collision>
  </link>
  <link name="b1">
    <collision><origin xyz="0 0 0.022"/><geometry><box size="0.01 0.02 0.038"/></geometry></collision>
  </link>
  <link name="b2">
    <collision><origin xyz="0 0 0.022"/><geometry><box size="0.01 0.02 0.038"/></geometry></collision>
  </link>
  <joint name="a_bend" type="revolute"><parent link="base"/><child link="a1"/>
    <origin xyz="-0.04 0 0.002"/><axis xyz="0 1 0"/><limit lower="0" upper="1.4"/></joint>
  <joint name="a_end" type="revolute"><parent link="a1"/><child link="a2"/>
    <origin xyz="0 0 0.044"/><axis xyz="0 1.0 0"/><limit lower="0" upper="1.3"/></joint>
  <joint name="b_bend" type="revolute"><parent link="base"/><child link="b1"/>
    <origin xyz="0.04 0 0.002"/><axis xyz="0 -1 0"/><limit lower="0" upper="1.45"/></joint>
  <joint name="b_end" type="revolute"><parent link="b1"/><child link="b2"/>
    <origin xyz="0 0 0.044"/><axis xyz="0 -1.0 0"/><limit lower="0" upper="1.35"/></joint>
</robot>
)";

const std::string kPinchSidecar = R"({
  "format": {"name": "graspfit hand sidecar", "version": 1},
  "fingers": [
    {"name": "a", "thumb": true, "links": ["a1", "a2"], "joints": ["a_bend", "a_end"], "tip_pad": "a_pad"},
    {"name": "b", "links": ["b1", "b2"], "joints": ["b_bend", "b_end"], "tip_pad": "b_pad"}
  ],
  "pads": [
    {"name": "a_pad", "link": "a2", "finger": "a",
     "frame": {"translation_m": [0.005, 0, 0.022], "rotation_wxyz": [0.7071067811865476, 0, 0.7071067811865476, 0]},
     "outline_m": [[0.015, -0.008], [0.015, 0.008], [-0.015, 0.008], [-0.015, -0.008]]},
    {"name": "b_pad", "link": "b2", "finger": "b",
     "frame": {"translation_m": [-0.005, 0, 0.022], "rotation_wxyz": [0.7071067811865476, 0, -0.7071067811865476, 0]},
     "outline_m": [[0.015, -0.008], [0.015, 0.008], [-0.015, 0.008], [-0.015, -0.008]]}
  ],
  "palm": {"link": "base", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
  "closing": {"a_bend": 1, "a_end": 1, "b_bend": 1, "b_end": 1},
  "exclusions": [["base", "a1"], ["a1", "a2"], ["base", "b1"], ["b1", "b2"]]
})";

HandCheck check_text(const std::string& urdf, const std::string& sidecar) {
  const TemporaryFolder folder;
  if (!sidecar.empty()) folder.write("pinch.graspfit.json", sidecar);
  return hands::check_hand(folder.write("pinch.urdf", urdf));
}

bool has(const HandCheck& check, FindingKind kind, const std::string& item,
         const std::string& what) {
  return std::any_of(check.findings.begin(), check.findings.end(), [&](const HandFinding& finding) {
    return finding.kind == kind && finding.item == item &&
           finding.what.find(what) != std::string::npos;
  });
}

/// Returns the findings of a kind, for messages of failing tests.
std::string listed(const HandCheck& check, FindingKind kind) {
  std::string text;
  for (const HandFinding& finding : check.findings) {
    if (finding.kind == kind) text += "\n  " + finding.item + ": " + finding.what;
  }
  return text;
}

TEST_CASE("All faults of a description are in one report", "[hands][hand_check]") {
  std::string urdf = with(kPinch, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>");
  urdf = with(urdf, "<limit lower=\"0\" upper=\"1.4\"/>", "<limit lower=\"2\" upper=\"1.4\"/>");
  urdf = with(urdf, "<limit lower=\"0\" upper=\"1.3\"/>", "");
  urdf = with(urdf, "xyz=\"0.04 0 0.002\"", "xyz=\"nan 0 0.002\"");
  urdf = with(urdf, "<box size=\"0.1 0.04 0.02\"/>", "<mesh filename=\"lost.obj\"/>");
  urdf = with(urdf, "<mass value=\"0.05\"/>", "<mass value=\"-1\"/>");
  urdf = with(urdf, "</robot>", R"(
  <link name="b2"/>
  <link name="c"><collision><geometry><mesh filename="../../etc/part.obj"/></geometry></collision>
    <visual><geometry><cube/></geometry></visual></link>
  <joint name="a_end" type="ball"><parent link="base"/><child link="c"/></joint>
  <joint name="loose" type="fixed"><parent link="base"/><child link="d"/></joint>
</robot>)");
  const HandCheck check = check_text(urdf, "{\"format\": {}}");
  CAPTURE(listed(check, FindingKind::Fault));
  CHECK_FALSE(check.model.has_value());
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"joint a_bend", "axis 0 0 0"},
      {"joint a_bend", "limits 2 to 1.4 are reversed"},
      {"joint a_end", "no limits"},
      {"joint b_bend", "is not finite"},
      {"link base", "mesh lost.obj is not there"},
      {"link a1", "<mass> is negative"},
      {"", "two links named b2"},
      {"link c", "lies outside the description's package"},
      {"link c", "geometry <cube> is none of"},
      {"joint a_end", "two joints named a_end"},
      {"joint a_end", "type ball is none of"},
      {"", "joint loose: no link named d"},
      {"", "pinch.graspfit.json"}};
  for (const auto& [item, what] : faults) {
    CAPTURE(item, what);
    CHECK(has(check, FindingKind::Fault, item, what));
  }
  CHECK(check.count(FindingKind::Fault) == faults.size());
  // Faults come first, then what is suspicious, then notes, each in one line.
  CHECK(std::is_sorted(check.findings.begin(), check.findings.end(),
                       [](const auto& a, const auto& b) { return a.kind < b.kind; }));
  for (const HandFinding& finding : check.findings) {
    CHECK_FALSE(finding.what.empty());
    CHECK(finding.what.find('\n') == std::string::npos);
  }
}

TEST_CASE("Bad content is reported, a file that cannot be read thrown", "[hands][hand_check]") {
  for (const char* text :
       {"", "<robot", "<mesh/>", "<robot name=\"x\"/>", "<robot><palm>p.xml</palm></robot>"}) {
    CAPTURE(text);
    const HandCheck check = check_text(text, "");
    CHECK_FALSE(check.model.has_value());
    CHECK(check.count(FindingKind::Fault) > 0);
  }
  const TemporaryFolder folder;
  CHECK_THROWS_AS(hands::check_hand(folder.path() / "none.urdf"), base::IoError);
  CHECK_THROWS_AS(hands::check_hand(folder.path()), base::IoError);
}

TEST_CASE("A sound hand gives notes only, a damaged one says what looks wrong",
          "[hands][hand_check]") {
  const HandCheck sound = check_text(kPinch, kPinchSidecar);
  CAPTURE(listed(sound, FindingKind::Fault), listed(sound, FindingKind::Suspicious));
  REQUIRE(sound.model.has_value());
  CHECK(sound.count(FindingKind::Fault) == 0);
  CHECK(sound.count(FindingKind::Suspicious) == 0);
  CHECK(has(sound, FindingKind::Note, "", "3 of 5 links with a mesh have no mass: a2, b1, b2"));
  CHECK(
      has(sound, FindingKind::Note, "", "4 pairs of links are excluded from collision: base - a1"));
  CHECK(has(sound, FindingKind::Note, "", "no joint follows another"));

  struct Row {
    std::string old, fresh, item, what;
  };
  const std::string a2_box =
      "<link name=\"a2\">\n    <collision><origin xyz=\"0 0 0.022\"/><geometry><box size=\"0.01 "
      "0.02 "
      "0.038\"/></geometry></collision>";
  for (const Row& row : std::vector<Row>{
           {"xyz=\"0 1.0 0\"", "xyz=\"0 0.3333 0\"", "joint a_end", "length 0.3333, not 1"},
           {"upper=\"1.3\"", "upper=\"0.4\"", "joint a_end", "\"leader\": \"a_bend\""},
           {"upper=\"1.3\"", "upper=\"0\"", "joint a_end", "it cannot move"},
           {"upper=\"1.4\"", "upper=\"80\"", "joint a_bend", "are they degrees?"},
           {"upper=\"1.4\"", "upper=\"0.05\"", "joint a_bend", "closes by 0.05 rad only"},
           {"<collision><origin xyz=\"0 0 -0.011\"/><geometry><box size=\"0.1 0.04 "
            "0.02\"/></geometry></collision>",
            "", "link base", "the palm has no mesh"},
           {a2_box, "<link name=\"a2\">", "link a2", "the hand ends there"},
           {"<inertial><origin xyz=\"0 0 0.022\"/>", "<inertial><origin xyz=\"0.2 0 0.022\"/>",
            "link a1", "m outside its mesh"},
           {"ixx=\"7.7e-6\"", "ixx=\"-7.7e-6\"", "link a1", "no body has the principal moments"},
           {"ixx=\"7.7e-6\"", "ixx=\"9e-6\"", "link a1", "no body has the principal moments"},
           {"ixx=\"7.7e-6\" iyy=\"6.4e-6\" izz=\"2.1e-6\"",
            "ixx=\"7.7e-9\" iyy=\"6.4e-9\" izz=\"2.1e-9\"", "link a1", "radius of gyration"},
           {"<origin xyz=\"-0.04 0 0.002\"/>", "<origin xyz=\"0.036 0 0.042\"/>", "link a1",
            "overlaps link b2"},
       }) {
    CAPTURE(row.fresh);
    const HandCheck check = check_text(with(kPinch, row.old, row.fresh), kPinchSidecar);
    CAPTURE(listed(check, FindingKind::Suspicious));
    CHECK(has(check, FindingKind::Suspicious, row.item, row.what));
  }
  for (const Row& row : std::vector<Row>{
           {"\"a_bend\": 1,", "\"a_bend\": -1,", "joint a_bend", "backward"},
           {"\"a_bend\": 1, \"a_end\": 1,", "", "finger a", "no joint that closes"},
           {"[0.7071067811865476, 0, 0.7071067811865476, 0]",
            "[0.7071067811865476, -0.7071067811865476, 0, 0]", "finger a", "never face each other"},
       }) {
    CAPTURE(row.fresh);
    const HandCheck check = check_text(kPinch, with(kPinchSidecar, row.old, row.fresh));
    CAPTURE(listed(check, FindingKind::Suspicious));
    CHECK(has(check, FindingKind::Suspicious, row.item, row.what));
  }
}

/// Returns the pinch with every length multiplied, of its surfaces alone or of its joints'
/// positions, too.
std::string scaled_pinch(double factor) {
  std::string text;
  std::string_view rest = kPinch;
  // Lengths are in origins, sizes and positions of inertias; axes and limits of turns are none.
  for (;;) {
    const std::size_t origin = rest.find("<origin xyz=\"");
    const std::size_t size = rest.find("<box size=\"");
    const std::size_t at = std::min(origin, size);
    if (at == std::string_view::npos) return text + std::string(rest);
    const std::size_t begin = rest.find('"', at) + 1;
    const std::size_t end = rest.find('"', begin);
    text += rest.substr(0, begin);
    std::istringstream numbers{std::string(rest.substr(begin, end - begin))};
    const char* separator = "";
    for (double number = 0.0; numbers >> number; separator = " ") {
      text += separator + base::shortest_decimal(factor * number);
    }
    rest.remove_prefix(end);
  }
}

TEST_CASE("A hand in another unit is suspicious with the factor that mends it",
          "[hands][hand_check]") {
  // The hand is 0.11 m high when open: it has two links of 44 mm, the palm's 20 mm and joints
  // between.
  struct Row {
    double factor;
    std::string what;
  };
  for (const Row& row : std::vector<Row>{
           {1000.0, "1000 times too large for a hand: are its lengths millimeters?"},
           {100.0, "100 times too large for a hand: are its lengths centimeters?"},
           {1.0 / 0.0254, "39.4 times too large for a hand: are its lengths inches?"},
           {0.001, "1000 times too small for a hand: were its lengths taken for millimeters?"},
           {0.01, "100 times too small for a hand: were its lengths taken for centimeters?"},
           {15.0, "which no hand does: are its lengths meters?"}}) {
    CAPTURE(row.factor);
    const HandCheck check = check_text(scaled_pinch(row.factor), "");
    CAPTURE(listed(check, FindingKind::Fault), listed(check, FindingKind::Suspicious));
    CHECK(has(check, FindingKind::Suspicious, "", row.what));
  }
  const HandCheck millimeters = check_text(scaled_pinch(1000.0), "");
  CHECK(has(millimeters, FindingKind::Suspicious, "",
            "Write scale=\"0.001 0.001 0.001\" into every <mesh>"));
  // Areas of square meters are not printed as negative numbers.
  CHECK(has(millimeters, FindingKind::Note, "pad a2_pad", " mm^2"));
  CHECK_FALSE(has(millimeters, FindingKind::Note, "pad a2_pad", "-"));
  for (const double factor : {0.2, 1.0, 5.0}) {
    CAPTURE(factor);
    CHECK_FALSE(has(check_text(scaled_pinch(factor), ""), FindingKind::Suspicious, "", "span"));
  }
}

TEST_CASE("A hand of kilometers is refused, and one of microns read", "[hands][hand_check]") {
  const HandCheck huge = check_text(scaled_pinch(1e9), "");
  CHECK_FALSE(huge.model.has_value());
  CHECK(has(huge, FindingKind::Fault, "", "hands are read up to 10000 m"));
  CHECK(has(check_text(scaled_pinch(1e-5), kPinchSidecar), FindingKind::Suspicious, "",
            "which no hand does"));
}

TEST_CASE("The reader of a hand finds its size suspicious, too", "[hands][hand_check]") {
  const TemporaryFolder folder;
  const auto findings = hands::read_hand(folder.write("pinch.urdf", scaled_pinch(1000.0))).findings;
  CHECK(std::any_of(findings.begin(), findings.end(), [](const HandFinding& finding) {
    return finding.kind == FindingKind::Suspicious &&
           finding.what.find("times too large") != std::string::npos;
  }));
}

TEST_CASE("A finger that meeting links keep open is named with the links", "[hands][hand_check]") {
  // A stop on the palm is 1 mm before the bent finger's way, and the open finger does not touch it.
  const std::string stop = R"(
    <collision><origin xyz="-0.029 0 0.03"/><geometry><box size="0.01 0.02 0.02"/></geometry></collision>
    <inertial><origin xyz="0 0 -0.011"/>)";
  const std::string urdf = with(kPinch, "\n    <inertial><origin xyz=\"0 0 -0.011\"/>", stop);
  const std::string sidecar =
      with(kPinchSidecar, R"([["base", "a1"], ["a1", "a2"], )", R"([["a1", "a2"], )");
  const HandCheck check = check_text(urdf, sidecar);
  CAPTURE(listed(check, FindingKind::Fault), listed(check, FindingKind::Suspicious));
  CHECK(has(check, FindingKind::Suspicious, "finger a", "closing leaves it open: after "));
  CHECK(has(check, FindingKind::Suspicious, "finger a", "link base meets link a1"));
  CHECK(has(check, FindingKind::Suspicious, "finger a", R"("exclusions": [["base", "a1"]])"));
  CHECK_FALSE(has(check, FindingKind::Suspicious, "finger b", "closing leaves it open"));
  CHECK_FALSE(
      has(check_text(urdf, kPinchSidecar), FindingKind::Suspicious, "finger a", "leaves it open"));
}

TEST_CASE("A pair of links that is excluded twice counts once", "[hands][hand_check]") {
  const HandCheck check = check_text(
      kPinch, with(kPinchSidecar, R"(["base", "b1"])", R"(["base", "b1"], ["a1", "base"])"));
  CHECK(
      has(check, FindingKind::Note, "", "4 pairs of links are excluded from collision: base - a1"));
}

TEST_CASE("A hand whose limits only let it open does not close", "[hands][hand_check]") {
  std::string urdf = kPinch;
  std::string sidecar = kPinchSidecar;
  for (const char* upper : {"1.4", "1.3", "1.45", "1.35"}) {
    const std::string limit = upper;
    urdf =
        with(urdf, "lower=\"0\" upper=\"" + limit + "\"", "lower=\"-" + limit + "\" upper=\"0\"");
  }
  for (const char* joint : {"a_bend", "a_end", "b_bend", "b_end"}) {
    const std::string name = "\"" + std::string(joint) + "\": ";
    sidecar = with(sidecar, name + "1", name + "-1");
  }
  const HandCheck check = check_text(urdf, sidecar);
  CAPTURE(listed(check, FindingKind::Suspicious));
  for (const char* item : {"finger a", "finger b"}) {
    CHECK(has(check, FindingKind::Suspicious, item, "does not close"));
  }
  CHECK(has(check, FindingKind::Suspicious, "joint b_bend", "backward"));
}

/// Returns a link of the given name on a joint, after `parent`.
std::string moved_link(const std::string& name, const std::string& parent, const std::string& type,
                       const std::string& origin, const std::string& axis,
                       const std::string& limits, const std::string& more = "") {
  return "<link name=\"" + name + "\"/><joint name=\"" + name + "_joint\" type=\"" + type +
         "\"><parent link=\"" + parent + "\"/><child link=\"" + name + "\"/><origin " + origin +
         "/><axis xyz=\"" + axis + "\"/><limit " + limits + "/>" + more + "</joint>";
}

std::string robot(const std::string& content) {
  return "<robot name=\"x\"><link name=\"base\"/>" + content + "</robot>";
}

bool looks_coupled(const std::string& urdf, const std::string& item, const std::string& what,
                   const std::string& sidecar = "") {
  return has(check_text(urdf, sidecar), FindingKind::Suspicious, item, what);
}

TEST_CASE("Twin fingers that swing by a right angle look like one spread, abduction does not",
          "[hands][hand_check]") {
  // The fingers are along y and flex about x; the second mirrors the first at x = 0.
  const auto twins = [](const std::string& limits_a, const std::string& limits_b,
                        const std::string& bone_b) {
    return robot(moved_link("a", "base", "revolute", "xyz=\"-0.03 0 0\"", "0 0 1", limits_a) +
                 moved_link("a_bone", "a", "revolute", "xyz=\"-0.01 0.05 0\"", "1 0 0",
                            "lower=\"0\" upper=\"2\"") +
                 moved_link("b", "base", "revolute", "xyz=\"0.03 0 0.04\"", "0 0 1", limits_b) +
                 moved_link("b_bone", "b", "revolute", "xyz=\"" + bone_b + "\"", "1 0 0",
                            "lower=\"0\" upper=\"2\""));
  };
  const std::string out = "lower=\"0\" upper=\"3.14\"";
  const std::string in = "lower=\"-3.14\" upper=\"0\"";
  const std::string narrow = "lower=\"-0.4\" upper=\"0.4\"";
  const std::string mirrored = "0.01 0.05 -0.04";
  CHECK(looks_coupled(twins(out, in, mirrored), "joint b_joint",
                      "\"leader\": \"a_joint\", \"ratio\": -1"));
  // With an axis the other way around the sign of the ratio is the other one.
  std::string turned = twins(out, out, mirrored);
  turned.replace(turned.rfind("0 0 1"), 5, "0 0 -1");
  CHECK(looks_coupled(turned, "joint b_joint", "\"leader\": \"a_joint\", \"ratio\": 1"));
  CHECK_FALSE(looks_coupled(twins(narrow, narrow, mirrored), "joint b_joint", "spread"));
  CHECK_FALSE(looks_coupled(twins(out, narrow, mirrored), "joint b_joint", "spread"));
  CHECK_FALSE(looks_coupled(twins(out, in, "0.01 0.06 -0.04"), "joint b_joint", "spread"));
}

TEST_CASE("Two jaws that slide alike look coupled until they are, or the sidecar says no",
          "[hands][hand_check]") {
  const auto jaws = [](const std::string& mimic) {
    return robot(moved_link("left", "base", "prismatic", "xyz=\"0 0 0\"", "1 0 0",
                            "lower=\"0\" upper=\"0.04\"") +
                 moved_link("right", "base", "prismatic", "xyz=\"0 0 0\" rpy=\"0 0 3.141592654\"",
                            "1 0 0", "lower=\"0\" upper=\"0.04\"", mimic));
  };
  CHECK(looks_coupled(jaws(""), "joint right_joint", "\"ratio\": 1}"));
  CHECK_FALSE(looks_coupled(jaws("<mimic joint=\"left_joint\"/>"), "joint right_joint", "jaws"));
  CHECK_FALSE(looks_coupled(
      jaws(""), "joint right_joint", "jaws",
      R"({"format": {"name": "graspfit hand sidecar", "version": 1}, "couplings": []})"));
}

TEST_CASE("More than twenty independent joints look as if couplings were lost",
          "[hands][hand_check]") {
  const auto hand = [](int num_fingers) {
    std::string content;
    for (int f = 0; f < num_fingers; ++f) {
      const std::string name = "f" + std::to_string(f);
      const std::string x = std::to_string(0.02 * f);
      const std::string limits = "lower=\"0\" upper=\"1.5\"";
      content +=
          moved_link(name, "base", "revolute", "xyz=\"" + x + " 0 0\"", "0 0 1", limits) +
          moved_link(name + "_b", name, "revolute", "xyz=\"0 0 0\"", "1 0 0", limits) +
          moved_link(name + "_c", name + "_b", "revolute", "xyz=\"0 0.04 0\"", "1 0 0", limits);
    }
    return robot(content);
  };
  const std::string pair = "f6_c_joint after f6_b_joint";
  CHECK(looks_coupled(hand(7), "", pair));
  const HandCheck six = check_text(hand(6), "");
  CHECK_FALSE(has(six, FindingKind::Suspicious, "", "follow"));
  CHECK(has(six, FindingKind::Note, "", "f5_c_joint after f5_b_joint"));
}

void check_sound(const std::string& name) {
  CAPTURE(name);
  const HandCheck check = hands::check_hand(hands::shipped_hand_file(name));
  CAPTURE(listed(check, FindingKind::Fault), listed(check, FindingKind::Suspicious));
  CHECK(check.model.has_value());
  CHECK(check.count(FindingKind::Fault) == 0);
  CHECK(check.count(FindingKind::Suspicious) == 0);
}

TEST_CASE("Nothing about the shipped hands is suspicious", "[hands][hand_check]") {
  for (const char* name : {"barrett", "parallel_gripper", "human_hand"}) check_sound(name);
}

TEST_CASE("Nothing about any shipped hand is suspicious", "[hands][hand_check][full]") {
  for (const std::string& name : hands::shipped_hands()) check_sound(name);
}

/// Checks a hand of the data folder; skips if it is not there.
#define CHECK_SHARED(check, name)                                         \
  const auto check##_file = testing::find_data("hands/" name);            \
  if (!check##_file) {                                                    \
    GRASPFIT_SKIP_TEST("hands/" name " is not there; set GRASPFIT_DATA"); \
  }                                                                       \
  const HandCheck check = hands::check_hand(*check##_file);               \
  CAPTURE(listed(check, FindingKind::Fault), listed(check, FindingKind::Suspicious))

TEST_CASE("The coupling that GraspIt!'s URDF of the Barrett hand lost is found",
          "[hands][hand_check][barrett]") {
  // SOURCES.md of the data folder says: "drops the coupling (distal axis is written as 0 0 0.333
  // instead)".
  CHECK_SHARED(urdf, "barrett_graspit/Barrett.urdf");
  for (const char* joint :
       {"joint a_link2_link3_joint", "joint b_link2_link3_joint", "joint c_link2_link3_joint"}) {
    CHECK(has(urdf, FindingKind::Suspicious, joint, "length 0.3333"));
  }
  CHECK(has(urdf, FindingKind::Suspicious, "joint b_palm_link1_joint",
            "\"leader\": \"a_palm_link1_joint\", \"ratio\": 1}"));
  // The XML has the coupling, and nothing is wrong there.
  CHECK_SHARED(xml, "barrett_graspit/graspit_Barrett.xml");
  CHECK(listed(xml, FindingKind::Suspicious).find("coupling") == std::string::npos);
}

TEST_CASE("The couplings that Barrett's own URDF never had are found",
          "[hands][hand_check][barrett]") {
  // SOURCES.md of the data folder says: "couple them: spread finger_1_prox = -finger_2_prox; each
  // dist follows its med (about 1/3)".
  CHECK_SHARED(check, "barrett_hand/bhand_model.urdf");
  CHECK(has(check, FindingKind::Suspicious, "joint finger_2_prox_joint",
            "\"leader\": \"finger_1_prox_joint\", \"ratio\": -1}"));
  for (const char* finger : {"finger_1", "finger_2", "finger_3"}) {
    const std::string name = finger;
    CHECK(has(check, FindingKind::Suspicious, "joint " + name + "_dist_joint",
              "\"leader\": \"" + name + "_med_joint\", \"ratio\": 0.322}"));
  }
}

TEST_CASE("Missing couplings of the Shadow hand are suspicious, those of the Allegro hand not",
          "[hands][hand_check]") {
  CHECK_SHARED(shadow, "shadow_hand/shadow_hand_right.urdf");
  CHECK(has(shadow, FindingKind::Suspicious, "", "FFJ1 after FFJ2"));
  // The hand has 16 motors for 16 joints.
  CHECK_SHARED(allegro, "allegro_hand/allegro_hand_right.urdf");
  CHECK(listed(allegro, FindingKind::Suspicious).find("coupling") == std::string::npos);
  CHECK(has(allegro, FindingKind::Note, "", "no joint follows another"));
}

TEST_CASE("The open skin of GraspIt!'s human hand is said", "[hands][hand_check]") {
  // SOURCES.md of the data folder says: "skin meshes are OPEN tubes (not closed)". The hand has 20
  // joints, which is no more than hands drive.
  CHECK_SHARED(check, "human_hand_20dof/HumanHand.urdf");
  CAPTURE(listed(check, FindingKind::Note));
  for (const char* link : {"link palm", "link index1", "link mid2", "link thumb3"}) {
    const bool is_said =
        std::any_of(check.findings.begin(), check.findings.end(), [&](const HandFinding& finding) {
          return finding.item == link && finding.what.find("boundary edges") != std::string::npos;
        });
    CHECK(is_said);
  }
  CHECK(listed(check, FindingKind::Suspicious).find("coupling") == std::string::npos);
}

}  // namespace

}  // namespace test_hand_check
