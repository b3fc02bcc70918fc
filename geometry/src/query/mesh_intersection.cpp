#include "graspfit/geometry/mesh_intersection.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "exact/predicates.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "mesh/input_check.hpp"
#include "query/box_tree.hpp"
#include "query/indexed_mesh.hpp"
#include "query/winding.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::BoxTree;
using internal::Corners;
using internal::IndexedTriangle;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A box in frame A that holds a node of B's tree, rounding included.
struct SeenBox {
  Vector3d lower;
  Vector3d upper;
};

/// Rounding of what is mapped from one frame to another, over the sum of all coordinates involved:
/// 90 times u = 2^-53.
constexpr double kMappedRounding = 1e-14;

SeenBox seen_from(const Eigen::AlignedBox3d& box, const RigidTransform& X_AB, double slack) {
  const Vector3d center = X_AB * Vector3d(0.5 * (box.min() + box.max()));
  const Vector3d half = X_AB.linear().cwiseAbs() * Vector3d(0.5 * (box.max() - box.min()));
  const Vector3d reach = half.array() + slack;
  return {center - reach, center + reach};
}

double sum_of_coordinates(const Eigen::AlignedBox3d& box) {
  return box.min().cwiseAbs().sum() + box.max().cwiseAbs().sum();
}

double sum_of_coordinates(const RigidTransform& X) { return X.translation().cwiseAbs().sum(); }

/// A box of things that are mapped as it is: center, half the size, their sum and the things
/// themselves are off by 10 u of those coordinates in all.
SeenBox seen_from(const Eigen::AlignedBox3d& box, const RigidTransform& X_AB) {
  return seen_from(box, X_AB,
                   kMappedRounding * (sum_of_coordinates(box) + sum_of_coordinates(X_AB)));
}

Eigen::AlignedBox3d box_of(const BoxTree::Node& node) { return {node.lower, node.upper}; }

bool overlap(const Vector3d& lower_a, const Vector3d& upper_a, const SeenBox& b) {
  return (lower_a.array() <= b.upper.array()).all() && (b.lower.array() <= upper_a.array()).all();
}

Corners mapped(const Corners& corners, const RigidTransform& X_AB) {
  return {X_AB * corners[0], X_AB * corners[1], X_AB * corners[2]};
}

