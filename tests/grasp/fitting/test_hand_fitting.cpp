#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "grasp/fitting_scene.hpp"
#include "grasp/target_oracle.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/random_targets.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_hand_fitting {

namespace {

using namespace graspfit;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::RigidTransform;
using grasp::FittingOptions;
using grasp::FittingResult;
using grasp::FittingStop;
using grasp::PalmPlacement;
using grasp::TargetContacts;
using testing::angle_between;
using testing::dense_points;
using testing::equilateral_targets;
using testing::on_surface;
using testing::Scene;
using testing::targets_at;
using testing::unsaid;

constexpr double kPi = std::numbers::pi;
const std::vector<std::string> kNothing;

FittingOptions with_guard(grasp::PenetrationGuard guard) {
  FittingOptions options;
  options.guard = guard;
  return options;
}

/// Returns how far inside the full voxels a point lies: its distance from the nearest voxel that is
/// not full [voxels]; 0 for a point in such a voxel. Depths beyond a voxel are reported as one.
double depth_in_full_voxels(const geometry::VoxelGrid& grid, const Vector3d& point) {
  const geometry::VoxelLattice& lattice = grid.lattice;
  const Eigen::Vector3i voxel = lattice.voxel_at(point);
  if (!lattice.contains(voxel) || grid.at(voxel) != geometry::VoxelClass::Full) return 0.0;
  double nearest = lattice.voxel_size;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const Eigen::Vector3i neighbor = voxel + Eigen::Vector3i(dx, dy, dz);
        if (grid.at(neighbor) == geometry::VoxelClass::Full) continue;
        const Vector3d center = lattice.center(neighbor);
        const Vector3d outside =
            ((point - center).cwiseAbs().array() - 0.5 * lattice.voxel_size).max(0.0);
        nearest = std::min(nearest, outside.norm());
      }
    }
  }
  return nearest / lattice.voxel_size;
}

/// Returns the depth of the deepest of points a quarter of a voxel apart on all links [voxels]: an
/// independent check of what d_min ≥ 0 promises.
double deepest_in_full_voxels(const Scene& scene, const std::vector<RigidTransform>& X_OL) {
  double deepest = 0.0;
  for (std::size_t link = 0; link < scene.hand.links.size(); ++link) {
    for (const Vector3d& point_L :
         dense_points(scene.hand.links[link].mesh_L, 0.25 * scene.voxel_size())) {
      deepest = std::max(deepest, depth_in_full_voxels(scene.object.grid, X_OL[link] * point_L));
    }
  }
  return deepest;
}

/// Returns d_min over the points that the fitting itself uses.
float sampled_distance(const Scene& scene, const std::vector<RigidTransform>& X_OL) {
  float smallest = std::numeric_limits<float>::infinity();
  for (std::size_t link = 0; link < scene.hand.links.size(); ++link) {
    for (const Vector3d& point_L : scene.fitting_hand.samples(static_cast<int>(link)).points_L) {
      const Vector3d point_O = X_OL[link] * point_L;
      smallest = std::min(smallest, scene.object.distance.at(point_O));
    }
  }
  return smallest;
}

/// Returns the distance of a point from a pad's clip volume [m].
double distance_to_clip_volume(const hands::ContactPad& pad, double thickness,
                               const Vector3d& point_C) {
  const double height = std::clamp(point_C.z(), 0.0, thickness);
  const Vector2d flat = point_C.head<2>();
  double flat_distance = 0.0;
  bool is_inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pad.outline.size(); ++i) {
    const Vector2d a = pad.outline[i], edge = pad.outline[(i + 1) % pad.outline.size()] - a;
    const Vector2d from_a = flat - a;
    if (edge.x() * from_a.y() - edge.y() * from_a.x() < 0.0) is_inside = false;
    const double t = std::clamp(from_a.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (from_a - t * edge).norm());
  }
  if (!is_inside) flat_distance = nearest;
  return std::hypot(flat_distance, point_C.z() - height);
}

