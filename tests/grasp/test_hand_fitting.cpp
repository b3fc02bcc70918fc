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

#include "grasp/target_oracle.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/contact_quality.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

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
using testing::unsaid;

constexpr double kPi = std::numbers::pi;
const std::vector<std::string> kNothing;

FittingOptions with_guard(grasp::PenetrationGuard guard) {
  FittingOptions options;
  options.guard = guard;
  return options;
}

/// An object prepared for the Barrett hand, and the hand prepared for it.
struct Scene {
  explicit Scene(const geometry::TriangleMesh& mesh)
      : hand(hands::find_hand("barrett")),
        object(grasp::prepare_object(mesh, hand, {})),
        fitting_hand(hand, FittingOptions{}.sample_spacing * object.grid.lattice.voxel_size),
        collision(hand) {
    contact_options.clip_thickness = grasp::clip_thickness({}, object.grid.lattice.voxel_size);
    fingers = grasp::requested_fingers(hand, {});
  }

  double voxel_size() const { return object.grid.lattice.voxel_size; }

  FittingResult fit(const TargetContacts& targets, const PalmPlacement& placement,
                    const FittingOptions& options = {}) const {
    return grasp::fit_hand(fitting_hand, object,
                           grasp::assign_fingers(hand, targets, fingers, placement), placement,
                           contact_options, options);
  }

  hands::HandModel hand;
  grasp::ObjectModel object;
  grasp::FittingHand fitting_hand;
  hands::HandCollision collision;
  grasp::ContactEstimationOptions contact_options;
  std::vector<int> fingers;  ///< Thumb first.
};

TargetContacts targets_at(const std::vector<Vector3d>& points,
                          const std::vector<Vector3d>& outward_normals) {
  TargetContacts targets;
  for (std::size_t i = 0; i < points.size(); ++i) {
    grasp::TargetContact target;
    target.point_O = points[i];
    target.outward_normal_O = outward_normals[i].normalized();
    target.score = 1.0;
    targets.contacts.push_back(target);
  }
  return targets;
}

/// Three targets 120° apart on the circle of radius `radius` around `X_OT`'s z axis, normals
/// radial, the seed at angle `turn`.
TargetContacts equilateral_targets(double radius, double turn,
                                   const RigidTransform& X_OT = RigidTransform::Identity()) {
  std::vector<Vector3d> points, normals;
  for (int i = 0; i < 3; ++i) {
    const double angle = turn + i * 2.0 * kPi / 3.0;
    const Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
    points.push_back(X_OT * Vector3d(radius * radial));
    normals.push_back(X_OT.linear() * radial);
  }
  return targets_at(points, normals);
}

/// Moves targets onto the surface and gives each the patch nearest to it.
TargetContacts on_surface(const grasp::ObjectModel& object, TargetContacts targets) {
  for (grasp::TargetContact& target : targets.contacts) {
    target.point_O = object.query.closest_point(target.point_O).point;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < object.patches.size(); ++i) {
      const double distance = (object.patches[i].centroid - target.point_O).norm();
      if (distance < nearest) {
        nearest = distance;
        target.patch = static_cast<int>(i);
      }
    }
  }
  return targets;
}

/// Points on every triangle of a mesh, on a grid not wider than `spacing`; corners included.
std::vector<Vector3d> dense_points(const geometry::TriangleMesh& mesh, double spacing) {
  std::vector<Vector3d> points;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = geometry::corners(mesh, face);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        points.push_back(a + (b - a) * (double(i) / n) + (c - a) * (double(j) / n));
      }
    }
  }
  return points;
}

/// How far inside the full voxels a point lies: its distance from the nearest voxel that is not
/// full [voxels]; 0 for a point in such a voxel. Depths beyond a voxel are reported as one.
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

/// The deepest of points a quarter of a voxel apart on all links [voxels]: an independent look at
/// what d_min ≥ 0 promises.
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

/// The same over the points that the fitting itself uses.
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

/// Distance of a point from a pad's clip volume [m].
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

