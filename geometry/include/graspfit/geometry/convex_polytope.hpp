#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry {

namespace internal {
struct PolytopeData;
}

/// The convex hull of points in 2 to 6 dimensions: rank, extreme points, facets, volume, and
/// questions about other points.
///
/// Rank, extreme points, the set of facets, `containment` and the sign of `inradius` are exact (the
/// last for points that are larger than 1e-300): they are the answer of real arithmetic on the
/// given doubles. Normals, offsets, volume and
/// distances are rounded, to about 1e-15 in ordinary cases and 1e-10 relative in any.
///
/// Points that span less than the space have a hull within their affine span, and everything here
/// is about that hull: facets have `rank` corners, and their normals lie along the span. Such a
/// hull has no volume and no inside: all of it is boundary.
///
/// Facets are simplices. Where more than `rank` extreme points lie in one facet's plane, that facet
/// is given as several simplices. Except for indices the result does not depend on the order of the
/// points; of equal points the first counts.
///
/// The cost is governed by the number of facets, which grows as n^⌊d/2⌋ for n points in d
/// dimensions: 40 points in 6-D have some thousands of facets. Copies share the data; all members
/// are const and safe to call from several threads.
class ConvexPolytope {
 public:
  /// Hull of the columns of `points`, with one coordinate per row. Any number of columns is
  /// allowed; without columns the rank is −1. @throws InvalidInput unless there are 2 to 6 rows,
  /// all finite.
  explicit ConvexPolytope(const Eigen::Ref<const Eigen::MatrixXd>& points);

  int dimension() const;  ///< Dimension of the space.
  int rank() const;  ///< Dimension of the points' affine span: −1 no points, 0 one, 1 a line, ...
                     ///< Exact.
  const Eigen::MatrixXd& points() const;

  /// Indices of the extreme points, ascending: those that are not in the hull of the others. Exact.
  const std::vector<int>& vertices() const;

  /// The boundary as a matrix of `rank` rows, whose columns hold the corners of one facet each; all
  /// corners are extreme points. The matrix is empty below rank 1. Its columns are in lexicographic
  /// order. Corners ascend, but the last two are swapped where that is needed for
  ///
  ///     det(p_1 − p_0, …, p_{d−1} − p_0, outward normal) > 0
  ///
  /// at full rank: counter-clockwise from outside in the plane and in space.
  const Eigen::MatrixXi& facets() const;
  int num_facets() const { return static_cast<int>(facets().cols()); }

  /// For each corner of each facet the neighboring facet beyond the ridge opposite to that corner.
  const Eigen::MatrixXi& neighbors() const;

  /// Outward unit normals, one per column, and offsets [unit of the coordinates]: a point x of the
  /// hull has normal · x ≤ offset. Rounded.
  const Eigen::MatrixXd& normals() const;
  const Eigen::VectorXd& offsets() const;

  /// Volume in the dimension of the space; 0 if the rank is lower. Rounded.
  double volume() const;

  /// Volume in the span: length, area, ... by rank; 0 below rank 1. Rounded.
  double measure() const;

  /// Where a point lies; never `Inside` if the rank is lower than the dimension. Exact.
  /// @throws InvalidInput unless `point` has `dimension()` coordinates, all finite; `inradius`
  /// throws likewise.
  Containment containment(const Eigen::Ref<const Eigen::VectorXd>& point) const;

  /// Distance from a point to the nearest facet: the radius of the largest ball around the point
  /// that lies in the polytope. The sign is exact, the magnitude rounded:
  ///
  ///     > 0   strictly inside, however little
  ///     0     on the boundary, so anywhere on a hull of lower rank
  ///     < 0   outside: minus the largest distance to a facet's plane that separates the point, or
  ///           to the span; the distance to the polytope is at least that. −∞ without points
  double inradius(const Eigen::Ref<const Eigen::VectorXd>& point) const;

 private:
  std::shared_ptr<const internal::PolytopeData> data_;
};

}  // namespace graspfit::geometry
