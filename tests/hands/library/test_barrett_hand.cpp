#include <algorithm>
#include <cmath>
#include <numbers>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_barrett_hand {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::ContactPad;
using hands::HandModel;
using hands::Link;
using hands::RigidTransform;
using std::numbers::pi;

const HandModel& barrett() {
  static const HandModel hand = hands::find_hand("barrett");
  return hand;
}

const Link& link(const std::string& name) {
  return barrett().links[static_cast<std::size_t>(barrett().link_index(name))];
}

TEST_CASE("The Barrett hand has four independent joints, three fingers, a thumb and seven pads",
          "[hands][barrett]") {
  const HandModel& hand = barrett();
  CHECK(hand.name == "barrett");
  CHECK(hand.num_intrinsic_dof() == 4);
  CHECK(hand.links.size() == 9);
  CHECK(hand.joints.size() == 8);
  REQUIRE(hand.fingers.size() == 3);
  CHECK(hand.fingers[0].name == "finger_1");
  CHECK(hand.fingers[1].name == "finger_2");
  CHECK(hand.fingers[2].name == "thumb");
  CHECK(hand.thumb() == 2);
  CHECK(hand.fingers[0].swing_joint == hand.joint_index("finger_1_spread"));
  CHECK_FALSE(hand.fingers[2].swing_joint.has_value());
  CHECK(hand.pads.size() == 7);
  REQUIRE(hand.palm.pad);
  CHECK(hand.pads[static_cast<std::size_t>(*hand.palm.pad)].name == "palm_pad");
  CHECK(hand.palm.center_H == Vector3d::Zero());
  CHECK(hand.palm.direction_H == Vector3d::UnitZ());
  CHECK(hand.description_sha256.size() == 64);
  CHECK(hand.sidecar_sha256.size() == 64);
  CHECK(hand.links[0].mesh_files == std::vector<std::string>{"meshes/palm.obj"});
}

TEST_CASE("Joint limits of the Barrett hand are the published ones", "[hands][barrett]") {
  // The ranges are spread 0 to 180, proximal 0 to 140, distal 0 to 48 degrees
  // (jhu-lcsr/barrett_model, GraspIt!).
  for (const hands::Joint& joint : barrett().joints) {
    CAPTURE(joint.name);
    CHECK(joint.lower == 0.0);
    const double upper_deg = joint.name.ends_with("spread")     ? 180
                             : joint.name.ends_with("proximal") ? 140
                                                                : 48;
    CHECK(joint.upper == Approx(upper_deg / 180.0 * pi).epsilon(1e-12));
    CHECK(joint.closing_sign == (joint.name.ends_with("spread") ? 0 : 1));
    if (joint.name.ends_with("distal")) {
      REQUIRE(joint.coupling.has_value());
      CHECK(joint.coupling->ratio == Approx(1.0 / 3.0).epsilon(1e-12));
      CHECK(joint.coupling->breakaway);
    }
  }
}

TEST_CASE("Link meshes are closed, manifold, outward and free of self-intersection",
          "[hands][barrett]") {
  for (const Link& l : barrett().links) {
    CAPTURE(l.name);
    const geometry::MeshAnalysis analysis =
        geometry::analyze(l.mesh_L, {.count_self_intersections = true});
    CHECK(analysis.is_closed);
    CHECK(analysis.is_manifold);
    CHECK(analysis.is_outward);
    CHECK(analysis.num_parts == 1);
    CHECK(analysis.num_degenerate_faces == 0);
    CHECK(analysis.num_self_intersections == std::size_t{0});
    CHECK(analysis.num_faces < 2500);
    CHECK(geometry::signed_volume(l.mesh_L) > 1e-5);
  }
}