/// Returns all that has to hold of a fit however it ended and does not, one line for each.
std::vector<std::string> broken_guarantees(const Scene& scene, const TargetContacts& targets,
                                           const PalmPlacement& placement,
                                           const FittingOptions& options,
                                           const FittingResult& result) {
  std::vector<std::string> broken;
  const auto report = [&](const auto&... parts) {
    std::ostringstream line;
    line.precision(17);
    (line << ... << parts);
    broken.push_back(line.str());
  };
  const hands::HandModel& hand = scene.hand;
  if (result.stop == FittingStop::InitialCollision) return broken;

  if (result.iterations < 0 || result.iterations > options.max_iterations) {
    report("iterations: ", result.iterations);
  }
  for (const hands::HandConfiguration* configuration : {&result.initial, &result.configuration}) {
    const char* name = configuration == &result.initial ? "initial: " : "final: ";
    if (configuration->q.size() != static_cast<int>(hand.joints.size())) {
      report(name, configuration->q.size(), " joint positions");
      return broken;
    }
    for (std::size_t i = 0; i < hand.joints.size(); ++i) {
      const hands::Joint& joint = hand.joints[i];
      const double q = configuration->q[i];
      if (!(q >= joint.lower - 1e-9 && q <= joint.upper + 1e-9)) {
        report(name, joint.name, " outside its limits: ", q);
      }
      if (!joint.coupling) continue;
      const double coupled = std::clamp(
          joint.coupling->ratio * configuration->q[joint.coupling->leader] + joint.coupling->offset,
          joint.lower, joint.upper);
      const double further_closed = joint.closing_sign * (q - coupled);
      if (joint.coupling->breakaway ? further_closed < -1e-9 : std::abs(q - coupled) > 1e-9) {
        report(name, joint.name, " at ", q, ", its coupling asks for ", coupled);
      }
    }
    const Eigen::Matrix3d R = configuration->X_OH.linear();
    if ((R.transpose() * R - Eigen::Matrix3d::Identity()).norm() > 1e-9 || R.determinant() < 0) {
      report(name, "not a rotation");
    }
    if (angle_between(R * hand.palm.direction_H, placement.direction_O) > 1e-9) {
      report(name, "palm direction left by ",
             angle_between(R * hand.palm.direction_H, placement.direction_O));
    }
  }

  const auto X_OL = hands::forward_kinematics(hand, result.configuration);
  const float sampled = sampled_distance(scene, X_OL);
  if (!(sampled >= 0.0F)) report("d_min of the fitting's own points: ", sampled);
  if (sampled != static_cast<float>(result.smallest_distance)) {
    report("reported d_min ", result.smallest_distance, ", found ", sampled);
  }
  const double deepest = deepest_in_full_voxels(scene, X_OL);
  const auto penetration = scene.collision.against_object(scene.object.query, X_OL);
  if (penetration.depth > scene.voxel_size()) {
    report(hand.links[*penetration.link_a].name, " cuts ", penetration.depth / scene.voxel_size(),
           " voxel edges into the object");
  }
  if (options.guard == grasp::PenetrationGuard::Meshes) {
    // No link is in the object, and so none is in a full voxel.
    if (penetration.intersects) {
      report(hand.links[*penetration.link_a].name, " cuts ", penetration.depth,
             " m into the object");
    }
    if (deepest > 0.0) report("a link reaches ", deepest, " voxels into full ones");
  } else if (deepest > options.sample_spacing) {
    // No sampled point is in a full voxel, and the next sample is no farther than the spacing.
    report("between its samples a link reaches ", deepest, " voxels into full ones");
  }

  const auto X_OL_initial = hands::forward_kinematics(hand, result.initial);
  if (scene.collision.against_object(scene.object.query, X_OL_initial).intersects) {
    report("initial configuration not clear of the object");
  }

  const std::vector<contact::Contact> contacts = scene.contacts(result);
  for (const contact::Contact& contact : contacts) {
    const hands::ContactPad& pad = hand.pads[*contact.pad];
    const double thickness = pad.clip_thickness.value_or(scene.contact_options.clip_thickness);
    const Vector3d point_C = hands::pad_pose(hand, *contact.pad, X_OL).inverse() * contact.point_O;
    const double distance = distance_to_clip_volume(pad, thickness, point_C);
    if (distance > scene.voxel_size()) {
      report("contact of pad ", *contact.pad, ": ", distance, " from its volume");
    }
  }
  if (result.stop == FittingStop::Contact) {
    for (const auto& target : targets.contacts) {
      if (std::none_of(contacts.begin(), contacts.end(), [&](const auto& contact) {
            return contact.is_target && grasp::is_for_part_of(target, contact);
          })) {
        report("formed, but no contact of finger ", target.finger.value_or(-1));
      }
    }
  }
  return broken;
}

