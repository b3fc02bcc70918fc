#include "quality/regularity.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/option_check.hpp"

namespace graspfit::contact {
namespace internal {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

constexpr double kSmallestRegularity = 1e-3;              // R stays in (0, 1]: collinear contacts
constexpr double kCoplanarAngle = std::numbers::pi / 36;  // 5°: hull triangles of one face
// A triangle this much thinner than long has a normal made of rounding errors.
constexpr double kSliverRel = 1e-9;

/// Angle regularity 1 − Q of a polygon seen along `normal`, counter-clockwise or clockwise alike:
///   θ̄ = π (n − 2) / n,   Q = Σ |θ_i − θ̄| / ((n − 2)(π − θ̄) + 2 θ̄)
/// The divisor is the sum when the polygon collapses to a line: two angles 0, all others π.
double angle_regularity(const Polygon& polygon, const Vector3d& normal) {
  const std::size_t n = polygon.size();
  const double mean = std::numbers::pi * static_cast<double>(n - 2) / static_cast<double>(n);
  const double collapsed = static_cast<double>(n - 2) * (std::numbers::pi - mean) + 2.0 * mean;
  double deviation = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d to_next = polygon[(i + 1) % n] - polygon[i];
    const Vector3d to_previous = polygon[(i + n - 1) % n] - polygon[i];
    // Seen along the normal, so that the angles of a slightly bent polygon still add up.
    const double sine = normal.dot(to_next.cross(to_previous));
    const double cosine = to_next.dot(to_previous) - normal.dot(to_next) * normal.dot(to_previous);
    double angle = std::atan2(sine, cosine);
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;  // a corner bent inward by merging
    deviation += std::abs(angle - mean);
  }
  return std::max(0.0, 1.0 - deviation / collapsed);
}

/// Shortest and longest of the edges seen so far.
struct EdgeRange {
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0.0;

