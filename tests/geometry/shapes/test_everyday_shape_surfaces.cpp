#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/solid_checks.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "support/catch.hpp"

namespace test_everyday_shape_surfaces {

using namespace graspfit::geometry;
using Eigen::Vector2d;
using Eigen::Vector3d;
using graspfit::testing::check_solid;
using graspfit::testing::volume_limit;
using std::numbers::pi;

// These tests check where the vertices of everyday shapes lie, surface by surface.
namespace {

// Vertices are rounded to 1e-12 of the longest extent; a test's own arithmetic adds a few ulps.
constexpr double kVertexBound = 2e-12;

Vector2d turned(const Vector3d& p) { return {std::hypot(p[0], p[1]), p[2]}; }

double to_circle(const Vector2d& p, const Vector2d& center, double radius) {
  return std::abs((p - center).norm() - radius);
}

double to_line(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d u = (b - a).normalized();
  return std::abs(u[0] * (p - a)[1] - u[1] * (p - a)[0]);
}

double to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (1 - t) * a - t * b).norm();
}

// Returns the distance to the outline of a rounded rectangle in the plane, piece by piece.
double to_rounded_rectangle(const Vector2d& p, double a, double b, double corner) {
  const auto segment = [&](Vector2d s, Vector2d e) {
    return to_segment({p[0], p[1], 0}, {s[0], s[1], 0}, {e[0], e[1], 0});
  };
  double least = std::numeric_limits<double>::infinity();
  for (const double x : {-1.0, 1.0}) {
    least = std::min(least, segment({x * a, -(b - corner)}, {x * a, b - corner}));
    least = std::min(least, segment({-(a - corner), x * b}, {a - corner, x * b}));
    for (const double y : {-1.0, 1.0}) {
      const Vector2d center(x * (a - corner), y * (b - corner));
      if (x * (p - center)[0] >= 0 && y * (p - center)[1] >= 0) {
        least = std::min(least, to_circle(p, center, corner));
      }
    }
  }
  return least;
}

}  // namespace

TEST_CASE("Vertices of a bottle lie on its cylinders, cone and arcs",
          "[geometry][everyday_shapes]") {
  const BottleDimensions d;
  const double body = 0.5 * d.body_diameter;
  const double neck = 0.5 * d.neck_diameter;
  const double turn = std::atan2(body - neck, d.shoulder_top - d.shoulder_bottom);
  const double tangent = d.shoulder_radius * std::tan(turn / 2);
  for (const Vector3d& vertex : bottle().vertices) {
    const Vector2d p = turned(vertex);
    const double z = p[1];
    double off;
    if (z <= d.base_radius) {
      off = std::min(z, to_circle(p, {body - d.base_radius, d.base_radius}, d.base_radius));
    } else if (z <= d.shoulder_bottom - tangent) {
      off = std::abs(p[0] - body);
    } else if (z >= d.height - d.lip_radius) {
      off = std::min(d.height - z,
                     to_circle(p, {neck - d.lip_radius, d.height - d.lip_radius}, d.lip_radius));
    } else if (z >= d.shoulder_top + tangent) {
      off = std::abs(p[0] - neck);
    } else if (z <= d.shoulder_bottom + tangent * std::cos(turn)) {
      off =
          to_circle(p, {body - d.shoulder_radius, d.shoulder_bottom - tangent}, d.shoulder_radius);
    } else if (z >= d.shoulder_top - tangent * std::cos(turn)) {
      off = to_circle(p, {neck + d.shoulder_radius, d.shoulder_top + tangent}, d.shoulder_radius);
    } else {
      off = to_line(p, {body, d.shoulder_bottom}, {neck, d.shoulder_top});
    }
    REQUIRE(off <= kVertexBound * d.height);
  }
}

