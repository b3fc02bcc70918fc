#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_check.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "support/catch.hpp"
#include "support/damaged.hpp"
#include "support/skip.hpp"
#include "support/small_hand.hpp"
#include "support/temporary_folder.hpp"

// What is wrong with a hand's files is said in one line that names the file, the item and the
// value.
namespace {

using namespace graspfit;
using geometry::Error;
using geometry::InvalidInput;
using geometry::IoError;
using testing::kSmallHandMesh;
using testing::kSmallHandSidecar;
using testing::kSmallHandUrdf;
using testing::TemporaryFolder;
namespace fs = std::filesystem;

/// The small hand's files, one of them broken or not.
struct HandFiles {
  std::string urdf = kSmallHandUrdf;
  std::string sidecar = kSmallHandSidecar;
  std::string mesh = kSmallHandMesh;
};

/// In a package of its own, so that meshes have an outside that is still in the test's folder.
fs::path write(const TemporaryFolder& folder, const HandFiles& files) {
  folder.write("package/meshes/bar.obj", files.mesh);
  folder.write("package/pincer.graspfit.json", files.sidecar);
  return folder.write("package/pincer.urdf", files.urdf);
}

/// `text` with the only occurrence of `old` replaced.
std::string with(std::string text, const std::string& old, const std::string& fresh) {
  const std::size_t at = text.find(old);
  INFO(old);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(old, at + 1) == std::string::npos);
  return text.replace(at, old.size(), fresh);
}

bool is_one_line(const std::string& message) {
  return !message.empty() &&
         std::none_of(message.begin(), message.end(), [](char c) { return c >= 0 && c < ' '; });
}

enum class Refusal { Io, Invalid };

/// `read_hand` refuses the file with one line that has all of `named` in it, and `check_hand`
/// reports the same as a fault instead of throwing.
void check_refused(const fs::path& file, Refusal expected, const std::vector<std::string>& named) {
  std::string message;
  try {
    hands::read_hand(file);
    FAIL_CHECK("accepted");
    return;
  } catch (const IoError& error) {
    message = error.what();
    CAPTURE(message);
    CHECK(expected == Refusal::Io);
  } catch (const InvalidInput& error) {
    message = error.what();
    CAPTURE(message);
    CHECK(expected == Refusal::Invalid);
  }
  CAPTURE(message);
  CHECK(is_one_line(message));
  for (const std::string& part : named) {
    CAPTURE(part);
    CHECK(message.find(part) != std::string::npos);
  }
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    CHECK_THROWS_AS(hands::check_hand(file), IoError);
    return;
  }
  hands::HandCheck report;
  REQUIRE_NOTHROW(report = hands::check_hand(file));
  CHECK_FALSE(report.model.has_value());
  CHECK(report.count(hands::FindingKind::Fault) > 0);
  for (const hands::HandFinding& finding : report.findings) CHECK(is_one_line(finding.what));
}

/// One edit of a good file and what the message has to name besides the file.
struct Row {
  std::string old, fresh;
  std::vector<std::string> named;
  Refusal expected = Refusal::Invalid;
};

void check_rows(std::string HandFiles::*file, const std::string& file_name,
                const std::vector<Row>& rows) {
  const TemporaryFolder folder;
  for (const Row& row : rows) {
    CAPTURE(row.old, row.fresh);
    HandFiles files;
    files.*file = with(files.*file, row.old, row.fresh);
    std::vector<std::string> named = row.named;
    named.push_back(file_name);
    check_refused(write(folder, files), row.expected, named);
  }
}

void check_urdf_rows(const std::vector<Row>& rows) {
  check_rows(&HandFiles::urdf, "pincer.urdf", rows);
}

void check_sidecar_rows(const std::vector<Row>& rows) {
  check_rows(&HandFiles::sidecar, "pincer.graspfit.json", rows);
}

TEST_CASE("The hand that is broken below is good", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const fs::path file = write(folder, {});
  const hands::HandReading reading = hands::read_hand(file);
  CHECK(reading.model.links.size() == 4);
  CHECK(reading.model.num_intrinsic_dof() == 2);
  for (const hands::HandFinding& finding : reading.findings) {
    CAPTURE(finding.item, finding.what);
    CHECK(finding.kind != hands::FindingKind::Fault);
  }
  const hands::HandCheck report = hands::check_hand(file);
  CHECK(report.model.has_value());
  CHECK(report.count(hands::FindingKind::Fault) == 0);
}