  void add(double length) {
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  double ratio() const { return longest > 0.0 ? shortest / longest : 0.0; }
};

struct RegularityTerms {
  double angles = 0.0;
  double edges = 0.0;
};

/// Normal of the plane that fits `points` best.
Vector3d best_fit_normal(const std::vector<Vector3d>& points) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vector3d& point : points) covariance += (point - mean) * (point - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

RegularityTerms planar_regularity(const ContactHull& contacts) {
  Vector3d normal = best_fit_normal(contacts.points);
  Polygon polygon;
  for (const std::size_t vertex : contacts.hull.vertices)
    polygon.push_back(contacts.points[vertex]);
  Vector3d twice_area = Vector3d::Zero();
  EdgeRange edges;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    twice_area += (polygon[i] - polygon[0]).cross(edge);
    edges.add((edge - normal.dot(edge) * normal).norm());
  }
  if (normal.dot(twice_area) < 0.0) normal = -normal;
  return {angle_regularity(polygon, normal), edges.ratio()};
}

/// Triangles of a hull in groups that are one flat face each.
class HullFaces {
 public:
  HullFaces(const std::vector<Vector3d>& points, const std::vector<geometry::HullFacet>& facets)
      : points_(points), facets_(facets), groups_(facets.size()) {
    for (std::size_t f = 0; f < facets.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) facet_of_edge_[edge(f, i)] = f;
    }
    base::DisjointSets sets(facets.size());
    const auto unite = [&sets](std::size_t f, std::size_t neighbor) {
      sets.unite(base::as_index<std::int32_t>(f), base::as_index<std::int32_t>(neighbor));
    };
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const std::optional<Vector3d> normal = unit_normal(f);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t neighbor = across(f, i);
        if (!normal) {
          if (i == longest_edge(f)) unite(f, neighbor);
        } else if (const std::optional<Vector3d> other = unit_normal(neighbor);
                   other &&
                   std::atan2(normal->cross(*other).norm(), normal->dot(*other)) < kCoplanarAngle) {
          unite(f, neighbor);
        }
      }
    }
    for (std::int32_t f = 0; f < std::ssize(facets); ++f) {
      groups_[f] = sets.root(f);
    }
    split_groups_without_outline();
  }

  RegularityTerms regularity() const {
    double angles = 0.0;
    int num_faces = 0;
    EdgeRange edges;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (groups_[across(f, i)] == groups_[f]) continue;
        const auto [a, b] = edge(f, i);
        edges.add((points_[a] - points_[b]).norm());
      }
      if (groups_[f] != f) continue;  // a face is counted at the triangle that names its group
      const std::optional<std::vector<std::size_t>> corners = outline(f);
      assert(corners);
      Polygon polygon;
      for (const std::size_t vertex : *corners) polygon.push_back(points_[vertex]);
      Vector3d area = Vector3d::Zero();
      for (std::size_t g = 0; g < facets_.size(); ++g) {
        if (groups_[g] == f) area += twice_vector_area(g);
      }
      angles += angle_regularity(polygon, area.normalized());
      ++num_faces;
    }
    return {angles / num_faces, edges.ratio()};
  }

 private:
  using Edge = std::pair<std::size_t, std::size_t>;

  Edge edge(std::size_t facet, std::size_t i) const {
    return {facets_[facet][i], facets_[facet][(i + 1) % 3]};
  }
  std::size_t across(std::size_t facet, std::size_t i) const {
    const auto [a, b] = edge(facet, i);
    return facet_of_edge_.at({b, a});
  }
  Vector3d twice_vector_area(std::size_t facet) const {
    const Vector3d& a = points_[facets_[facet][0]];
    return (points_[facets_[facet][1]] - a).cross(points_[facets_[facet][2]] - a);
  }
  std::size_t longest_edge(std::size_t facet) const {
    std::size_t longest = 0;
    double squared_length = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = edge(facet, i);
      if (const double s = (points_[a] - points_[b]).squaredNorm(); s > squared_length) {
        squared_length = s;
        longest = i;
      }
    }
    return longest;
  }
  /// Returns the unit normal of a triangle; empty for a sliver.
  std::optional<Vector3d> unit_normal(std::size_t facet) const {
    const auto [a, b] = edge(facet, longest_edge(facet));
    const Vector3d area = twice_vector_area(facet);
    if (!(area.norm() > kSliverRel * (points_[a] - points_[b]).squaredNorm())) return std::nullopt;
    return area.normalized();
  }

  /// Corners around the group that `name` names; empty unless they form one simple loop.
  std::optional<std::vector<std::size_t>> outline(std::size_t name) const {
    std::map<std::size_t, std::size_t> next;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (groups_[f] != name) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (groups_[across(f, i)] == name) continue;
        const auto [a, b] = edge(f, i);
        if (!next.emplace(a, b).second) return std::nullopt;
      }
    }
    if (next.size() < 3) return std::nullopt;
    std::vector<std::size_t> loop;
    std::size_t vertex = next.begin()->first;
    do {
      loop.push_back(vertex);
      vertex = next.at(vertex);
    } while (vertex != loop.front() && loop.size() <= next.size());
    if (loop.size() != next.size()) return std::nullopt;
    return loop;
  }

  /// A chain of small angles can wrap a group around a rounded hull. Such a group is split: each of
  /// its triangles becomes a face of its own.
  void split_groups_without_outline() {
    const std::vector<std::size_t> merged = groups_;
    for (std::size_t name = 0; name < facets_.size(); ++name) {
      if (merged[name] != name || outline(name)) continue;
      for (std::size_t f = 0; f < facets_.size(); ++f) {
        if (merged[f] == name) groups_[f] = f;
      }
    }
  }

  const std::vector<Vector3d>& points_;
  const std::vector<geometry::HullFacet>& facets_;
  std::vector<std::size_t> groups_;  // per triangle: the smallest triangle of its face
  std::map<Edge, std::size_t> facet_of_edge_;
};

double combined(const RegularityTerms& terms, Regularity definition) {
  switch (definition) {
    case Regularity::AngleOnly:
      return terms.angles;
    case Regularity::EdgeOnly:
      return terms.edges;
    case Regularity::Combined:
      break;
  }
  return std::sqrt(terms.angles * terms.edges);
}

}  // namespace

double regularity(const ContactHull& contacts, Regularity definition) {
  if (contacts.num_contacts < 2) return 0.0;
  if (contacts.num_contacts == 2) return 1.0;
  switch (contacts.hull.rank) {
    case 2:
      return std::max(kSmallestRegularity, combined(planar_regularity(contacts), definition));
    case 3:
      return std::max(
          kSmallestRegularity,
          combined(HullFaces(contacts.points, contacts.hull.facets).regularity(), definition));
    default:
      return kSmallestRegularity;
  }
}

}  // namespace internal

double regularity(std::span<const Eigen::Vector3d> points, Regularity definition,
                  double merge_distance) {
  base::require(merge_distance >= 0.0 && std::isfinite(merge_distance), "regularity",
                "merge_distance", merge_distance, "finite and at least 0");
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite()) {
      throw base::InvalidInput("regularity: a point has a coordinate that is not finite");
    }
  }
  return internal::regularity(internal::contact_hull(points, merge_distance), definition);
}

}  // namespace graspfit::contact