Kernel::Triangle_3 to_cgal(const Corners& c) {
  const auto point = [](const Vector3d& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  return {point(c[0]), point(c[1]), point(c[2])};
}

/// Whether two faces intersect. Exact. Degenerate faces bound nothing that their neighbors do not,
/// and CGAL's test needs proper triangles, so that they are left out.
bool triangles_intersect(const Corners& a, const Corners& b) {
  if (!internal::box_of(a).intersects(internal::box_of(b))) return false;
  if (internal::is_beside(a, b) || internal::is_beside(b, a)) return false;
  const Kernel::Triangle_3 first = to_cgal(a);
  const Kernel::Triangle_3 second = to_cgal(b);
  return !first.is_degenerate() && !second.is_degenerate() && CGAL::do_intersect(first, second);
}

/// The inverse of a pose whose rotation matrix may be orthogonal only up to the digits of a file,
/// so that the inverse of the matrix is not its transpose.
RigidTransform inverse_of(const RigidTransform& X_AB) {
  RigidTransform X_BA = RigidTransform::Identity();
  X_BA.linear() = X_AB.linear().inverse();
  X_BA.translation() = -(X_BA.linear() * X_AB.translation());
  return X_BA;
}

/// Whether the surfaces share a point.
///
/// Two boxes are passed over if they are apart along the axes of either frame: seen from one frame
/// alone, turned boxes are so much larger that ten times as many pairs are looked at near a touch.
///
/// The slack is a share of the coordinates of both roots and of both translations. What is seen
/// from B is off by that share, too: B's vertices in A by 7 u, the inverse by 11 u an entry, its
/// translation by 14 u, and the box by 5 u, in all by 17 u of the 90 u of the slack.
bool surfaces_intersect(const BoxTree& a, const BoxTree& b, const RigidTransform& X_AB) {
  const RigidTransform X_BA = inverse_of(X_AB);
  const double slack = kMappedRounding * (sum_of_coordinates(box_of(a.nodes[0])) +
                                          sum_of_coordinates(box_of(b.nodes[0])) +
                                          sum_of_coordinates(X_AB) + sum_of_coordinates(X_BA));
  std::vector<std::pair<std::int32_t, std::int32_t>> open = {{0, 0}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    const BoxTree::Node& node_a = a.nodes[i];
    const BoxTree::Node& node_b = b.nodes[j];
    if (!overlap(node_a.lower, node_a.upper, seen_from(box_of(node_b), X_AB, slack))) continue;
    if (!overlap(node_b.lower, node_b.upper, seen_from(box_of(node_a), X_BA, slack))) continue;
    const bool is_leaf_a = node_a.count > 0;
    const bool is_leaf_b = node_b.count > 0;
    if (is_leaf_a && is_leaf_b) {
      for (std::int32_t t = 0; t < node_b.count; ++t) {
        const Corners triangle_b = mapped(b.triangles[node_b.first + t].corners, X_AB);
        for (std::int32_t s = 0; s < node_a.count; ++s) {
          if (triangles_intersect(a.triangles[node_a.first + s].corners, triangle_b)) return true;
        }
      }
      continue;
    }
    const bool split_a =
        !is_leaf_a && (is_leaf_b || (node_a.upper - node_a.lower).squaredNorm() >=
                                        (node_b.upper - node_b.lower).squaredNorm());
    if (split_a) {
      open.emplace_back(i + 1, j);
      open.emplace_back(node_a.first, j);
    } else {
      open.emplace_back(i, j + 1);
      open.emplace_back(i, node_b.first);
    }
  }
  return false;
}

/// Containment in a mesh whose vertices are mapped by X_AB and rounded. Exact.
Containment placed_containment(const MeshQuery& b, const RigidTransform& X_AB,
                               const Vector3d& point_A) {
  internal::Winding winding(point_A);
  b.indexed().tree().traverse(
      [&](const Eigen::AlignedBox3d& of_faces) {
        const SeenBox box = seen_from(of_faces, X_AB);
        return winding.may_meet(box.lower, box.upper);
      },
      [&](const IndexedTriangle& triangle) { winding.add(mapped(triangle.corners, X_AB)); });
  return winding.result();
}

/// Whether some part of another mesh, whose surface does not cross that of `outer`, lies inside
/// `outer`; `part_points` has a point of each part, in the frame of `outer`.
bool holds_a_part(const MeshQuery& outer, const std::vector<Vector3d>& part_points) {
  return std::any_of(part_points.begin(), part_points.end(), [&](const Vector3d& point) {
    return outer.indexed().box.contains(point) && outer.containment(point) != Containment::Outside;
  });
}

std::vector<Vector3d> part_points(const MeshQuery& query, const RigidTransform& X) {
  std::vector<Vector3d> points;
  for (const std::int32_t vertex : query.indexed().part_vertices) {
    points.push_back(X * query.mesh().vertices[vertex]);
  }
  return points;
}

/// By how much a matrix may lengthen a vector, at most: 1 for a rotation, more where its numbers
/// have few digits. Norms of rows and columns bound it; rounding takes 8 u, and 90 u are added.
double largest_stretch(const Eigen::Matrix3d& matrix) {
  const double of_columns = matrix.cwiseAbs().colwise().sum().maxCoeff();
  const double of_rows = matrix.cwiseAbs().rowwise().sum().maxCoeff();
  const double from_norms = std::sqrt(of_columns * of_rows);
  // Of a matrix near a rotation this is nearer: the square of the largest singular value.
  const double from_gram =
      std::sqrt(1.0 + (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm());
  return std::min(from_norms, from_gram) * (1.0 + 1e-14);
}

/// Best-first search for the point of one surface that is deepest inside another solid.
class DeepestPoint {
 public:
  /// Points that are not deeper than `depth_known` are not searched for.
  DeepestPoint(const MeshQuery& solid, const RigidTransform& X_solid_surface,
               const PenetrationOptions& options, double depth_known = 0.0)
      : depth(depth_known),
        solid_(solid),
        X_(X_solid_surface),
        stretch_(largest_stretch(X_solid_surface.linear())),
        tolerance_(options.tolerance),
        enough_(options.enough) {}

  double depth;                       ///< Depth of the deepest point found.
  double bound = 0.0;                 ///< No point is deeper.
  Vector3d point = Vector3d::Zero();  ///< In the solid's frame.

  void search(const BoxTree& surface) {
    push_node(surface, 0, 0);
    // Equally deep triangles over a wide flat overlap would be cut forever; the bound stays valid
    // when the search ends early.
    constexpr int kLargestWork = 50000;
    for (int work = 0; work < kLargestWork && !open_.empty(); ++work) {
      if (open_.top().bound <= depth + tolerance_ || depth > enough_) break;
      const Item item = open_.top();
      open_.pop();
      if (item.node >= 0) {
        const BoxTree::Node& node = surface.nodes[item.node];
        if (node.count == 0) {
          push_node(surface, item.node + 1, item.face);
          push_node(surface, node.first, item.face);
        } else {
          for (std::int32_t t = 0; t < node.count; ++t) {
            push_triangle(mapped(surface.triangles[node.first + t].corners, X_), item.face);
          }
        }
      } else if (!split_along_face(item)) {
        for (const Corners& quarter : internal::quarters_of(item.corners)) {
          push_triangle(quarter, item.face);
        }
      }
    }
    bound = std::max(depth, open_.empty() ? 0.0 : open_.top().bound);
  }

 private:
  struct Item {
    double bound;
    std::int32_t node;  ///< −1 for a triangle.
    Corners corners;    ///< In the solid's frame.
    std::int32_t face;  ///< Of the solid, nearest to the middle of the triangle or node.
    bool operator<(const Item& other) const { return bound < other.bound; }
  };

  inline static const Corners kNoCorners = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};

  void push(double item_bound, std::int32_t node, const Corners& corners, std::int32_t face) {
    if (item_bound > depth) open_.push({item_bound, node, corners, face});
  }

  /// `near_face` is one of the solid that may be near, as for triangles.
  void push_node(const BoxTree& surface, std::int32_t index, std::int32_t near_face) {
    const BoxTree::Node& node = surface.nodes[index];
    const SeenBox box = seen_from(box_of(node), X_);
    const Eigen::AlignedBox3d& solid_box = solid_.indexed().box;
    // A point deeper than `depth` lies at least that far inside the solid's box.
    const Vector3d inset = Vector3d::Constant(depth);
    if (!overlap(solid_box.min() + inset, solid_box.max() - inset, box)) return;
    const Vector3d center = 0.5 * (box.lower + box.upper);
    const double radius = 0.5 * stretch_ * (node.upper - node.lower).norm();
    const ClosestPoint closest = solid_.closest_point(center, near_face);
    const double distance = std::sqrt(closest.squared_distance);
    // The distance to a surface is 1-Lipschitz.
    if (radius + distance <= depth) return;
    const double most =
        solid_.containment(center) == Containment::Inside ? radius + distance : radius - distance;
    push(most, index, kNoCorners, closest.face);
  }

  void push_triangle(const Corners& corners, std::int32_t near_face) {
    const Vector3d center = (corners[0] + corners[1] + corners[2]) / 3.0;
    double radius = 0.0;
    for (const Vector3d& corner : corners) radius = std::max(radius, (corner - center).norm());
    const ClosestPoint closest = solid_.closest_point(center, near_face);
    const double distance = std::sqrt(closest.squared_distance);
    // A point outside is at most `radius` − distance deep anywhere on the triangle.
    if (radius + distance <= depth) return;
    // No point is farther from the surface than from the face nearest to the center, and the
    // distance to this face, which is convex, is largest at a corner.
    const Corners face = geometry::corners(solid_.mesh(), closest.face);
    double to_face = 0.0;
    for (const Vector3d& corner : corners) {
      to_face = std::max(to_face, (corner - internal::closest_on_triangle(corner, face)).norm());
    }
    if (to_face <= depth) return;
    const bool is_inside = solid_.containment(center) == Containment::Inside;
    if (is_inside && distance > depth) {
      depth = distance;
      point = center;
    }
    const double most = std::min(to_face, is_inside ? radius + distance : radius - distance);
    if (most > depth + tolerance_ && !is_inside && stays_outside(corners)) return;
    push(most, -1, corners, closest.face);
  }

  /// Whether a triangle whose middle is outside the solid does not enter the solid: to enter, it
  /// would have to pass through the plane of a face near it, but it lies on one side of each of
  /// these planes. This settles at once triangles that touch the solid from outside along an edge
  /// or a face. False decides nothing.
  ///
  /// Corners count as on a plane up to a slack, since those that do lie on it are rounded. So a
  /// triangle that stays outside may dip into the solid by twice the slack, which `bound` does not
  /// contain: a larger slack settles more triangles, and is less safe.
  bool stays_outside(const Corners& corners) const {
    const Eigen::AlignedBox3d& whole = solid_.indexed().box;
    const double slack = 1e-12 * whole.diagonal().norm() +
                         1e-15 * whole.min().cwiseAbs().cwiseMax(whole.max().cwiseAbs()).maxCoeff();
    Eigen::AlignedBox3d box(corners[0]);
    box.extend(corners[1]).extend(corners[2]);
    box.min().array() -= slack;
    box.max().array() += slack;
    bool stays = true;
    const auto enter = [&](const Eigen::AlignedBox3d& of_faces) {
      return stays && box.intersects(of_faces);
    };
    solid_.indexed().tree().traverse(enter, [&](const IndexedTriangle& triangle) {
      if (!box.intersects(internal::box_of(triangle.corners))) return;
      const Corners& face = triangle.corners;
      const Vector3d ab = face[1] - face[0];
      const Vector3d ac = face[2] - face[0];
      const Vector3d vector = ab.cross(ac);
      const double squared_edge = std::max(ab.squaredNorm(), ac.squaredNorm());
      // The normal is off by up to 14 u times an edge squared, over its length. A face thinner than
      // a thousandth has none that is good to 1.6e-12, and decides nothing; one without area bounds
      // nothing that its neighbors do not.
      if (!(vector.squaredNorm() > 1e-6 * squared_edge * squared_edge)) {
        stays = stays && internal::are_collinear(face[0], face[1], face[2]);
        return;
      }
      const Vector3d normal = vector.normalized();
      bool is_above = false;
      bool is_below = false;
      for (const Vector3d& corner : corners) {
        const double height = normal.dot(corner - face[0]);
        is_above = is_above || height > slack;
        is_below = is_below || height < -slack;
      }
      stays = stays && !(is_above && is_below);
    });
    return stays;
  }

  /// Cuts a triangle where it leaves the prism over a face of the solid on which it nearly lies:
  /// the part over the face is then at once known to be no deeper than its height over the face,
  /// whereas quarters would have to become as small as the tolerance all along the edge. False if
  /// no such cut applies.
  bool split_along_face(const Item& item) {
    const Corners face = geometry::corners(solid_.mesh(), item.face);
    const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
    for (const Vector3d& corner : item.corners) {
      // Also refuses faces without a normal.
      if (!(std::abs(normal.dot(corner - face[0])) <= depth + tolerance_)) return false;
    }
    double farthest = 0.0;
    std::array<double, 3> beyond{};
    for (int edge = 0; edge < 3; ++edge) {
      const Vector3d along = face[(edge + 1) % 3] - face[edge];
      const Vector3d outward = along.cross(normal).normalized();
      std::array<double, 3> side;
      for (int i = 0; i < 3; ++i) side[i] = outward.dot(item.corners[i] - face[edge]);
      const auto [least, most] = std::minmax_element(side.begin(), side.end());
      // A cut that would leave a sliver is not made.
      if (-*least <= 1e-3 * *most || *most <= 1e-3 * -*least || *most <= farthest) continue;
      farthest = *most;
      beyond = side;
    }
    if (farthest == 0.0) return false;
    for (const double sign : {1.0, -1.0}) {
      std::array<Vector3d, 4> part;
      int size = 0;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (sign * beyond[i] >= 0.0) part[size++] = item.corners[i];
        if (beyond[i] * beyond[j] < 0.0) {
          part[size++] = item.corners[i] +
                         beyond[i] / (beyond[i] - beyond[j]) * (item.corners[j] - item.corners[i]);
        }
      }
      for (int i = 2; i < size; ++i) {
        push_triangle({part[0], part[i - 1], part[i]}, item.face);
      }
    }
    return true;
  }

  const MeshQuery& solid_;
  const RigidTransform X_;
  const double stretch_;  ///< By how much X_ may lengthen a vector of the surface.
  const double tolerance_;
  const double enough_;
  std::priority_queue<Item> open_;
};

}  // namespace