/// All that has to hold of a fit however it ended, one line for each thing that does not.
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
  if (options.guard == grasp::PenetrationGuard::Meshes) {
    // Nothing of the hand is in the object, so nothing is in a full voxel.
    const auto penetration = scene.collision.against_object(scene.object.query, X_OL);
    if (penetration.intersects) {
      report(hand.links[penetration.link_a].name, " cuts ", penetration.depth,
             " m into the object");
    }
    if (deepest > 0.0) report("a link reaches ", deepest, " voxels into full ones");
  } else if (deepest > options.sample_spacing) {
    // No sampled point is in a full voxel, and the next one is no farther than the spacing.
    report("between its samples a link reaches ", deepest, " voxels into full ones");
  }

  const auto X_OL_initial = hands::forward_kinematics(hand, result.initial);
  if (scene.collision.against_object(scene.object.query, X_OL_initial).intersects) {
    report("initial configuration not clear of the object");
  }

  // Contacts are what the estimation finds in the final configuration.
  const auto estimated =
      grasp::estimate_contacts(hand, X_OL, scene.object.query, scene.contact_options);
  if (estimated.size() != result.contacts.size()) {
    report(result.contacts.size(), " contacts, estimation finds ", estimated.size());
    return broken;
  }
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    const grasp::Contact &a = result.contacts[i], &b = estimated[i];
    if (a.point_O != b.point_O || a.inward_normal_O != b.inward_normal_O || a.area != b.area ||
        a.pad_boundary_distance != b.pad_boundary_distance || a.gap != b.gap || a.link != b.link ||
        a.pad != b.pad || a.finger != b.finger || a.weak != b.weak) {
      report("contact ", i, " is not the one that estimation finds");
    }
    const hands::ContactPad& pad = hand.pads[a.pad];
    const bool had_target =
        std::any_of(targets.contacts.begin(), targets.contacts.end(), [&](const auto& target) {
          return target.finger >= 0 && hand.fingers[target.finger].tip_pad == a.pad;
        });
    if (a.is_target != had_target) report("contact ", i, ": is_target ", a.is_target);
    const double thickness = pad.clip_thickness.value_or(scene.contact_options.clip_thickness);
    const Vector3d point_C = hands::pad_pose(hand, a.pad, X_OL).inverse() * a.point_O;
    const double distance = distance_to_clip_volume(pad, thickness, point_C);
    if (distance > scene.voxel_size()) report("contact ", i, ": ", distance, " from its volume");
  }
  if (result.stop == FittingStop::Contact) {
    for (const auto& target : targets.contacts) {
      if (std::none_of(result.contacts.begin(), result.contacts.end(), [&](const auto& contact) {
            return contact.is_target && contact.finger == target.finger;
          })) {
        report("formed, but no contact of finger ", target.finger);
      }
    }
  }
  return broken;
}

// ---------------------------------------------------------------------------------------------
// The whole fit

TEST_CASE("The Barrett hand forms a grasp on ideal targets around a ball",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const auto guard = GENERATE(grasp::PenetrationGuard::Meshes, grasp::PenetrationGuard::Voxels);
  const bool settle = GENERATE(true, false);
  FittingOptions options = with_guard(guard);
  options.settle = settle;
  for (const double turn : {0.0, 0.7, -kPi / 2.0, 3.0}) {
    for (const double side : {1.0, -1.0}) {
      INFO("seed at " << turn << " rad, palm looks along " << side << " z, guard "
                      << static_cast<int>(guard) << ", settle " << settle);
      const PalmPlacement placement{Vector3d(0, 0, side)};
      const TargetContacts targets = grasp::assign_fingers(
          scene.hand, on_surface(scene.object, equilateral_targets(0.05, turn)), scene.fingers,
          placement);
      const FittingResult result = grasp::fit_hand(scene.fitting_hand, scene.object, targets,
                                                   placement, scene.contact_options, options);
      CHECK(result.stop == FittingStop::Contact);
      CHECK(broken_guarantees(scene, targets, placement, options, result) == kNothing);
      CHECK(result.smallest_distance == 0.0);  // touching parts share voxels with the surface
      for (const grasp::Contact& contact : result.contacts) {
        // The faces of an icosphere lie below the sphere by 1 − cos of half an edge's angle.
        CHECK(contact.point_O.norm() == Approx(0.05).epsilon(0.01));
      }

      // Sections 7.4 and 8.3: the thumb is turned to the seed.
      const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
      const Vector3d center = result.configuration.X_OH * scene.hand.palm.center_H;
      const int thumb_pad = scene.hand.fingers[scene.hand.thumb()].tip_pad;
      Vector3d to_thumb = hands::pad_pose(scene.hand, thumb_pad, X_OL).translation() - center;
      Vector3d to_seed = targets.contacts[0].point_O - center;
      to_thumb.z() = 0.0;
      to_seed.z() = 0.0;
      CHECK(angle_between(to_thumb, to_seed) < 15.0 * kPi / 180.0);

      // A fit to perfect targets is a usable grasp: it escapes none of M's zero cases.
      grasp::QualityContext context;
      context.center_of_mass_O = scene.object.mass.center_of_mass;
      context.normalizing_radius = scene.object.normalizing_radius;
      context.hand = &scene.hand;
      CHECK(grasp::contact_quality(result.contacts, context).is_usable());
    }
  }
}

