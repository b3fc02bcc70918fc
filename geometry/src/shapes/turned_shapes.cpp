#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/geometry/everyday_shapes.hpp"
#include "shapes/shape_dimensions.hpp"
#include "shapes/turned_surface.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector2d;
using internal::require_below;
using internal::require_positive;
using internal::require_range;
using std::numbers::pi;

// The number of segments is a multiple of four, so that the widest ring touches all sides of the
// box.
void require_segments(const char* shape, int segments) {
  require_range(shape, "segments", segments, 12, 2048);  // 10 million faces of a bottle
  if (segments % 4 != 0) {
    throw base::InvalidInput(std::string(shape) + ": segments is " + std::to_string(segments) +
                             ", must be a multiple of 4");
  }
}

// A cubic polynomial per interval: the natural or clamped interpolating spline.
class Spline {
 public:
  // End slopes; NaN for a natural end (no curvature).
  Spline(std::vector<Vector2d> knots, double first_slope, double last_slope)
      : knots_(std::move(knots)) {
    // Curvatures m at the knots solve a tridiagonal system (Thomas algorithm).
    const std::size_t n = knots_.size();
    std::vector<double> lower(n, 0.0), diagonal(n, 1.0), upper(n, 0.0), right(n, 0.0);
    const auto h = [&](std::size_t i) { return knots_[i + 1][0] - knots_[i][0]; };
    const auto secant = [&](std::size_t i) { return (knots_[i + 1][1] - knots_[i][1]) / h(i); };
    if (!std::isnan(first_slope)) {
      diagonal[0] = h(0) / 3;
      upper[0] = h(0) / 6;
      right[0] = secant(0) - first_slope;
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      lower[i] = h(i - 1) / 6;
      diagonal[i] = (h(i - 1) + h(i)) / 3;
      upper[i] = h(i) / 6;
      right[i] = secant(i) - secant(i - 1);
    }
    if (!std::isnan(last_slope)) {
      lower[n - 1] = h(n - 2) / 6;
      diagonal[n - 1] = h(n - 2) / 3;
      right[n - 1] = last_slope - secant(n - 2);
    }
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1];
      right[i] -= factor * right[i - 1];
    }
    curvatures_.assign(n, 0.0);
    for (std::size_t i = n; i-- > 0;) {
      const double next = i + 1 < n ? curvatures_[i + 1] : 0.0;
      curvatures_[i] = (right[i] - upper[i] * next) / diagonal[i];
    }
  }

  double first() const { return knots_.front()[0]; }
  double last() const { return knots_.back()[0]; }

  // Value and slope at x.
  Vector2d at(double x) const {
    std::size_t i = 0;
    while (i + 2 < knots_.size() && x > knots_[i + 1][0]) ++i;
    const double h = knots_[i + 1][0] - knots_[i][0];
    const double b = (x - knots_[i][0]) / h;
    const double a = 1.0 - b;
    const double ma = curvatures_[i];
    const double mb = curvatures_[i + 1];
    return {a * knots_[i][1] + b * knots_[i + 1][1] +
                ((a * a * a - a) * ma + (b * b * b - b) * mb) * h * h / 6,
            (knots_[i + 1][1] - knots_[i][1]) / h +
                ((1 - 3 * a * a) * ma + (3 * b * b - 1) * mb) * h / 6};
  }

 private:
  std::vector<Vector2d> knots_;  // (x, value)
  std::vector<double> curvatures_;
};

// The pin's side in inches: (z, radius), from the base to where the cap begins.
constexpr double kPinHeight = 15.0;
constexpr double kCapRadius = 1.273;
constexpr double kCapStart = 14.4;  // z; lower, the side would widen above the head to meet the arc
constexpr double kBaseRadius = 5.0 / 32.0;
constexpr std::array<std::array<double, 2>, 14> kPinDiameters = {{{0.0, 2.031},
                                                                  {0.75, 2.828},
                                                                  {2.25, 3.906},
                                                                  {3.375, 4.510},
                                                                  {4.5, 4.766},
                                                                  {5.875, 4.563},
                                                                  {7.25, 3.703},
                                                                  {8.625, 2.472},
                                                                  {9.375, 1.965},
                                                                  {10.0, 1.797},
                                                                  {10.875, 1.870},
                                                                  {11.75, 2.094},
                                                                  {12.625, 2.406},
                                                                  {13.5, 2.547}}};
