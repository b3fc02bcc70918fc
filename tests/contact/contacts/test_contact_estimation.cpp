#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "contact/pad_hand.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_contact_estimation {

using namespace graspfit;
using namespace graspfit::contact;
using Eigen::Vector3d;
using geometry::MeshQuery;
using geometry::RigidTransform;
using graspfit::testing::pad_hand;
using testing::Contains;

namespace {

constexpr double kPi = std::numbers::pi;

// Lengths near 0.1 m are off by a few roundings.
constexpr double kRounding = 1e-12;

constexpr double kThickness = 0.002;
const ContactEstimationOptions kOptions{.clip_thickness = kThickness};

/// Returns a pad frame with its origin at `origin` that looks along `direction`; its x axis is
/// `x_axis`.
RigidTransform facing(const Vector3d& origin, const Vector3d& direction,
                      const Vector3d& x_axis = Vector3d::UnitX()) {
  RigidTransform X_OC = RigidTransform::Identity();
  X_OC.linear().col(0) = x_axis;
  X_OC.linear().col(1) = direction.cross(x_axis);
  X_OC.linear().col(2) = direction;
  X_OC.translation() = origin;
  return X_OC;
}

/// Returns the frame of a pad that looks down at a top face at height `top` from `gap` above it.
RigidTransform above(double x, double y, double top, double gap) {
  return facing({x, y, top + gap}, -Vector3d::UnitZ());
}

}  // namespace

TEST_CASE("On a flat face the contact is the pad's own rectangle",
          "[contact][contact_estimation]") {
  // A pad of 2 x 4 cm is half a millimeter above the middle of the top of a box of 20 cm; its clip
  // volume is 2 mm thick.
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const double gap = 0.0005;
  const auto contact = estimate_contact(hand, 1, above(0.03, -0.01, 0.1, gap), box, kOptions);
  REQUIRE(contact);
  CHECK(contact->area == Approx(0.02 * 0.04).epsilon(kRounding));
  CHECK(contact->gap == Approx(gap).epsilon(1e-10));  // It is a difference of lengths near 0.1.
  CHECK((contact->point_O - Vector3d(0.03, -0.01, 0.1)).norm() < kRounding);
  CHECK((contact->inward_normal_O + Vector3d::UnitZ()).norm() < kRounding);
  CHECK(contact->pad_boundary_distance == Approx(0.01).epsilon(1e-10));
  CHECK(contact->pad == 1);
  CHECK(contact->link == 1);
  CHECK(contact->finger == 0);
  CHECK_FALSE(contact->is_target);
  CHECK_FALSE(contact->weak.has_value());
}

TEST_CASE("A curved pad touches where its offset surface reaches, and its gap is that of its top",
          "[contact][contact_estimation]") {
  // The pad is a roof over an outline of 2 x 4 cm with a ridge of height 5 mm along x. It is half a
  // millimeter above a flat face, so that the clip volume, 2 mm over the roof, covers |y| <= 20 mm
  // (2 - 0.5) / 5.
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  hands::ContactPad& roof = hand.pads[1];
  const double height = 0.005;
  roof.surface = {{0.01, 0, height}, {-0.01, 0, height}};
  roof.planes = hands::surface_planes(roof);
  const double gap = 0.0005;
  const auto contact = estimate_contact(hand, 1, above(0, 0, 0.1, height + gap), box, kOptions);
  REQUIRE(contact);
  CHECK(contact->area == Approx(0.02 * 2 * 0.02 * (kThickness - gap) / height).epsilon(1e-9));
  CHECK(contact->gap == Approx(gap).margin(2e-12));
  CHECK((contact->inward_normal_O + Vector3d::UnitZ()).norm() < kRounding);
  CHECK((contact->point_O - Vector3d(0, 0, 0.1)).norm() < kRounding);
  // It is measured in the plane, as if flat.
  CHECK(contact->pad_boundary_distance == Approx(0.01).epsilon(1e-9));
  CHECK_FALSE(
      estimate_contact(hand, 1, above(0, 0, 0.1, height + 1.01 * kThickness), box, kOptions));
}