TEST_CASE("Settled fingers rest on the true surface", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const FittingOptions options;
  for (const double turn : {0.0, 1.3}) {
    const FittingResult result =
        scene.fit(on_surface(scene.object, equilateral_targets(0.05, turn)), {Vector3d(0, 0, -1)});
    REQUIRE(result.stop == FittingStop::Contact);
    const auto X_OL = hands::forward_kinematics(scene.hand, result.configuration);
    for (const hands::Finger& finger : scene.hand.fingers) {
      double gap = std::numeric_limits<double>::infinity();
      for (const int link : finger.links) {
        const geometry::MeshQuery mesh(scene.hand.links[link].mesh_L);
        gap = std::min(gap, geometry::distance(scene.object.query, mesh, X_OL[link]).distance);
      }
      // One more motion of the tolerance would penetrate, so some link is no farther away than
      // that.
      INFO(finger.name << ", seed at " << turn << " rad");
      CHECK(gap > 0.0);
      CHECK(gap <= 2.0 * options.settle_tolerance);
    }
  }
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
      const FittingResult result = scene.fit(targets, placement, options);
      for (std::size_t i = 0; i < scene.hand.joints.size(); ++i) {
        const hands::Joint& joint = scene.hand.joints[i];
        if (joint.closing_sign > 0) CHECK(result.initial.q[i] == Approx(joint.lower).margin(1e-12));
        if (joint.closing_sign < 0) CHECK(result.initial.q[i] == Approx(joint.upper).margin(1e-12));
      }
      const Vector3d center = result.initial.X_OH * scene.hand.palm.center_H;
      const Vector3d from_targets = center - targets.centroid();
      CHECK(from_targets.head<2>().norm() < 1e-9);
      // Beyond the ball's pole by the clearance at least (A24); the icosphere's pole may be lower
      // than the sphere's by 1 − cos of half an edge.
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
    const hands::TipDistances distances = hands::tip_distances(scene.hand);
    grasp::TargetOptions target_options;
    target_options.min_separation = 0.023;
    for (int seed = 1; seed <= 6; ++seed) {
      // The paper's guard on every third set.
      const FittingOptions options = with_guard(seed % 3 == 0 ? grasp::PenetrationGuard::Voxels
                                                              : grasp::PenetrationGuard::Meshes);
      geometry::Random random(seed);
      const auto selection = grasp::select_target_contacts(scene.object, distances, scene.fingers,
                                                           target_options, random);
      if (!selection.targets) continue;
      for (const PalmPlacement& placement :
           grasp::palm_placements(scene.object, *selection.targets, std::nullopt)) {
        INFO(shape.name << ", seed " << seed << ", palm along "
                        << placement.direction_O.transpose());
        const TargetContacts targets =
            grasp::assign_fingers(scene.hand, *selection.targets, scene.fingers, placement);
        const FittingResult result = grasp::fit_hand(scene.fitting_hand, scene.object, targets,
                                                     placement, scene.contact_options, options);
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
  const FittingResult a = scene.fit(targets, placement), b = scene.fit(targets, placement);
  CHECK(a.stop == b.stop);
  CHECK(a.iterations == b.iterations);
  CHECK(a.configuration.X_OH.matrix() == b.configuration.X_OH.matrix());
  CHECK(a.configuration.q == b.configuration.q);
}

TEST_CASE("Fingers that close on nothing miss their contacts", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  // Targets in free air, farther from the ball than any finger reaches.
  RigidTransform X_OT = RigidTransform::Identity();
  X_OT.translation() = Vector3d(0.5, 0, 0);
  const TargetContacts targets = equilateral_targets(0.05, 0.0, X_OT);
  const FittingResult result = scene.fit(targets, {Vector3d(0, 0, -1)});
  CHECK(result.stop == FittingStop::MissedContact);
  CHECK(result.contacts.empty());
  CHECK(result.smallest_distance > 0.0);
}

TEST_CASE("A fit stops when its iterations are used up", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  const TargetContacts targets = on_surface(scene.object, equilateral_targets(0.05, 0.0));
  FittingOptions options;
  // Opened tips are 16 cm from the axis and have to come within 5 cm; a step moves them at most
  // three voxels of 3.3 mm, so ten steps are not enough.
  options.max_iterations = 10;
  const FittingResult result = scene.fit(targets, {Vector3d(0, 0, -1)}, options);
  CHECK(result.stop == FittingStop::IterationLimit);
  CHECK(result.iterations == 10);
}

// ---------------------------------------------------------------------------------------------
// Palm placements

TEST_CASE("A target triangle has two palm directions, opposite and along its normal",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  geometry::Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vector3d> points, normals;
    for (int i = 0; i < 3; ++i) {
      points.push_back(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
                           .normalized() *
                       0.05);
      normals.push_back(points.back());
    }
    const TargetContacts targets = targets_at(points, normals);
    const auto placements = grasp::palm_placements(scene.object, targets, std::nullopt);
    REQUIRE(placements.size() == 2);
    CHECK((placements[0].direction_O + placements[1].direction_O).norm() < 1e-12);
    for (const PalmPlacement& placement : placements) {
      CHECK(placement.direction_O.norm() == Approx(1.0).epsilon(1e-12));
      for (int i = 0; i < 3; ++i) {
        const Vector3d edge = points[(i + 1) % 3] - points[i];
        // A cross product of edges loses accuracy as the triangle gets thin.
        const double thinness =
            (points[1] - points[0]).cross(points[2] - points[0]).norm() / (0.05 * 0.05);
        CHECK(std::abs(placement.direction_O.dot(edge)) < 1e-14 / thinness);
      }
    }

    // An approach leaves the nearer one alone.
    const Vector3d approach =
        3.0 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto approached = grasp::palm_placements(scene.object, targets, approach);
    REQUIRE(approached.size() == 1);
    CHECK(approached[0].direction_O.dot(approach) > 0.0);
    CHECK(std::min((approached[0].direction_O - placements[0].direction_O).norm(),
                   (approached[0].direction_O - placements[1].direction_O).norm()) < 1e-12);
  }
}

TEST_CASE("The palm direction with more room comes first", "[grasp][hand_fitting]") {
  // A tall box with targets around its upper end: the palm has 5 cm of object to clear above them,
  // 25 cm below.
  const Scene scene(geometry::box(Vector3d(0.06, 0.06, 0.30)));
  for (const double end : {1.0, -1.0}) {
    const double z = end * 0.10;
    for (const bool is_reversed : {false, true}) {
      std::vector<Vector3d> points = {{0.03, 0.0, z}, {-0.03, 0.02, z}, {-0.03, -0.02, z}};
      std::vector<Vector3d> normals = {{1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}};
      if (is_reversed) std::swap(points[1], points[2]);
      const auto placements =
          grasp::palm_placements(scene.object, targets_at(points, normals), std::nullopt);
      REQUIRE(placements.size() == 2);
      CHECK((placements[0].direction_O - Vector3d(0, 0, -end)).norm() < 1e-9);
    }
  }
}

TEST_CASE("Two targets have sixteen palm directions around their axis", "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  geometry::Random random(9);
  for (int trial = 0; trial < 10; ++trial) {
    // Trial 0: along z, 1 and 2: along the others, where a helper axis could be parallel.
    Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (trial < 3) axis = Vector3d::Unit((trial + 2) % 3);
    axis.normalize();
    const TargetContacts targets = targets_at({0.05 * axis, -0.05 * axis}, {axis, -axis});
    const auto placements = grasp::palm_placements(scene.object, targets, std::nullopt);
    REQUIRE(placements.size() == 16);
    const Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
    std::vector<double> angles;
    for (const PalmPlacement& placement : placements) {
      CHECK(placement.direction_O.norm() == Approx(1.0).epsilon(1e-12));
      CHECK(std::abs(placement.direction_O.dot(axis)) < 1e-12);
      angles.push_back(std::atan2(placement.direction_O.dot(y), placement.direction_O.dot(x)));
    }
    std::sort(angles.begin(), angles.end());
    for (int i = 0; i < 15; ++i) {
      CHECK(angles[i + 1] - angles[i] == Approx(2.0 * kPi / 16.0).epsilon(1e-9));
    }

    // With an approach, those nearest to it first (A23).
    const Vector3d approach(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto approached = grasp::palm_placements(scene.object, targets, approach);
    REQUIRE_FALSE(approached.empty());
    for (const PalmPlacement& placement : approached) {
      CHECK(std::abs(placement.direction_O.dot(axis)) < 1e-12);
      CHECK(placement.direction_O.dot(approach) <= approached[0].direction_O.dot(approach) + 1e-12);
    }
  }
}

TEST_CASE("More than three targets have the normals of their least-squares plane",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::ball(0.05));
  geometry::Random random(3);
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<Vector3d> points, normals;
    Eigen::MatrixXd rows(5, 3);
    for (int i = 0; i < 5; ++i) {
      const double angle = i * 2.0 * kPi / 5.0;
      points.push_back(
          Vector3d(0.04 * std::cos(angle), 0.05 * std::sin(angle), random.uniform(-0.01, 0.01)));
      normals.push_back(points.back());
      rows.row(i) = points.back();
    }
    rows.rowwise() -= rows.colwise().mean().eval();
    const Vector3d expected =
        Eigen::JacobiSVD<Eigen::MatrixXd>(rows, Eigen::ComputeThinV).matrixV().col(2);
    const auto placements =
        grasp::palm_placements(scene.object, targets_at(points, normals), std::nullopt);
    REQUIRE(placements.size() == 2);
    CHECK((placements[0].direction_O + placements[1].direction_O).norm() < 1e-12);
    CHECK(std::abs(std::abs(placements[0].direction_O.dot(expected)) - 1.0) < 1e-12);
  }
}

