// The planning method that grasp/README.md shows, axis_guidance.cpp beside this file.
#include <memory>

#include "grasp/guidance_scene.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace graspfit::grasp::internal {
std::unique_ptr<GraspGuidance> axis_guidance(const GuidanceScene& scene);
}

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using Eigen::Vector3d;

TEST_CASE("The method that the page shows comes along each axis and touches the object",
          "[grasp][planning_methods]") {
  const Vector3d center(0.02, -0.01, 0.03);
  geometry::TriangleMesh mesh = geometry::ball(0.04, 3);
  for (Vector3d& vertex : mesh.vertices) vertex += center;
  const Guided guided(mesh, at_voxel_level("gs"));  // whose scene is anybody's
  const Scene& scene = guided.scene;
  const std::unique_ptr<grasp::GraspGuidance> guidance =
      grasp::internal::axis_guidance({.object = scene.object,
                                      .hand = scene.fitting_hand,
                                      .surroundings = scene.nothing,
                                      .parts = scene.parts,
                                      .options = guided.options,
                                      .contact_options = scene.contact_options});
  for (int axis = 0; axis < 3; ++axis) {
    const grasp::GuidedStarts starts = guidance->starts(axis);
    CHECK_FALSE(starts.is_exhausted);
    REQUIRE(starts.starts.size() == 1);
    const grasp::FittingResult closed = starts.starts[0].close();
    const geometry::RigidTransform& X_OH = closed.initial.X_OH;
    const Vector3d direction = X_OH.linear() * scene.hand.palm.direction_H;
    CHECK((direction + Vector3d::Unit(axis)).norm() < 1e-12);
    // The palm's axis goes through the center of mass, which is the ball's center to rounding.
    const Vector3d to_center = center - X_OH * scene.hand.palm.center_H;
    CHECK(to_center.cross(direction).norm() < 1e-9);
    CHECK(closed.contacts.size() >= 2);
    CHECK(closed.smallest_distance >= 0.0);
    for (const grasp::Contact& contact : closed.contacts) {
      CHECK((contact.point_O - center).norm() == Approx(0.04).epsilon(0.05));
    }
  }
  CHECK(guidance->starts(3).is_exhausted);
  CHECK(guidance->starts(3).starts.empty());
  CHECK(guidance->model().columns.size() == 3);
}

}  // namespace
