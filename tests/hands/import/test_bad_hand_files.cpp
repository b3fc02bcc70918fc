#include <string>
#include <vector>

#include "hands/bad_hand_files.hpp"

namespace test_bad_hand_files {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

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
      // A name has a line feed in it, as XML may have; the message is still one line.
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
  // The nesting would use up a stack.
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
  // Good meshes that are none of this hand's business lie outside, and ways to them stay hidden
  // until links are followed.
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
  // The message says what would let the description have the file: what begins a package, and
  // where.
  const auto with_path = [&](const std::string& path) {
    HandFiles files;
    files.urdf = with(files.urdf, "meshes/bar.obj", path);
    return write(folder, files);
  };
  const std::string cure = "; an empty file package.xml in " +
                           fs::weakly_canonical(folder.path()).string() + " makes one of both";
  check_refused(with_path("../outside/bar.obj"), Refusal::Invalid, {cure});
  check_refused(with_path("/etc/passwd"), Refusal::Invalid, {"; copy it there"});
  folder.write("package.xml", "");
  CHECK_NOTHROW(hands::read_hand(with_path("../outside/bar.obj")));
  folder.write("package/package.xml", "");
  check_refused(with_path("../outside/bar.obj"), Refusal::Invalid,
                {"; move its package.xml to " + fs::weakly_canonical(folder.path()).string()});
  fs::remove(folder.path() / "package.xml");
  fs::remove(folder.path() / "package/package.xml");
  // The same mesh within the package is accepted, however roundabout its path is.
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
        std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n"),  // It has no faces.
        std::string("f 1 2 3\n"), with(kSmallHandMesh, last, "f 4 5 9\n"),
        with(kSmallHandMesh, last, "f 4 5 2147483648\n"),
        with(kSmallHandMesh, last, "f 4 5 18446744073709551617\n"),
        with(kSmallHandMesh, last, "f 4 5 0\n"), with(kSmallHandMesh, last, "f 4 5 -9\n"),
        with(kSmallHandMesh, "v 0.5 0.5 0.5\n", "v 0.5 nan 0.5\n"),
        with(kSmallHandMesh, "v 0.5 0.5 0.5\n", "v 0.5 1e999 0.5\n"),
        std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")}) {  // It has no area.
    CAPTURE(mesh);
    const fs::path file = write(folder, {.mesh = mesh});
    // Which of the two is thrown depends on whether the file or what it holds is at fault.
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
    // A surface that cannot be closed is that of the link, of one or more files.
    const bool names_mesh = message.find("bar.obj") != std::string::npos;
    CHECK((names_mesh || message.find("its surface is not closed") != std::string::npos));
    CHECK(hands::check_hand(file).count(hands::FindingKind::Fault) > 0);
  }
}

}  // namespace

}  // namespace test_bad_hand_files