// ---------------------------------------------------------------------------------------------
// Assignment

/// The permutation of the further targets to the further fingers with the least squared angular
/// error around the palm axis, the thumb's pad turned to the seed and the shared spread free. Brute
/// force over the spread. Returns the fingers in the order of the targets.
std::vector<int> best_assignment(const hands::HandModel& hand, const TargetContacts& targets,
                                 const std::vector<int>& fingers, const Vector3d& direction) {
  const Vector3d center = targets.centroid();
  const auto azimuth = [](const Vector3d& vector, const Vector3d& zero, const Vector3d& axis) {
    return std::atan2(axis.dot(zero.cross(vector)),
                      zero.dot(vector) - zero.dot(axis) * vector.dot(axis));
  };
  std::vector<int> order(fingers.begin() + 1, fingers.end());
  std::sort(order.begin(), order.end());
  std::vector<int> best;
  double least = std::numeric_limits<double>::infinity();
  do {
    const int spread = hand.joint_index("finger_1_spread");
    for (int step = 0; step <= 180; ++step) {
      hands::HandConfiguration configuration = hands::open_configuration(hand);
      configuration.q[spread] = step * kPi / 180.0;
      hands::apply_couplings(hand, configuration.q);
      const auto X_HL = hands::forward_kinematics(hand, configuration);
      const auto pad_at = [&](int finger) -> Vector3d {
        return hands::pad_pose(hand, hand.fingers[finger].tip_pad, X_HL).translation() -
               hand.palm.center_H;
      };
      double error = 0.0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const double of_target = azimuth(targets.contacts[i + 1].point_O - center,
                                         targets.contacts[0].point_O - center, direction);
        const double of_finger =
            azimuth(pad_at(order[i]), pad_at(fingers[0]), hand.palm.direction_H);
        error += std::pow(std::remainder(of_target - of_finger, 2.0 * kPi), 2);
      }
      if (error < least) {
        least = error;
        best = order;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  best.insert(best.begin(), fingers[0]);
  return best;
}

std::vector<int> fingers_of(const TargetContacts& targets) {
  std::vector<int> fingers;
  for (const auto& target : targets.contacts) fingers.push_back(target.finger);
  return fingers;
}

TEST_CASE("The seed gets the first finger and the others the fingers on their sides",
          "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const std::vector<int> fingers = grasp::requested_fingers(hand, {});
  REQUIRE(fingers.size() == 3);
  REQUIRE(fingers[0] == hand.thumb());
  geometry::Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    RigidTransform X_OT = RigidTransform::Identity();
    X_OT.linear() = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                       random.uniform(-1, 1), random.uniform(-1, 1))
                        .normalized()
                        .toRotationMatrix();
    X_OT.translation() = Vector3d(random.uniform(), random.uniform(), random.uniform());
    const TargetContacts targets = equilateral_targets(0.05, random.uniform(-3, 3), X_OT);
    TargetContacts swapped = targets;
    std::swap(swapped.contacts[1], swapped.contacts[2]);
    for (const double side : {1.0, -1.0}) {
      const PalmPlacement placement{side * X_OT.linear().col(2)};
      const TargetContacts assigned = grasp::assign_fingers(hand, targets, fingers, placement);
      REQUIRE(assigned.contacts.size() == 3);
      for (int i = 0; i < 3; ++i) {
        CHECK(assigned.contacts[i].point_O == targets.contacts[i].point_O);
        CHECK(assigned.contacts[i].outward_normal_O == targets.contacts[i].outward_normal_O);
        CHECK(assigned.contacts[i].patch == targets.contacts[i].patch);
      }
      const std::vector<int> result = fingers_of(assigned);
      CHECK(result[0] == fingers[0]);
      CHECK(std::is_permutation(result.begin(), result.end(), fingers.begin(), fingers.end()));
      CHECK(result == best_assignment(hand, targets, fingers, placement.direction_O));

      // The order of the targets does not matter, only where they are.
      const std::vector<int> after_swap =
          fingers_of(grasp::assign_fingers(hand, swapped, fingers, placement));
      CHECK(after_swap == std::vector<int>{result[0], result[2], result[1]});

      // From the other side of the triangle, left and right are exchanged.
      const PalmPlacement opposite{-placement.direction_O};
      const std::vector<int> from_behind =
          fingers_of(grasp::assign_fingers(hand, targets, fingers, opposite));
      CHECK(from_behind == std::vector<int>{result[0], result[2], result[1]});
    }
  }
}