TEST_CASE("A bowling pin has the regulation diameters, and is widest and narrowest where they say",
          "[geometry][everyday_shapes]") {
  const TriangleMesh mesh = bowling_pin({.height = 15.0}, 768);
  // These are (z, radius) along the meridian y = 0, x > 0.
  std::vector<Vector2d> side;
  for (const Vector3d& p : mesh.vertices) {
    if (p[1] == 0.0 && p[0] > 0.0) side.emplace_back(p[2], p[0]);
  }
  std::sort(side.begin(), side.end(), [](auto& a, auto& b) { return a[0] < b[0]; });
  const auto diameter = [&](double z) {
    auto above = std::lower_bound(side.begin(), side.end(), z,
                                  [](const Vector2d& p, double value) { return p[0] < value; });
    const Vector2d& a = *(above - 1);
    const double t = (z - a[0]) / ((*above)[0] - a[0]);
    return 2 * ((1 - t) * a[1] + t * (*above)[1]);
  };
  // Chords of 0.02 in of a profile with curvature below 1/in sag by at most 0.02²/8.
  const double sag = 1e-4;
  const double table[][2] = {{0.75, 2.828},  {2.25, 3.906},  {3.375, 4.510}, {4.5, 4.766},
                             {5.875, 4.563}, {7.25, 3.703},  {8.625, 2.472}, {9.375, 1.965},
                             {10, 1.797},    {10.875, 1.87}, {11.75, 2.094}, {12.625, 2.406},
                             {13.5, 2.547}};
  for (const auto& [z, expected] : table) CHECK(diameter(z) == Approx(expected).margin(sag));
  // Up to the belly it becomes wider, to the neck narrower, to the head wider, to the top narrower.
  for (std::size_t i = 1; i < side.size(); ++i) {
    const double z = 0.5 * (side[i - 1][0] + side[i][0]);
    if (z <= 0.0) continue;
    INFO(z);
    const bool is_widening = z < 4.5 || (z > 10 && z < 13.5);
    REQUIRE((side[i][1] > side[i - 1][1]) == is_widening);
  }
  for (const Vector2d& p : side) {
    if (p[0] > 14.4) REQUIRE(to_circle({p[1], p[0]}, {0, 15 - 1.273}, 1.273) < 1e-13 * 15);
  }
  // The volume converges with the square of the edges.
  const auto volume = [](int n) { return signed_volume(bowling_pin({}, n)); };
  CHECK((volume(192) - volume(96)) / (volume(384) - volume(192)) == Approx(4).epsilon(0.1));
}

