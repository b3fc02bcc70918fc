#include "shapes/turned_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::geometry::internal {

using Eigen::Vector2d;
using std::numbers::pi;

std::pair<double, double> turn(int i, int n) {
  const std::int64_t quarter = 4LL * i;
  if (quarter % n == 0) {
    constexpr int kCos[] = {1, 0, -1, 0};
    const auto q = static_cast<int>(quarter / n % 4);
    return {kCos[q], kCos[(q + 3) % 4]};
  }
  const double angle = 2.0 * pi * i / n;
  return {std::cos(angle), std::sin(angle)};
}

namespace {

constexpr int kMostEdges = 1 << 13;  // along one side of a profile

}  // namespace

std::vector<Vector2d> rounded_profile(const char* shape, const std::vector<ProfileCorner>& corners,
                                      double edge_length) {
  std::vector<Vector2d> points = {corners.front().point};
  const auto line_to = [&](const Vector2d& end) {
    const Vector2d start = points.back();
    const double length = (end - start).norm();
    if (length == 0.0) return;
    if (!(length < kMostEdges * edge_length)) {
      throw base::InvalidInput(std::string(shape) + ": a side of " +
                               base::shortest_decimal(length) + " m is too long for edges of " +
                               base::shortest_decimal(edge_length) + " m; lower segments");
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(length / edge_length)));
    for (int i = 1; i < steps; ++i) points.push_back(start + (end - start) * i / steps);
    points.push_back(end);
  };
  // Length of the line before a corner that the rounding of the previous corner takes.
  double used = 0.0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Vector2d& corner = corners[k].point;
    const Vector2d before = corner - corners[k - 1].point;
    const Vector2d after = corners[k + 1].point - corner;
    const Vector2d in = before.normalized();
    const Vector2d out = after.normalized();
    const double cross = in[0] * out[1] - in[1] * out[0];
    const double angle = std::atan2(cross, in.dot(out));  // turned through, left positive
    const double radius = corners[k].rounding;
    const double tangent = radius * std::tan(std::abs(angle) / 2);
    if (!(used + tangent < before.norm()) || !(tangent < after.norm())) {
      throw base::InvalidInput(std::string(shape) + ": " + corners[k].field + " is " +
                               base::shortest_decimal(radius) +
                               ", too large for the lengths between its neighbors");
    }
    used = tangent;
    line_to(corner - tangent * in);
    if (tangent == 0.0) continue;
    const Vector2d normal = (angle > 0.0 ? 1.0 : -1.0) * Vector2d(-in[1], in[0]);
    const Vector2d center = corner - tangent * in + radius * normal;
    const int steps =
        std::max({1, static_cast<int>(std::ceil(std::abs(angle) * radius / edge_length)),
                  static_cast<int>(std::ceil(std::abs(angle) / (pi / 8)))});
    for (int i = 1; i < steps; ++i) {
      const double a = std::abs(angle) * i / steps;
      points.push_back(center + radius * (std::sin(a) * in - std::cos(a) * normal));
    }
    points.push_back(corner + tangent * out);
  }
  line_to(corners.back().point);
  return points;
}

TriangleMesh turned_surface(const std::vector<Vector2d>& profile, int segments,
                            double edge_length) {
  const auto rings = base::as_index<std::int32_t>(profile.size()) - 2;
  // How often the number of vertices of each ring is halved: while edges stay below 1.4 edge
  // lengths, so that they end between 0.7 and 1.4, and at most once more than for the neighboring
  // rings.
  std::vector<int> halvings(rings, 0);
  for (std::int32_t ring = 0; ring < rings; ++ring) {
    int& h = halvings[ring];
    while (segments % (2 << h) == 0 && segments / (2 << h) >= 6 &&
           2 * pi * profile[ring + 1][0] / (segments / (2 << h)) < 1.4 * edge_length) {
      ++h;
    }
  }
  for (std::int32_t i = 1; i < rings; ++i) {
    halvings[i] = std::min(halvings[i], halvings[i - 1] + 1);
  }
  for (std::int32_t i = rings - 1; i > 0; --i) {
    halvings[i - 1] = std::min(halvings[i - 1], halvings[i] + 1);
  }

  TriangleMesh mesh;
  std::vector<std::int32_t> first(rings);
  mesh.vertices.emplace_back(0.0, 0.0, profile.front()[1]);
  for (std::int32_t ring = 0; ring < rings; ++ring) {
    first[ring] = base::as_index<std::int32_t>(mesh.vertices.size());
    const Vector2d& p = profile[ring + 1];
    for (int i = 0; i < segments; i += 1 << halvings[ring]) {
      const auto [c, s] = turn(i, segments);
      mesh.vertices.emplace_back(p[0] * c, p[0] * s, p[1]);
    }
  }
  const auto last = base::as_index<std::int32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, profile.back()[1]);
  const auto at = [&](std::int32_t ring, int i) {
    return first[ring] + (i % segments >> halvings[ring]);
  };
  for (int i = 0; i < segments; i += 1 << halvings[0]) {
    mesh.faces.push_back({0, at(0, i + (1 << halvings[0])), at(0, i)});
  }
  for (std::int32_t ring = 0; ring + 1 < rings; ++ring) {
    const int low = 1 << halvings[ring];
    const int high = 1 << halvings[ring + 1];
    for (int i = 0; i < segments; i += std::max(low, high)) {
      const auto l = [&](int k) { return at(ring, i + k); };
      const auto h = [&](int k) { return at(ring + 1, i + k); };
      if (low == high) {
        mesh.faces.insert(mesh.faces.end(), {Face{l(0), l(low), h(low)}, {l(0), h(low), h(0)}});
      } else if (low < high) {
        mesh.faces.insert(
            mesh.faces.end(),
            {Face{l(0), l(low), h(0)}, {l(low), h(high), h(0)}, {l(low), l(high), h(high)}});
      } else {
        mesh.faces.insert(
            mesh.faces.end(),
            {Face{l(0), h(high), h(0)}, {l(0), l(low), h(high)}, {l(low), h(low), h(high)}});
      }
    }
  }
  for (int i = 0; i < segments; i += 1 << halvings[rings - 1]) {
    mesh.faces.push_back({last, at(rings - 1, i), at(rings - 1, i + (1 << halvings[rings - 1]))});
  }
  return mesh;
}

}  // namespace graspfit::geometry::internal
