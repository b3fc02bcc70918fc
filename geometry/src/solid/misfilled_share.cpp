#include "solid/misfilled_share.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "query/winding.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

/// Winding number of the triangles around the origin [van Oosterom & Strackee 1983]. Rounded.
double winding_number(const std::vector<Triangle>& triangles, const Vector3d& origin) {
  double angle = 0.0;
  for (const Triangle& triangle : triangles) {
    const Vector3d a = triangle[0] - origin;
    const Vector3d b = triangle[1] - origin;
    const Vector3d c = triangle[2] - origin;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (2.0 * std::numbers::pi);
}

}  // namespace

double misfilled_share(const TriangleMesh& closed, const std::vector<Triangle>& fillings) {
  constexpr std::uint64_t kSeed = 1;
  constexpr int kEnoughInside = 1'000;  // Standard deviation of a share of a quarter: 0.014.
  // A thin object fills a hundredth of its box and less; of a sheet without volume no point is
  // inside.
  constexpr int kMostPoints = 200'000;
  constexpr int kMostUntilInside = 10'000;
  constexpr std::int64_t kMostTriangles = 100'000'000;  // A few seconds.

  const MeshQuery query(closed);
  const Vector3d corner = query.box().min();
  const Vector3d size = query.box().sizes();
  const double extent = size.maxCoeff();
  if (fillings.empty() || !(extent > 0.0) || !std::isfinite(extent)) return 0.0;
  // The triangles are scaled to an extent of one, where products of lengths stay in the range of
  // doubles.
  std::vector<Triangle> scaled = fillings;
  for (Triangle& triangle : scaled) {
    for (Vector3d& p : triangle) p = (p - corner) / extent;
  }

  base::Random random(kSeed);
  std::int64_t num_triangles = 0;
  int num_inside = 0;
  int num_different = 0;
  for (int i = 0; i < kMostPoints && num_inside < kEnoughInside; ++i) {
    if (num_triangles > kMostTriangles || (num_inside == 0 && i > kMostUntilInside)) break;
    const Vector3d share(random.uniform(), random.uniform(), random.uniform());
    const Winding winding = winding_around(query, corner + share.cwiseProduct(size));
    if (winding.is_on_surface()) continue;
    const double open =
        winding.number() - winding_number(scaled, share.cwiseProduct(size) / extent);
    num_triangles += static_cast<std::int64_t>(scaled.size());
    const bool is_inside_filled = winding.number() != 0;
    const bool is_inside_open = std::abs(open) > 0.5;
    if (is_inside_filled || is_inside_open) ++num_inside;
    if (is_inside_filled != is_inside_open) ++num_different;
  }
  return num_inside > 0 ? static_cast<double>(num_different) / num_inside : 0.0;
}

}  // namespace graspfit::geometry::internal