TEST_CASE("Numbers of a URDF that are none, or not finite, are named with their joint or link",
          "[hands][bad_hand_files]") {
  const std::string origin = R"(xyz="-0.04 0 0.001")";
  const std::string axis = R"(<axis xyz="2 0 0"/>)";
  const std::string limits = R"(lower="0" upper="0.03")";
  const std::string scale = R"(scale="0.01 0.02 0.05")";
  const std::string box = R"(size="0.12 0.04 0.02")";
  check_urdf_rows({
      {origin, R"(xyz="-0.04 nan 0.001")", {"slide", "nan"}},
      {origin, R"(xyz="-0.04 NaN 0.001")", {"slide", "NaN"}},
      {origin, R"(xyz="-0.04 0 -inf")", {"slide", "-inf"}},
      {origin, R"(xyz="1e999 0 0.001")", {"slide", "1e999"}},
      {origin, R"(xyz="0x10 0 0.001")", {"slide", "0x10"}},
      {origin, R"(xyz="-0,04 0 0.001")", {"slide", "-0,04"}},
      {origin, R"(xyz="")", {"slide", "origin"}},
      {origin, R"(xyz="   ")", {"slide", "origin"}},
      {origin, R"(xyz="-0.04 0")", {"slide", "-0.04 0"}},
      {origin, R"(xyz="-0.04 0 0.001 7")", {"slide", "-0.04 0 0.001 7"}},
      {origin, R"(xyz="-0.04 0 0.001m")", {"slide", "0.001m"}},
      {R"(rpy="0 0 0.0")", R"(rpy="0 inf 0")", {"slide", "inf"}},
      {R"(rpy="0 0 0.0")", R"(rpy="0 0 90deg")", {"slide", "90deg"}},
      {axis, R"(<axis xyz="0 0 0"/>)", {"slide", "0 0 0"}},
      {axis, R"(<axis xyz="0 nan 1"/>)", {"slide", "nan"}},
      {axis, R"(<axis xyz="1e999 0 0"/>)", {"slide", "1e999"}},
      {axis, R"(<axis xyz=""/>)", {"slide", "axis"}},
      {limits, R"(lower="nan" upper="0.03")", {"slide", "nan"}},
      {limits, R"(lower="0" upper="inf")", {"slide", "inf"}},
      {limits, R"(lower="0" upper="1e999")", {"slide", "1e999"}},
      {limits, R"(lower="0" upper="")", {"slide", "upper"}},
      {limits, R"(lower="0" upper="0,03")", {"slide", "0,03"}},
      {limits, R"(lower="0.03" upper="0")", {"slide", "0.03"}},
      {R"(<limit lower="0" upper="0.03" effort="1" velocity="1"/>)", "", {"slide", "limit"}},
      {R"(<limit lower="-0.2" upper="1.2" effort="1" velocity="1"/>)", "", {"turn", "limit"}},
      {R"(multiplier="0.5")", R"(multiplier="nan")", {"bend", "nan"}},
      {R"(offset="0.1")", R"(offset="0.1rad")", {"bend", "0.1rad"}},
      {scale, R"(scale="0.01 0 0.05")", {"left", "0.01 0 0.05"}},
      {scale, R"(scale="0.01 nan 0.05")", {"left", "nan"}},
      {scale, R"(scale="0.01 0.02")", {"left", "0.01 0.02"}},
      {scale, R"(scale="1e999 0.02 0.05")", {"left", "1e999"}},
      {box, R"(size="0.12 0 0.02")", {"base", "0.12 0 0.02"}},
      {box, R"(size="0.12 -0.04 0.02")", {"base", "0.12 -0.04 0.02"}},
      {box, R"(size="0.12 inf 0.02")", {"base", "inf"}},
      {box, "", {"base", "size"}},
      {R"(radius="0.008")", R"(radius="0")", {"right", "radius"}},
      {R"(length="0.04")", R"(length="nan")", {"right", "nan"}},
      {R"(radius="0.009")", R"(radius="1e999")", {"tip", "1e999"}},
      {R"(mass value="0.5")", R"(mass value="nan")", {"base", "nan"}},
      {R"(mass value="0.5")", R"(mass value="-0.5")", {"base", "-0.5"}},
      {R"(ixx="1e-4")", R"(ixx="inf")", {"base", "inf"}},
      {R"(ixx="1e-4")", R"(ixx="1e-4f")", {"base", "1e-4f"}},
  });
}

