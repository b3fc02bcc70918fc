#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "hands/closing.hpp"
#include "support/catch.hpp"

namespace test_shipped_hands {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::ContactPad;
using hands::HandModel;
using hands::Link;
using hands::RigidTransform;
using testing::closed_by;

const std::map<std::string, HandModel>& shipped() {
  static const std::map<std::string, HandModel> hands = [] {
    std::map<std::string, HandModel> result;
    for (const std::string& name : graspfit::hands::shipped_hands()) {
      result.emplace(name, graspfit::hands::find_hand(name));
    }
    return result;
  }();
  return hands;
}

const Link& link_of(const HandModel& hand, const ContactPad& pad) {
  return hand.links[static_cast<std::size_t>(pad.link)];
}

TEST_CASE("The paper's three hands are shipped with their options and degrees of freedom",
          "[hands][shipped_hands]") {
  // The paper has gripper 1, Barrett 4, human hand 20. Options are Franka's proportions, Barrett
  // with free distal joints (1 spread, 3 proximal, 3 distal), end joints coupled by 2/3, and sizes.
  const std::map<std::string, std::pair<int, std::size_t>> expected{
      {"parallel_gripper", {1, 2}},
      {"franka_gripper", {1, 2}},
      {"barrett", {4, 3}},
      {"barrett_7dof", {7, 3}},
      {"barrett_ends", {4, 3}},
      {"human_hand", {20, 5}},
      {"human_hand_medium", {20, 5}},
      {"human_hand_small", {20, 5}},
      {"human_hand_coupled", {16, 5}}};
  CHECK(shipped().size() == expected.size());
  for (const auto& [name, counts] : expected) {
    CAPTURE(name);
    REQUIRE(shipped().contains(name));
    const HandModel& hand = shipped().at(name);
    CHECK(hand.name == name);
    CHECK(hand.num_intrinsic_dof() == counts.first);
    CHECK(hand.fingers.size() == counts.second);
    CHECK(hand.palm.pad);
    CHECK(hand.palm.direction_H == Vector3d::UnitZ());
    for (const hands::Finger& finger : hand.fingers) CHECK(finger.tip_pad);
  }
}

TEST_CASE("Every shipped link is closed, manifold, outward, one part and free of self-intersection",
          "[hands][shipped_hands]") {
  std::size_t num_checked = 0;
  for (const auto& [name, hand] : shipped()) {
    if (name.starts_with("human_hand_")) continue;  // Their meshes are human_hand's, scaled.
    for (const Link& link : hand.links) {
      if (link.mesh_L.faces.empty()) continue;
      CAPTURE(name, link.name);
      const geometry::MeshAnalysis analysis =
          geometry::analyze(link.mesh_L, {.count_self_intersections = true});
      CHECK(analysis.is_closed);
      CHECK(analysis.is_manifold);
      CHECK(analysis.is_outward);
      CHECK(analysis.num_parts == 1);
      CHECK(analysis.num_degenerate_faces == 0);
      CHECK(analysis.num_self_intersections == std::size_t{0});
      CHECK(analysis.num_faces < 3000);
      ++num_checked;
    }
  }
  CHECK(num_checked == 3 + 3 + 3 * 9 + 16);
}

TEST_CASE(
    "Every shipped link with a surface has a mass, inside its own box and of plausible inertia",
    "[hands][shipped_hands]") {
  for (const auto& [name, hand] : shipped()) {
    for (const Link& link : hand.links) {
      CAPTURE(name, link.name);
      REQUIRE(link.inertia.has_value() == !link.mesh_L.faces.empty());
      if (!link.inertia) continue;
      CHECK(link.inertia->mass > 0.0);
      CHECK(
          (link.inertia->center_L - geometry::mass_properties(link.mesh_L).center_of_mass).norm() <
          1e-6);
      // The principal moments of a body are positive, and none is larger than the other two
      // together.
      const Vector3d moments =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link.inertia->inertia_L).eigenvalues();
      CHECK(moments[0] > 0.0);
      CHECK(moments[2] <= moments[0] + moments[1]);
    }
  }
}

TEST_CASE("Flat pads of the grippers are a part of their link's mesh", "[hands][shipped_hands]") {
  // This is checked as for the Barrett hand in test_barrett_hand.cpp.
  for (const std::string name : {"parallel_gripper", "franka_gripper"}) {
    const HandModel& hand = shipped().at(name);
    for (const ContactPad& pad : hand.pads) {
      CAPTURE(name, pad.name);
      const geometry::TriangleMesh& mesh = link_of(hand, pad).mesh_L;
      // Coordinates in the files have 10 decimals.
      constexpr double kTolerance = 1e-9;
      geometry::ConvexVolume slab_C = hands::clip_volume_C(pad, 1.0);
      slab_C[slab_C.size() - 2].offset = kTolerance;
      const geometry::ConvexVolume slab = hands::transformed(slab_C, pad.X_LC);
      double covered = 0.0;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto piece = geometry::clip(geometry::corners(mesh, f), slab);
        // These are the areas [m²] of faces that only border on the pad.
        constexpr double kSliver = 1e-9;
        if (!piece || piece->area < kSliver) continue;
        for (const Vector3d& corner : piece->polygon) {
          CHECK((pad.X_LC.inverse() * corner).z() < kTolerance);
        }
        covered += piece->area;
      }
      CHECK(covered == Approx(hands::pad_area(pad)).epsilon(1e-6));
    }
  }
}

