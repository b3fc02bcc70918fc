#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "graspfit/base/units.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "shapes/implicit_surface.hpp"
#include "shapes/shape_dimensions.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using internal::FilletedUnion;
using internal::ImplicitSolid;
using internal::kMostSegments;
using internal::polygonize;
using internal::require_at_most;
using internal::require_below;
using internal::require_positive;
using internal::require_range;
using std::numbers::pi;

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

// Function of a point of the plane that is positive outside a rectangle of the given half extents
// with rounded corners. Its absolute value is the distance to the outline everywhere.
double rounded_rectangle_distance(const Vector2d& p, const Vector2d& half, double corner) {
  const Vector2d q = p.cwiseAbs() - half + Vector2d::Constant(corner);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - corner;
}

// Radius from the axis to the middle of a mug's wall.
double wall_middle(const MugDimensions& d) { return 0.5 * (d.diameter - d.wall_thickness); }

// Half extents of the rectangle of a handle's center line, whose middle is in the wall.
Vector2d handle_half(const MugDimensions& d) {
  return {0.5 * d.diameter + d.handle_clearance + 0.5 * d.handle_thickness - wall_middle(d),
          0.5 * (d.handle_height - d.handle_thickness)};
}

// Distance to the middle of a mug's wall, in the half-plane (radius, z): a floor, a quarter of a
// circle, a wall.
//
//                |  <- height − wall/2
//                |
//   -----------.-'  <- wall/2
double mug_sheet_distance(const MugDimensions& d, const Vector2d& p) {
  const double half_wall = 0.5 * d.wall_thickness;
  const double radius = wall_middle(d);
  const double corner = d.base_radius - half_wall;
  const Vector2d center(radius - corner, half_wall + corner);
  const Vector2d from_center = p - center;
  if (from_center[0] >= 0.0 && from_center[1] <= 0.0) {
    return std::abs(from_center.norm() - corner);
  }
  const double to_floor = std::hypot(std::max(from_center[0], 0.0), p[1] - half_wall);
  const double to_wall =
      std::hypot(p[0] - radius, p[1] - std::clamp(p[1], center[1], d.height - half_wall));
  return std::min(to_floor, to_wall);
}

struct Hole {
  Vector3d end;  // center of the round end
  Vector3d out;  // a point outside the ball on the axis
  double radius;
};

std::array<Hole, 3> holes(const BowlingBallDimensions& d) {
  const double radius = 0.5 * d.diameter;
  const double sine = 0.5 * d.span / radius;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const auto hole = [&](const Vector3d& direction, double offset, double depth, double diameter) {
    const Vector3d side = offset * Vector3d::UnitY();
    const double surface = std::sqrt(radius * radius - offset * offset);
    return Hole{side + (surface - depth + 0.5 * diameter) * direction,
                side + (radius + diameter) * direction, 0.5 * diameter};
  };
  const Vector3d finger(sine, 0.0, cosine);
  const double offset = 0.5 * d.finger_spacing;
  return {hole({-sine, 0.0, cosine}, 0.0, d.thumb_depth, d.thumb_diameter),
          hole(finger, -offset, d.finger_depth, d.finger_diameter),
          hole(finger, offset, d.finger_depth, d.finger_diameter)};
}

// An octopus' arm in the half-plane (distance from the z axis, z): an arc of a circle,
// parameterized by its heading above the horizontal.
struct Arm {
  static constexpr double kFirst = -55.0 * base::kRadiansPerDegree;
  static constexpr double kLast = 35.0 * base::kRadiansPerDegree;
  double start;  // distance of the first point from the z axis
  double root_radius;
  double tip_radius;
  double arc_radius;
  Vector2d center;
  double lowest_heading;  // where the arm touches z = 0