TEST_CASE("Trees of a URDF that are none are refused with the names at fault",
          "[hands][bad_hand_files]") {
  const std::string end = "</robot>";
  check_urdf_rows({
      {R"(<link name="tip">)", R"(<link name="left">)", {"left"}},
      {R"(<link name="tip">)", R"(<link name="">)", {"link", "name"}},
      {R"(<link name="tip">)", R"(<link>)", {"link", "name"}},
      {R"(joint name="bend")", R"(joint name="turn")", {"turn"}},
      {R"(joint name="bend")", R"(joint)", {"joint", "name"}},
      {R"(<parent link="right"/>)", R"(<parent link="wrong"/>)", {"bend", "wrong"}},
      {R"(<child link="tip"/>)", R"(<child link="tipp"/>)", {"bend", "tipp"}},
      {R"(<child link="tip"/>)", R"(<child link="right"/>)", {"right"}},
      {R"(<child link="tip"/>)", R"(<child link="base"/>)", {"base"}},
      {R"(<child link="tip"/>)", R"(<child link="left"/>)", {"left", "bend"}},
      {R"(<parent link="right"/>)", "", {"bend", "parent"}},
      {R"(<child link="tip"/>)", "", {"bend", "child"}},
      {R"(<child link="tip"/>)", R"(<child/>)", {"bend", "child"}},
      // A name with a line feed in it, as XML may have: still one line.
      {R"(<child link="tip"/>)", "<child link=\"ti&#10;pp\"/>", {"bend"}},
      {R"(<parent link="right"/>)", R"(<parent link="tip"/>)", {"tip"}},
      {R"(<joint name="bend" type="revolute">)",
       R"(<joint name="bend" type="ball">)",
       {"bend", "ball"}},
      {R"(<joint name="bend" type="revolute">)",
       R"(<joint name="bend" type="floating">)",
       {"bend", "floating"}},
      {R"(<joint name="bend" type="revolute">)",
       R"(<joint name="bend" type="Revolute">)",
       {"bend", "Revolute"}},
      {R"(<joint name="bend" type="revolute">)", R"(<joint name="bend">)", {"bend", "type"}},
      {R"(<mimic joint="turn")", R"(<mimic joint="tern")", {"bend", "tern"}},
      {R"(<mimic joint="turn")", R"(<mimic )", {"bend", "mimic"}},
      {end, R"(<link name="lost"/></robot>)", {"base", "lost"}},
      {end,
       R"(<link name="a"/><link name="b"/>
         <joint name="ab" type="continuous"><parent link="a"/><child link="b"/></joint>
         <joint name="ba" type="continuous"><parent link="b"/><child link="a"/></joint></robot>)",
       {"cycle"}},
      {R"(name="pincer">)", R"(>)", {"name"}},
      {R"(name="pincer">)",
       R"(name="pincer" xmlns:xacro="http://www.ros.org/wiki/xacro">
         <xacro:property name="width" value="0.1"/>)",
       {"xacro"}},
      {R"(size="0.12 0.04 0.02")", R"(size="${width} 0.04 0.02")", {"base", "${width}"}},
  });
}

TEST_CASE("Couplings of a URDF lead to one leader or are refused", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const auto urdf = [&](const std::string& turns_mimic, const std::string& bends_mimic) {
    HandFiles files;
    files.sidecar = with(files.sidecar,
                         R"({"joint": "bend", "leader": "turn", "ratio": 0.5, "offset": 0.1, )"
                         R"("breakaway": true})",
                         "");
    files.urdf = with(files.urdf, R"(upper="1.2" effort="1" velocity="1"/>)",
                      R"(upper="1.2" effort="1" velocity="1"/>)" + turns_mimic);
    files.urdf =
        with(files.urdf, R"(<mimic joint="turn" multiplier="0.5" offset="0.1"/>)", bends_mimic);
    return write(folder, files);
  };
  check_refused(urdf(R"(<mimic joint="bend"/>)", R"(<mimic joint="turn"/>)"), Refusal::Invalid,
                {"pincer.urdf", "cycle"});
  check_refused(urdf("", R"(<mimic joint="bend"/>)"), Refusal::Invalid, {"pincer.urdf", "bend"});
}

TEST_CASE("A description without a movable joint is refused", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  HandFiles files;
  for (const char* type : {"prismatic", "revolute", "revolute"}) {
    const std::size_t at = files.urdf.find(std::string("type=\"") + type);
    REQUIRE(at != std::string::npos);
    files.urdf.replace(at + 6, std::string(type).size(), "fixed");
  }
  check_refused(write(folder, files), Refusal::Invalid, {"pincer.urdf", "movable joint"});
}

TEST_CASE("What is no robot description at all is refused by what it is",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::vector<std::string>& named = {}) {
    CAPTURE(text.substr(0, 80));
    std::vector<std::string> all = named;
    all.push_back("pincer.urdf");
    check_refused(write(folder, {.urdf = text}), Refusal::Io, all);
  };
  refused("", {"empty"});
  refused(" \n\n");
  refused("<!-- nothing -->");
  refused("not XML at all");
  refused("{\"format\": 1}");
  refused(std::string("\0\1\2\3\xff\xfe", 6));
  refused(std::string(R"(<robot name="pincer">)") + std::string(100, '\0') + "</robot>");
  refused("<sdf version=\"1.6\"><model name=\"x\"/></sdf>", {"sdf"});
  refused("<html><body>404 Not Found</body></html>", {"html"});
  refused(with(kSmallHandUrdf, "</robot>", ""));
  refused(with(kSmallHandUrdf, R"(name="pincer">)", R"(name="pincer>)"));
  // Nesting that would use up a stack.
  std::string deep = "<robot name=\"deep\">";
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  refused(deep);
  std::string closed = deep;
  for (int i = 0; i < 200000; ++i) closed += "</a>";
  refused(closed + "</robot>");

  check_refused(folder.path() / "none.urdf", Refusal::Io, {"none.urdf"});
  check_refused(folder.path(), Refusal::Io, {folder.path().filename().string()});
  check_refused("", Refusal::Io, {});
}

