#include <clocale>
#include <filesystem>
#include <locale>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_hand_io {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::HandModel;
namespace fs = std::filesystem;
using Folder = testing::TemporaryFolder;

const std::string kUrdf = R"(<?xml version="1.0"?>
<robot name="pinch">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.02"/></geometry></collision></link>
  <link name="left"><visual><origin xyz="0 0 0.05"/><geometry><cylinder radius="0.01" length="0.1"/></geometry></visual></link>
  <link name="left_tip"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
  <link name="right"/>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="left"/>
    <origin xyz="0.04 0 0.01" rpy="0 0 1.5"/><axis xyz="0 2 0"/><limit lower="-0.01" upper="+0.03" effort="1" velocity="1"/>
  </joint>
  <joint name="mount" type="fixed"><parent link="left"/><child link="left_tip"/><origin xyz="0 0 0.1"/></joint>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="right"/><mimic joint="slide" multiplier="-2" offset="0.5"/>
  </joint>
</robot>
)";

const std::string kSidecar = R"({
  "format": {"name": "graspfit hand sidecar", "version": 1},
  "fingers": [
    {"name": "left", "links": ["left", "left_tip"], "joints": ["slide"]},
    {"name": "right", "links": ["right"], "joints": ["turn"], "swing_joint": "turn"}
  ],
  "pads": [
    {"name": "left_pad", "link": "left_tip", "finger": "left",
     "frame": {"translation_m": [0.01, 0, 0], "rotation_wxyz": [0.7071, 0, 0.7071, 0]},
     "outline_m": [[0.01, -0.01], [0.01, 0.01], [-0.01, 0.01], [-0.01, -0.01]]}
  ],
  "palm": {"link": "base", "center_m": [0, 0, 0.01], "direction": [0, 0, 2]},
  "closing": {"slide": -1},
  "couplings": [],
  "exclusions": [["base", "left"]]
})";

fs::path write_hand(const Folder& folder, const std::string& urdf = kUrdf,
                    const std::string& sidecar = kSidecar) {
  folder.write("pinch.graspfit.json", sidecar);
  return folder.write("pinch.urdf", urdf);
}

/// Returns `text` with the only occurrence of `old` replaced.
std::string with(std::string text, const std::string& old, const std::string& fresh) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), fresh);
}