TEST_CASE("Vertices of a mug lie on its wall and, away from the fillets, on its handle",
          "[geometry][everyday_shapes]") {
  const MugDimensions d;
  const double outer = 0.5 * d.diameter;
  const double inner = outer - d.wall_thickness;
  const double half_wall = 0.5 * d.wall_thickness;
  const TriangleMesh mesh = mug();
  std::size_t num_on_handle = 0;
  std::size_t num_inside = 0;
  for (const Vector3d& vertex : mesh.vertices) {
    const Vector2d p = turned(vertex);
    const double bound = kVertexBound * d.height;
    double off = std::numeric_limits<double>::infinity();
    if (p[1] <= d.base_radius) {
      const Vector2d center(outer - d.base_radius, d.base_radius);
      off = std::min(to_circle(p, center, d.base_radius),
                     to_circle(p, center, d.base_radius - d.wall_thickness));
      if (p[0] <= center[0]) {
        off = std::min(std::abs(p[1]), std::abs(p[1] - d.wall_thickness));
      }
    } else if (p[1] >= d.height - half_wall) {
      off = to_circle(p, {outer - half_wall, d.height - half_wall}, half_wall);
    } else {
      off = std::min(std::abs(p[0] - outer), std::abs(p[0] - inner));
    }
    if (p[0] < outer - half_wall) ++num_inside;
    // Where the wall is farther than the fillet, only the handle is left.
    const double from_wall = p[0] - outer;
    if (from_wall >= d.fillet) {
      ++num_on_handle;
      const double middle = outer - half_wall;
      const double a = outer + d.handle_clearance + 0.5 * d.handle_thickness - middle;
      const double b = 0.5 * (d.handle_height - d.handle_thickness);
      const double in_plane = to_rounded_rectangle({vertex[0] - middle, vertex[2] - 0.5 * d.height},
                                                   a, b, d.handle_radius);
      off = std::abs(std::hypot(in_plane, vertex[1]) - 0.5 * d.handle_thickness);
    }
    const bool is_blend = vertex[0] > 0 && from_wall < d.fillet && from_wall > -bound &&
                          std::abs(vertex[1]) < 0.5 * d.handle_thickness + d.fillet &&
                          std::abs(vertex[2] - 0.5 * d.height) < 0.5 * d.handle_height + d.fillet;
    if (!is_blend) REQUIRE(off <= bound);
  }
  CHECK(num_on_handle > 1000);
  CHECK(num_inside > 5000);

  // The volume of the wall is the area of half the cross-section times the way of its centroid
  // [Pappus], of floor, arc, wall and rim; all pieces are w thick around their middle line.
  const double w = d.wall_thickness;
  const double middle = outer - half_wall;
  const double corner = d.base_radius - half_wall;
  const double straight = d.height - half_wall - d.base_radius;
  const double floor_volume = pi * std::pow(middle - corner, 2) * w;
  // This is ∫∫ (middle − corner + r sin) r dr dangle over the quarter ring.
  const double quarter = 2 * pi *
                         ((middle - corner) * pi / 4 *
                              (std::pow(corner + half_wall, 2) - std::pow(corner - half_wall, 2)) +
                          (std::pow(corner + half_wall, 3) - std::pow(corner - half_wall, 3)) / 3);
  const double wall = floor_volume + quarter + 2 * pi * middle * w * straight +
                      2 * pi * middle * pi / 2 * half_wall * half_wall;
  // The handle has two straight pieces from the wall, two quarters of a circle, and one straight
  // piece.
  const double a = outer + d.handle_clearance + 0.5 * d.handle_thickness - outer;
  const double length = 2 * (a - d.handle_radius) + pi * d.handle_radius +
                        (d.handle_height - d.handle_thickness - 2 * d.handle_radius);
  const double handle = length * pi / 4 * d.handle_thickness * d.handle_thickness;
  // A fillet of radius f around a bar of radius r adds (1 − π/4) f² along its foot, 2π (r + f/4):
  // 0.15e-6 m³ for two; the wall's bend takes less than a tenth of the handle's end away.
  const double fillets = 2 * (1 - pi / 4) * d.fillet * d.fillet * 2 * pi *
                         (0.5 * d.handle_thickness + 0.25 * d.fillet);
  CHECK(volume_limit([](int n) { return mug({}, n); }, 150) ==
        Approx(wall + handle + fillets).margin(0.5 * fillets));
}