TEST_CASE("Mesh paths that lead nowhere or out of the package are refused with link and path",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  // Good meshes that are none of this hand's business, and ways to them that stay hidden until
  // links are followed.
  const fs::path outside = folder.write("outside/bar.obj", kSmallHandMesh);
  write(folder, {});
  fs::create_symlink(outside, folder.path() / "package/meshes/link.obj");
  fs::create_directory_symlink(folder.path() / "outside", folder.path() / "package/elsewhere");
  fs::create_symlink(folder.path() / "nowhere.obj", folder.path() / "package/meshes/dangling.obj");
  fs::create_symlink("loop.obj", folder.path() / "package/meshes/loop.obj");
  fs::create_directories(folder.path() / "package/meshes/folder.obj");
  folder.write("package/meshes/bar.step", "ISO-10303-21;");

  struct PathRow {
    std::string path, named;
    Refusal expected;
  };
  const std::string out = "package";
  for (const PathRow& row : {
           PathRow{"meshes/none.obj", "none.obj", Refusal::Io},
           {"meshes/dangling.obj", "dangling.obj", Refusal::Io},
           {"meshes/loop.obj", "loop.obj", Refusal::Io},
           {"meshes/folder.obj", "folder.obj", Refusal::Io},
           {std::string(5000, 'x') + ".obj", "xxx.obj", Refusal::Io},
           {"package://pincer/none.obj", "none.obj", Refusal::Io},
           {"../../../../../../../../etc/passwd", out, Refusal::Invalid},
           {"../outside/bar.obj", out, Refusal::Invalid},
           {"meshes/../../outside/bar.obj", out, Refusal::Invalid},
           {"/etc/passwd", out, Refusal::Invalid},
           {outside.string(), out, Refusal::Invalid},
           {"file:///etc/passwd", out, Refusal::Invalid},
           {"file://" + outside.string(), out, Refusal::Invalid},
           {"package://pincer/../outside/bar.obj", out, Refusal::Invalid},
           {"package://other/../../outside/bar.obj", out, Refusal::Invalid},
           {"meshes/link.obj", out, Refusal::Invalid},
           {"elsewhere/bar.obj", out, Refusal::Invalid},
           {"http://example.org/bar.obj", "http", Refusal::Invalid},
           {"", "", Refusal::Invalid},
       }) {
    CAPTURE(row.path);
    HandFiles files;
    files.urdf = with(files.urdf, "meshes/bar.obj", row.path);
    check_refused(write(folder, files), row.expected, {"pincer.urdf", "left", row.path, row.named});
  }
  // The same mesh within the package is fine, however roundabout.
  for (const std::string& path : {std::string("package://pincer/meshes/bar.obj"),
                                  "file://" + (folder.path() / "package/meshes/bar.obj").string(),
                                  std::string("./meshes//../meshes/bar.obj")}) {
    CAPTURE(path);
    HandFiles files;
    files.urdf = with(files.urdf, "meshes/bar.obj", path);
    CHECK_NOTHROW(hands::read_hand(write(folder, files)));
  }
}

