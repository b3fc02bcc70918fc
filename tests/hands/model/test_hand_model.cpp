#include <algorithm>
#include <cmath>
#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "support/catch.hpp"

namespace test_hand_model {

namespace {

using namespace graspfit;
using Eigen::Vector2d;
using Eigen::Vector3d;
using hands::ContactPad;
using hands::HandModel;
using hands::RigidTransform;

ContactPad pad_of(std::vector<Vector2d> outline) {
  ContactPad pad;
  pad.name = "pad";
  pad.outline = std::move(outline);
  return pad;
}

ContactPad rectangle(double length, double width) {
  const double x = length / 2, y = width / 2;
  return pad_of({{x, -y}, {x, y}, {-x, y}, {-x, -y}});
}

ContactPad regular_polygon(int corners, double side_distance) {
  std::vector<Vector2d> outline;
  const double radius = side_distance / std::cos(std::numbers::pi / corners);
  for (int k = 0; k < corners; ++k) {
    const double a = 2 * std::numbers::pi * k / corners;
    outline.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  return pad_of(outline);
}

/// Returns a palm and one finger of two links, the smallest hand that has everything.
HandModel small_hand() {
  HandModel hand;
  hand.name = "small";
  hand.links.resize(3);
  hand.links[0].name = "palm";
  for (int i : {1, 2}) {
    auto& link = hand.links[static_cast<std::size_t>(i)];
    link.name = i == 1 ? "near" : "far";
    link.parent_link = i - 1;
    link.parent_joint = i - 1;
    hands::Joint joint;
    joint.name = i == 1 ? "knuckle" : "middle";
    joint.parent_link = i - 1;
    joint.child_link = i;
    joint.X_PJ.translation() = Vector3d(0.05, 0, 0);
    joint.upper = 1.0;
    joint.closing_sign = 1;
    hand.joints.push_back(joint);
  }
  hand.palm.link = 0;
  hand.pads.push_back(rectangle(0.02, 0.01));
  hand.pads[0].link = 2;
  hand.pads[0].finger = 0;
  hands::Finger finger;
  finger.name = "finger";
  finger.links = {1, 2};
  finger.joints = {0, 1};
  finger.tip_pad = 0;
  hand.fingers.push_back(finger);
  hand.exclusions = {{0, 1}, {1, 2}};
  return hand;
}

TEST_CASE("Area, inradius and boundary distance of a rectangular pad have their closed forms",
          "[hands][hand_model]") {
  // The distal pad of the Barrett hand is 52 x 23 mm. The inradius is half the shorter side.
  const ContactPad pad = rectangle(0.052, 0.023);
  CHECK(hands::pad_area(pad) == Approx(0.052 * 0.023).epsilon(1e-12));
  CHECK(hands::largest_boundary_distance(pad) == Approx(0.0115).epsilon(1e-12));
  CHECK(hands::boundary_distance(pad, {0, 0}) == Approx(0.0115).epsilon(1e-12));
  CHECK(hands::boundary_distance(pad, {0.020, 0.001}) == Approx(0.006).epsilon(1e-12));
  CHECK(hands::boundary_distance(pad, {0.020, 0.0095}) == Approx(0.002).epsilon(1e-12));
  CHECK(hands::boundary_distance(pad, {0.026, 0.0}) == 0.0);
  CHECK(hands::boundary_distance(pad, {0.030, 0.0}) == 0.0);
  CHECK(hands::boundary_distance(pad, {0.0, -0.5}) == 0.0);
}

TEST_CASE("Area and inradius of a hexagonal and a triangular pad have their closed forms",
          "[hands][hand_model]") {
  // A regular n-gon with inradius r has area n r^2 tan(pi/n).
  for (const int corners : {3, 6, 8}) {
    const double r = 0.01;
    const ContactPad pad = regular_polygon(corners, r);
    CHECK(hands::pad_area(pad) ==
          Approx(corners * r * r * std::tan(std::numbers::pi / corners)).epsilon(1e-12));
    CHECK(hands::largest_boundary_distance(pad) == Approx(r).epsilon(1e-12));
    CHECK(hands::boundary_distance(pad, {0, 0}) == Approx(r).epsilon(1e-12));
  }
  // The triangle with sides 3, 4, 5 has the inradius (3 + 4 - 5) / 2 = 1.
  CHECK(hands::largest_boundary_distance(pad_of({{0, 0}, {4, 0}, {0, 3}})) == Approx(1.0));
}

TEST_CASE("No point of a pad is farther from the outline than its inradius",
          "[hands][hand_model]") {
  const ContactPad pad =
      pad_of({{0.02, -0.01}, {0.03, 0.005}, {0.0, 0.02}, {-0.025, 0.004}, {-0.01, -0.012}});
  double farthest = 0.0;
  for (double x = -0.03; x < 0.03; x += 0.0002) {
    for (double y = -0.02; y < 0.02; y += 0.0002) {
      farthest = std::max(farthest, hands::boundary_distance(pad, {x, y}));
    }
  }
  const double inradius = hands::largest_boundary_distance(pad);
  CHECK(farthest <= inradius + 1e-15);
  // The distance is 1-Lipschitz, and the grid's points are at most 0.0002 / sqrt(2) from any point.
  CHECK(farthest >= inradius - 0.00015);
}

TEST_CASE("The clip volume is the prism over the outline, in any frame", "[hands][hand_model]") {
  const ContactPad pad = rectangle(0.04, 0.02);
  const geometry::ConvexVolume volume = hands::clip_volume_C(pad, 0.003);
  RigidTransform X_AC = RigidTransform::Identity();
  X_AC.translation() = Vector3d(0.1, -0.2, 0.3);
  X_AC.linear() = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const geometry::ConvexVolume in_a = hands::transformed(volume, X_AC);
  const auto contains = [](const geometry::ConvexVolume& v, const Vector3d& p) {
    for (const auto& h : v) {
      if (h.normal.dot(p) > h.offset) return false;
    }
    return true;
  };
  for (const auto& [point, inside] :
       std::vector<std::pair<Vector3d, bool>>{{{0.0, 0.0, 0.001}, true},
                                              {{0.0199, 0.0099, 0.0029}, true},
                                              {{-0.0199, -0.0099, 0.0001}, true},
                                              {{0.0, 0.0, -0.0001}, false},
                                              {{0.0, 0.0, 0.0031}, false},
                                              {{0.0201, 0.0, 0.001}, false},
                                              {{0.0, -0.0101, 0.001}, false}}) {
    CHECK(contains(volume, point) == inside);
    CHECK(contains(in_a, X_AC * point) == inside);
  }
  CHECK_THROWS_AS(hands::clip_volume_C(pad, 0.0), base::InvalidInput);
  CHECK_THROWS_AS(hands::clip_volume_C(pad, std::nan("")), base::InvalidInput);
}

/// Returns a half ellipsoid's upper part over a decagon: corners of the rim raised, a ring, the
/// top.
ContactPad dome() {
  ContactPad pad;
  pad.name = "dome";
  const auto height = [](double x, double y) {
    return 0.008 * std::sqrt(1 - x * x / 1.4e-4 - y * y / 1e-4) - 0.003;
  };
  for (const double share : {1.0, 0.6}) {
    for (int k = 0; k < 10; ++k) {
      const double a = 2 * std::numbers::pi * (k + 0.5) / 10;
      const double x = share * 0.010 * std::cos(a), y = share * 0.008 * std::sin(a);
      if (share == 1.0) pad.outline.emplace_back(x, y);
      pad.surface.emplace_back(x, y, height(x, y));
    }
  }
  pad.surface.emplace_back(0, 0, height(0, 0));
  pad.planes = hands::surface_planes(pad);
  return pad;
}

bool contains(const geometry::ConvexVolume& volume, const Vector3d& p, double slack = 0.0) {
  return std::all_of(volume.begin(), volume.end(), [&](const geometry::HalfSpace& h) {
    return h.normal.dot(p) <= h.offset + slack;
  });
}

TEST_CASE(
    "The clip volume of a curved pad is the hull of its surface and of the same moved outward",
    "[hands][hand_model]") {
  const ContactPad pad = dome();
  constexpr double kThickness = 0.0015;
  // The oracle is the hull as CGAL finds it.
  std::vector<Vector3d> points;
  for (const Vector2d& corner : pad.outline) points.emplace_back(corner.x(), corner.y(), 0.0);
  points.insert(points.end(), pad.surface.begin(), pad.surface.end());
  for (const Vector3d& point : pad.surface)
    points.push_back(point + kThickness * Vector3d::UnitZ());
  for (const Vector2d& corner : pad.outline) {
    points.emplace_back(corner.x(), corner.y(), kThickness);
  }
  const geometry::ConvexHull3 hull = geometry::convex_hull(points);
  geometry::ConvexVolume expected;
  for (const geometry::HullFacet& facet : hull.facets) {
    const Vector3d n = (points[facet[1]] - points[facet[0]])
                           .cross(points[facet[2]] - points[facet[0]])
                           .normalized();
    expected.push_back({n, n.dot(points[facet[0]])});
  }
  const geometry::ConvexVolume volume = hands::clip_volume_C(pad, kThickness);
  // The volume holds its corners.
  for (const Vector3d& point : points) CHECK(contains(volume, point, 1e-15));
  // It holds nothing more: random points are inside both or outside both, but for a band of
  // rounding.
  base::Random random(2);
  int num_inside = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vector3d p(random.uniform(-0.011, 0.011), random.uniform(-0.009, 0.009),
                     random.uniform(-0.001, 0.008));
    if (contains(expected, p, 1e-12) != contains(expected, p, -1e-12)) continue;
    CHECK(contains(volume, p) == contains(expected, p));
    num_inside += contains(volume, p) ? 1 : 0;
  }
  CHECK(num_inside > 5000);
  CHECK(volume.size() == pad.outline.size() + 1 + pad.planes.size());
}

TEST_CASE("The mesh of a clip volume is closed and bounds the same volume", "[hands][hand_model]") {
  constexpr double kThickness = 0.0015;
  for (const ContactPad& pad : {dome(), rectangle(0.04, 0.02)}) {
    const geometry::TriangleMesh mesh = hands::clip_volume_mesh_C(pad, kThickness);
    const geometry::MeshAnalysis analysis = geometry::analyze(mesh);
    CHECK(analysis.is_closed);
    CHECK(analysis.is_outward);
    const geometry::ConvexVolume volume = hands::clip_volume_C(pad, kThickness);
    for (const Vector3d& vertex : mesh.vertices) CHECK(contains(volume, vertex, 1e-15));
    // Every half-space has a face in it.
    for (const geometry::HalfSpace& half_space : volume) {
      int num_in_plane = 0;
      for (const Vector3d& vertex : mesh.vertices) {
        num_in_plane += half_space.normal.dot(vertex) > half_space.offset - 1e-12 ? 1 : 0;
      }
      CHECK(num_in_plane >= 3);
    }
  }
  CHECK(geometry::signed_volume(hands::clip_volume_mesh_C(rectangle(0.04, 0.02), kThickness)) ==
        Approx(0.04 * 0.02 * kThickness).epsilon(1e-12));
  CHECK_THROWS_AS(hands::clip_volume_mesh_C(dome(), -1.0), base::InvalidInput);
}

TEST_CASE("Heights over a curved pad vanish on its corners, and it has those of its plane if flat",
          "[hands][hand_model]") {
  const ContactPad pad = dome();
  for (const Vector3d& point : pad.surface) {
    CHECK(std::abs(hands::height_over_pad(pad, point)) < 1e-15);
    CHECK(hands::height_over_pad(pad, point + Vector3d(0, 0, 0.002)) == Approx(0.002));
  }
  CHECK(hands::pad_height(pad) == Approx(0.005).epsilon(1e-12));
  // The distance d of M1 is measured in the plane, so that the dome does not change it.
  ContactPad flat = pad;
  flat.surface.clear();
  flat.planes.clear();
  CHECK(hands::boundary_distance(pad, {0.004, 0.001}) ==
        hands::boundary_distance(flat, {0.004, 0.001}));
  CHECK(hands::pad_height(flat) == 0.0);
  CHECK(hands::height_over_pad(flat, {0.004, 0.001, -0.0007}) == -0.0007);
  CHECK(hands::surface_planes(flat).empty());
}

TEST_CASE("Coplanar facets of a curved pad count once", "[hands][hand_model]") {
  // The pad is a roof over a square: two slopes, each a rectangle that the hull cuts into
  // triangles.
  ContactPad roof = rectangle(0.02, 0.02);
  roof.surface = {{0.01, 0, 0.005}, {-0.01, 0, 0.005}};
  roof.planes = hands::surface_planes(roof);
  REQUIRE(roof.planes.size() == 2);
  CHECK(hands::height_over_pad(roof, {0.003, 0.004, 0.003}) == Approx(0.0).margin(1e-15));
  CHECK(hands::height_over_pad(roof, {0.003, -0.004, 0.004}) == Approx(0.001));
}

TEST_CASE("A model that makes no sense is refused in one line that names the item",
          "[hands][hand_model]") {
  CHECK_NOTHROW(hands::validate(small_hand()));
  const auto refused = [](auto change, const std::string& about) {
    HandModel hand = small_hand();
    change(hand);
    CAPTURE(about);
    try {
      hands::validate(hand);
      FAIL("accepted");
    } catch (const base::InvalidInput& error) {
      const std::string message = error.what();
      CAPTURE(message);
      CHECK(message.find("hand small: ") == 0);
      CHECK(message.find(about) != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
    }
  };
  refused(
      [](HandModel& h) {
        h.joints.clear();
        h.links.resize(1);
      },
      "no movable joint");
  refused([](HandModel& h) { h.links[2].parent_link = 2; }, "does not come before");
  refused([](HandModel& h) { h.links[1].name = "far"; }, "two links named far");
  refused([](HandModel& h) { h.joints[0].lower = 2.0; }, "joint knuckle: limits 2 to 1");
  refused([](HandModel& h) { h.joints[0].axis_J *= 2.0; }, "joint knuckle: axis");
  refused([](HandModel& h) { h.joints[1].coupling = hands::Coupling{1}; }, "follows itself");
  refused([](HandModel& h) { h.joints[1].coupling = hands::Coupling{7}; }, "leader has index 7");
  refused(
      [](HandModel& h) {
        h.joints[1].closing_sign = 0;
        h.joints[1].coupling = hands::Coupling{.leader = 0, .breakaway = true};
      },
      "breakaway without a closing direction");
  refused([](HandModel& h) { h.fingers[0].tip_pad = 3; }, "tip pad has index 3");
  refused([](HandModel& h) { h.fingers[0].links = {2, 1}; }, "not ordered");
  refused([](HandModel& h) { h.fingers[0].links = {1}; }, "joint middle moves none of its links");
  refused([](HandModel& h) { h.pads[0].link = 0; }, "is none of finger");
  refused(
      [](HandModel& h) {
        h.pads[0].outline.pop_back();
        h.pads[0].outline.pop_back();
      },
      "2 corners");
  refused([](HandModel& h) { std::reverse(h.pads[0].outline.begin(), h.pads[0].outline.end()); },
          "clockwise");
  refused([](HandModel& h) { h.pads[0].outline[1] = {-0.009, -0.004}; }, "not convex");
  refused([](HandModel& h) { h.pads[0].outline = {{0, 0}, {1, 1}, {2, 2}}; }, "no area");
  refused([](HandModel& h) { h.pads[0].X_LC.linear() *= 2.0; }, "frame is not a rotation");
  const auto bulge = [](HandModel& h, std::vector<Vector3d> points) {
    h.pads[0].surface = std::move(points);
    h.pads[0].planes = hands::surface_planes(h.pads[0]);
  };
  refused([](HandModel& h) { h.pads[0].surface = {{0, 0, 0.001}}; }, "do not belong together");
  refused(
      [&](HandModel& h) {
        bulge(h, {{0, 0, 0.002}, {0.005, 0, -0.001}});
      },
      "pad pad: surface point 1 lies behind");
  refused([&](HandModel& h) { bulge(h, {{0.011, 0, 0.001}}); }, "point 0 lies beside the outline");
  refused(
      [&](HandModel& h) {
        bulge(h, {{-0.009, 0, 0.003}, {0, 0, 0.001}, {0.009, 0, 0.003}});
      },
      "point 1 lies below the others: the surface is not convex");
  refused([&](HandModel& h) { bulge(h, {{0, 0, 1e-12}}); }, "does not rise");
  refused([](HandModel& h) { h.links[1].inertia = hands::LinkInertia{.mass = -1.0}; },
          "link near: mass -1 is negative");
  refused(
      [](HandModel& h) {
        h.links[1].inertia = hands::LinkInertia{.center_L = Vector3d(0, std::nan(""), 0)};
      },
      "link near: center of mass");
  refused([](HandModel& h) { h.palm.direction_H = Vector3d(0, 0, 2); }, "palm direction");
  refused([](HandModel& h) { h.palm.link = 1; }, "root link");
  refused([](HandModel& h) { h.exclusions.push_back({0, 9}); }, "index 9");
}

TEST_CASE("Names are looked up, and an unknown one is answered with those there are",
          "[hands][hand_model]") {
  const HandModel hand = small_hand();
  CHECK(hand.finger_index("finger") == 0);
  CHECK(hand.joint_index("middle") == 1);
  CHECK(hand.link_index("far") == 2);
  CHECK(hand.part_name(0) == "finger");
  CHECK(hand.part_name(std::nullopt) == "palm");
  CHECK_THROWS_WITH(hand.joint_index("wrist"),
                    "hand small: no joint named wrist; there are knuckle, middle");
  CHECK(hand.thumb() == 0);
  CHECK(hand.num_intrinsic_dof() == 2);
  CHECK(hand.is_excluded(1, 0));
  CHECK(hand.is_excluded(2, 2));
  CHECK_FALSE(hand.is_excluded(0, 2));
}

TEST_CASE("The reach bounds every vertex over revolute and prismatic joints",
          "[hands][hand_model]") {
  HandModel hand = small_hand();
  hand.palm.center_H = Vector3d(0.0, 0.0, 0.02);
  hand.links[2].mesh_L.vertices = {Vector3d(0.03, 0.04, 0.0)};
  // The reach is |(0.05, 0, 0) - (0, 0, 0.02)| + 0.05 + |(0.03, 0.04, 0)|.
  CHECK(hands::largest_reach(hand) == Approx(std::hypot(0.05, 0.02) + 0.05 + 0.05).epsilon(1e-12));
  hand.joints[1].type = hands::JointType::Prismatic;
  hand.joints[1].lower = -0.2;
  hand.joints[1].upper = 0.1;
  CHECK(hands::largest_reach(hand) ==
        Approx(std::hypot(0.05, 0.02) + 0.05 + 0.05 + 0.2).epsilon(1e-12));
}

}  // namespace

}  // namespace test_hand_model