/// Checks that reading throws `Exception` with one line that names the file and contains `about`.
template <typename Exception>
void check_refused(const fs::path& file, const std::string& names_file, const std::string& about) {
  CAPTURE(about);
  try {
    hands::read_hand_model(file);
    FAIL("accepted");
  } catch (const Exception& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(message.find(names_file) != std::string::npos);
    CHECK(message.find(about) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("A small description is read as it is written", "[hands][hand_io]") {
  const Folder folder;
  const HandModel hand = hands::read_hand_model(write_hand(folder));
  CHECK(hand.name == "pinch");
  REQUIRE(hand.links.size() == 4);
  CHECK(hand.links[0].name == "base");
  CHECK(hand.links[1].name == "left");
  CHECK(hand.links[2].name == "left_tip");
  CHECK_FALSE(hand.links[2].parent_joint);
  CHECK(hand.links[2].X_PL_fixed.translation() == Vector3d(0, 0, 0.1));
  REQUIRE(hand.joints.size() == 2);
  const hands::Joint& slide = hand.joints[0];
  CHECK(slide.type == hands::JointType::Prismatic);
  CHECK(slide.axis_J == Vector3d(0, 1, 0));
  CHECK(slide.lower == -0.01);
  CHECK(slide.upper == 0.03);
  CHECK(slide.closing_sign == -1);
  const hands::Joint& turn = hand.joints[1];
  CHECK(turn.axis_J == Vector3d(1, 0, 0));
  REQUIRE(turn.coupling.has_value());
  CHECK(turn.coupling->ratio == -2.0);
  CHECK(turn.coupling->offset == 0.5);
  // It follows a closing joint of sign −1 by a negative ratio.
  CHECK(turn.closing_sign == 1);
  CHECK(hand.palm.direction_H == Vector3d(0, 0, 1));
  CHECK(!hand.palm.pad);
  CHECK(hand.fingers[0].tip_pad == 0);
  CHECK(!hand.fingers[1].tip_pad);
  CHECK(hand.is_excluded(0, 1));
  CHECK(hand.is_excluded(1, 2));  // They are fixed to each other.
  CHECK_FALSE(hand.is_excluded(0, 2));
  CHECK_FALSE(hand.pads[0].clip_thickness.has_value());
  CHECK((hand.pads[0].X_LC.linear().col(2) - Vector3d(1, 0, 0)).norm() < 1e-12);
  // Of the primitives the box is exact, the cylinder inscribed and moved.
  CHECK(geometry::signed_volume(hand.links[0].mesh_L) == Approx(0.1 * 0.1 * 0.02));
  CHECK(geometry::bounding_box(hand.links[1].mesh_L).min().z() == Approx(0.0).margin(1e-12));
  CHECK(geometry::bounding_box(hand.links[1].mesh_L).max().z() == Approx(0.1));
  CHECK(hand.links[3].mesh_L.faces.empty());
}

TEST_CASE("Meshes are found beside the description and scaled, mirrored ones turned outward",
          "[hands][hand_io]") {
  const Folder folder;
  const std::string tetrahedron =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  folder.write("pinch/meshes/part.obj", tetrahedron);
  for (const std::string& name :
       {std::string("meshes/part.obj"), std::string("./meshes/../meshes/part.obj"),
        std::string("package://pinch/meshes/part.obj"),
        std::string("package://other/meshes/part.obj"),
        "file://" + (folder.path() / "pinch/meshes/part.obj").string()}) {
    CAPTURE(name);
    const std::string urdf = with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>",
                                  "<mesh filename=\"" + name + "\" scale=\"0.01 -0.02 0.03\"/>");
    folder.write("pinch/pinch.graspfit.json", kSidecar);
    const HandModel hand = hands::read_hand_model(folder.write("pinch/pinch.urdf", urdf));
    CHECK(hand.links[0].mesh_files == std::vector<std::string>{"meshes/part.obj"});
    CHECK(geometry::signed_volume(hand.links[0].mesh_L) == Approx(0.01 * 0.02 * 0.03 / 6));
    CHECK(geometry::bounding_box(hand.links[0].mesh_L).min().y() == Approx(-0.02));
  }
}

TEST_CASE("Meshes may lie in a folder meshes beside the description's own, and no farther",
          "[hands][hand_io]") {
  const Folder folder;
  const std::string tetrahedron =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  folder.write("clone/meshes/visual/part.obj", tetrahedron);
  folder.write("clone/other/part.obj", tetrahedron);
  folder.write("meshes/part.obj", tetrahedron);
  folder.write("clone/urdf/pinch.graspfit.json", kSidecar);
  const auto hand_of = [&](const std::string& name) {
    const std::string urdf = with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>",
                                  "<mesh filename=\"" + name + "\" scale=\"0.01 0.02 0.03\"/>");
    return hands::read_hand_model(folder.write("clone/urdf/pinch.urdf", urdf));
  };
  // The folder of the clone need not be named after the package.
  for (const char* name : {"../meshes/visual/part.obj", "package://pinch/meshes/visual/part.obj"}) {
    CAPTURE(name);
    CHECK(hand_of(name).links[0].mesh_files ==
          std::vector<std::string>{"../meshes/visual/part.obj"});
  }
  for (const char* name :
       {"../other/part.obj", "../meshes/../other/part.obj", "../../meshes/part.obj"}) {
    CAPTURE(name);
    CHECK_THROWS_AS(hand_of(name), base::InvalidInput);
  }
  // This folder only looks as if it were there.
  fs::remove_all(folder.path() / "clone/meshes");
  fs::create_directory_symlink(folder.path() / "clone/other", folder.path() / "clone/meshes");
  CHECK_THROWS_AS(hand_of("../meshes/part.obj"), base::InvalidInput);
}

TEST_CASE("Links are known again by the bytes of their mesh files", "[hands][hand_io]") {
  const Folder folder;
  const std::string tetrahedron =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  folder.write("meshes/part.obj", tetrahedron);
  const std::string mesh = "<mesh filename=\"meshes/part.obj\" scale=\"0.01 0.02 0.03\"/>";
  const HandModel hand =
      hands::read_hand_model(write_hand(folder, with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>", mesh)));
  const std::vector<std::string> hashes = hands::link_mesh_hashes(hand);
  REQUIRE(hashes.size() == hand.links.size());
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    CHECK(hashes[i] == (hand.links[i].name == "base" ? base::sha256_hex(tetrahedron) : ""));
  }
  fs::remove(folder.path() / "meshes/part.obj");
  CHECK_THROWS_AS(hands::link_mesh_hashes(hand), base::IoError);
}

TEST_CASE("Couplings alone are a whole sidecar", "[hands][hand_io]") {
  const Folder folder;
  folder.write("claw.graspfit.json",
               R"({"couplings": [{"joint": "right_hinge", "leader": "left_hinge"}]})");
  const HandModel hand = hands::read_hand_model(folder.write("claw.urdf", R"(<robot name="claw">
  <link name="palm"><collision><origin xyz="0 0 -0.015"/><geometry><box size="0.09 0.06 0.03"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0 0 0.045"/><geometry><box size="0.012 0.025 0.09"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0 0 0.045"/><geometry><box size="0.012 0.025 0.09"/></geometry></collision></link>
  <joint name="left_hinge" type="revolute"><parent link="palm"/><child link="left"/>
    <origin xyz="-0.035 0 0.001"/><axis xyz="0 1 0"/><limit lower="-0.5" upper="0.3"/></joint>
  <joint name="right_hinge" type="revolute"><parent link="palm"/><child link="right"/>
    <origin xyz="0.035 0 0.001"/><axis xyz="0 -1 0"/><limit lower="-0.5" upper="0.3"/></joint>
</robot>)"));
  REQUIRE(hand.joints[1].coupling.has_value());
  CHECK(hand.joints[1].coupling->leader == 0);
  CHECK(hand.joints[1].coupling->ratio == 1.0);
  CHECK(hand.num_intrinsic_dof() == 1);
  CHECK(hand.fingers.size() == 2);
  CHECK(hand.pads.size() >= 2);
}

TEST_CASE("The sidecar's couplings override <mimic>, and chains lead to the first leader",
          "[hands][hand_io]") {
  const Folder folder;
  const std::string sidecar =
      with(kSidecar, R"("couplings": [])",
           R"("couplings": [{"joint": "turn", "leader": "slide", "ratio": 4, "breakaway": true}])");
  const HandModel hand = hands::read_hand_model(write_hand(folder, kUrdf, sidecar));
  CHECK(hand.joints[1].coupling->ratio == 4.0);
  CHECK(hand.joints[1].coupling->offset == 0.0);
  CHECK(hand.joints[1].coupling->breakaway);
  CHECK(hand.joints[1].closing_sign == -1);

  const std::string chain = with(kUrdf, "</robot>", R"(
  <link name="third"/>
  <joint name="third_turn" type="revolute"><parent link="right"/><child link="third"/>
    <limit lower="0" upper="1"/><mimic joint="turn" multiplier="3" offset="0.1"/></joint>
</robot>)");
  const HandModel chained = hands::read_hand_model(write_hand(folder, chain));
  // The equation is 3 (-2 q + 0.5) + 0.1.
  CHECK(chained.joints[2].coupling->leader == 0);
  CHECK(chained.joints[2].coupling->ratio == -6.0);
  CHECK(chained.joints[2].coupling->offset == Approx(1.6));
}

TEST_CASE("A bad description gives one line with the file and the item", "[hands][hand_io]") {
  const Folder folder;
  using base::InvalidInput;
  using base::IoError;
  const auto bad = [&](const std::string& urdf, const std::string& about) {
    check_refused<InvalidInput>(write_hand(folder, urdf), "pinch.urdf", about);
  };
  const auto unreadable = [&](const std::string& urdf, const std::string& about) {
    check_refused<IoError>(write_hand(folder, urdf), "pinch.urdf", about);
  };
  check_refused<IoError>(folder.path() / "none.urdf", "none.urdf", "no such hand description");
  check_refused<IoError>(folder.path(), folder.path().filename().string(), "is not a file");
  unreadable("", "empty file");
  unreadable("solid cube\nfacet normal 0 0 1\n", "not XML");
  unreadable("<robot name=\"x\"><link name=\"a\"></robot>", "line 1: not XML");
  unreadable("<sdf version=\"1.7\"/>", "its root element is <sdf>");
  bad("<robot name=\"x\"/>", "no links");
  bad(with(kUrdf, "name=\"pinch\"", "name=\"\""), "<robot> has no name");
  bad(with(kUrdf, "<link name=\"right\"/>", "<xacro:finger/>"), "this is a xacro file");
  bad(with(kUrdf, "<link name=\"right\"/>", "<link name=\"left\"/>"),
      "line 6: two links named left");
  bad(with(kUrdf, "joint name=\"mount\"", "joint name=\"slide\""), "two joints named slide");
  bad(with(kUrdf, "<child link=\"right\"/>", "<child link=\"wrong\"/>"),
      "joint turn: no link named wrong");
  bad(with(kUrdf, "<child link=\"right\"/>", "<child link=\"left\"/>"),
      "link left hangs on two joints, slide and turn");
  bad(with(kUrdf, "type=\"fixed\"", "type=\"ball\""), "joint mount: type ball");
  bad(with(kUrdf, "xyz=\"0 2 0\"", "xyz=\"0 0 0\""), "joint slide: axis 0 0 0");
  bad(with(kUrdf, "xyz=\"0 2 0\"", "xyz=\"0 nan 0\""), "\"0 nan 0\" is not finite");
  bad(with(kUrdf, "xyz=\"0 2 0\"", "xyz=\"0 2\""), "has 2 of 3 numbers");
  bad(with(kUrdf, "xyz=\"0 2 0\"", "xyz=\"0 2,5 0\""), "is not a number");
  bad(with(kUrdf, "lower=\"-0.01\"", "lower=\"0.31\""),
      "joint slide: limits 0.31 to 0.03 are reversed");
  bad(with(kUrdf, "<limit lower=\"-0.01\" upper=\"+0.03\" effort=\"1\" velocity=\"1\"/>", ""),
      "joint slide: no limits");
  bad(with(kUrdf, "radius=\"0.01\" length", "radius=\"-1\" length"), "not positive");
  bad(with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>", "<capsule/>"), "geometry <capsule> is none of");
  unreadable(with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>", "<mesh filename=\"lost.obj\"/>"),
             "link base: mesh lost.obj is not there");
  bad(with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>", "<mesh filename=\"../../etc/part.obj\"/>"),
      "lies outside the description's package");
  bad(with(kUrdf, "<box size=\"0.1 0.1 0.02\"/>", "<mesh filename=\"http://x/part.obj\"/>"),
      "only files and package:// are read");
}

TEST_CASE("A tree without root, with two roots or without movable joint is refused",
          "[hands][hand_io]") {
  const Folder folder;
  const auto bad = [&](const std::string& urdf, const std::string& about) {
    check_refused<base::InvalidInput>(write_hand(folder, urdf), "pinch.urdf", about);
  };
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& type = "continuous") {
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/></joint>";
  };
  const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>";
  bad("<robot name=\"x\">" + links + joint("1", "a", "b") + joint("2", "b", "c") +
          joint("3", "c", "a") + "</robot>",
      "cycle");
  bad("<robot name=\"x\">" + links + joint("1", "b", "c") + joint("2", "c", "b") + "</robot>",
      "cycle");
  bad("<robot name=\"x\">" + links + joint("1", "a", "b") + "</robot>", "a and c are both roots");
  bad("<robot name=\"x\">" + links + joint("1", "a", "b", "fixed") + joint("2", "b", "c", "fixed") +
          "</robot>",
      "no movable joint");
}

TEST_CASE("A bad sidecar gives one line with the file and the item", "[hands][hand_io]") {
  const Folder folder;
  using base::InvalidInput;
  using base::IoError;
  const auto bad = [&](const std::string& old, const std::string& fresh, const std::string& about) {
    check_refused<InvalidInput>(write_hand(folder, kUrdf, with(kSidecar, old, fresh)),
                                "pinch.graspfit.json", about);
  };
  check_refused<IoError>(write_hand(folder, kUrdf, "{\"format\": "), "pinch.graspfit.json",
                         "is not JSON: parse error at line 1");
  check_refused<IoError>(write_hand(folder, kUrdf, ""), "pinch.graspfit.json", "is not JSON");
  check_refused<InvalidInput>(write_hand(folder, kUrdf, "[]"), "pinch.graspfit.json",
                              "/: is [], must be an object");
  bad("\"version\": 1", "\"version\": 2", "/format: version is not 1");
  bad("graspfit hand sidecar", "another", "/format: name is not");
  bad("\"closing\"", "\"closings\"",
      "/closings: is not a member that is known here; there are format, ");
}

TEST_CASE("Names and values in a sidecar are checked against the description", "[hands][hand_io]") {
  const Folder folder;
  using base::InvalidInput;
  const auto bad = [&](const std::string& old, const std::string& fresh, const std::string& about) {
    check_refused<InvalidInput>(write_hand(folder, kUrdf, with(kSidecar, old, fresh)),
                                "pinch.graspfit.json", about);
  };
  bad("\"joints\": [\"slide\"]", "\"joints\": [\"slid\"]",
      "finger left: the description has no movable joint named slid");
  bad("\"joints\": [\"slide\"]", "\"joints\": [\"mount\"]", "no movable joint named mount");
  bad("[\"left\", \"left_tip\"]", "[\"left\", \"tip\"]", "no link named tip");
  bad("[\"left\", \"left_tip\"]", "\"left\"", "/fingers/0/links: is \"left\", must be an array");
  bad("\"finger\": \"left\"", "\"finger\": \"middle\"", "pad left_pad: no finger named middle");
  bad("\"link\": \"left_tip\"", "\"link\": \"right\"", "its link right is none of finger left");
  bad("[0.7071, 0, 0.7071, 0]", "[1, 0, 1, 0]",
      "/pads/0/frame/rotation_wxyz: is not a unit quaternion");
  bad("[0.7071, 0, 0.7071, 0]", "[1, 0, 0]", "has 3 of 4 numbers");
  bad("[0.01, 0, 0]", "[0.01, \"0\", 0]",
      "/pads/0/frame/translation_m/1: is \"0\", must be a number");
  bad("\"direction\": [0, 0, 2]", "\"direction\": [0, 0, 0]", "/palm/direction: is zero");
  bad("\"slide\": -1", "\"slide\": 3", "/closing/slide: is none of -1, 0, 1");
  bad("\"slide\": -1", "\"shut\": 1", "closing: the description has no movable joint named shut");
  bad("[[\"base\", \"left\"]]", "[[\"base\"]]", "/exclusions/0: is not a pair");
  bad("\"couplings\": []", "\"couplings\": [{\"joint\": \"slide\", \"leader\": \"turn\"}]",
      "cycle");
  bad("\"name\": \"right\"", "\"name\": \"left\"", "two fingers named left");
  bad("[[0.01, -0.01], [0.01, 0.01], [-0.01, 0.01], [-0.01, -0.01]]", "[[0, 0], [1, 1], [2, 2]]",
      "outline has no area");
}

TEST_CASE("A curved pad is read, and one that is not convex is refused with its point",
          "[hands][hand_io]") {
  const Folder folder;
  const std::string end = "[-0.01, -0.01]]}";
  const auto curved = [&](const std::string& fields) {
    return write_hand(folder, kUrdf, with(kSidecar, end, "[-0.01, -0.01]], " + fields + "}"));
  };
  const HandModel hand = hands::read_hand_model(
      curved(R"("surface_m": [[0, 0, 0.004], [0.004, 0, 0.003]], "clip": {"kind": "offset"})"));
  REQUIRE(hand.pads[0].surface.size() == 2);
  CHECK(hand.pads[0].surface[1] == Vector3d(0.004, 0, 0.003));
  CHECK(hands::pad_height(hand.pads[0]) == 0.004);
  CHECK(hand.pads[0].planes.size() >= 4);
  using base::InvalidInput;
  const auto bad = [&](const std::string& fields, const std::string& about) {
    check_refused<InvalidInput>(curved(fields), "pinch.graspfit.json", about);
  };
  bad(R"("surface_m": [])", "/pads/0/surface_m: is empty");
  bad(R"("surface_m": [[0, 0]])", "/pads/0/surface_m/0: has 2 of 3 numbers");
  bad(R"("surface_m": [[0, 0, -0.001]])", "surface point 0 lies behind the pad's plane");
  bad(R"("surface_m": [[0.02, 0, 0.001]])", "surface point 0 lies beside the outline");
  bad(R"("surface_m": [[0.008, 0, 0.003], [0, 0, 0.001], [-0.008, 0, 0.003]])",
      "surface point 1 lies below the others");
  bad(R"("surface_m": [[0, 0, 0.004]], "clip": {"kind": "prism"})",
      "the clip volume of a pad with surface_m is \"offset\"");
  bad(R"("clip": {"kind": "offset"})", "the clip volume of a flat pad is \"prism\"");
  bad(R"("clip": {"kind": "box"})", "is neither \"prism\" nor \"offset\"");
}

TEST_CASE("Masses are read where they are given, inertia turned into the link's axes",
          "[hands][hand_io]") {
  const Folder folder;
  const std::string old = R"(<link name="right"/>)";
  const auto hand_with = [&](const std::string& inertial) {
    return write_hand(
        folder,
        with(kUrdf, old, "<link name=\"right\"><inertial>" + inertial + "</inertial></link>"));
  };
  // A quarter turn about z swaps x and y: ixx and iyy are swapped, and ixy has the other sign.
  const HandModel hand = hands::read_hand_model(
      hand_with(R"(<origin xyz="0.1 0 -0.2" rpy="0 0 1.5707963267948966"/><mass value="0.25"/>
                   <inertia ixx="1e-4" ixy="2e-5" ixz="0" iyy="3e-4" iyz="0" izz="4e-4"/>)"));
  const auto& inertia = hand.links[static_cast<std::size_t>(hand.link_index("right"))].inertia;
  REQUIRE(inertia.has_value());
  CHECK(inertia->mass == 0.25);
  CHECK(inertia->center_L == Vector3d(0.1, 0, -0.2));
  Eigen::Matrix3d expected;
  expected << 3e-4, -2e-5, 0, -2e-5, 1e-4, 0, 0, 0, 4e-4;
  CHECK((inertia->inertia_L - expected).norm() < 1e-18);
  CHECK_FALSE(hand.links[0].inertia.has_value());
  check_refused<base::InvalidInput>(hand_with(""), "pinch.urdf",
                                    "link right: <inertial> without <mass>");
  check_refused<base::InvalidInput>(hand_with(R"(<mass value="-1"/>)"), "pinch.urdf",
                                    "link right: <mass> is negative");
  check_refused<base::InvalidInput>(hand_with(R"(<mass value="nan"/>)"), "pinch.urdf",
                                    "is not finite");
}

/// Writes a decimal comma, as in many countries.
class DecimalComma : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
};

TEST_CASE("Numbers are read the same in a locale with a decimal comma", "[hands][hand_io]") {
  const Folder folder;
  const fs::path file = write_hand(folder);
  const std::locale old = std::locale::global(std::locale(std::locale(), new DecimalComma));
  const std::string old_c = std::setlocale(LC_ALL, nullptr);
  // This has no effect where the locale is not installed.
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  const HandModel hand = hands::read_hand_model(file);
  std::setlocale(LC_ALL, old_c.c_str());
  std::locale::global(old);
  CHECK(hand.joints[0].upper == 0.03);
  CHECK(hand.pads[0].X_LC.translation().x() == 0.01);
}

}  // namespace

}  // namespace test_hand_io