TEST_CASE("A pad over an edge touches what it overlaps", "[contact][contact_estimation]") {
  // The pad's middle is over the edge x = 0.1: half its width, 1 cm, is above the top face, and the
  // side wall runs down through the volume from the top to its end, 2 - 0.5 mm.
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const double gap = 0.0005;
  const auto contact = estimate_contact(hand, 1, above(0.1, 0.0, 0.1, gap), box, kOptions);
  REQUIRE(contact);
  const double top = 0.01 * 0.04;
  const double wall = (kThickness - gap) * 0.04;
  CHECK(contact->area == Approx(top + wall).epsilon(1e-10));
  CHECK(contact->gap == Approx(gap).epsilon(1e-10));
  // The normal is the area-weighted mean of +z and +x, turned inward.
  const Vector3d inward = -Vector3d(wall, 0, top).normalized();
  CHECK((contact->inward_normal_O - inward).norm() < 1e-10);
  // The point is the mean of the centroids (0.095, 0, 0.1) and (0.1, 0, 0.1 - 0.75 mm), projected
  // to the nearer face. That is the top, 0.1 mm above, while the wall is more than 4 mm away.
  const double x = (top * 0.095 + wall * 0.1) / (top + wall);
  CHECK((contact->point_O - Vector3d(x, 0, 0.1)).norm() < 1e-10);
  // In the pad's plane the point is x - 0.1 off the middle, 1 cm - |x - 0.1| from the outline.
  CHECK(contact->pad_boundary_distance == Approx(0.01 - (0.1 - x)).epsilon(1e-9));
}

TEST_CASE("Plain averaging counts pieces, whatever their size", "[contact][contact_estimation]") {
  // The pad, 1 cm long, is over the same edge at y = 0.06. The two triangles of a face meet along a
  // diagonal, which is within 1 cm of the edge only near its ends, y = ±0.1. So the pad sees one
  // piece of the top and one of the wall, and the normal is the bisector of +z and +x although the
  // top is larger.
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.01);
  ContactEstimationOptions plain = kOptions;
  plain.averaging = geometry::PatchAveraging::Plain;
  const auto contact = estimate_contact(hand, 1, above(0.1, 0.06, 0.1, 0.0005), box, plain);
  REQUIRE(contact);
  CHECK((contact->inward_normal_O + Vector3d(1, 0, 1).normalized()).norm() < 1e-10);
}

TEST_CASE("On a ball the contact is the cap that the clip volume cuts off",
          "[contact][contact_estimation]") {
  // A slab of depth t - gap below the pole has the lateral area 2 pi R (t - gap) [Archimedes], as
  // long as the pad covers the cap. The mesh is inscribed: its edges sag by s = e²/(8 R) with edges
  // e of about 1.1 R / 2^6, which is 0.0019 mm here. The depth is 2 mm, so that the areas agree to
  // about 2 s / t = 0.2 %.
  const double radius = 0.05;
  const MeshQuery ball(geometry::ball(radius, 6));
  // The cap's radius, sqrt(2 R t) = 14 mm, is below 20 mm.
  const hands::HandModel hand = pad_hand(1, 0.04, 0.04);
  const double gap = GENERATE(0.0, 0.0005, 0.0015);
  CAPTURE(gap);
  const Vector3d direction = Vector3d(0.3, -0.5, 0.8).normalized();
  const Vector3d x_axis = direction.cross(Vector3d::UnitZ()).normalized();
  const auto contact = estimate_contact(
      hand, 1, facing((radius + gap) * direction, -direction, x_axis), ball, kOptions);
  REQUIRE(contact);
  CHECK(contact->area ==
        Approx(2 * kPi * radius * (kThickness - gap)).epsilon(gap > 0.001 ? 0.01 : 0.004));
  CHECK(contact->gap == Approx(gap).margin(2e-6));
  // All is symmetric about the pole up to the mesh, so that centroid and normal are the pole's.
  CHECK((contact->point_O - radius * direction).norm() < 5e-5);
  CHECK((contact->inward_normal_O + direction).norm() < 2e-3);
  CHECK(contact->pad_boundary_distance == Approx(0.02).margin(5e-5));
}

namespace {

/// Returns two bars along y, 5 mm wide under the pad's halves, with tops at 0.1 and `second_top`,
/// and below the slit between them a third one whose top is at `middle_top`.
geometry::TriangleMesh bars(double second_top, double middle_top) {
  const auto bar = [](double x, double width, double top) {
    geometry::TriangleMesh mesh = geometry::box({width, 0.2, 0.05});
    for (Vector3d& vertex : mesh.vertices) vertex += Vector3d(x, 0, top - 0.025);
    return mesh;
  };
  return geometry::concatenated(
      {bar(-0.01, 0.01, 0.1), bar(0.01, 0.01, second_top), bar(0.0, 0.002, middle_top)});
}

}  // namespace