TEST_CASE("Vertices of a bowling ball lie on its sphere and in its holes, rounded edges aside",
          "[geometry][everyday_shapes]") {
  const BowlingBallDimensions d;
  const double radius = 0.5 * d.diameter;
  const double sine = 0.5 * d.span / radius;
  const Vector3d to_fingers(sine, 0, std::sqrt(1 - sine * sine));
  const Vector3d to_thumb(-sine, 0, std::sqrt(1 - sine * sine));
  std::size_t num_in_holes = 0;
  double deepest[3] = {radius, radius, radius};
  const TriangleMesh mesh = bowling_ball();
  for (const Vector3d& p : mesh.vertices) {
    double to_hole = std::numeric_limits<double>::infinity();
    int nearest = -1;
    for (int i = 0; i < 3; ++i) {
      const Vector3d u = i == 0 ? to_thumb : to_fingers;
      const Vector3d side = (i - 1.5) * (i == 0 ? 0.0 : d.finger_spacing) * Vector3d::UnitY();
      const double surface = std::sqrt(radius * radius - side.squaredNorm());
      const double r = 0.5 * (i == 0 ? d.thumb_diameter : d.finger_diameter);
      const double end = surface - (i == 0 ? d.thumb_depth : d.finger_depth);
      const double h = to_segment(p, side + (end + r) * u, side + 2 * radius * u) - r;
      if (h < to_hole) {
        to_hole = h;
        nearest = i;
      }
      if (h < d.edge_radius) deepest[i] = std::min(deepest[i], p.dot(u) - end);
    }
    const double bound = kVertexBound * d.diameter;
    if (to_hole >= d.edge_radius) {
      REQUIRE(std::abs(p.norm() - radius) <= bound);
    } else if (p.norm() <= radius - d.edge_radius) {
      REQUIRE(std::abs(to_hole) <= bound);
      ++num_in_holes;
    } else {
      REQUIRE(p.norm() <= radius + bound);
      REQUIRE(to_hole >= -bound);
    }
    REQUIRE(nearest >= 0);
  }
  CHECK(num_in_holes > 2000);
  // The round ends are met by edges of 3 mm on a ball of 12.5 mm, which sag by 0.1 mm.
  for (const double depth : deepest) CHECK(depth == Approx(0).margin(2e-4));

  // The volume is that of the sphere less the holes: over the disc of each hole, from its round end
  // to the sphere (midpoint rule in r and angle).
  const auto hole = [&](double offset, double depth, double r) {
    constexpr int n = 400;
    double sum = 0.0;
    const double end = std::sqrt(radius * radius - offset * offset) - depth;
    for (int i = 0; i < n; ++i) {
      const double q = r * (i + 0.5) / n;
      for (int j = 0; j < n; ++j) {
        const double angle = 2 * pi * (j + 0.5) / n;
        const double y = offset + q * std::sin(angle);
        const double x = q * std::cos(angle);
        sum += (std::sqrt(radius * radius - x * x - y * y) - (end + r - std::sqrt(r * r - q * q))) *
               q * (r / n) * (2 * pi / n);
      }
    }
    return sum;
  };
  const double rt = 0.5 * d.thumb_diameter;
  const double rf = 0.5 * d.finger_diameter;
  // A rounded square edge takes (1 − π/4) e² along a circle a quarter of e outside of the hole.
  const double edges = (1 - pi / 4) * d.edge_radius * d.edge_radius * 2 * pi *
                       (rt + 2 * rf + 3 * 0.25 * d.edge_radius);
  const double expected = 4 * pi / 3 * std::pow(radius, 3) - hole(0, d.thumb_depth, rt) -
                          2 * hole(0.5 * d.finger_spacing, d.finger_depth, rf) - edges;
  CHECK(volume_limit([](int n) { return bowling_ball({}, n); }, 220) ==
        Approx(expected).margin(0.25 * edges));
}