TEST_CASE("The Barrett hand forms a grasp on ideal targets around a ball",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const auto guard = GENERATE(grasp::PenetrationGuard::Meshes, grasp::PenetrationGuard::Voxels);
  const auto state = GENERATE(grasp::ContactState::Closed, grasp::ContactState::FirstGraze);
  FittingOptions options = with_guard(guard);
  options.contact_state = state;
  for (const double turn : {0.0, 0.7, -kPi / 2.0, 3.0}) {
    for (const double side : {1.0, -1.0}) {
      INFO("seed at " << turn << " rad, palm looks along " << side << " z, guard "
                      << static_cast<int>(guard) << ", state " << static_cast<int>(state));
      const PalmPlacement placement{Vector3d(0, 0, side)};
      const TargetContacts targets = grasp::assign_fingers(
          scene.hand, on_surface(scene.object, equilateral_targets(0.05, turn)), scene.parts,
          placement);
      const FittingResult result = scene.fit(targets, placement, options);
      CHECK(result.stop == FittingStop::Contact);
      CHECK(broken_guarantees(scene, targets, placement, options, result) == kNothing);
      // Touching parts share voxels with the surface.
      CHECK(result.smallest_distance == 0.0);
      for (const contact::Contact& contact : scene.contacts(result)) {
        // The faces of an icosphere are below the sphere by 1 − cos of half an edge's angle.
        CHECK(contact.point_O.norm() == Approx(0.05).epsilon(0.01));
      }

      // The thumb is turned to the seed (sections 7.4 and 8.3 of the paper).
      const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
      const Vector3d center = result.configuration.X_OH * scene.hand.palm.center_H;
      const int thumb_pad = *scene.hand.fingers[scene.hand.thumb()].tip_pad;
      Vector3d to_thumb = hands::pad_pose(scene.hand, thumb_pad, X_OL).translation() - center;
      Vector3d to_seed = targets.contacts[0].point_O - center;
      to_thumb.z() = 0.0;
      to_seed.z() = 0.0;
      CHECK(angle_between(to_thumb, to_seed) < 15.0 * kPi / 180.0);

      // A fit to perfect targets is a usable grasp: none of the cases applies in which M is zero.
      contact::QualityContext context;
      context.center_of_mass_O = scene.object.mass.center_of_mass;
      context.normalizing_radius = scene.object.normalizing_radius;
      context.hand = &scene.hand;
      CHECK(contact::contact_quality(scene.contacts(result), context).is_usable());
    }
  }
}

TEST_CASE("Closed fingers rest on the true surface", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const FittingOptions options;
  for (const double turn : {0.0, 1.3}) {
    const FittingResult result =
        scene.fit(scene.assigned(on_surface(scene.object, equilateral_targets(0.05, turn)),
                                 {Vector3d(0, 0, -1)}),
                  {Vector3d(0, 0, -1)});
    REQUIRE(result.stop == FittingStop::Contact);
    const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
    for (const hands::Finger& finger : scene.hand.fingers) {
      double gap = std::numeric_limits<double>::infinity();
      for (const int link : finger.links) {
        const geometry::MeshQuery mesh(scene.hand.links[link].mesh_L);
        gap = std::min(gap, geometry::distance(scene.object.query, mesh, X_OL[link]).distance);
      }
      // One more motion of the tolerance would penetrate, so that some link is no farther away than
      // that.
      INFO(finger.name << ", seed at " << turn << " rad");
      CHECK(gap > 0.0);
      CHECK(gap <= 2.0 * options.closing_tolerance);
    }
  }
}

