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
/// straight from the input. That sign is decided in doubles with an error bound and, where the
/// bound does not suffice, in rationals. Coordinates are computed last and decide nothing.
///
///     vertex k        lines e_i, e_j      exactly the input
///     edge × plane    lines e_i, G
///     two planes      lines G, G'

namespace graspfit::geometry::internal {

/// How often the filters failed, for tests and benchmarks.
struct ClipCounters {
  std::uint64_t signs = 0;              ///< Signs asked for at cut corners.
  std::uint64_t exact_signs = 0;        ///< Of these, decided in rationals.
  std::uint64_t corners = 0;            ///< Corners computed.
  std::uint64_t exact_coordinates = 0;  ///< Of these, computed in rationals.
};

/// A corner of a cut polygon.
struct CutCorner {
  std::uint32_t line_a = 0;  ///< Lines that meet here; h = A × B.
  std::uint32_t line_b = 0;
  std::uint32_t edge = 0;        ///< Line of the edge from here to the next corner,
  bool edge_is_turned = false;   ///< and whether the polygon is on its negative side.
  std::array<double, 3> h;       ///< A × B in doubles.
  std::array<double, 3> h_size;  ///< |h − exact| ≤ a few ulps of this.
  double lambda_1 = 0.0;         ///< Barycentric coordinates of vertices 1 and 2.
  double lambda_2 = 0.0;
  Eigen::Vector3d point;
};

/// Counter-clockwise in the order of the triangle; empty if nothing is left.
using CutPolygon = std::vector<CutCorner>;

/// Area and area centroid of a cut polygon.
struct CutMeasure {
  double fraction = 0.0;  ///< Of the triangle's area, > 0 for every polygon that has corners.
  Eigen::Vector3d centroid;
};

/// One triangle and the planes that cut it.
///
/// Bounds: signs are exact. Barycentric coordinates are within 2^-44 of their exact places, so that
/// a corner is within 2^-42 of the longest edge plus two ulps of the largest coordinate of its own;
/// a corner on an axis-aligned plane has that plane's coordinate exactly, a vertex is the vertex.
class TriangleCutter {
 public:
  /// Precondition: the corners are not collinear. Forgets the planes of the last triangle.
  void reset(const std::array<Eigen::Vector3d, 3>& corners);

  /// The whole triangle.
  void whole(CutPolygon& polygon) const;

  /// Line of the plane normal · p = offset, inside where normal · p ≤ offset. Returns its name.
  std::uint32_t add_plane(const Eigen::Vector3d& normal, double offset);

  /// Line of the plane p[axis] = coordinate, inside where p[axis] ≤ coordinate.
  std::uint32_t add_axis_plane(int axis, double coordinate);

  /// The part of `polygon` inside `line`, and, unless null, the part on its other side; parts
  /// without area are empty. A polygon in the plane goes to `in_plane`: to the inside or the other.
  enum class InPlane { Inside, Outside };
  void split(const CutPolygon& polygon, std::uint32_t line, InPlane in_plane, CutPolygon& inside,
             CutPolygon* outside);

  CutMeasure measure(const CutPolygon& polygon) const;

  const ClipCounters& counters() const { return counters_; }

 private:
  struct Line {
    std::array<double, 3> value;  // G in doubles,
    std::array<double, 3> size;   // |value − exact| ≤ a few ulps of this, and |value| ≤ this.
    Eigen::Vector3d normal;       // The plane itself, for exact evaluation;
    double offset = 0.0;
    int axis = -1;    // its axis if it is axis-aligned,
    int vertex = -1;  // or the index of the unit vector.
  };

  int sign_at(const CutCorner& corner, std::uint32_t line);
  CutCorner meet(std::uint32_t a, bool a_is_turned, std::uint32_t b, bool b_is_turned);
  void place(CutCorner& corner);
  template <typename Number>
  std::array<Number, 3> exact_line(std::uint32_t line) const;
  template <typename Number>
  std::array<Number, 3> exact_corner(std::uint32_t a, std::uint32_t b) const;
  int exact_sign_at(const CutCorner& corner, std::uint32_t line) const;
  void place_exactly(CutCorner& corner) const;
  double exact_fraction(const CutPolygon& polygon) const;

  std::array<Eigen::Vector3d, 3> vertices_;
  Eigen::Vector3d edge_1_;
  Eigen::Vector3d edge_2_;
  std::vector<Line> lines_;
  std::vector<int> signs_;
  ClipCounters counters_;
};

}  // namespace graspfit::geometry::internal