TEST_CASE("Mesh files that hold no mesh are refused with link and path",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const std::string last = "f 4 5 8\n";
  for (const std::string& mesh :
       {std::string(), std::string("not a mesh\n"), std::string(200, '\0'),
        std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n"),  // no faces
        std::string("f 1 2 3\n"), with(kSmallHandMesh, last, "f 4 5 9\n"),
        with(kSmallHandMesh, last, "f 4 5 2147483648\n"),
        with(kSmallHandMesh, last, "f 4 5 18446744073709551617\n"),
        with(kSmallHandMesh, last, "f 4 5 0\n"), with(kSmallHandMesh, last, "f 4 5 -9\n"),
        with(kSmallHandMesh, "v 0.5 0.5 0.5\n", "v 0.5 nan 0.5\n"),
        with(kSmallHandMesh, "v 0.5 0.5 0.5\n", "v 0.5 1e999 0.5\n"),
        std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")}) {  // no area
    CAPTURE(mesh);
    const fs::path file = write(folder, {.mesh = mesh});
    // Which of the two depends on whether the file or what it holds is at fault.
    std::string message;
    try {
      hands::read_hand(file);
      FAIL_CHECK("accepted");
    } catch (const Error& error) {
      message = error.what();
    }
    CAPTURE(message);
    CHECK(is_one_line(message));
    CHECK(message.find("pincer.urdf") != std::string::npos);
    CHECK(message.find("link left") != std::string::npos);
    // A surface that cannot be closed is the link's, of one or more files.
    const bool names_mesh = message.find("bar.obj") != std::string::npos;
    CHECK((names_mesh || message.find("its surface is not closed") != std::string::npos));
    CHECK(hands::check_hand(file).count(hands::FindingKind::Fault) > 0);
  }
}

TEST_CASE("What is wrong in a sidecar is named by its place and value", "[hands][bad_hand_files]") {
  const std::string thumb = R"("thumb": false)";
  const std::string fingers = R"("fingers": [)";
  const std::string pads = R"("pads": [)";
  const std::string outline = R"([[-0.03, -0.01], [0.03, -0.01], [0, 0.02]])";
  const std::string coupling =
      R"({"joint": "bend", "leader": "turn", "ratio": 0.5, "offset": 0.1, "breakaway": true})";
  check_sidecar_rows({
      {R"("version": 1)", R"("version": 2)", {"version"}},
      {R"("version": 1)", R"("version": "1")", {"version"}},
      {R"("version": 1)", R"("version": 1.5)", {"version"}},
      {R"("format": {"name": "graspfit hand sidecar", "version": 1},)", "", {"format"}},
      {R"("name": "graspfit hand sidecar")", R"("name": "hand")", {"format"}},
      {R"("closing")", R"("closings")", {"closings"}},
      {R"("swing_joint")", R"("swing")", {"fingers", "swing"}},
      {R"("clip": {"kind")", R"("clip": {"sort")", {"pads[0].clip", "sort"}},
      {R"("tip_pad": "one_pad")", R"("tip_pad": "pad")", {"one", "pad"}},
      {R"("links": ["left"])", R"("links": ["lefty"])", {"one", "lefty"}},
      {R"("links": ["left"])", R"("links": [])", {"one", "links"}},
      {R"("links": ["left"])", R"("links": "left")", {"fingers", "links"}},
      {R"("joints": ["slide"])", R"("joints": ["glide"])", {"one", "glide"}},
      {R"("joints": ["slide"])", R"("joints": [1])", {"fingers", "joints"}},
      {R"("swing_joint": null)", R"("swing_joint": "spin")", {"two", "spin"}},
      {thumb, R"("thumb": true)", {"thumb"}},
      {thumb, R"("thumb": "no")", {"thumb"}},
      {fingers, fingers + R"({"name": "two", "links": ["tip"], "joints": ["bend"]},)", {"two"}},
      {fingers, fingers + R"({"name": "palm", "links": ["tip"], "joints": ["bend"]},)", {"palm"}},
      {fingers, fingers + R"({"name": "too", "links": ["tip"], "joints": ["bend"]},)", {"tip"}},
      {R"("tip_pad": "two_pad")", R"("tip_pad": "one_pad")", {"two", "one_pad"}},
      {pads,
       pads + R"({"name": "two_pad", "link": "tip", "finger": "two",
         "frame": {"translation_m": [0, 0, 0], "rotation_wxyz": [1, 0, 0, 0]},
         "outline_m": [[0, 0], [0.01, 0], [0, 0.01]]},)",
       {"two_pad"}},
      {R"("link": "tip")", R"("link": "tipp")", {"two_pad", "tipp"}},
      {R"("link": "tip")", R"("link": "left")", {"two_pad", "left"}},
      {R"("finger": "two")", R"("finger": "three")", {"two_pad", "three"}},
      {R"([0.005, 0, 0])", R"([0.005, "NaN", 0])", {"translation_m"}},
      {R"([0.005, 0, 0])", R"([0.005, null, 0])", {"translation_m"}},
      {R"([0.005, 0, 0])", R"([0.005, 0])", {"translation_m"}},
      {R"([0.5, 0.5, 0.5, 0.5])", R"([0.5, 0.5, 0.5, 0.6])", {"rotation_wxyz"}},
      {R"([0.5, 0.5, 0.5, 0.5])", R"([0, 0, 0, 0])", {"rotation_wxyz"}},
      // Clockwise, not convex, touching itself, without area, too few corners.
      {outline, "[[0, 0.02], [0.03, -0.01], [-0.03, -0.01]]", {"palm_pad", "outline"}},
      {outline, "[[-0.03, -0.01], [0, 0], [0.03, -0.01], [0, 0.02]]", {"palm_pad", "outline"}},
      {outline, "[[0, 0], [1, 0], [0, 1], [1, 1]]", {"palm_pad", "outline"}},
      {outline,
       "[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [1, 0], [1, 1], [0, 1]]",
       {"palm_pad", "outline"}},
      {outline, "[[0, 0], [0.01, 0.01], [0.02, 0.02]]", {"palm_pad", "outline"}},
      {outline, "[[0, 0], [0.01, 0.01]]", {"outline"}},
      {R"("thickness_m": 0.001)", R"("thickness_m": 0)", {"thickness"}},
      {R"("thickness_m": 0.001)", R"("thickness_m": -0.001)", {"thickness"}},
      {R"("thickness_m": 0.001)", R"("thickness_m": "1 mm")", {"thickness"}},
      {R"("palm": {"link": "base")", R"("palm": {"link": "hand")", {"palm", "hand"}},
      {R"("direction": [0, 0, 1])", R"("direction": [0, 0, 0])", {"palm", "direction"}},
      {R"("direction": [0, 0, 1])", R"("direction": "up")", {"palm", "direction"}},
      {R"("pad": "palm_pad")", R"("pad": "flat")", {"palm", "flat"}},
      {R"({"slide": 1, "turn": 1})", R"({"slide": 2, "turn": 1})", {"closing", "slide"}},
      {R"({"slide": 1, "turn": 1})", R"({"slide": 0.5, "turn": 1})", {"closing", "slide"}},
      {R"({"slide": 1, "turn": 1})", R"({"glide": 1, "turn": 1})", {"closing", "glide"}},
      {R"({"slide": 1, "turn": 1})", R"(["slide", "turn"])", {"closing"}},
      {R"({"slide": 1, "turn": 1})", R"({"slide\nturn": 1})", {"closing"}},
      {R"("name": "two_pad")", R"("name": "two\npad")", {"pads"}},
      {coupling, R"({"joint": "bend", "leader": "tern"})", {"bend", "tern"}},
      {coupling, R"({"joint": "bent", "leader": "turn"})", {"coupling", "bent"}},
      {coupling, R"({"joint": "bend", "leader": "bend"})", {"bend"}},
      {coupling,
       R"({"joint": "bend", "leader": "turn"}, {"joint": "turn", "leader": "bend"})",
       {"cycle"}},
      {coupling, coupling + ", " + coupling, {"bend"}},
      {R"("ratio": 0.5)", R"("ratio": "NaN")", {"couplings", "ratio"}},
      {R"(["right", "tip"]])", R"(["right", "tips"]])", {"exclusions", "tips"}},
      {R"(["right", "tip"]])", R"(["right"]])", {"exclusions"}},
      {R"("hand": "pincer")", "\"hands\\nhands\": \"pincer\"", {"hands"}},
      // No JSON any more.
      {R"("version": 1)", R"("version": NaN)", {"not JSON"}, Refusal::Io},
      {R"("version": 1)", R"("version": 0x1)", {"not JSON"}, Refusal::Io},
      {R"([0.005, 0, 0])", R"([0.005, 1e999, 0])", {"1e999"}, Refusal::Io},
      {R"([0.005, 0, 0])", R"([0,005, 0, 0])", {"not JSON"}, Refusal::Io},
      {R"("hand": "pincer")", "\"hand\": \"\xff\"", {"not JSON"}, Refusal::Io},
      {R"("hand": "pincer")", "\"hand\": \"pin\ncer\"", {"not JSON"}, Refusal::Io},
      {R"("hand": "pincer",)", R"("hand": "pincer")", {"not JSON"}, Refusal::Io},
  });
}