constexpr int kBelly = 4;
constexpr int kNeck = 9;
constexpr int kHead = 13;

std::vector<Vector2d> pin_profile_inches(double edge_length) {
  const auto knots = [](int from, int to) {
    std::vector<Vector2d> result;
    for (int i = from; i <= to; ++i) {
      result.emplace_back(kPinDiameters[i][0], 0.5 * kPinDiameters[i][1]);
    }
    return result;
  };
  const double cap_center = kPinHeight - kCapRadius;
  const double cap_r =
      std::sqrt(kCapRadius * kCapRadius - (kCapStart - cap_center) * (kCapStart - cap_center));
  std::vector<Vector2d> head = knots(kHead, kHead);
  head.emplace_back(kCapStart, cap_r);
  const Spline sides[] = {
      Spline(knots(0, kBelly), std::nan(""), 0.0), Spline(knots(kBelly, kNeck), 0.0, 0.0),
      Spline(knots(kNeck, kHead), 0.0, 0.0), Spline(head, 0.0, -(kCapStart - cap_center) / cap_r)};

  // The arc at the base touches the floor and the side. It touches the side at the height z where
  // the inward normal of length kBaseRadius ends at the height kBaseRadius.
  double low = 0.0;
  double high = kBaseRadius;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    const double slope = sides[0].at(z)[1];
    (z + kBaseRadius * slope / std::sqrt(1.0 + slope * slope) < kBaseRadius ? low : high) = z;
  }
  const Vector2d side = sides[0].at(low);
  const double norm = std::sqrt(1.0 + side[1] * side[1]);
  const Vector2d base_center(side[0] - kBaseRadius / norm, kBaseRadius);
  // From straight down to the side's outward normal, which points downward.
  const double base_turn = pi / 2 - std::asin(side[1] / norm);

  std::vector<Vector2d> profile = {{0.0, 0.0}};
  const auto steps_of = [&](double length, double turn) {
    return std::max({1, static_cast<int>(std::ceil(length / edge_length)),
                     static_cast<int>(std::ceil(turn / (pi / 8)))});
  };
  const int floor_steps = steps_of(base_center[0], 0.0);
  for (int i = 1; i <= floor_steps; ++i) profile.emplace_back(base_center[0] * i / floor_steps, 0);
  const int base_steps = steps_of(kBaseRadius * base_turn, base_turn);
  for (int i = 1; i < base_steps; ++i) {
    const double a = base_turn * i / base_steps;
    profile.push_back(base_center + kBaseRadius * Vector2d(std::sin(a), -std::cos(a)));
  }
  for (const Spline& spline : sides) {
    const double from = &spline == &sides[0] ? low : spline.first();
    // Slopes are below 1.1, so that an edge is at most half as long again as its height.
    const int steps = steps_of(1.2 * (spline.last() - from), 0.0);
    for (int i = 0; i < steps; ++i) {
      const double z = from + (spline.last() - from) * i / steps;
      profile.emplace_back(spline.at(z)[0], z);
    }
  }
  const double cap_turn = std::acos((kCapStart - cap_center) / kCapRadius);
  const int cap_steps = steps_of(kCapRadius * cap_turn, cap_turn);
  for (int i = 0; i < cap_steps; ++i) {
    const double a = cap_turn * (cap_steps - i) / cap_steps;
    profile.emplace_back(kCapRadius * std::sin(a), cap_center + kCapRadius * std::cos(a));
  }
  profile.emplace_back(0.0, kPinHeight);
  return profile;
}

}  // namespace