TEST_CASE("Link meshes have the stated sizes", "[hands][barrett]") {
  // GraspIt!'s meshes have the extents palm 89 x 109 x 90 to 96, proximal 92 x 26 x 19 to 21,
  // distal 68 x 20 x 23 mm. Ours follow to 1 mm.
  const auto check = [](const char* name, const Vector3d& low, const Vector3d& high) {
    CAPTURE(name);
    const Vector3d size = geometry::bounding_box(link(name).mesh_L).sizes() * 1000;
    CAPTURE(size.transpose());
    CHECK(((size - low).array() > -1.0).all());
    CHECK(((high - size).array() > -1.0).all());
  };
  check("palm", {89, 109, 90}, {89, 109, 96});
  // D_w of Barrett's wiki is 76 mm from the wrist plane to the knuckle axes, which GraspIt! puts
  // 3.32 mm below the palm.
  CHECK(geometry::bounding_box(link("palm").mesh_L).min().z() ==
        Approx(-0.076 - 0.00332).margin(1e-9));
  check("finger_1_proximal_link", {92, 26, 19}, {92, 26, 21});
  check("thumb_distal_link", {68, 20, 23}, {68, 20, 23});
  // The knuckle is a cylinder r 15 x 24 at its end (jhu-lcsr/barrett_model).
  const Eigen::AlignedBox3d knuckle = geometry::bounding_box(link("finger_2_knuckle").mesh_L);
  CHECK(knuckle.sizes().y() == Approx(0.024).margin(1e-6));
  CHECK(knuckle.max().z() == Approx(0.015).margin(2e-4));
  CHECK(knuckle.max().x() == Approx(0.065).margin(5e-4));
}

TEST_CASE("Links of the Barrett hand have the published masses", "[hands][barrett]") {
  // The masses are those of jhu-lcsr/barrett_model, models/hand.urdf.xacro [kg].
  for (const Link& l : barrett().links) {
    CAPTURE(l.name);
    REQUIRE(l.inertia.has_value());
    const double expected = l.name == "palm"                     ? 0.50573
                            : l.name.ends_with("knuckle")        ? 0.14109
                            : l.name.ends_with("_proximal_link") ? 0.062139
                                                                 : 0.041377;
    CHECK(l.inertia->mass == expected);
  }
}

TEST_CASE("Every pad is a flat part of its link's mesh: a contact of the pad is one of the mesh",
          "[hands][barrett]") {
  for (const ContactPad& pad : barrett().pads) {
    CAPTURE(pad.name);
    const Link& l = barrett().links[static_cast<std::size_t>(pad.link)];
    const RigidTransform X_CL = pad.X_LC.inverse();
    // Coordinates in the files have 10 decimals, so that planes agree to 1e-9 m.
    constexpr double kTolerance = 1e-9;
    double covered = 0.0;
    const geometry::ConvexVolume slab = hands::transformed(
        [&] {
          geometry::ConvexVolume v = hands::clip_volume_C(pad, 1.0);
          // −z ≤ tolerance keeps what lies in the plane.
          v[v.size() - 2].offset = kTolerance;
          return v;
        }(),
        pad.X_LC);
    for (std::size_t f = 0; f < l.mesh_L.faces.size(); ++f) {
      const auto piece = geometry::clip(geometry::corners(l.mesh_L, f), slab);
      // Faces that only border on the pad leave slivers as thin as the tolerance.
      // The unit is m²; 52 mm x 1e-9 m is twenty times smaller.
      constexpr double kSliver = 1e-9;
      if (!piece || piece->area < kSliver) continue;
      // Above the pad's outline nothing stands out of the pad's plane.
      for (const Vector3d& corner : piece->polygon) CHECK((X_CL * corner).z() < kTolerance);
      // What lies in the pad's plane faces outward.
      CHECK((X_CL.linear() * geometry::face_normal(l.mesh_L, f)).z() > 1 - 1e-9);
      covered += piece->area;
    }
    CHECK(covered == Approx(hands::pad_area(pad)).epsilon(1e-6));
  }
}