  explicit Arm(const OctopusDimensions& d)
      : root_radius(0.5 * d.arm_root_diameter), tip_radius(0.5 * d.arm_tip_diameter) {
    start = d.mantle_diameter / 6.0;
    arc_radius = (d.arm_reach - tip_radius - start) / (std::sin(kLast) - std::sin(kFirst));
    // Below the center the arm reaches down by (arc_radius + radius(h)) cos h, which is largest
    // where its derivative, falling in h, changes sign.
    double low = kFirst;
    double high = 0.0;
    for (int i = 0; i < 60; ++i) {
      const double h = 0.5 * (low + high);
      const double rise = radius_slope() * std::cos(h) - (arc_radius + radius_at(h)) * std::sin(h);
      (rise > 0.0 ? low : high) = h;
    }
    lowest_heading = low;
    center = {start - arc_radius * std::sin(kFirst), (arc_radius + radius_at(low)) * std::cos(low)};
  }

  double radius_slope() const { return (tip_radius - root_radius) / (kLast - kFirst); }
  double radius_at(double heading) const {
    return root_radius + radius_slope() * (heading - kFirst);
  }
  Vector2d point_at(double heading, double radius) const {
    return center + radius * Vector2d(std::sin(heading), -std::cos(heading));
  }

  // Distance from the arm of the point at distance `across` from the arm's plane and with
  // projection (s, z) to that plane.
  double distance(double s, double z, double across) const {
    const Vector2d p = Vector2d(s, z) - center;
    const double heading = std::atan2(p[0], -p[1]);
    if (heading >= kFirst && heading <= kLast) {
      const double within = p.norm() - arc_radius;
      return std::sqrt(within * within + across * across) - radius_at(heading);
    }
    const auto to_end = [&](double end) {
      const Vector2d q = Vector2d(s, z) - point_at(end, arc_radius);
      return std::sqrt(q.squaredNorm() + across * across);
    };
    return std::min(to_end(kFirst) - root_radius, to_end(kLast) - tip_radius);
  }
};

// The two ends of the mantle's axis: low, high.
Vector2d mantle_ends(const OctopusDimensions& d) {
  return {d.height - d.mantle_height + 0.5 * d.mantle_diameter, d.height - 0.5 * d.mantle_diameter};
}

// Half extents of the center line of a cage's frame.
Vector2d frame_half(const WireCageDimensions& d) {
  return 0.5 * (Vector2d(d.width, d.depth) - Vector2d::Constant(d.frame_diameter));
}

}  // namespace

void MugDimensions::validate() const {
  const char* const shape = "mug";
  require_positive(shape, *this, internal::kMugFields);
  require_below(shape, "wall_thickness", wall_thickness, 0.5 * std::min(diameter, height),
                "half of diameter and of height");
  require_at_most(shape, "wall_thickness", wall_thickness, base_radius, "base_radius");
  require_below(shape, "base_radius", base_radius, 0.5 * diameter, "half of diameter");
  require_below(shape, "fillet", fillet, 0.5 * handle_clearance, "half of handle_clearance");
  require_at_most(shape, "handle_height", handle_height, height - 2 * (base_radius + fillet),
                  "what base_radius and fillet leave of height");
  require_below(shape, "handle_thickness", handle_thickness,
                std::min(0.5 * diameter, 0.5 * handle_height - fillet),
                "half of diameter and what fillet leaves of half of handle_height");
  require_at_most(shape, "handle_radius", handle_radius, handle_half(*this).minCoeff(),
                  "the half extents of the handle's center line");
  require_below(shape, "handle_thickness", handle_thickness, 2 * handle_radius,
                "twice handle_radius");
}