TEST_CASE("The point of a contact lies on its pieces, not on whatever is near their mean",
          "[contact][contact_estimation]") {
  // A pad that reaches 10 mm far sees bars from 5 to 15 mm on either side. Their mean is over the
  // slit, 1 mm from the middle bar, which ends just below the clip volume.
  const double gap = 0.0005;
  const MeshQuery object(bars(0.1, 0.1 - (kThickness - gap) - 1e-4));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const auto contact = estimate_contact(hand, 1, above(0, 0, 0.1, gap), object, kOptions);
  REQUIRE(contact);
  CHECK(std::abs(contact->point_O.x()) == Approx(0.005).margin(kRounding));
  CHECK(contact->point_O.z() <= 0.1 + kRounding);
  CHECK(contact->point_O.z() >= 0.1 - (kThickness - gap) - kRounding);
  const double top = 0.005 * 0.04;
  const double wall = (kThickness - gap) * 0.04;
  CHECK(contact->area == Approx(2 * (top + wall)).epsilon(1e-9));
  CHECK(std::abs(contact->inward_normal_O.x()) < 1e-9);  // The walls of the slit cancel.
}

TEST_CASE("Pieces far apart are contacts of their own where that is asked for",
          "[contact][contact_estimation]") {
  const double gap = 0.0005;
  const double lower = 0.001;
  const MeshQuery object(bars(0.1 - lower, 0.05));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  ContactEstimationOptions separate = kOptions;
  separate.pieces = ContactPieces::Separate;
  const std::vector<RigidTransform> X_OL = {above(0, 0, 0.2, 0), above(0, 0, 0.1, gap)};
  const std::vector<Contact> contacts = estimate_contacts(hand, X_OL, object, separate);
  REQUIRE(contacts.size() == 2);
  for (int i = 0; i < 2; ++i) {
    const Contact& contact = contacts[i];
    CAPTURE(i);
    const double depth = kThickness - gap - (i == 1 ? lower : 0.0);
    const double top = 0.005 * 0.04;
    const double wall = depth * 0.04;
    CHECK(contact.pad == 1);
    CHECK(contact.area == Approx(top + wall).epsilon(1e-9));
    CHECK(contact.gap == Approx(i == 0 ? gap : gap + lower).epsilon(1e-9));
    const double side = i == 0 ? -1.0 : 1.0;
    // The wall toward the slit looks along -side x, so the inward normal leans along +side x.
    CHECK((contact.inward_normal_O - Vector3d(side * wall, 0, -top).normalized()).norm() < 1e-9);
    CHECK(contact.point_O.x() * side > 0.005 - kRounding);
  }
  CHECK(estimate_contacts(hand, X_OL, object, kOptions).size() == 1);
  // Pieces nearer to each other than half the pad's width are one: the bars are 2 cm apart, the pad
  // is 6 cm wide.
  const hands::HandModel wide = pad_hand(1, 0.06, 0.08);
  CHECK(estimate_contacts(wide, X_OL, object, separate).size() == 1);
}

TEST_CASE("Of a wall thinner than the clip volume the near side is a contact where it is asked for",
          "[contact][contact_estimation]") {
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const MeshQuery plate(geometry::box({0.2, 0.2, 0.25 * kThickness}));
  const double top = 0.125 * kThickness;
  const RigidTransform X_OC = above(0.01, 0.02, top, 0.0005);
  CHECK_FALSE(estimate_contact(hand, 1, X_OC, plate, kOptions));
  CHECK_FALSE(has_contact(hand, 1, X_OC, plate, kOptions));
  ContactEstimationOptions facing_pads = kOptions;
  facing_pads.faces = ContactFaces::Facing;
  const auto contact = estimate_contact(hand, 1, X_OC, plate, facing_pads);
  REQUIRE(contact);
  CHECK(has_contact(hand, 1, X_OC, plate, facing_pads));
  CHECK((contact->inward_normal_O + Vector3d::UnitZ()).norm() < kRounding);
  CHECK((contact->point_O - Vector3d(0.01, 0.02, top)).norm() < kRounding);
  CHECK(contact->area == Approx(0.02 * 0.04));
  // A pad on the other side that looks away from the plate, though its clip volume holds it.
  const RigidTransform behind = facing({0.01, 0.02, top - 0.0001}, Vector3d::UnitZ());
  CHECK(has_contact(hand, 1, behind, plate, kOptions));
  CHECK_FALSE(has_contact(hand, 1, behind, plate, facing_pads));
  // Where nothing looks away, nothing changes: an edge and its wall.
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const RigidTransform at_edge = above(0.095, 0.0, 0.1, 0.0005);
  const auto all = estimate_contact(hand, 1, at_edge, box, kOptions);
  const auto some = estimate_contact(hand, 1, at_edge, box, facing_pads);
  REQUIRE((all && some));
  CHECK(all->area == some->area);
  CHECK(all->point_O == some->point_O);
  CHECK(all->inward_normal_O == some->inward_normal_O);
}