void BottleDimensions::validate() const {
  const char* const shape = "bottle";
  require_positive(shape, *this, internal::kBottleFields);
  require_below(shape, "neck_diameter", neck_diameter, body_diameter, "body_diameter");
  require_below(shape, "shoulder_bottom", shoulder_bottom, shoulder_top, "shoulder_top");
  require_below(shape, "shoulder_top", shoulder_top, height, "height");
}

TriangleMesh bottle(const BottleDimensions& d, int segments) {
  d.validate();
  require_segments("bottle", segments);
  const double edge_length = pi * d.body_diameter / segments;
  const double body = 0.5 * d.body_diameter;
  const double neck = 0.5 * d.neck_diameter;
  return internal::turned_surface(
      internal::rounded_profile("bottle",
                                {{{0.0, 0.0}},
                                 {{body, 0.0}, d.base_radius, "base_radius"},
                                 {{body, d.shoulder_bottom}, d.shoulder_radius, "shoulder_radius"},
                                 {{neck, d.shoulder_top}, d.shoulder_radius, "shoulder_radius"},
                                 {{neck, d.height}, d.lip_radius, "lip_radius"},
                                 {{0.0, d.height}}},
                                edge_length),
      segments, edge_length);
}

void BowlingPinDimensions::validate() const {
  require_positive("bowling_pin", *this, internal::kBowlingPinFields);
}

TriangleMesh bowling_pin(const BowlingPinDimensions& d, int segments) {
  d.validate();
  require_segments("bowling_pin", segments);
  const double edge_length = pi * kPinDiameters[kBelly][1] / segments;
  TriangleMesh mesh =
      internal::turned_surface(pin_profile_inches(edge_length), segments, edge_length);
  // Dividing last keeps the height exact.
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex * d.height / kPinHeight;
  return mesh;
}

void FlowerPotDimensions::validate() const {
  const char* const shape = "flower_pot";
  require_positive(shape, *this, internal::kFlowerPotFields);
  require_below(shape, "base_diameter", base_diameter, top_diameter, "top_diameter");
  require_below(shape, "wall_thickness", wall_thickness, 0.5 * base_diameter,
                "half of base_diameter");
  require_below(shape, "wall_thickness", wall_thickness, rim_thickness, "rim_thickness");
  require_below(shape, "rim_thickness", rim_thickness,
                0.5 * (top_diameter - base_diameter) + wall_thickness,
                "wall_thickness and half of what top_diameter exceeds base_diameter by");
  require_below(shape, "rim_height", rim_height, height - wall_thickness,
                "what wall_thickness leaves of height");
}

TriangleMesh flower_pot(const FlowerPotDimensions& d, int segments) {
  d.validate();
  require_segments("flower_pot", segments);
  const double edge_length = pi * d.top_diameter / segments;
  const double base = 0.5 * d.base_diameter;
  const double top = 0.5 * d.top_diameter;
  // The outside of the wall as if it went on through the collar.
  const double slope = (top - d.rim_thickness + d.wall_thickness - base) / d.height;
  const double collar = d.height - d.rim_height;
  return internal::turned_surface(
      internal::rounded_profile(
          "flower_pot",
          {{{0.0, 0.0}},
           {{base, 0.0}, d.edge_radius, "edge_radius"},
           {{base + slope * collar, collar}, d.edge_radius, "edge_radius"},
           {{top, collar}, d.edge_radius, "edge_radius"},
           {{top, d.height}, d.edge_radius, "edge_radius"},
           {{top - d.rim_thickness, d.height}, d.edge_radius, "edge_radius"},
           {{base + slope * d.wall_thickness - d.wall_thickness, d.wall_thickness},
            d.edge_radius,
            "edge_radius"},
           {{0.0, d.wall_thickness}}},
          edge_length),
      segments, edge_length);
}

}  // namespace graspfit::geometry