TriangleMesh mug(const MugDimensions& d, int segments) {
  d.validate();
  require_range("mug", "segments", segments, 12, kMostSegments);
  const double half_wall = 0.5 * d.wall_thickness;
  const double middle = wall_middle(d);
  const double radius = 0.5 * d.diameter;
  const Vector2d half = handle_half(d);
  const double end = radius + d.handle_clearance + d.handle_thickness;
  ImplicitSolid solid;
  solid.name = "mug";
  solid.genus = 1;
  solid.field = [=](const Vector3d& p) {
    const double from_axis = std::hypot(p[0], p[1]);
    const double wall = mug_sheet_distance(d, {from_axis, p[2]}) - half_wall;
    // Closer to the axis than the middle of the wall only the wall counts, so that the handle does
    // not come through. Both expressions are −half_wall where they meet.
    if (from_axis <= middle) return wall;
    const double to_line =
        rounded_rectangle_distance({p[0] - middle, p[2] - 0.5 * d.height}, half, d.handle_radius);
    FilletedUnion both(d.fillet);
    both.add(wall);
    // The other half of the rectangle, at negative x, is no handle.
    if (p[0] > 0.0) both.add(std::hypot(to_line, p[1]) - 0.5 * d.handle_thickness);
    return std::max(both.distance(), -half_wall);
  };
  solid.slope_bound = std::numbers::sqrt2;
  solid.box = AlignedBox3d(Vector3d(-radius, -radius, 0.0), Vector3d(end, radius, d.height));
  const double z = 0.5 * d.height;
  solid.extreme_points = {{-radius, 0.0, z}, {end, 0.0, z},   {0.0, -radius, z},
                          {0.0, radius, z},  {0.0, 0.0, 0.0}, {-middle, 0.0, d.height}};
  return polygonize(solid, pi * d.diameter / segments);
}

void BowlingBallDimensions::validate() const {
  const char* const shape = "bowling_ball";
  require_positive(shape, *this, internal::kBowlingBallFields);
  const double radius = 0.5 * diameter;
  // Holes keep off the top and, by staying within 45 degrees of it, off the widest circle.
  require_below(shape, "span", span, std::numbers::sqrt2 * radius, "diameter / sqrt(2)");
  require_below(shape, "edge_radius", edge_radius, 0.5 * std::min(finger_diameter, thumb_diameter),
                "half of finger_diameter and of thumb_diameter");
  require_below(shape, "finger_spacing", finger_spacing, radius - finger_diameter - 2 * edge_radius,
                "what finger_diameter and edges leave of half of diameter");
  require_below(shape, "finger_diameter", finger_diameter, finger_spacing - 2 * edge_radius,
                "what edges leave of finger_spacing");
  for (const auto& [name, hole, depth_name, depth] :
       {std::tuple{"finger_diameter", finger_diameter, "finger_depth", finger_depth},
        std::tuple{"thumb_diameter", thumb_diameter, "thumb_depth", thumb_depth}}) {
    require_below(shape, depth_name, depth, 0.9 * radius, "0.45 of diameter");
    require_below(shape, name, hole, span - 4 * edge_radius, "what edges leave of span");
    require_below(shape, name, hole, 2 * depth - 4 * edge_radius,
                  std::string("what edges leave of twice ") + depth_name);
  }
  // The axes of the thumb's and a finger's hole spread outward.
  const auto all = holes(*this);
  constexpr int kSteps = 256;
  double gap = diameter;
  for (int i = 0; i <= kSteps; ++i) {
    const Vector3d p = all[0].end + (all[0].out - all[0].end) * i / kSteps;
    gap = std::min(gap, distance_to_segment(p, all[1].end, all[1].out));
  }
  require_below(shape, "thumb_diameter", thumb_diameter,
                2 * gap - finger_diameter - 4 * edge_radius,
                "what finger_diameter and edges leave of twice the distance of their axes");
}