void PenetrationOptions::validate() const {
  base::require(tolerance > 0.0 && std::isfinite(tolerance), "PenetrationOptions", "tolerance",
                tolerance, "finite and > 0 m");
  base::require(enough >= 0.0, "PenetrationOptions", "enough", enough, ">= 0 m");
}

bool do_intersect(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB) {
  internal::require_finite(X_AB, "do_intersect");
  const SeenBox box_b = seen_from(b.indexed().box, X_AB);
  const Eigen::AlignedBox3d& box_a = a.indexed().box;
  if (!overlap(box_a.min(), box_a.max(), box_b)) return false;
  if (surfaces_intersect(a.indexed().pair_tree(), b.indexed().pair_tree(), X_AB)) return true;
  if (holds_a_part(a, part_points(b, X_AB))) return true;
  const std::vector<Vector3d> points_a = part_points(a, RigidTransform::Identity());
  return std::any_of(points_a.begin(), points_a.end(), [&](const Vector3d& point_A) {
    return overlap(point_A, point_A, box_b) &&
           placed_containment(b, X_AB, point_A) != Containment::Outside;
  });
}

Penetration penetration(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB,
                        const PenetrationOptions& options) {
  options.validate();
  Penetration result;
  result.intersects = do_intersect(a, b, X_AB);
  if (!result.intersects) return result;
  DeepestPoint in_a(a, X_AB, options);
  in_a.search(b.indexed().pair_tree());
  // Where one direction is deep enough, the other is bounded, not searched.
  DeepestPoint in_b(b, inverse_of(X_AB), options, in_a.depth > options.enough ? in_a.depth : 0.0);
  in_b.search(a.indexed().pair_tree());
  const bool is_in_a = in_a.depth >= in_b.depth;
  result.depth = std::max(in_a.depth, in_b.depth);
  result.depth_bound = std::max(in_a.bound, in_b.bound);
  result.deepest_point_A = is_in_a ? in_a.point : Vector3d(X_AB * in_b.point);
  return result;
}

DepthBounds depth_above(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB,
                        double floor, const PenetrationOptions& options) {
  options.validate();
  base::require(floor >= 0.0 && std::isfinite(floor), "depth_above", "floor", floor,
                "finite and >= 0 m");
  internal::require_finite(X_AB, "depth_above");
  DeepestPoint in_a(a, X_AB, options, floor);
  in_a.search(b.indexed().pair_tree());
  DeepestPoint in_b(b, inverse_of(X_AB), options, in_a.depth);
  in_b.search(a.indexed().pair_tree());
  return {in_b.depth > floor ? in_b.depth : 0.0, std::max(in_a.bound, in_b.bound)};
}

MeshDistance distance(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB) {
  const MeshDistance none{0.0, Vector3d::Zero(), Vector3d::Zero()};
  if (do_intersect(a, b, X_AB)) return none;
  const std::optional<SurfaceProximity> nearest =
      nearest_points(a, b, X_AB, std::numeric_limits<double>::infinity());
  if (!nearest) throw base::InvalidInput("distance: the solids are too far apart to be squared");
  return {nearest->distance, nearest->point_on_a_A, nearest->point_on_b_A};
}

}  // namespace graspfit::geometry