TEST_CASE("A palm below which nothing moves is refused", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  HandFiles files;
  files.sidecar = with(files.sidecar, R"("palm": {"link": "base")", R"("palm": {"link": "tip")");
  check_refused(write(folder, files), Refusal::Invalid, {"pincer", "palm", "tip"});
}

TEST_CASE("A sidecar that is no JSON object is refused by what it is", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, Refusal expected) {
    CAPTURE(text.substr(0, 80));
    check_refused(write(folder, {.sidecar = text}), expected, {"pincer.graspfit.json"});
  };
  refused("", Refusal::Io);
  refused("fingers: [one, two]", Refusal::Io);
  refused(std::string(50, '\0'), Refusal::Io);
  refused(kSmallHandSidecar + "{}", Refusal::Io);
  refused(std::string(200000, '['), Refusal::Io);
  refused(std::string(200000, '[') + std::string(200000, ']'), Refusal::Invalid);
  refused("null", Refusal::Invalid);
  refused("[]", Refusal::Invalid);
  refused("3", Refusal::Invalid);
  refused("{}", Refusal::Invalid);
  const fs::path urdf = write(folder, {});
  fs::remove(folder.path() / "package/pincer.graspfit.json");
  fs::create_directory(folder.path() / "package/pincer.graspfit.json");
  check_refused(urdf, Refusal::Io, {"pincer.graspfit.json"});
}