TriangleMesh bowling_ball(const BowlingBallDimensions& d, int segments) {
  d.validate();
  require_range("bowling_ball", "segments", segments, 12, kMostSegments);
  const double radius = 0.5 * d.diameter;
  ImplicitSolid solid;
  solid.name = "bowling_ball";
  solid.field = [=, all = holes(d)](const Vector3d& p) {
    double hole_distance = d.diameter;
    for (const Hole& hole : all) {
      hole_distance =
          std::min(hole_distance, distance_to_segment(p, hole.end, hole.out) - hole.radius);
    }
    return internal::rounded_intersection(p.norm() - radius, -hole_distance, d.edge_radius);
  };
  solid.slope_bound = std::numbers::sqrt2;
  solid.box = AlignedBox3d(Vector3d::Constant(-radius), Vector3d::Constant(radius));
  for (int axis = 0; axis < 3; ++axis) {
    solid.extreme_points.push_back(-radius * Vector3d::Unit(axis));
    solid.extreme_points.push_back(radius * Vector3d::Unit(axis));
  }
  return polygonize(solid, pi * d.diameter / segments);
}

void OctopusDimensions::validate() const {
  const char* const shape = "octopus";
  require_positive(shape, *this, internal::kOctopusFields);
  require_below(shape, "mantle_diameter", mantle_diameter, mantle_height, "mantle_height");
  require_below(shape, "mantle_height", mantle_height, height, "height");
  require_below(shape, "mantle_diameter", mantle_diameter, arm_reach / 1.5,
                "two thirds of arm_reach");
  require_below(shape, "arm_tip_diameter", arm_tip_diameter, arm_root_diameter,
                "arm_root_diameter");
  require_below(shape, "arm_root_diameter", arm_root_diameter, 0.5 * mantle_diameter,
                "half of mantle_diameter");
  require_at_most(shape, "fillet", fillet, 0.5 * arm_root_diameter, "half of arm_root_diameter");
  const Arm arm(*this);
  const Vector2d root = arm.point_at(Arm::kFirst, arm.arc_radius);
  const Vector2d ends = mantle_ends(*this);
  const double above = root[1] - std::clamp(root[1], ends[0], ends[1]);
  if (!(std::hypot(root[0], above) < 0.5 * mantle_diameter)) {
    throw base::InvalidInput(
        "octopus: height is " + base::shortest_decimal(height) +
        ", which leaves the arms' beginnings at z = " + base::shortest_decimal(root[1]) +
        " outside of the mantle (see mantle_height, arm_reach)");
  }
}

TriangleMesh octopus(const OctopusDimensions& d, int segments) {
  d.validate();
  require_range("octopus", "segments", segments, 12, kMostSegments);
  const Arm arm(d);
  const Vector2d ends = mantle_ends(d);
  const double diagonal = std::sqrt(0.5);
  const std::array<Vector2d, 8> directions = {{{1, 0},
                                               {diagonal, diagonal},
                                               {0, 1},
                                               {-diagonal, diagonal},
                                               {-1, 0},
                                               {-diagonal, -diagonal},
                                               {0, -1},
                                               {diagonal, -diagonal}}};
  ImplicitSolid solid;
  solid.name = "octopus";
  solid.field = [=, start = arm.start](const Vector3d& p) {
    FilletedUnion body(d.fillet);
    const double above = p[2] - std::clamp(p[2], ends[0], ends[1]);
    body.add(std::sqrt(p.head<2>().squaredNorm() + above * above) - 0.5 * d.mantle_diameter);
    for (const Vector2d& u : directions) {
      const double along = u.dot(p.head<2>());
      const double across = u[0] * p[1] - u[1] * p[0];
      // The arm lies within root_radius of its line, which lies at along >= start.
      const double bound = std::max(std::abs(across), start - along) - arm.root_radius;
      if (!body.is_indifferent_to(bound)) body.add(arm.distance(along, p[2], across));
    }
    return body.distance();
  };
  // Nine solids, of which the arms' distances have slopes a little above one.
  solid.slope_bound = 3.5;
  const double reach = d.arm_reach;
  solid.box = AlignedBox3d(Vector3d(-reach, -reach, 0.0), Vector3d(reach, reach, d.height));
  const double tip_z = arm.point_at(Arm::kLast, arm.arc_radius)[1];
  const double low = arm.lowest_heading;
  const double low_s = arm.point_at(low, arm.arc_radius + arm.radius_at(low))[0];
  solid.extreme_points = {{0.0, 0.0, d.height}};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vector2d& u = directions[i];
    solid.extreme_points.emplace_back(low_s * u[0], low_s * u[1], 0.0);
    if (i % 2 == 0) solid.extreme_points.emplace_back(reach * u[0], reach * u[1], tip_z);
  }
  return polygonize(solid, pi * d.mantle_diameter / segments);
}