TEST_CASE("Without the thumb the seed gets the first finger that is asked for",
          "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const int finger_1 = hand.finger_index("finger_1"), finger_2 = hand.finger_index("finger_2");
  const TargetContacts targets = targets_at({{0.03, 0, 0}, {-0.03, 0, 0}}, {{1, 0, 0}, {-1, 0, 0}});
  const PalmPlacement placement{Vector3d(0, 0, -1)};
  CHECK(fingers_of(grasp::assign_fingers(hand, targets, {finger_1, finger_2}, placement)) ==
        std::vector<int>{finger_1, finger_2});
  CHECK(fingers_of(grasp::assign_fingers(hand, targets, {finger_2, finger_1}, placement)) ==
        std::vector<int>{finger_2, finger_1});
}

// ---------------------------------------------------------------------------------------------
// The sampled hand and its distances

/// Walks the tree of balls from `ball` down: how far any point is outside a ball that should hold
/// it [m], counting for each point the leaves that hold it.
double farthest_outside(const grasp::FittingHand::LinkSamples& samples, std::int32_t ball,
                        std::vector<std::int32_t> ancestors, std::vector<int>& times_held) {
  ancestors.push_back(ball);
  const grasp::FittingHand::Ball& node = samples.balls[ball];
  if (node.count == 0) {
    return std::max(farthest_outside(samples, ball + 1, ancestors, times_held),
                    farthest_outside(samples, node.first, ancestors, times_held));
  }
  double outside = 0.0;
  for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
    ++times_held[i];
    for (const std::int32_t ancestor : ancestors) {
      const grasp::FittingHand::Ball& holder = samples.balls[ancestor];
      outside = std::max(outside, (samples.points_L[i] - holder.center_L).norm() - holder.radius);
    }
  }
  return outside;
}

