#include "graspfit/geometry/convex_hull.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "exact/predicates.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_polytope.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;

/// Extreme points in counter-clockwise order of points seen in their first two coordinates
/// (Andrew's monotone chain on exact orientation signs); points on edges are dropped.
std::vector<std::size_t> polygon_around(const std::vector<Vector3d>& points,
                                        std::vector<std::size_t> order) {
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::tie(points[a].x(), points[a].y(), a) < std::tie(points[b].x(), points[b].y(), b);
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<std::size_t> polygon;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = polygon.size();
    for (const std::size_t i : order) {
      while (polygon.size() >= base + 2 &&
             internal::orientation_2d(points[polygon[polygon.size() - 2]], points[polygon.back()],
                                      points[i], 0, 1) <= 0) {
        polygon.pop_back();
      }
      polygon.push_back(i);
    }
    polygon.pop_back();  // the last point of one chain starts the other
    std::reverse(order.begin(), order.end());
  }
  return polygon;
}

/// Indices of distinct points, ascending; of equal ones the first.
std::vector<std::size_t> distinct_points(std::span<const Vector3d> points) {
  const auto place = [&](std::size_t i) {
    return std::tie(points[i].x(), points[i].y(), points[i].z());
  };
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  order.erase(std::unique(order.begin(), order.end(),
                          [&](std::size_t a, std::size_t b) { return place(a) == place(b); }),
              order.end());
  std::sort(order.begin(), order.end());
  return order;
}

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

/// Volume and centroid from tetrahedra with one hull vertex as apex.
void measure_solid(std::span<const Vector3d> points, double volume, ConvexHull3& hull) {
  hull.measure = volume;
  const Vector3d& apex = points[hull.vertices.front()];
  double six_volumes = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (const HullFacet& facet : hull.facets) {
    const Vector3d a = points[facet[0]] - apex;
    const Vector3d b = points[facet[1]] - apex;
    const Vector3d c = points[facet[2]] - apex;
    const double six_volume = std::max(0.0, a.dot(b.cross(c)));
    six_volumes += six_volume;
    moment += six_volume * (a + b + c) / 4.0;
  }
  hull.centroid =
      six_volumes > 0.0 ? Vector3d(apex + moment / six_volumes) : mean_of(points, hull.vertices);
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

/// Corners of an exactly planar hull, from the lowest index on.
std::vector<std::size_t> corners_around(const ConvexPolytope& polygon) {
  std::map<int, int> next;
  for (Eigen::Index f = 0; f < polygon.num_facets(); ++f) {
    next[polygon.facets()(0, f)] = polygon.facets()(1, f);
  }
  std::vector<std::size_t> around;
  int corner = next.begin()->first;
  do {
    around.push_back(static_cast<std::size_t>(corner));
    corner = next.at(corner);
  } while (corner != next.begin()->first);
  return around;
}

}  // namespace

ConvexHull3 convex_hull(std::span<const Vector3d> points, const HullOptions& options) {
  for (const double value : {options.collinear_rel, options.planar_rel}) {
    if (!(value >= 0.0)) {
      throw base::InvalidInput("convex_hull: thresholds must be >= 0, one is " +
                               std::to_string(value));
    }
  }
  Eigen::Matrix3Xd columns(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw base::InvalidInput("convex_hull: point " + std::to_string(i) + " is not finite");
    }
    columns.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  const ConvexPolytope exact(columns);
  ConvexHull3 hull;
  hull.rank = exact.rank();
  if (hull.rank < 0) return hull;
  if (hull.rank == 0) {
    hull.vertices.assign(exact.vertices().begin(), exact.vertices().end());
    hull.centroid = points[hull.vertices.front()];
    return hull;
  }

  const std::vector<std::size_t> distinct = distinct_points(points);
  const Vector3d mean = mean_of(points, distinct);
  Eigen::Matrix3Xd centered(3, distinct.size());
  for (std::size_t k = 0; k < distinct.size(); ++k) {
    centered.col(static_cast<Eigen::Index>(k)) = points[distinct[k]] - mean;
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
  if (hull.rank == 1) {
    make_segment(points, distinct, axes.col(0), hull);
  } else if (is_nearly_flat) {
    std::vector<Vector3d> flat(points.size(), Vector3d::Zero());
    std::vector<Vector3d> projected(points.begin(), points.end());
    for (const std::size_t i : distinct) {
      flat[i] = {points[i].dot(axes.col(0)), points[i].dot(axes.col(1)), 0.0};
      projected[i] -= axes.col(2).dot(points[i] - mean) * axes.col(2);
    }
    std::vector<std::size_t> around = polygon_around(flat, distinct);
    if (around.size() < 3) {  // a needle, once it is projected and rounded
      make_segment(points, distinct, axes.col(0), hull);
    } else {
      make_polygon(projected, std::move(around), hull);
    }
  } else if (hull.rank == 2) {
    make_polygon(points, corners_around(exact), hull);
  } else {
    hull.vertices.assign(exact.vertices().begin(), exact.vertices().end());
    for (Eigen::Index f = 0; f < exact.num_facets(); ++f) {
      const Eigen::Vector3i corners = exact.facets().col(f);
      hull.facets.emplace_back(corners.begin(), corners.end());
    }
    measure_solid(points, exact.volume(), hull);
  }
  return hull;
}

}  // namespace graspfit::geometry
