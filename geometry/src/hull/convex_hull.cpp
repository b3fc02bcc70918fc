#include "graspfit/geometry/convex_hull.hpp"

#include <CGAL/determinant.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "exact/exact_number.hpp"
#include "exact/predicates.hpp"
#include "graspfit/base/errors.hpp"
#include "hull/exact_hull.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;

Vector3d mean_of(std::span<const Vector3d> points, const std::vector<std::size_t>& indices) {
  Vector3d sum = Vector3d::Zero();
  for (const std::size_t i : indices) sum += points[i];
  return sum / static_cast<double>(indices.size());
}

/// Area and centroid of a planar polygon.
void measure_polygon(std::span<const Vector3d> points, ConvexHull3& hull) {
  const Vector3d& apex = points[hull.vertices.front()];
  Vector3d total = Vector3d::Zero();
  std::vector<std::pair<Vector3d, Vector3d>> triangles;  // vector area, centroid
  for (std::size_t i = 1; i + 1 < hull.vertices.size(); ++i) {
    const Vector3d& b = points[hull.vertices[i]];
    const Vector3d& c = points[hull.vertices[i + 1]];
    triangles.emplace_back(internal::accurate_vector_area(apex, b, c), (apex + b + c) / 3.0);
    total += triangles.back().first;
  }
  hull.measure = total.norm();
  if (!(hull.measure > 0.0)) {
    hull.centroid = mean_of(points, hull.vertices);
    return;
  }
  const Vector3d normal = total / hull.measure;
  hull.centroid.setZero();
  for (const auto& [area, centroid] : triangles) {
    hull.centroid += area.dot(normal) / hull.measure * (centroid - apex);
  }
  hull.centroid += apex;
}

/// Volume and centroid from tetrahedra with one hull vertex as apex. The volume of a hull so flat
/// that doubles leave less than 36 bits of it is computed in rationals.
void measure_solid(std::span<const Vector3d> points, ConvexHull3& hull) {
  const Vector3d& apex = points[hull.vertices.front()];
  const auto six_volumes = [&](auto number) {
    using Number = decltype(number);
    Number sum(0);
    for (const HullFacet& facet : hull.facets) {
      std::array<std::array<Number, 3>, 3> m;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (int axis = 0; axis < 3; ++axis) {
          m[corner][axis] = Number(points[facet[corner]][axis]) - Number(apex[axis]);
        }
      }
      sum += CGAL::determinant(m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0],
                               m[2][1], m[2][2]);
    }
    return sum;
  };
  const std::optional<double> near = internal::value_by_intervals(six_volumes, 0x1p-36);
  hull.measure = (near ? *near : internal::nearest_double(six_volumes(internal::Rational()))) / 6.0;
  double six_sum = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (const HullFacet& facet : hull.facets) {
    const Vector3d a = points[facet[0]] - apex;
    const Vector3d b = points[facet[1]] - apex;
    const Vector3d c = points[facet[2]] - apex;
    const double six_volume = std::max(0.0, a.dot(b.cross(c)));
    six_sum += six_volume;
    moment += six_volume * (a + b + c) / 4.0;
  }
  hull.centroid =
      six_sum > 0.0 ? Vector3d(apex + moment / six_sum) : mean_of(points, hull.vertices);
}

void make_segment(std::span<const Vector3d> points, const std::vector<std::size_t>& distinct,
                  const Vector3d& direction, ConvexHull3& hull) {
  const auto along = [&](std::size_t a, std::size_t b) {
    return points[a].dot(direction) < points[b].dot(direction);
  };
  const auto [low, high] = std::minmax_element(distinct.begin(), distinct.end(), along);
  hull.rank = 1;
  hull.vertices = {std::min(*low, *high), std::max(*low, *high)};
  hull.measure = (points[*high] - points[*low]).norm();
  hull.centroid = 0.5 * (points[*low] + points[*high]);
}

void make_polygon(std::span<const Vector3d> points, std::vector<std::size_t> around,
                  ConvexHull3& hull) {
  hull.rank = 2;
  hull.vertices = std::move(around);
  hull.facets = {hull.vertices};
  measure_polygon(points, hull);
}

}  // namespace

ConvexHull3 convex_hull(std::span<const Vector3d> points, const HullOptions& options) {
  for (const double value : {options.collinear_rel, options.planar_rel}) {
    if (!(value >= 0.0)) {
      throw base::InvalidInput("convex_hull: thresholds must be >= 0, one is " +
                               std::to_string(value));
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw base::InvalidInput("convex_hull: point " + std::to_string(i) + " is not finite");
    }
  }
  const internal::ExactHull exact = internal::exact_hull(points);
  ConvexHull3 hull;
  hull.rank = exact.rank;
  if (hull.rank < 0) return hull;
  if (hull.rank == 0) {
    hull.vertices = exact.corners;
    hull.centroid = points[hull.vertices.front()];
    return hull;
  }

  std::vector<std::size_t> distinct = internal::distinct_points(points);
  std::sort(distinct.begin(), distinct.end());
  const Vector3d mean = mean_of(points, distinct);
  Eigen::Matrix3Xd centered(3, distinct.size());
  for (Eigen::Index k = 0; k < std::ssize(distinct); ++k) {
    centered.col(k) = points[distinct[k]] - mean;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(centered, Eigen::ComputeFullU);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Matrix3d axes = svd.matrixU();
  const auto range = [&](int axis) {
    const Eigen::RowVectorXd along = axes.col(axis).transpose() * centered;
    return along.maxCoeff() - along.minCoeff();
  };

  const double spread = values.size() > 1 ? values[1] : 0.0;
  if (hull.rank >= 2 && spread < options.collinear_rel * values[0]) hull.rank = 1;
  const bool is_nearly_flat = hull.rank == 3 && range(2) < options.planar_rel * range(0);
  if (exact.rank == 1) {
    make_segment(points, exact.corners, axes.col(0), hull);
  } else if (hull.rank == 1) {
    make_segment(points, distinct, axes.col(0), hull);
  } else if (is_nearly_flat) {
    std::vector<Vector3d> flat(points.size(), Vector3d::Zero());
    std::vector<Vector3d> projected(points.begin(), points.end());
    for (const std::size_t i : distinct) {
      flat[i] = {points[i].dot(axes.col(0)), points[i].dot(axes.col(1)), 0.0};
      projected[i] -= axes.col(2).dot(points[i] - mean) * axes.col(2);
    }
    std::vector<std::size_t> around = internal::hull_in_plane(flat, distinct, 0, 1);
    if (around.size() < 3) {  // a needle, once it is projected and rounded
      make_segment(points, distinct, axes.col(0), hull);
    } else {
      make_polygon(projected, std::move(around), hull);
    }
  } else if (hull.rank == 2) {
    make_polygon(points, exact.corners, hull);
  } else {
    hull.vertices = exact.corners;
    for (const auto& corners : exact.triangles) {
      hull.facets.emplace_back(corners.begin(), corners.end());
    }
    measure_solid(points, hull);
  }
  return hull;
}

}  // namespace graspfit::geometry