TEST_CASE("The points of a fitting hand lie on its links and leave no gap wider than the spacing",
          "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  constexpr double kSpacing = 0.003;
  const grasp::FittingHand fitting_hand(hand, kSpacing);
  for (std::size_t i = 0; i < hand.links.size(); ++i) {
    const int link = static_cast<int>(i);
    INFO(hand.links[i].name);
    const grasp::FittingHand::LinkSamples& samples = fitting_hand.samples(link);
    const std::vector<Vector3d>& points = samples.points_L;
    if (hand.links[i].mesh_L.faces.empty()) {
      CHECK(points.empty());
      CHECK(samples.balls.empty());
      continue;
    }
    const geometry::MeshQuery surface(hand.links[i].mesh_L);
    double farthest = 0.0, off_surface = 0.0;
    for (const Vector3d& point : points) {
      farthest = std::max(farthest, point.norm());
      off_surface = std::max(off_surface, std::sqrt(surface.closest_point(point).squared_distance));
    }
    CHECK(off_surface < 1e-12);
    CHECK(samples.reach == Approx(farthest).epsilon(1e-12));
    std::vector<int> times_held(points.size(), 0);
    CHECK(farthest_outside(samples, 0, {}, times_held) < 1e-12);
    CHECK(std::all_of(times_held.begin(), times_held.end(), [](int times) { return times == 1; }));

    double widest_gap = 0.0;
    geometry::Random random(1);
    const auto probes = dense_points(hand.links[i].mesh_L, 0.5 * kSpacing);
    for (int k = 0; k < 300; ++k) {
      const Vector3d& probe = probes[random.index(probes.size())];
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vector3d& point : points) nearest = std::min(nearest, (point - probe).norm());
      widest_gap = std::max(widest_gap, nearest);
    }
    CHECK(widest_gap <= kSpacing);
  }
}