TEST_CASE("A palm that goes on after the first contact brings fingers nearer to their targets",
          "[grasp][hand_fitting]") {
  // The hand starts beside a ball: one finger meets the ball before the palm is over it.
  const Scene scene(geometry::ball(0.05));
  double frozen_sum = 0.0, recentred_sum = 0.0;
  for (const double turn : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5}) {
    INFO("seed at " << turn << " rad");
    const PalmPlacement placement{Vector3d(0, 0, -1)};
    // The targets are below the equator on one side and above it on the other.
    RigidTransform X_OT = RigidTransform::Identity();
    X_OT.linear() = Eigen::AngleAxisd(0.3, Vector3d(std::cos(2 * turn), std::sin(2 * turn), 0))
                        .toRotationMatrix();
    const TargetContacts targets =
        scene.assigned(on_surface(scene.object, equilateral_targets(0.05, turn, X_OT)), placement);
    const auto missed_by = [&](grasp::PalmAfterContact palm) {
      FittingOptions options;
      options.palm_after_contact = palm;
      const FittingResult result = scene.fit(targets, placement, options);
      CHECK(result.stop == FittingStop::Contact);
      CHECK(broken_guarantees(scene, targets, placement, options, result) == kNothing);
      double sum = 0.0;
      for (const contact::Contact& contact : scene.contacts(result)) {
        for (const grasp::TargetContact& target : targets.contacts) {
          if (contact.is_target && grasp::is_for_part_of(target, contact)) {
            sum += (contact.point_O - target.point_O).norm();
          }
        }
      }
      return sum;
    };
    frozen_sum += missed_by(grasp::PalmAfterContact::Frozen);
    recentred_sum += missed_by(grasp::PalmAfterContact::Recentred);
  }
  INFO("frozen " << frozen_sum << " m, recentred " << recentred_sum << " m");
  CHECK(recentred_sum < frozen_sum);
}

TEST_CASE("The hand starts open, over the middle of the targets, clear of the object",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const TargetContacts targets = on_surface(scene.object, equilateral_targets(0.05, 0.3));
  for (const double clearance : {0.02, 0.05}) {
    FittingOptions options;
    options.clearance = clearance;
    for (const double side : {1.0, -1.0}) {
      const PalmPlacement placement{Vector3d(0, 0, side)};
      const FittingResult result =
          scene.fit(scene.assigned(targets, placement), placement, options);
      for (std::size_t i = 0; i < scene.hand.joints.size(); ++i) {
        const hands::Joint& joint = scene.hand.joints[i];
        if (joint.closing_sign > 0) CHECK(result.initial.q[i] == Approx(joint.lower).margin(1e-12));
        if (joint.closing_sign < 0) CHECK(result.initial.q[i] == Approx(joint.upper).margin(1e-12));
      }
      const Vector3d center = result.initial.X_OH * scene.hand.palm.center_H;
      const Vector3d from_targets = center - targets.centroid();
      // The palm is where the fingertips reach their targets best. The thumb's base is nearer to
      // the palm center than the others' by 25 mm, so that this is not quite over the middle.
      CHECK(from_targets.head<2>().norm() < 0.025);
      // The palm is beyond the ball's pole by the clearance at least; the icosphere's pole may be
      // lower than the sphere's by 1 − cos of half an edge.
      CHECK(-side * from_targets.z() > 0.05 * 0.99 + clearance - 1e-9);
      CHECK_FALSE(scene.collision
                      .against_object(scene.object.query,
                                      hands::forward_kinematics(scene.hand, result.initial))
                      .intersects);
    }
  }
}

TEST_CASE("The guarantees of fitting hold on every shape, however the fit ends",
          "[grasp][hand_fitting]") {
  struct Case {
    const char* name;
    geometry::TriangleMesh mesh;
  };
  const std::vector<Case> cases = {
      {"box", geometry::box(Vector3d(0.10, 0.06, 0.08))},
      {"torus", geometry::torus(0.05, 0.018)},
      {"capsule", geometry::capsule(0.03, 0.08)},
  };
  int num_formed = 0;
  for (const Case& shape : cases) {
    const Scene scene(shape.mesh);
    const grasp::PartDistances distances = grasp::part_distances(scene.hand);
    grasp::TargetOptions target_options;
    target_options.min_separation = 0.023;
    for (int seed = 1; seed <= 6; ++seed) {
      // Every third set has the paper's guard.
      FittingOptions options = with_guard(seed % 3 == 0 ? grasp::PenetrationGuard::Voxels
                                                        : grasp::PenetrationGuard::Meshes);
      if (seed % 2 == 0) options.palm_after_contact = grasp::PalmAfterContact::Frozen;
      base::Random random(seed);
      const auto selection =
          grasp::TargetSelector(scene.object, distances, scene.parts, target_options,
                                grasp::IdealMeasure{&scene.hand, {}})
              .select(random);
      if (!selection.targets) continue;
      for (const PalmPlacement& placement :
           grasp::palm_placements(scene.object, *selection.targets, std::nullopt, kPi)) {
        INFO(shape.name << ", seed " << seed << ", palm along "
                        << placement.direction_O.transpose());
        const TargetContacts targets =
            grasp::assign_fingers(scene.hand, *selection.targets, scene.parts, placement);
        const FittingResult result = scene.fit(targets, placement, options);
        CHECK(broken_guarantees(scene, targets, placement, options, result) == kNothing);
        if (result.stop == FittingStop::Contact) ++num_formed;
      }
    }
  }
  CHECK(num_formed > 0);
}

