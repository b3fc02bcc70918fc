#include "hands/mjcf_reading.hpp"

namespace test_mjcf {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

TEST_CASE("MJCF: includes, defaults, degrees and frames come out as written", "[hands][mjcf]") {
  const TemporaryFolder folder;
  folder.write("deep/finger.xml", R"(<mujocoinclude>
    <body name="finger" pos=".1 .2 .3" euler="0 90 30">
      <joint name="bend" class="finger"/>
      <geom class="finger"/><geom type="sphere" size=".01" pos="0 0 .1"/>
    </body></mujocoinclude>)");
  const Reading reading = read(folder.write("hand.xml", R"(
    <mujoco model="pinch">
      <compiler angle="degree" eulerseq="zyx" autolimits="true"/>
      <default><geom contype="0" conaffinity="0"/>
        <default class="finger">
          <joint axis="0 3 4" range="-30 90"/><geom type="box" size=".01 .02 .03" contype="1"/>
        </default>
      </default>
      <worldbody><body name="palm"><include file="deep/finger.xml"/></body></worldbody>
    </mujoco>)"));
  CHECK(reading.robot.name == "pinch");
  REQUIRE(reading.robot.links.size() == 2);
  CHECK(reading.robot.links[0].name == "palm");
  const DescribedJoint& bend = reading.joint("bend");
  CHECK(bend.type == DescribedJoint::Type::Revolute);
  CHECK(bend.parent == "palm");
  CHECK(bend.child == "finger");
  CHECK((bend.axis - Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
  CHECK(bend.lower == Approx(-kPi / 6).epsilon(1e-15));
  CHECK(bend.upper == Approx(kPi / 2).epsilon(1e-15));
  // The frame is turned about z by 0, then about the new y by 90, then about the new x by 30
  // degrees: x looks down, y lies in the parent's x-y plane.
  CHECK((bend.X_PJ.translation() - Vector3d(0.1, 0.2, 0.3)).norm() < 1e-15);
  CHECK((bend.X_PJ.linear().col(0) - Vector3d(0, 0, -1)).norm() < 1e-15);
  CHECK((bend.X_PJ.linear().col(1) - Vector3d(0.5, std::sqrt(0.75), 0)).norm() < 1e-15);
  const DescribedLink& finger = reading.link("finger");
  REQUIRE(finger.collision.size() == 1);
  CHECK(std::get<hands::internal::BoxShape>(finger.collision[0].shape).size ==
        Vector3d(0.02, 0.04, 0.06));
  REQUIRE(finger.visual.size() == 1);
  CHECK(std::get<hands::internal::SphereShape>(finger.visual[0].shape).radius == 0.01);
  CHECK(finger.visual[0].X_LG.translation() == Vector3d(0, 0, 0.1));
}

TEST_CASE("MJCF: a joint's anchor and ref move the link as MuJoCo does", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const Reading reading = read(folder.write("hand.xml", mjcf(R"(
    <body name="palm">
      <body name="f" pos="0 0 1">
        <joint name="turn" axis="0 0 1" pos=".1 0 5" ref=".5" range="0 3"/>
        <joint name="slide" type="slide" axis="1 0 0" ref=".02" range="0 .1"/>
        <geom size=".01"/>
      </body>
      <body><joint axis="0 0 2" pos="0 0 7"/><geom size=".01"/></body>
    </body>)")));
  CHECK(reading.joint("turn").child == "f__turn");
  CHECK(reading.joint("slide").parent == "f__turn");
  CHECK(reading.joint("slide").child == "f");
  CHECK(!reading.link("f__turn").inertia.has_value());
  // An anchor on the axis through the origin counts as none; an unlimited hinge makes one turn.
  const DescribedJoint& free = reading.joint("body_3_joint");
  CHECK(free.child == "body_3");
  CHECK(free.type == DescribedJoint::Type::Continuous);
  CHECK(free.lower == -kPi);
  CHECK(free.upper == kPi);
  // A quarter turn beyond ref about (0.1, 0) takes the origin to (0.1, -0.1) and x to y; the slide
  // then goes 3 cm along that.
  const RigidTransform X =
      link_poses(reading.robot, {{"turn", 0.5 + kPi / 2}, {"slide", 0.05}}).at("f");
  CHECK((X.translation() - Vector3d(0.1, -0.07, 1.0)).norm() < 1e-15);
  CHECK((X.linear().col(0) - Vector3d(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("MJCF: geoms of every kind become the shapes that they are", "[hands][mjcf]") {
  const TemporaryFolder folder;
  // The mesh is a tetrahedron of volume 1/6 beside the origin, as OBJ with two normals per corner.
  folder.write("package.xml", "");
  folder.write("meshes/corner.obj",
               "v 2 0 0\nv 3 0 0\nv 2 1 0\nv 2 0 1\nvn 0 0 -1\nvn 1 0 0\n"
               "f 1//1 3//1 2//1\nf 1//2 2//2 4//2\nf 1//2 4//1 3//1\nf 2//1 3//2 4//2\n");
  folder.write("robot/assets.xml",
               R"(<assets><mesh name="m" file="corner.obj" scale=".1 .1 .2"/></assets>)");
  const Reading reading = read(folder.write("robot/hand.xml", R"(
    <mujoco><compiler angle="radian" meshdir="../meshes"/>
      <asset><include file="assets.xml"/></asset>
      <worldbody><body name="palm">
        <geom type="sphere" size=".01" pos="1 2 3"/>
        <geom type="capsule" fromto="0 0 0 0 .2 0" size=".02"/>
        <geom type="cylinder" size=".03 .04"/>
        <geom type="ellipsoid" size=".01 .02 .03"/>
        <geom type="box" size=".01 .02 .03" quat=".6 0 0 .8"/>
        <geom type="mesh" mesh="m" pos="0 0 .5"/>
        <geom type="plane" size="1 1 1"/>
        <body name="f"><joint axis="0 0 1"/><geom size=".1"/></body>
      </body></worldbody></mujoco>)"));
  using namespace hands::internal;
  const auto& parts = reading.link("palm").collision;
  REQUIRE(parts.size() == 6);
  CHECK(std::get<SphereShape>(parts[0].shape).radius == 0.01);
  CHECK(parts[0].X_LG.translation() == Vector3d(1, 2, 3));
  CHECK(std::get<CapsuleShape>(parts[1].shape).radius == 0.02);
  CHECK(std::get<CapsuleShape>(parts[1].shape).length == Approx(0.2).epsilon(1e-15));
  CHECK((parts[1].X_LG.translation() - Vector3d(0, 0.1, 0)).norm() < 1e-15);
  CHECK(std::abs(parts[1].X_LG.linear()(1, 2)) == Approx(1.0).epsilon(1e-15));
  CHECK(std::get<CylinderShape>(parts[2].shape).length == 0.08);
  CHECK(std::get<EllipsoidShape>(parts[3].shape).radii == Vector3d(0.01, 0.02, 0.03));
  CHECK(std::get<BoxShape>(parts[4].shape).size == Vector3d(0.02, 0.04, 0.06));
  CHECK((parts[4].X_LG.linear().col(0) - Vector3d(-0.28, 0.96, 0)).norm() < 1e-15);
  CHECK(reading.has(FindingKind::Note, "link palm: its planes"));
  CHECK(reading.has(FindingKind::Note, "single precision"));

  // The mesh is where the file says, though MuJoCo keeps it about its center of mass.
  const auto& loaded = std::get<LoadedMeshShape>(parts[5].shape);
  CHECK(loaded.filename == "../meshes/corner.obj");
  REQUIRE(loaded.mesh.vertices.size() == 4);
  REQUIRE(loaded.mesh.faces.size() == 4);
  const geometry::TriangleMesh mesh_L = geometry::transformed(loaded.mesh, parts[5].X_LG);
  const std::array<Vector3d, 4> corners = {Vector3d(0.2, 0, 0.5), Vector3d(0.3, 0, 0.5),
                                           Vector3d(0.2, 0.1, 0.5), Vector3d(0.2, 0, 0.7)};
  for (const Vector3d& corner : corners) {
    double nearest = 1.0;
    for (const Vector3d& v : mesh_L.vertices) nearest = std::min(nearest, (v - corner).norm());
    CHECK(nearest < 1e-7);  // Single precision of 0.3 m is 3e-8.
  }
  CHECK(geometry::signed_volume(mesh_L) == Approx(0.1 * 0.1 * 0.2 / 6).epsilon(1e-5));
}

TEST_CASE("MJCF: masses and inertias are turned into the link's frame", "[hands][mjcf]") {
  const TemporaryFolder folder;
  const Reading reading = read(folder.write("hand.xml", mjcf(R"(
    <body name="palm"><geom type="box" size=".1 .2 .3" density="100"/>
      <body name="f"><joint axis="0 0 1"/><geom size=".01"/>
        <inertial pos="1 2 3" quat=".6 0 0 .8" mass="2" diaginertia=".1 .2 .25"/></body>
    </body>)")));
  const hands::LinkInertia& palm = *reading.link("palm").inertia;
  CHECK(palm.mass == Approx(0.2 * 0.4 * 0.6 * 100).epsilon(1e-14));
  // The moment of a box is m (b² + c²) / 12.
  CHECK(palm.inertia_L(0, 0) == Approx(4.8 * (0.16 + 0.36) / 12).epsilon(1e-14));
  CHECK(palm.inertia_L(2, 2) == Approx(4.8 * (0.04 + 0.16) / 12).epsilon(1e-14));
  const hands::LinkInertia& f = *reading.link("f").inertia;
  CHECK(f.mass == 2.0);
  CHECK(f.center_L == Vector3d(1, 2, 3));
  // With R = [c −s; s c], c = −0.28 and s = 0.96 it is Ixx = c² 0.1 + s² 0.2, Ixy = c s (0.1 −
  // 0.2).
  CHECK(f.inertia_L(0, 0) == Approx(0.0784 * 0.1 + 0.9216 * 0.2).epsilon(1e-14));
  CHECK(f.inertia_L(0, 1) == Approx(-0.28 * 0.96 * (0.1 - 0.2)).epsilon(1e-14));
  CHECK(f.inertia_L(2, 2) == Approx(0.25).epsilon(1e-14));
}

TEST_CASE("MJCF: random trees stand as in MuJoCo's kinematics at 1000 random configurations",
          "[hands][mjcf]") {
  const TemporaryFolder folder;
  double largest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const fs::path file = folder.write("tree.xml", random_tree(seed));
    const Reading reading = read(file);
    Mujoco mujoco(file);
    base::Random random(seed);
    for (int i = 0; i < 50; ++i) {
      const Positions q = random_positions(reading.robot, random);
      mujoco.set(q);
      largest = std::max(largest,
                         largest_difference(link_poses(reading.robot, q), mujoco.poses("b0"), 8));
    }
  }
  CHECK(largest < 1e-9);
}

}  // namespace

}  // namespace test_mjcf