TEST_CASE("A fitting hand needs a positive spacing", "[grasp][hand_fitting]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  for (const double spacing : {0.0, -0.001, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(grasp::FittingHand(hand, spacing), geometry::InvalidInput);
  }
}

TEST_CASE("The smallest distance is that of a search over all points, up to what is enough",
          "[grasp][hand_fitting]") {
  const Scene scene(geometry::torus(0.05, 0.018));
  geometry::Random random(2);
  int num_below = 0, num_above = 0;
  for (int trial = 0; trial < 200; ++trial) {
    RigidTransform X_OL = RigidTransform::Identity();
    X_OL.linear() = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                       random.uniform(-1, 1), random.uniform(-1, 1))
                        .normalized()
                        .toRotationMatrix();
    // Some far outside the lattice.
    const double away = trial % 10 == 0 ? 2.0 : 0.12;
    X_OL.translation() =
        away * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const int link = static_cast<int>(random.index(scene.hand.links.size()));
    const std::vector<Vector3d>& points = scene.fitting_hand.samples(link).points_L;
    if (points.empty()) continue;
    float expected = std::numeric_limits<float>::infinity();
    for (const Vector3d& point : points) {
      const Vector3d point_O = X_OL * point;
      expected = std::min(expected, scene.object.distance.at(point_O));
    }
    for (const float enough : {-1.0F, 0.0F, 2.0F, 5.0F, 1e6F}) {
      const float found =
          grasp::smallest_distance(scene.fitting_hand, link, X_OL, scene.object.distance, enough);
      if (expected <= enough) {
        ++num_below;
        CHECK(found == expected);
      } else {
        ++num_above;
        CHECK(found > enough);
      }
    }
  }
  CHECK(num_below > 100);
  CHECK(num_above > 100);
}

TEST_CASE("Fitting options out of range are refused by name and value", "[grasp][hand_fitting]") {
  const auto message_of = [](auto set) {
    FittingOptions options;
    set(options);
    try {
      options.validate();
    } catch (const geometry::InvalidInput& error) {
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
  CHECK(unsaid(message_of([](auto& o) { o.settle_tolerance = 0.0; }), "settle_tolerance", "0") ==
        "");
  CHECK(unsaid(message_of([](auto& o) { o.sample_spacing = 0.0; }), "sample_spacing", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.sample_spacing = -0.25; }), "sample_spacing", "-0.25") ==
        "");
}

}  // namespace