TEST_CASE("Contacts of fingertips and palm alone", "[contact][contact_estimation]") {
  // One finger has two pads, the first of which is no fingertip's.
  hands::HandModel hand = pad_hand(2);
  hand.pads[1].finger = 1;
  hand.fingers[1].links = {1, 2};
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const std::vector<RigidTransform> X_OL(3, above(0, 0, 0.1, 0.0005));
  CHECK(estimate_contacts(hand, X_OL, box, kOptions).size() == 3);
  ContactEstimationOptions some = kOptions;
  some.pads = CountedPads::TipsAndPalm;
  const std::vector<Contact> contacts = estimate_contacts(hand, X_OL, box, some);
  REQUIRE(contacts.size() == 2);
  CHECK(contacts[0].pad == 0);
  CHECK(contacts[1].pad == 2);
}

TEST_CASE("Contacts that touch are those within the gap", "[contact][contact_estimation]") {
  std::vector<Contact> contacts(3);
  contacts[0].gap = 0.0001;
  contacts[1].gap = 0.0002;
  contacts[2].gap = 0.0;
  CHECK(touching_contacts(contacts, std::nullopt).size() == 3);
  const std::vector<Contact> touching = touching_contacts(contacts, 0.0001);
  REQUIRE(touching.size() == 2);
  CHECK(touching[0].gap == 0.0001);
  CHECK(touching[1].gap == 0.0);
}

TEST_CASE("A pad off the middle knows how far its outline is", "[contact][contact_estimation]") {
  // The ball's pole is 6 mm from the pad's middle along x, so 20 - 6 mm from the outline. The
  // outline would cut the cap only beyond 14 mm, so that the cap is whole.
  const double radius = 0.05;
  const MeshQuery ball(geometry::ball(radius, 6));
  const hands::HandModel hand = pad_hand(1, 0.04, 0.04);
  const auto contact = estimate_contact(
      hand, 1, facing({-0.006, 0, radius + 0.0002}, -Vector3d::UnitZ()), ball, kOptions);
  REQUIRE(contact);
  CHECK(contact->pad_boundary_distance == Approx(0.014).margin(5e-5));
}

TEST_CASE("No surface in the clip volume is no contact", "[contact][contact_estimation]") {
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const auto touches = [&](const RigidTransform& X_OC) {
    return estimate_contact(hand, 1, X_OC, box, kOptions).has_value();
  };
  CHECK(touches(above(0, 0, 0.1, 0.001)));
  SECTION("clear of the object") { CHECK_FALSE(touches(above(0, 0, 0.1, 0.5))); }
  SECTION("just beyond the clip volume, and just inside") {
    CHECK_FALSE(touches(above(0, 0, 0.1, kThickness + 1e-9)));
    CHECK(touches(above(0, 0, 0.1, kThickness - 1e-9)));
  }
  SECTION("surface behind the pad's plane") {
    CHECK_FALSE(touches(above(0, 0, 0.1, -1e-9)));
    CHECK_FALSE(touches(facing({0, 0, 0.1005}, Vector3d::UnitZ())));
  }
  SECTION("beside the object") { CHECK_FALSE(touches(above(0.1101, 0, 0.1, 0.0005))); }
  SECTION("in the middle of the solid") { CHECK_FALSE(touches(above(0, 0, 0.0, 0.0))); }
}

TEST_CASE("The two sides of a plate thinner than the clip volume cancel",
          "[contact][contact_estimation]") {
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const auto contact_on_plate = [&](double thickness) {
    const MeshQuery plate(geometry::box({0.2, 0.2, thickness}));
    const RigidTransform X_OC = above(0.02, 0.03, thickness / 2, 0.0005);
    const bool is_contact = estimate_contact(hand, 1, X_OC, plate, kOptions).has_value();
    CHECK(has_contact(hand, 1, X_OC, plate, kOptions) == is_contact);
    return is_contact;
  };
  CHECK_FALSE(contact_on_plate(0.001));
  CHECK(contact_on_plate(0.003));
}