TEST_CASE("Curved pads lie on their link's skin, face outward and follow it to 0.4 mm",
          "[hands][shipped_hands]") {
  std::size_t num_curved = 0;
  for (const auto& [name, hand] : shipped()) {
    for (const ContactPad& pad : hand.pads) {
      if (pad.surface.empty()) continue;
      ++num_curved;
      CAPTURE(name, pad.name);
      const geometry::MeshQuery skin(link_of(hand, pad).mesh_L);
      for (const Vector3d& point_C : pad.surface) {
        const auto nearest = skin.closest_point(pad.X_LC * point_C);
        // Facets of the mesh are at most 6 mm long on curves of more than 6 mm radius.
        CHECK((nearest.point - pad.X_LC * point_C).norm() < 0.3e-3);
      }
      // A contact of the skin is one of the pad: what lies under the outline is at most this far
      // over or under the pad, less than half of the thinnest clip volume (1 mm).
      const RigidTransform X_CL = pad.X_LC.inverse();
      std::size_t num_under = 0;
      for (const Vector3d& vertex : skin.mesh().vertices) {
        const Vector3d vertex_C = X_CL * vertex;
        if (vertex_C.z() < 0.0 || hands::boundary_distance(pad, vertex_C.head<2>()) == 0.0)
          continue;
        CHECK(std::abs(hands::height_over_pad(pad, vertex_C)) < 0.4e-3);
        ++num_under;
      }
      // End pads are facets of the mesh, whose corners are theirs.
      if (!name.starts_with("barrett")) CHECK(num_under > 5);
    }
  }
  CHECK(num_curved == 4 * (4 * 3 + 2 + 1) + 3);
}

TEST_CASE("The point of a pad that touches lies on the link's skin, of a flat pad at its frame",
          "[hands][shipped_hands]") {
  for (const auto& [name, hand] : shipped()) {
    const auto X_OL = hands::forward_kinematics(hand, closed_by(hand, 0.3));
    for (std::size_t p = 0; p < hand.pads.size(); ++p) {
      const ContactPad& pad = hand.pads[p];
      CAPTURE(name, pad.name);
      const Vector3d point_C = hands::pad_contact_point_C(pad);
      CHECK(point_C.head<2>().norm() == 0.0);
      CHECK(std::abs(hands::height_over_pad(pad, point_C)) < 1e-15);
      const RigidTransform X_OC = hands::pad_pose(hand, static_cast<int>(p), X_OL);
      const Vector3d point_O = hands::pad_contact_point(hand, static_cast<int>(p), X_OL);
      if (pad.surface.empty()) {
        CHECK(point_O == X_OC.translation());
      } else {
        CHECK((point_O - X_OC * point_C).norm() < 1e-15);
        CHECK(point_C.z() > 0.8 * hands::pad_height(pad));
        const geometry::MeshQuery skin(link_of(hand, pad).mesh_L);
        CHECK(std::sqrt(skin.closest_point(pad.X_LC * point_C).squared_distance) < 0.3e-3);
      }
    }
  }
}

TEST_CASE("No shipped hand touches itself open or half closed", "[hands][shipped_hands]") {
  for (const auto& [name, hand] : shipped()) {
    const hands::HandCollision collision(hand);
    for (const double closing : {0.0, 0.5}) {
      const auto found =
          collision.against_self(hands::forward_kinematics(hand, closed_by(hand, closing)));
      CAPTURE(name, closing, found.link_a, found.link_b, found.depth);
      CHECK_FALSE(found.intersects);
    }
  }
}

TEST_CASE("Closing brings the thumb's pad and the fingers' pads face to face",
          "[hands][shipped_hands]") {
  // The human hand is closed by a quarter of the way, the others by 45 %.
  for (const auto& [name, hand] : shipped()) {
    const bool is_human = name.starts_with("human");
    const auto X_OL = hands::forward_kinematics(hand, closed_by(hand, is_human ? 0.25 : 0.45));
    const RigidTransform thumb =
        hands::pad_pose(hand, *hand.fingers[static_cast<std::size_t>(hand.thumb())].tip_pad, X_OL);
    for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
      // The little finger stays beside GraspIt!'s thumb, which does not turn so far.
      if (static_cast<int>(f) == hand.thumb() || hand.fingers[f].name == "little") continue;
      CAPTURE(name, hand.fingers[f].name);
      const RigidTransform tip = hands::pad_pose(hand, *hand.fingers[f].tip_pad, X_OL);
      const Vector3d line = (tip.translation() - thumb.translation()).normalized();
      CHECK(thumb.linear().col(2).dot(line) > 0.5);
      CHECK(-tip.linear().col(2).dot(line) > 0.5);
    }
  }
}

TEST_CASE("Hands may share meshes inside the package of all hands", "[hands][shipped_hands]") {
  CHECK(shipped().at("barrett_7dof").links[0].mesh_files ==
        std::vector<std::string>{"../barrett/meshes/palm.obj"});
  CHECK(shipped().at("human_hand_small").links[0].mesh_files ==
        std::vector<std::string>{"../human_hand/meshes/palm.obj"});
}

}  // namespace

}  // namespace test_shipped_hands