/// `text` without what stands from `member` to the next member, or to the end.
std::string without(std::string text, const std::string& member, const std::string& next) {
  const std::size_t from = text.find(member);
  REQUIRE(from != std::string::npos);
  if (!next.empty()) return text.erase(from, text.find(next) - from);
  text.erase(from, text.rfind('}') - from);
  return text.erase(text.rfind(','), 1);
}

TEST_CASE("Every member of a sidecar may be left out, and is derived", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  // Fingers and pads name each other; what is derived bears other names.
  for (const auto& [member, next] :
       std::vector<std::pair<std::string, std::string>>{{"\"palm\": {", "\"closing\""},
                                                        {"\"closing\"", "\"couplings\""},
                                                        {"\"couplings\"", "\"exclusions\""},
                                                        {"\"exclusions\"", ""}}) {
    CAPTURE(member);
    const hands::HandReading reading =
        hands::read_hand(write(folder, {.sidecar = without(kSmallHandSidecar, member, next)}));
    CHECK_NOTHROW(hands::validate(reading.model));
    CHECK(reading.model.fingers.size() == 2);
    CHECK(reading.model.fingers[0].name == "one");
    CHECK(reading.model.pads.size() >= 3);
    if (member == "\"couplings\"") {  // the URDF's own
      const auto& coupling = reading.model.joints[2].coupling;
      REQUIRE(coupling.has_value());
      CHECK(coupling->ratio == 0.5);
      CHECK_FALSE(coupling->breakaway);
    } else if (member == "\"exclusions\"") {  // nothing that never meets
      CHECK_FALSE(reading.model.is_excluded(reading.model.link_index("left"),
                                            reading.model.link_index("tip")));
    } else {
      CHECK_FALSE(reading.findings.empty());
    }
  }
  // Nothing but the format: all of it.
  const hands::HandReading bare = hands::read_hand(
      write(folder, {.sidecar = R"({"format": {"name": "graspfit hand sidecar", "version": 1}})"}));
  CHECK(bare.model.fingers.size() == 2);
  CHECK_FALSE(bare.findings.empty());
  // No sidecar: the same hand.
  const fs::path urdf = write(folder, {});
  fs::remove(folder.path() / "package/pincer.graspfit.json");
  const hands::HandReading none = hands::read_hand(urdf);
  REQUIRE(none.model.fingers.size() == bare.model.fingers.size());
  REQUIRE(none.model.pads.size() == bare.model.pads.size());
  for (std::size_t p = 0; p < none.model.pads.size(); ++p) {
    CHECK(none.model.pads[p].name == bare.model.pads[p].name);
    CHECK(none.model.pads[p].outline == bare.model.pads[p].outline);
    CHECK(none.model.pads[p].X_LC.matrix() == bare.model.pads[p].X_LC.matrix());
  }
}

/// Whether the hand was read; refusals are of our own and in one line, and what is read holds the
/// model's promises.
bool is_read(const fs::path& file) {
  try {
    const hands::HandModel hand = hands::read_hand_model(file);
    hands::validate(hand);
    for (const hands::RigidTransform& X :
         hands::forward_kinematics(hand, hands::open_configuration(hand))) {
      REQUIRE(X.matrix().allFinite());
    }
    return true;
  } catch (const Error& refusal) {
    INFO(refusal.what());
    REQUIRE(is_one_line(refusal.what()));
    return false;
  }
}

TEST_CASE("Every prefix of a hand's files is read or refused in one line",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  int num_read = 0;
  for (std::string HandFiles::*member : {&HandFiles::urdf, &HandFiles::sidecar, &HandFiles::mesh}) {
    const std::string whole = HandFiles{}.*member;
    // A sidecar is only looked at when the URDF is good, which takes longer.
    const std::size_t step = member == &HandFiles::urdf ? 1 : 3;
    for (std::size_t size = 0; size < whole.size(); size += step) {
      HandFiles files;
      files.*member = whole.substr(0, size);
      CAPTURE(files.*member);
      bool read = false;
      REQUIRE_NOTHROW(read = is_read(write(folder, files)));
      num_read += read;
    }
  }
  CHECK(num_read < 60);  // without the line feed at the end, or an OBJ of fewer faces
}

void damage_the_hand(int times) {
  const TemporaryFolder folder;
  geometry::Random random(11);
  int num_read = 0;
  for (int k = 0; k < times; ++k) {
    HandFiles files;
    std::string& file = k % 2 == 0 ? files.urdf : files.sidecar;
    file = testing::damaged(file, testing::kWordsForHands, random);
    INFO("round " << k);
    CAPTURE(file);
    bool read = false;
    REQUIRE_NOTHROW(read = is_read(write(folder, files)));
    num_read += read;
  }
  // Both happen: names and numbers may change without harm.
  CHECK(num_read > times / 100);
  CHECK(num_read < times / 2);
}

TEST_CASE("Damaged URDFs and sidecars are read or refused in one line", "[hands][bad_hand_files]") {
  damage_the_hand(2000);
}

