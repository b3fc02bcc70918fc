#include "graspfit/geometry/convex_polytope.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "graspfit/geometry/errors.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point to_cgal(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// Extreme points of a planar set in counter-clockwise order (Andrew's monotone chain on exact
/// orientation signs); points on edges are dropped.
std::vector<std::size_t> hull_order(const std::vector<Vector2d>& points,
                                    std::vector<std::size_t> order) {
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::tie(points[a].x(), points[a].y(), a) < std::tie(points[b].x(), points[b].y(), b);
  };
  std::sort(order.begin(), order.end(), less);
  const auto turns_left = [&](std::size_t a, std::size_t b, std::size_t c) {
    using P = Kernel::Point_2;
    return CGAL::orientation(P(points[a].x(), points[a].y()), P(points[b].x(), points[b].y()),
                             P(points[c].x(), points[c].y())) == CGAL::LEFT_TURN;
  };
  std::vector<std::size_t> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const std::size_t i : order) {
      while (hull.size() >= base + 2 && !turns_left(hull[hull.size() - 2], hull.back(), i)) {
        hull.pop_back();
      }
      hull.push_back(i);
    }
    hull.pop_back();  // the last point of one chain starts the other
    std::reverse(order.begin(), order.end());
  }
  return hull;
}

/// Area and centroid of a (nearly) planar polygon.
void measure_polygon(std::span<const Vector3d> points, ConvexHull3& hull) {
  const Vector3d& apex = points[hull.vertices.front()];
  Vector3d total = Vector3d::Zero();
  std::vector<std::pair<Vector3d, Vector3d>> triangles;  // vector area, centroid
  for (std::size_t i = 1; i + 1 < hull.vertices.size(); ++i) {
    const Vector3d& b = points[hull.vertices[i]];
    const Vector3d& c = points[hull.vertices[i + 1]];
    triangles.emplace_back(0.5 * (b - apex).cross(c - apex), (apex + b + c) / 3.0);
    total += triangles.back().first;
  }
  const Vector3d normal = total.normalized();
  hull.measure = total.norm();
  hull.centroid.setZero();
  for (const auto& [area, centroid] : triangles) {
    hull.centroid += area.dot(normal) * (centroid - apex);
  }
  hull.centroid = apex + hull.centroid / hull.measure;
}

/// Volume and centroid from tetrahedra with one hull vertex as apex.
void measure_solid(std::span<const Vector3d> points, ConvexHull3& hull) {
  const Vector3d& apex = points[hull.vertices.front()];
  double six_volumes = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (const HullFacet& facet : hull.facets) {
    const Vector3d a = points[facet[0]] - apex;
    const Vector3d b = points[facet[1]] - apex;
    const Vector3d c = points[facet[2]] - apex;
    const double six_volume = a.dot(b.cross(c));
    six_volumes += six_volume;
    moment += six_volume * (a + b + c) / 4.0;
  }
  hull.measure = six_volumes / 6.0;
  hull.centroid = apex + moment / six_volumes;
}

void make_point(std::span<const Vector3d> points, std::size_t index, ConvexHull3& hull) {
  hull.rank = 0;
  hull.vertices = {index};
  hull.centroid = points[index];
}

void make_segment(std::span<const Vector3d> points, const std::vector<std::size_t>& kept,
                  const Vector3d& direction, ConvexHull3& hull) {
  const auto along = [&](std::size_t a, std::size_t b) {
    return points[a].dot(direction) < points[b].dot(direction);
  };
  const auto [low, high] = std::minmax_element(kept.begin(), kept.end(), along);
  hull.rank = 1;
  hull.vertices = {std::min(*low, *high), std::max(*low, *high)};
  hull.measure = (points[*high] - points[*low]).norm();
  hull.centroid = 0.5 * (points[*low] + points[*high]);
}

void make_polygon(std::span<const Vector3d> points, const std::vector<std::size_t>& kept,
                  const Vector3d& axis_x, const Vector3d& axis_y, ConvexHull3& hull) {
  std::vector<Vector2d> flat(points.size(), Vector2d::Zero());
  for (const std::size_t i : kept) flat[i] = {points[i].dot(axis_x), points[i].dot(axis_y)};
  hull.rank = 2;
  hull.vertices = hull_order(flat, kept);
  hull.facets = {hull.vertices};
  measure_polygon(points, hull);
}