TEST_CASE("A pad's own thickness comes before the options'", "[contact][contact_estimation]") {
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const RigidTransform X_OC = above(0, 0, 0.1, 0.005);
  CHECK_FALSE(estimate_contact(hand, 1, X_OC, box, kOptions));
  hand.pads[1].clip_thickness = 0.006;
  const auto contact = estimate_contact(hand, 1, X_OC, box, kOptions);
  REQUIRE(contact);
  CHECK(contact->gap == Approx(0.005).epsilon(1e-10));
}

TEST_CASE("Contacts move with hand and object together", "[contact][contact_estimation]") {
  const geometry::TriangleMesh mesh_B = geometry::torus(0.05, 0.02);
  const hands::HandModel hand = pad_hand(1, 0.02, 0.04);
  const RigidTransform X_BC = facing({0.05, 0.001, 0.0203}, -Vector3d::UnitZ());
  const auto contact = estimate_contact(hand, 1, X_BC, MeshQuery(mesh_B), kOptions);
  REQUIRE(contact);
  RigidTransform X_AB = RigidTransform::Identity();
  X_AB.rotate(Eigen::AngleAxisd(2.0, Vector3d(1, 0.5, -2).normalized()));
  X_AB.pretranslate(Vector3d(0.2, 0.1, -0.4));
  const auto moved = estimate_contact(hand, 1, X_AB * X_BC,
                                      MeshQuery(geometry::transformed(mesh_B, X_AB)), kOptions);
  REQUIRE(moved);
  CHECK(moved->area == Approx(contact->area).epsilon(1e-9));
  CHECK((moved->point_O - X_AB * contact->point_O).norm() < 1e-9);
  CHECK((moved->inward_normal_O - X_AB.linear() * contact->inward_normal_O).norm() < 1e-9);
  CHECK(moved->gap == Approx(contact->gap).margin(1e-12));
  CHECK(moved->pad_boundary_distance == Approx(contact->pad_boundary_distance).epsilon(1e-8));
}

TEST_CASE("No triangle near a pad is overlooked", "[contact][contact_estimation]") {
  // The reference is the clip of every triangle of the mesh, at random poses of a long pad that
  // touch.
  const MeshQuery torus(geometry::torus(0.05, 0.02));
  hands::HandModel hand = pad_hand(1, 0.01, 0.06);
  const bool is_curved = GENERATE(false, true);
  CAPTURE(is_curved);
  if (is_curved) {  // This is a roof with its ridge along y and both ends sloping.
    hand.pads[1].surface = {{0, 0.02, 0.003}, {0, -0.02, 0.003}};
    hand.pads[1].planes = hands::surface_planes(hand.pads[1]);
  }
  std::vector<std::int32_t> all_faces(torus.mesh().faces.size());
  std::iota(all_faces.begin(), all_faces.end(), 0);
  base::Random random(3);
  int num_contacts = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto face = random.index(all_faces.size());
    const Vector3d outward = geometry::face_normal(torus.mesh(), face);
    const Vector3d x_axis = outward.unitOrthogonal();
    RigidTransform X_OC = facing(geometry::corners(torus.mesh(), face)[0] +
                                     (0.001 + hands::pad_height(hand.pads[1])) * outward,
                                 -outward, x_axis);
    X_OC.rotate(Eigen::AngleAxisd(random.uniform(0, 6), Vector3d::UnitZ()));
    X_OC.rotate(Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Vector3d::UnitX()));
    double area = 0.0;
    for (const geometry::ClippedPiece& piece :
         geometry::clip(torus.mesh(), all_faces,
                        hands::transformed(hands::clip_volume_C(hand.pads[1], kThickness), X_OC))) {
      area += piece.area;
    }
    const auto contact = estimate_contact(hand, 1, X_OC, torus, kOptions);
    // The sums run in another order, so that they differ by roundings.
    CHECK((contact ? contact->area : 0.0) == Approx(area).epsilon(kRounding));
    CHECK(has_contact(hand, 1, X_OC, torus, kOptions) == contact.has_value());
    if (contact) ++num_contacts;
  }
  CHECK(num_contacts > 30);
}