void WireCageDimensions::validate() const {
  const char* const shape = "wire_cage";
  require_positive(shape, *this, internal::kWireCageFields);
  require_range(shape, "bars_per_side", bars_per_side, 1, 50);
  const Vector2d half = frame_half(*this);
  require_below(shape, "corner_radius", corner_radius, half.minCoeff(),
                "the half extents of the frame's center line");
  require_below(shape, "frame_diameter", frame_diameter,
                std::min(2 * (corner_radius - fillet), 0.5 * height - fillet),
                "what fillet leaves of twice corner_radius and of half of height");
  require_at_most(shape, "bar_diameter", bar_diameter, frame_diameter - 2 * fillet,
                  "what fillets leave of frame_diameter");
  require_below(shape, "bar_diameter", bar_diameter,
                2 * (half.minCoeff() - corner_radius) / bars_per_side - 2 * fillet,
                "what fillets leave of the distance between bars");
}

TriangleMesh wire_cage(const WireCageDimensions& d, int segments) {
  d.validate();
  require_range("wire_cage", "segments", segments, 6, kMostSegments);
  const double frame_radius = 0.5 * d.frame_diameter;
  const double bar_radius = 0.5 * d.bar_diameter;
  const Vector2d half = frame_half(d);
  const double low = frame_radius;
  const double high = d.height - frame_radius;
  std::vector<std::array<Vector3d, 2>> bars;
  for (int k = 0; k < d.bars_per_side; ++k) {
    const double along = (2.0 * k + 1 - d.bars_per_side) / d.bars_per_side;
    const double x = along * (half[0] - d.corner_radius);
    const double y = along * (half[1] - d.corner_radius);
    for (const double side : {-1.0, 1.0}) {
      bars.push_back({Vector3d(side * half[0], y, low), Vector3d(side * half[0], y, high)});
      bars.push_back({Vector3d(x, side * half[1], low), Vector3d(x, side * half[1], high)});
    }
    for (const double z : {low, high}) {
      bars.push_back({Vector3d(x, -half[1], z), Vector3d(x, half[1], z)});
    }
  }
  ImplicitSolid solid;
  solid.name = "wire_cage";
  solid.genus = 6 * d.bars_per_side + 1;
  solid.field = [=](const Vector3d& p) {
    FilletedUnion all(d.fillet);
    const double to_line = rounded_rectangle_distance(p.head<2>(), half, d.corner_radius);
    all.add(std::hypot(to_line, p[2] - low) - frame_radius);
    all.add(std::hypot(to_line, p[2] - high) - frame_radius);
    for (const auto& [a, b] : bars) all.add(distance_to_segment(p, a, b) - bar_radius);
    return all.distance();
  };
  solid.slope_bound = 2.0;  // at most a frame and two bars meet
  solid.box = AlignedBox3d(Vector3d(-0.5 * d.width, -0.5 * d.depth, 0.0),
                           Vector3d(0.5 * d.width, 0.5 * d.depth, d.height));
  for (const double side : {-1.0, 1.0}) {
    solid.extreme_points.emplace_back(side * 0.5 * d.width, 0.0, low);
    solid.extreme_points.emplace_back(0.0, side * 0.5 * d.depth, low);
    solid.extreme_points.emplace_back(half[0], 0.0, side < 0 ? 0.0 : d.height);
  }
  return polygonize(solid, pi * d.bar_diameter / segments);
}

}  // namespace graspfit::geometry