TEST_CASE("Many more damaged URDFs and sidecars are read or refused in one line",
          "[hands][bad_hand_files][full]") {
  damage_the_hand(200000);
}

/// A chain of links, every joint but the first of one type; its finger has the first.
HandFiles long_chain(int num_links, const std::string& type, bool is_coupled) {
  std::ostringstream urdf;
  urdf << "<robot name=\"chain\"><link name=\"l0\"/>";
  for (int i = 1; i < num_links; ++i) {
    urdf << "<link name=\"l" << i << "\"/><joint name=\"j" << i << "\" type=\""
         << (i == 1 ? "continuous" : type) << "\"><parent link=\"l" << i - 1
         << "\"/><child link=\"l" << i << "\"/><origin xyz=\"0 0 0.001\"/>";
    if (is_coupled && i > 1) urdf << "<mimic joint=\"j" << i - 1 << "\"/>";
    urdf << "</joint>";
  }
  urdf << "</robot>";
  return {.urdf = urdf.str(), .sidecar = R"({
  "format": {"name": "graspfit hand sidecar", "version": 1},
  "fingers": [{"name": "one", "links": ["l1"], "joints": ["j1"]}],
  "pads": [], "palm": {"link": "l0", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
  "closing": {}, "couplings": [], "exclusions": []})"};
}

TEST_CASE("A chain of ten thousand links uses up neither stack nor patience",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  constexpr int kNumLinks = 10000;
  for (const char* type : {"continuous", "fixed"}) {
    CAPTURE(type);
    const hands::HandModel hand =
        hands::read_hand_model(write(folder, long_chain(kNumLinks, type, false)));
    REQUIRE(hand.links.size() == kNumLinks);
    const auto X_OL = hands::forward_kinematics(hand, hands::open_configuration(hand));
    // Sums of ten thousand roundings of at most half a unit in the last place of 10 m.
    CHECK(X_OL.back().translation().z() == Approx(0.001 * (kNumLinks - 1)).margin(1e-11));
  }
  const hands::HandModel coupled =
      hands::read_hand_model(write(folder, long_chain(kNumLinks, "continuous", true)));
  CHECK(coupled.num_intrinsic_dof() == 1);
  CHECK(coupled.joints.back().coupling->leader == 0);
}

/// A locale whose decimals have a comma while it lives: the system's, or one compiled here.
class GermanLocale {
 public:
  GermanLocale() : old_(std::setlocale(LC_ALL, nullptr)) {
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    if (is_set_) return;
    const std::string file = (folder_.path() / "de_DE.UTF-8").string();
    const std::string command = "localedef -i de_DE -f UTF-8 '" + file + "' > /dev/null 2>&1";
    if (std::system(command.c_str()) == -1) return;
    ::setenv("LOCPATH", folder_.path().c_str(), 1);
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  }
  ~GermanLocale() {
    std::setlocale(LC_ALL, old_.c_str());
    ::unsetenv("LOCPATH");
  }
  bool is_set() const { return is_set_; }

 private:
  TemporaryFolder folder_;
  std::string old_;
  bool is_set_ = false;
};

TEST_CASE("A German locale changes neither numbers nor what is refused",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const fs::path file = write(folder, {});
  const hands::HandModel expected = hands::read_hand_model(file);
  const GermanLocale german;
  if (!german.is_set()) {
    GRASPFIT_SKIP_TEST("no German locale, and none could be compiled; install the package locales");
  }
  REQUIRE(std::strtod("1,5", nullptr) == 1.5);
  const hands::HandModel hand = hands::read_hand_model(file);
  REQUIRE(hand.joints.size() == expected.joints.size());
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    CHECK(hand.joints[j].X_PJ.matrix() == expected.joints[j].X_PJ.matrix());
    CHECK(hand.joints[j].lower == expected.joints[j].lower);
    CHECK(hand.joints[j].upper == expected.joints[j].upper);
  }
  for (std::size_t p = 0; p < hand.pads.size(); ++p) {
    CHECK(hand.pads[p].X_LC.matrix() == expected.pads[p].X_LC.matrix());
    CHECK(hand.pads[p].outline == expected.pads[p].outline);
  }
  for (std::size_t i = 0; i < hand.links.size(); ++i) {
    CHECK(hand.links[i].mesh_L == expected.links[i].mesh_L);
  }
  HandFiles comma;
  comma.urdf = with(comma.urdf, R"(upper="0.03")", R"(upper="0,03")");
  check_refused(write(folder, comma), Refusal::Invalid, {"slide", "0,03"});
  check_refused(write(folder, {.urdf = with(kSmallHandUrdf, R"(upper="0.03")", R"(upper="-0.5")")}),
                Refusal::Invalid, {"slide", "-0.5"});
}

}  // namespace