void make_polyhedron(std::span<const Vector3d> points, const std::vector<std::size_t>& kept,
                     ConvexHull3& hull) {
  std::vector<Point> input;
  std::map<std::tuple<double, double, double>, std::size_t> index_of;
  for (const std::size_t i : kept) {
    input.push_back(to_cgal(points[i]));
    // + 0.0 makes both zeros one key.
    index_of.emplace(std::make_tuple(points[i].x() + 0.0, points[i].y() + 0.0, points[i].z() + 0.0),
                     i);
  }
  CGAL::Surface_mesh<Point> mesh;
  CGAL::convex_hull_3(input.begin(), input.end(), mesh);
  const auto index = [&](const auto& vertex) {
    const Point& p = mesh.point(vertex);
    return index_of.at(std::make_tuple(p.x() + 0.0, p.y() + 0.0, p.z() + 0.0));
  };
  hull.rank = 3;
  for (const auto vertex : mesh.vertices()) hull.vertices.push_back(index(vertex));
  std::sort(hull.vertices.begin(), hull.vertices.end());
  for (const auto face : mesh.faces()) {
    HullFacet facet;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
      facet.push_back(index(vertex));
    }
    // The same facet whatever half-edge CGAL starts from.
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    hull.facets.push_back(std::move(facet));
  }
  std::sort(hull.facets.begin(), hull.facets.end());
  measure_solid(points, hull);
}

/// Exact dimension of the span; `first` is kept[0], and on return `second`, `third` are affinely
/// independent of it as far as the rank goes.
int exact_rank(std::span<const Vector3d> points, const std::vector<std::size_t>& kept,
               std::size_t& second, std::size_t& third) {
  const Point a = to_cgal(points[kept.front()]);
  const auto b = std::find_if(kept.begin(), kept.end(),
                              [&](std::size_t i) { return to_cgal(points[i]) != a; });
  if (b == kept.end()) return 0;
  second = *b;
  const Point pb = to_cgal(points[second]);
  const auto c = std::find_if(kept.begin(), kept.end(), [&](std::size_t i) {
    return !CGAL::collinear(a, pb, to_cgal(points[i]));
  });
  if (c == kept.end()) return 1;
  third = *c;
  const Point pc = to_cgal(points[third]);
  const bool is_flat = std::all_of(kept.begin(), kept.end(), [&](std::size_t i) {
    return CGAL::coplanar(a, pb, pc, to_cgal(points[i]));
  });
  return is_flat ? 2 : 3;
}

}  // namespace

ConvexHull3 convex_hull(std::span<const Vector3d> points, const HullOptions& options) {
  for (const double value : {options.collinear_rel, options.planar_rel, options.merge_distance}) {
    if (!(value >= 0.0)) {
      throw InvalidInput("convex_hull: thresholds must be >= 0, one is " + std::to_string(value));
    }
  }
  ConvexHull3 hull;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw InvalidInput("convex_hull: point " + std::to_string(i) + " is not finite");
    }
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](std::size_t k) {
      return points[k] == points[i] || (points[k] - points[i]).norm() < options.merge_distance;
    });
    if (is_new) kept.push_back(i);
  }
  if (kept.empty()) return hull;
  if (kept.size() == 1) {
    make_point(points, kept.front(), hull);
    return hull;
  }

  Vector3d mean = Vector3d::Zero();
  for (const std::size_t i : kept) mean += points[i];
  mean /= static_cast<double>(kept.size());
  Eigen::Matrix3Xd centered(3, kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    centered.col(static_cast<Eigen::Index>(k)) = points[kept[k]] - mean;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(centered, Eigen::ComputeFullU);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Matrix3d axes = svd.matrixU();
  const auto range = [&](int axis) {
    const Eigen::RowVectorXd along = axes.col(axis).transpose() * centered;
    return along.maxCoeff() - along.minCoeff();
  };

  std::size_t second = 0;
  std::size_t third = 0;
  int rank = exact_rank(points, kept, second, third);
  const double spread = values.size() > 1 ? values[1] : 0.0;
  if (rank >= 2 && spread < options.collinear_rel * values[0]) rank = 1;
  const bool is_nearly_flat = rank == 3 && range(2) < options.planar_rel * range(0);
  if (rank == 1) {
    make_segment(points, kept, axes.col(0), hull);
  } else if (is_nearly_flat) {
    make_polygon(points, kept, axes.col(0), axes.col(1), hull);
  } else if (rank == 2) {
    // Leaving out the coordinate along which the plane is steepest keeps exact decisions exact.
    const Vector3d normal =
        (points[second] - points[kept.front()]).cross(points[third] - points[kept.front()]);
    Eigen::Index dropped = 0;
    normal.cwiseAbs().maxCoeff(&dropped);
    make_polygon(points, kept, Vector3d::Unit((dropped + 1) % 3), Vector3d::Unit((dropped + 2) % 3),
                 hull);
  } else {
    make_polyhedron(points, kept, hull);
  }
  return hull;
}

}  // namespace graspfit::geometry