TEST_CASE("End pads are the round ends of the fingertips, beside the paper's pads",
          "[hands][barrett]") {
  const HandModel ends = hands::find_hand("barrett_ends");
  CHECK(ends.num_intrinsic_dof() == barrett().num_intrinsic_dof());
  int num_ends = 0;
  for (const ContactPad& pad : ends.pads) {
    CAPTURE(pad.name);
    if (!pad.name.ends_with("_end_pad")) {
      const auto same =
          std::find_if(barrett().pads.begin(), barrett().pads.end(),
                       [&](const ContactPad& other) { return other.name == pad.name; });
      REQUIRE(same != barrett().pads.end());
      CHECK(same->X_LC.matrix() == pad.X_LC.matrix());
      CHECK(same->outline == pad.outline);
      continue;
    }
    ++num_ends;
    CHECK(pad.link == ends.pads[*ends.fingers[*pad.finger].tip_pad].link);
    // Corners of the surface are vertices of the link's cylinder, or lie on its edges.
    const geometry::MeshQuery link(ends.links[pad.link].mesh_L);
    std::vector<Vector3d> corners = pad.surface;
    for (const Eigen::Vector2d& corner : pad.outline)
      corners.emplace_back(corner.x(), corner.y(), 0);
    for (const Vector3d& corner_C : corners) {
      CHECK(std::abs(link.signed_distance(pad.X_LC * corner_C)) < 1e-8);
    }
    // So is where it touches; it leans 58 degrees from the flat pad, which lies before it.
    CHECK(std::abs(link.signed_distance(pad.X_LC * hands::pad_contact_point_C(pad))) < 1e-8);
    const ContactPad& flat = ends.pads[*ends.fingers[*pad.finger].tip_pad];
    const double cosine = pad.X_LC.linear().col(2).dot(flat.X_LC.linear().col(2));
    CHECK(std::acos(cosine) == Approx(57.6 / 180.0 * pi).margin(0.01));
    for (const Vector3d& corner_C : corners) {
      const Vector3d in_flat = flat.X_LC.inverse() * (pad.X_LC * corner_C);
      CHECK(in_flat.x() > 0.026);
      CHECK(in_flat.z() < 1e-8);
    }
  }
  CHECK(num_ends == 3);
}

TEST_CASE("Pads of the Barrett hand have the stated sizes", "[hands][barrett]") {
  // The inner pad box of jhu-lcsr/barrett_model is 52 x 23 mm.
  const ContactPad& tip = barrett().pads[static_cast<std::size_t>(*barrett().fingers[0].tip_pad)];
  CHECK(hands::pad_area(tip) == Approx(0.052 * 0.023).epsilon(1e-9));
  CHECK(hands::largest_boundary_distance(tip) == Approx(0.0115).epsilon(1e-9));
  // The pad's plane is tangent to the base cylinder, 9.5 mm from the distal axis, Barrett's D3.
  CHECK(tip.X_LC.translation().dot(tip.X_LC.linear().col(2)) == Approx(0.0095).epsilon(1e-9));
  // The palm is 76 x 46 mm with cut corners, less an edge of 1.5 mm.
  const ContactPad& palm = barrett().pads[static_cast<std::size_t>(*barrett().palm.pad)];
  CHECK(palm.outline.size() == 8);
  CHECK(hands::largest_boundary_distance(palm) == Approx(0.0215).epsilon(1e-9));
}

TEST_CASE("The reach of the Barrett hand covers its fingertips and little more",
          "[hands][barrett]") {
  // At a spread of 90 degrees finger 1 lies along x from its base at 25 mm. Every vertex of the
  // hand is within the bound, which straightens the finger: 25.2 + 50 + 70 + at most 59.5 mm to the
  // palm center.
  const double reach = hands::largest_reach(barrett());
  CHECK(reach < 0.2050);
  hands::HandConfiguration wide = hands::open_configuration(barrett());
  wide.q[barrett().joint_index("finger_1_spread")] = pi / 2;
  hands::apply_couplings(barrett(), wide.q);
  const auto X_OL = hands::forward_kinematics(barrett(), wide);
  double farthest = 0.0;
  for (std::size_t i = 0; i < X_OL.size(); ++i) {
    for (const Vector3d& vertex : barrett().links[i].mesh_L.vertices) {
      farthest = std::max(farthest, (X_OL[i] * vertex).norm());
    }
  }
  CHECK(farthest > 0.188);  // The tip point alone is at 25 + 162.8.
  CHECK(farthest <= reach);
}

}  // namespace

}  // namespace test_barrett_hand
