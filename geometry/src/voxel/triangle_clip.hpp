#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

/// \file
/// A triangle cut by planes, in its barycentric coordinates.
///
/// A plane with the affine function g (inside: g ≥ 0) meets the triangle's plane in the line
/// { λ : G · λ = 0 }, G = (g(v0), g(v1), g(v2)); the triangle's own edges are the lines of the unit
/// vectors. A corner of a cut polygon is where two lines meet: h = A × B up to scale, and oriented
/// so that h0 + h1 + h2 > 0. So each corner *keeps its origin* (the names of its two lines), and
/// the side of a third plane at it is the sign of one determinant det(A, B, G) of numbers that come
/// straight from the input.
///
///     vertex k        lines e_i, e_j      exactly the input
///     edge × plane    lines e_i, G
///     two planes      lines G, G'
///
/// Three stages decide that sign, each where the one before cannot: the distance of the corner's
/// rounded position from the plane, if it exceeds the error bound of the position; the determinant
/// in CGAL's intervals; the determinant in rationals.

namespace graspfit::geometry::internal {

/// A corner of a cut polygon.
struct CutCorner {
  std::uint32_t line_a = 0;  ///< Lines that meet here; h = A × B.
  std::uint32_t line_b = 0;
  std::uint32_t exact_axes = 0;  ///< Bit k: point[k] is exact.
  double lambda_1 = 0.0;         ///< Barycentric coordinates of vertices 1 and 2.
  double lambda_2 = 0.0;
  Eigen::Vector3d point;
};

/// A corner by its name, with the edge from it to the next.
struct CutEdge {
  std::uint32_t corner;
  std::uint32_t edge;  ///< Twice the name of its line, plus one if the polygon is on the line's
                       ///< negative side.
};

/// Counter-clockwise in the order of the triangle; empty if nothing is left.
using CutPolygon = std::vector<CutEdge>;

/// Area and area centroid of a cut polygon.
struct CutMeasure {
  double fraction = 0.0;  ///< Of the triangle's area, > 0 for every polygon that has corners.
  Eigen::Vector3d centroid;
};

/// How often doubles could not decide a sign or compute a corner or an area. Every entry counts,
/// none sums.
struct ClipStatistics {
  std::int64_t signs_by_determinant = 0;  ///< Signs at corners too near the plane to decide by the
                                          ///< rounded corner.
  std::int64_t signs_in_rationals = 0;    ///< Signs of these that intervals do not tell.
  std::int64_t corners_in_rationals = 0;  ///< Corners of cuts too flat for doubles and for long
                                          ///< doubles.
  std::int64_t areas_in_rationals = 0;    ///< Pieces too small for their rounded corners.
};

/// One triangle and the planes that cut it.
///
/// Bounds: signs are exact. Barycentric coordinates are within 2^-44 of their exact values, so that
/// a corner is off its exact position by at most 2^-42 of the longest edge plus two ulps of the
/// largest coordinate. A corner on an axis-aligned plane has that plane's coordinate exactly, and a
/// corner at a vertex of the triangle is exactly that vertex.
class TriangleCutter {
 public:
  TriangleCutter();

  /// Precondition: the corners are not collinear. Forgets corners and planes of the last triangle.
  void reset(const std::array<Eigen::Vector3d, 3>& corners);

  /// The whole triangle.
  void whole(CutPolygon& polygon) const;

  /// Adds the line of the plane normal · p = offset, inside where normal · p ≤ offset. Returns the
  /// line's name. Names are consecutive from 3 on; the names 0 to 2 are those of the triangle's
  /// edges, each the name of the vertex that the edge does not touch.
  std::uint32_t add_plane(const Eigen::Vector3d& normal, double offset);

  /// Adds the line of the plane p[axis] = coordinate, inside where p[axis] ≤ coordinate.
  std::uint32_t add_axis_plane(int axis, double coordinate);

  /// The part of `polygon` inside `line`, and, unless null, the part on its other side; parts
  /// without area are empty. A polygon in the plane goes to the side that `in_plane` names.
  enum class InPlane { Inside, Outside };
  void split(const CutPolygon& polygon, std::uint32_t line, InPlane in_plane, CutPolygon& inside,
             CutPolygon* outside);

  CutMeasure measure(const CutPolygon& polygon);

  const CutCorner& corner(const CutEdge& of) const { return corners_[of.corner]; }

  /// Bound on |point[axis] − exact| of every corner of this triangle.
  double slack(int axis) const { return slack_[axis]; }

  const ClipStatistics& statistics() const { return statistics_; }

 private:
  struct Line {
    std::array<double, 3> value;  // G in doubles,
    std::array<double, 3> size;   // |value − exact| ≤ a few ulps of this, and |value| ≤ this.
    Eigen::Vector3d normal;       // The plane itself;
    double offset = 0.0;
    double slack = 0.0;  // bound on |offset − normal · point| − its exact value at a cut corner.
    int axis = -1;       // The plane's axis if it is axis-aligned,
    int vertex = -1;     // or the index of the unit vector.
  };

  int sign_at(std::uint32_t corner, std::uint32_t line);
  int determinant_sign(const CutCorner& corner, std::uint32_t line);
  std::uint32_t meet(std::uint32_t a, std::uint32_t b);
  void place_on_edge(CutCorner& corner, int vertex, const Line& plane) const;
  void place(CutCorner& corner, const Line& p, const Line& q);
  void place_exactly(CutCorner& corner) const;
  template <typename Number>
  std::array<Number, 3> values_of(std::uint32_t line) const;
  template <typename Number>
  std::array<Number, 3> corner_of(std::uint32_t a, std::uint32_t b) const;
  double exact_fraction(const CutPolygon& polygon) const;

  std::array<Eigen::Vector3d, 3> vertices_;
  Eigen::Vector3d edge_1_;
  Eigen::Vector3d edge_2_;
  Eigen::Vector3d slack_;
  bool is_huge_ = false;  // Differences of coordinates may overflow.
  std::vector<Line> lines_;
  std::vector<CutCorner> corners_;
  std::vector<int> signs_;
  ClipStatistics statistics_;
};

}  // namespace graspfit::geometry::internal