TEST_CASE("Arms of an octopus have the stated radius around their arc",
          "[geometry][everyday_shapes]") {
  const OctopusDimensions d;
  const double tip = 0.5 * d.arm_tip_diameter;
  const double root = 0.5 * d.arm_root_diameter;
  const double first = -55 * pi / 180;
  const double last = 35 * pi / 180;
  const double start = 0.5 * d.mantle_diameter / 3;
  const double arc = (d.arm_reach - tip - start) / (std::sin(last) - std::sin(first));
  const double center_s = start - arc * std::sin(first);
  // The arc's height follows from the tips, which touch the box: vertices at x = reach.
  const TriangleMesh mesh = octopus();
  double tip_z = -1;
  for (const Vector3d& p : mesh.vertices) {
    if (p[0] == d.arm_reach) tip_z = p[2];
  }
  REQUIRE(tip_z > 0);
  const double center_z = tip_z + arc * std::cos(last);
  std::size_t num_on_arms = 0;
  std::array<int, 8> per_arm{};
  for (const Vector3d& p : mesh.vertices) {
    const double mantle =
        to_segment(p, {0, 0, d.height - d.mantle_height + 0.5 * d.mantle_diameter},
                   {0, 0, d.height - 0.5 * d.mantle_diameter}) -
        0.5 * d.mantle_diameter;
    const int k = static_cast<int>(std::lround(std::atan2(p[1], p[0]) / (pi / 4)) + 8) % 8;
    const double c = std::cos(k * pi / 4);
    const double s = std::sin(k * pi / 4);
    const double along = c * p[0] + s * p[1];
    const double across = c * p[1] - s * p[0];
    // The neighboring arms are far enough away where the gap between directions is wide.
    if (mantle < d.fillet || along < 0.09) continue;
    ++num_on_arms;
    ++per_arm[k];
    // This finds the nearest point of the arc, by golden-section search over the heading.
    const auto distance = [&](double h) {
      return Vector3d(along - center_s - arc * std::sin(h), p[2] - center_z + arc * std::cos(h),
                      across)
          .norm();
    };
    double low = first;
    double high = last;
    const double golden = std::numbers::phi - 1;
    for (int i = 0; i < 80; ++i) {
      const double a = high - golden * (high - low);
      const double b = low + golden * (high - low);
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    const double h = 0.5 * (low + high);
    const double radius = root + (tip - root) * (h - first) / (last - first);
    // A minimum is found to the square root of the rounding: 1e-8 of a heading, which moves the
    // radius by 1e-10 m.
    REQUIRE(distance(h) == Approx(radius).margin(1e-9));
  }
  CHECK(num_on_arms > 5000);
  for (const int count : per_arm) CHECK(count > 500);
  // By the eight-fold symmetry the center of mass is on the axis, and the inertia is the same about
  // x and y, up to the lattice.
  const MassProperties mass = mass_properties(mesh);
  CHECK(mass.center_of_mass.head<2>().norm() < 1e-5 * d.arm_reach);
  CHECK(mass.inertia(0, 0) == Approx(mass.inertia(1, 1)).epsilon(1e-4));
  CHECK(std::abs(mass.inertia(0, 1)) < 1e-4 * mass.inertia(0, 0));
}

TEST_CASE("Vertices of a wire cage lie on its bars and frames, fillets aside",
          "[geometry][everyday_shapes]") {
  const WireCageDimensions d;
  const double a = 0.5 * (d.width - d.frame_diameter);
  const double b = 0.5 * (d.depth - d.frame_diameter);
  const double low = 0.5 * d.frame_diameter;
  const double high = d.height - low;
  std::size_t num_on_bars = 0;
  for (const Vector3d& p : wire_cage().vertices) {
    const double outline = to_rounded_rectangle(p.head<2>(), a, b, d.corner_radius);
    const double frame =
        std::min(std::hypot(outline, p[2] - low), std::hypot(outline, p[2] - high)) - low;
    double bar = std::numeric_limits<double>::infinity();
    for (int k = -1; k <= 1; ++k) {
      const double x = k * 2.0 / 3 * (a - d.corner_radius);
      const double y = k * 2.0 / 3 * (b - d.corner_radius);
      for (const double side : {-1.0, 1.0}) {
        bar = std::min(bar, to_segment(p, {side * a, y, low}, {side * a, y, high}));
        bar = std::min(bar, to_segment(p, {x, side * b, low}, {x, side * b, high}));
      }
      for (const double z : {low, high}) bar = std::min(bar, to_segment(p, {x, -b, z}, {x, b, z}));
    }
    bar -= 0.5 * d.bar_diameter;
    if (frame >= d.fillet) {
      REQUIRE(std::abs(bar) <= kVertexBound * d.width);
      ++num_on_bars;
    } else if (bar >= d.fillet) {
      REQUIRE(std::abs(frame) <= kVertexBound * d.width);
    }
  }
  CHECK(num_on_bars > 5000);
  // A graph of two rings with 4n + 2n bars between their points has 6n + 1 loops.
  for (const int n : {1, 2}) {
    WireCageDimensions cage;
    cage.bars_per_side = n;
    check_solid(wire_cage(cage, 8), 6 * n + 1);
  }
}

}  // namespace test_everyday_shape_surfaces