TEST_CASE("All pads of a hand report in pad order, the palm's without a finger",
          "[contact][contact_estimation]") {
  // Two fingers and a palm are around a box of 10 cm: finger 0 is on +x, finger 1 is clear of the
  // box, the palm is on top.
  const MeshQuery box(geometry::box({0.1, 0.1, 0.1}));
  const hands::HandModel hand = pad_hand(2, 0.02, 0.04);
  const std::vector<RigidTransform> X_OL = {
      above(0, 0, 0.05, 0.001), facing({0.051, 0, 0}, -Vector3d::UnitX(), Vector3d::UnitY()),
      facing({-0.06, 0, 0}, Vector3d::UnitX(), Vector3d::UnitY())};
  const std::vector<Contact> contacts = estimate_contacts(hand, X_OL, box, kOptions);
  REQUIRE(contacts.size() == 2);
  CHECK(contacts[0].pad == 0);
  CHECK(!contacts[0].finger);
  CHECK(contacts[1].pad == 1);
  CHECK(contacts[1].finger == 0);
  CHECK((contacts[1].inward_normal_O + Vector3d::UnitX()).norm() < kRounding);
  // The pad's pose in its link counts.
  hands::HandModel shifted = hand;
  shifted.pads[2].X_LC.translation().z() = 0.009;  // It is 1 mm from the box with this.
  CHECK(estimate_contacts(shifted, X_OL, box, kOptions).size() == 3);
}

TEST_CASE("Contact estimation refuses what makes no sense", "[contact][contact_estimation]") {
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const hands::HandModel hand = pad_hand(1);
  CHECK_THROWS_WITH(ContactEstimationOptions{}.validate(), Contains("clip_thickness = 0"));
  CHECK_THROWS_AS(ContactEstimationOptions{.clip_thickness = -0.001}.validate(),
                  base::InvalidInput);
  CHECK_THROWS_WITH((ContactEstimationOptions{.clip_thickness = std::nan("")}.validate()),
                    Contains("ContactEstimationOptions") && Contains("clip_thickness = nan"));
  const RigidTransform X_OC = RigidTransform::Identity();
  CHECK_THROWS_WITH(estimate_contact(hand, 2, X_OC, box, kOptions), Contains("pad = 2"));
  CHECK_THROWS_WITH(estimate_contact(hand, -1, X_OC, box, kOptions), Contains("pad = -1"));
  CHECK_THROWS_WITH(estimate_contacts(hand, {X_OC}, box, kOptions),
                    Contains("1 link poses for the 2 links"));
}

TEST_CASE(
    "A contact is weak if at least half of its surface is, and unknown where nothing is known",
    "[contact][contact_estimation]") {
  // The two triangles of the top meet along x = y; the one with y < x is weak.
  const MeshQuery box(geometry::box({0.2, 0.2, 0.2}));
  const hands::HandModel hand = pad_hand(1, 0.02, 0.02);
  geometry::WeakRegions regions;
  regions.is_weak.assign(box.mesh().faces.size(), false);
  regions.is_weak[box.closest_point({0.05, -0.05, 0.1}).face] = true;
  geometry::WeakRegions coarse = regions;
  coarse.outcome = geometry::WeakOutcome::TooCoarse;
  for (const auto& [x, is_weak] :
       {std::pair{0.03, true}, {0.002, true}, {-0.002, false}, {-0.03, false}}) {
    const RigidTransform X_OC = above(x, -x, 0.1, 0.0005);
    const auto contact = estimate_contact(hand, 1, X_OC, box, kOptions, &regions);
    REQUIRE(contact);
    REQUIRE(contact->weak.has_value());
    CHECK(*contact->weak == is_weak);
    auto same = estimate_contact(hand, 1, X_OC, box, kOptions);
    REQUIRE(same);
    CHECK_FALSE(same->weak.has_value());
    CHECK(same->area == contact->area);
    CHECK_FALSE(estimate_contact(hand, 1, X_OC, box, kOptions, &coarse)->weak.has_value());
  }
  // The same holds for all pads at once, here the palm, which lies over the other triangle, and a
  // finger.
  const auto all = estimate_contacts(hand, {above(-0.03, 0.03, 0.1, 0), above(0.03, -0.03, 0.1, 0)},
                                     box, kOptions, &regions);
  REQUIRE(all.size() == 2);
  CHECK(all[0].weak == false);
  CHECK(all[1].weak == true);
  regions.is_weak.pop_back();
  CHECK_THROWS_WITH(estimate_contact(hand, 1, above(0, 0, 0.1, 0), box, kOptions, &regions),
                    Contains("weak regions of 11 faces for a mesh of 12"));
}

}  // namespace test_contact_estimation