TEST_CASE("A fit is a function of its input", "[grasp][hand_fitting]") {
  const Scene scene(geometry::capsule(0.03, 0.08));
  const TargetContacts targets = on_surface(scene.object, equilateral_targets(0.03, 0.4));
  const PalmPlacement placement{Vector3d(0, 0, -1)};
  const TargetContacts assigned = scene.assigned(targets, placement);
  const FittingResult a = scene.fit(assigned, placement), b = scene.fit(assigned, placement);
  CHECK(a.stop == b.stop);
  CHECK(a.iterations == b.iterations);
  CHECK(a.configuration.X_OH.matrix() == b.configuration.X_OH.matrix());
  CHECK(a.configuration.q == b.configuration.q);
}

TEST_CASE("Fingers that close on nothing miss their contacts", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  // The targets are in free air, farther from the ball than any finger reaches.
  RigidTransform X_OT = RigidTransform::Identity();
  X_OT.translation() = Vector3d(0.5, 0, 0);
  const TargetContacts targets = equilateral_targets(0.05, 0.0, X_OT);
  const FittingResult result =
      scene.fit(scene.assigned(targets, {Vector3d(0, 0, -1)}), {Vector3d(0, 0, -1)});
  CHECK(result.stop == FittingStop::MissedContact);
  CHECK(scene.contacts(result).empty());
  CHECK(result.smallest_distance > 0.0);
}

TEST_CASE("A fit stops when its iterations are used up", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const TargetContacts targets = on_surface(scene.object, equilateral_targets(0.05, 0.0));
  FittingOptions options;
  // Opened tips are more than ten voxels from the ball, and a step moves them at most eight.
  options.max_iterations = 1;
  const FittingResult result =
      scene.fit(scene.assigned(targets, {Vector3d(0, 0, -1)}), {Vector3d(0, 0, -1)}, options);
  CHECK(result.stop == FittingStop::IterationLimit);
  CHECK(result.iterations == 1);
}

TEST_CASE("Fitting options out of range are refused by name and value", "[grasp][hand_fitting]") {
  const auto message_of = [](auto set) {
    FittingOptions options;
    set(options);
    try {
      options.validate();
    } catch (const base::InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  CHECK_NOTHROW(FittingOptions{}.validate());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(unsaid(message_of([](auto& o) { o.clearance = -0.125; }), "clearance", "-0.125") == "");
  CHECK(unsaid(message_of([=](auto& o) { o.clearance = nan; }), "clearance", "nan") == "");
  CHECK(unsaid(message_of([=](auto& o) { o.large_step_at = nan; }), "large_step_at", "nan") == "");
  CHECK(unsaid(message_of([](auto& o) { o.large_step_limit = -1.5; }), "large_step_limit",
               "-1.5") == "");
  CHECK(unsaid(message_of([](auto& o) { o.small_step = 0.0; }), "small_step", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.max_halvings = -2; }), "max_halvings", "-2") == "");
  CHECK(unsaid(message_of([](auto& o) { o.max_iterations = 0; }), "max_iterations", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.closing_tolerance = 0.0; }), "closing_tolerance", "0") ==
        "");
  CHECK(unsaid(message_of([](auto& o) { o.give_up_distance = -0.5; }), "give_up_distance",
               "-0.5") == "");
  CHECK(unsaid(message_of([](auto& o) { o.sample_spacing = 0.0; }), "sample_spacing", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.sample_spacing = -0.25; }), "sample_spacing", "-0.25") ==
        "");
}

}  // namespace

}  // namespace test_hand_fitting
