#include "graspfit/geometry/solid_boundary.hpp"

// CGAL would print a recommendation of another class wherever two cuts meet in a face.
#define CGAL_NO_CDT_2_WARNING
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/determinant.h>
#include <CGAL/intersections.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "exact/exact_number.hpp"
#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/errors.hpp"
#include "mesh/input_check.hpp"
#include "query/face_tree.hpp"
#include "solid/crossing_faces.hpp"
#include "solid/intersection_part.hpp"
#include "solid/mesh_edges.hpp"
#include "solid/mesh_operations.hpp"
#include "solid/union_by_corefinement.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::FaceTree;
using internal::IndexedTriangle;
using internal::Interval;
using Corners = std::array<Vector3d, 3>;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactNumber = std::decay_t<decltype(CGAL::exact(Exact::FT()))>;
using Cut =
    CGAL::Constrained_Delaunay_triangulation_2<Exact, CGAL::Default, CGAL::Exact_intersections_tag>;
/// What two triangles have in common, exactly.
using Common = decltype(CGAL::intersection(Exact::Triangle_3(), Exact::Triangle_3()));

Exact::Point_3 to_exact(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// A point with exact coordinates, which are computed only where intervals leave a sign in doubt.
struct ExactPoint {
  std::array<Exact::FT, 3> exact;
  std::array<std::pair<double, double>, 3> between;  ///< Bounds of the coordinates.

  explicit ExactPoint(std::array<Exact::FT, 3> coordinates) : exact(std::move(coordinates)) {
    for (int axis = 0; axis < 3; ++axis) between[axis] = CGAL::to_interval(exact[axis]);
  }

  Interval coordinate(int axis, Interval) const { return between[axis]; }
  ExactNumber coordinate(int axis, const ExactNumber&) const { return CGAL::exact(exact[axis]); }

  /// Rounded from the exact coordinates, so that equal points of different faces stay equal.
  Vector3d rounded() const {
    const auto nearest = [&](int axis) {
      return internal::nearest_double(CGAL::exact(exact[axis]));
    };
    return {nearest(0), nearest(1), nearest(2)};
  }
};

/// Sign of the area of (u, v, point) in the plane of coordinates a and b. Exact.
int turn_about(const Vector3d& u, const Vector3d& v, const ExactPoint& point, int a, int b) {
  return internal::sign_of_expression<ExactNumber>([&](const auto& number) {
    using Number = std::decay_t<decltype(number)>;
    const Number pa = point.coordinate(a, number);
    const Number pb = point.coordinate(b, number);
    return Number((Number(u[a]) - pa) * (Number(v[b]) - pb) -
                  (Number(u[b]) - pb) * (Number(v[a]) - pa));
  });
}

/// On which side of the plane of the triangle the point is, as `internal::orientation`. Exact.
int side_of_plane(const Corners& corners, const ExactPoint& point) {
  return internal::sign_of_expression<ExactNumber>([&](const auto& number) {
    using Number = std::decay_t<decltype(number)>;
    std::array<Number, 3> ab;
    std::array<Number, 3> ac;
    std::array<Number, 3> ap;
    for (int axis = 0; axis < 3; ++axis) {
      const Number origin(corners[0][axis]);
      ab[axis] = Number(corners[1][axis]) - origin;
      ac[axis] = Number(corners[2][axis]) - origin;
      ap[axis] = point.coordinate(axis, number) - origin;
    }
    return Number(CGAL::determinant(ab[0], ab[1], ab[2], ac[0], ac[1], ac[2], ap[0], ap[1], ap[2]));
  });
}

/// What lies on the two sides of a piece of surface, seen along a coordinate axis.
struct Sides {
  bool is_solid_above = false;
  bool is_solid_below = false;
  std::optional<std::int32_t> first_face;  ///< The first of the faces that cover the piece.
};

/// Winding numbers on both sides of a point within a piece, by the crossings of the ray from it
/// along `axis`. As in `internal::Winding` the ray counts as moved by (ε, ε²), so that it meets the
/// interior of triangles only. Faces that hold the point lie in the piece's plane, or they would
/// have cut it there.
Sides sides_at(const FaceTree& tree, const ExactPoint& point, std::int32_t own, int axis) {
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  const auto turn = [&](const Vector3d& u, const Vector3d& v) {
    const int side = turn_about(u, v, point, a, b);
    if (side != 0) return side;
    if (u[b] != v[b]) return u[b] > v[b] ? 1 : -1;
    return u[a] != v[a] ? (v[a] > u[a] ? 1 : -1) : 0;
  };
  int above = 0;
  int at = 0;
  Sides sides;
  const auto is_beyond = [&](const Eigen::AlignedBox3d& box, int along) {
    return box.max()[along] < point.between[along].first;
  };
  const auto is_before = [&](const Eigen::AlignedBox3d& box, int along) {
    return box.min()[along] > point.between[along].second;
  };
  const auto enter = [&](const Eigen::AlignedBox3d& box) {
    return !(is_beyond(box, axis) || is_beyond(box, a) || is_before(box, a) || is_beyond(box, b) ||
             is_before(box, b));
  };
  tree.traverse(enter, [&](const IndexedTriangle& triangle) {
    const auto& [corners, face] = triangle;
    const int around = turn(corners[0], corners[1]);
    if (around == 0 || turn(corners[1], corners[2]) != around ||
        turn(corners[2], corners[0]) != around) {
      return;
    }
    const int side = face == own ? 0 : around * side_of_plane(corners, point);
    if (side < 0) above += around;
    if (side != 0) return;
    at += around;
    if (!sides.first_face || face < *sides.first_face) sides.first_face = face;
  });
  sides.is_solid_above = above != 0;
  sides.is_solid_below = above + at != 0;
  return sides;
}

/// The axis along which the projection of a face is largest.
int main_axis(const Corners& corners) {
  int axis = 0;
  internal::accurate_vector_area(corners[0], corners[1], corners[2]).cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// Pairs of faces that cross from which on it is asked whether corefinement may unite the parts:
/// fewer are cut here in a tenth of a second.
constexpr std::size_t kManyCrossings = 500;

/// The faces that have area, on vertices with distinct coordinates. @throws InvalidInput if the
/// faces bound no solid.
TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  internal::weld(result, 0.0);
  if (!internal::bounds_solid(result)) {
    throw base::InvalidInput(
        "the mesh bounds no solid: an edge is not run through equally often in both directions");
  }
  std::size_t kept = 0;
  for (std::int32_t face = 0; face < std::ssize(result.faces); ++face) {
    if (!internal::is_degenerate(result, face)) result.faces[kept++] = result.faces[face];
  }
  result.faces.resize(kept);
  return result;
}

/// What a face meets.
struct Crossings {
  std::vector<Common> cuts;            ///< Of faces in other planes.
  std::vector<std::int32_t> coplanar;  ///< Faces in its own plane.

  bool empty() const { return cuts.empty() && coplanar.empty(); }
};

class Builder {
 public:
  explicit Builder(const TriangleMesh& mesh) : mesh_(welded(mesh)) {
    result_ = {mesh_.vertices, {}};
  }

  TriangleMesh build() {
    if (mesh_.faces.empty()) return result_;
    const auto crossings = internal::crossing_faces(mesh_);
    if (crossings.size() >= kManyCrossings) {
      if (auto united = internal::union_by_corefinement(mesh_, crossings)) {
        result_ = std::move(*united);
        return cleaned();
      }
    }
    tree_.emplace(mesh_);
    std::vector<Crossings> met(mesh_.faces.size());
    for (const auto& [first, second] : crossings) {
      if (are_coplanar(first, second)) {
        met[first].coplanar.push_back(second);
        met[second].coplanar.push_back(first);
        continue;
      }
      // Both faces share the exact points, which are evaluated once.
      const Common common = CGAL::intersection(triangle(first), triangle(second));
      met[first].cuts.push_back(common);
      met[second].cuts.push_back(common);
    }
    add_whole_faces(met);
    for (std::int32_t face = 0; face < std::ssize(mesh_.faces); ++face) {
      if (!met[face].empty()) add_pieces(face, met[face]);
    }
    return cleaned();
  }

 private:
  Exact::Triangle_3 triangle(std::int32_t face) const {
    const auto [a, b, c] = geometry::corners(mesh_, face);
    return {to_exact(a), to_exact(b), to_exact(c)};
  }

  bool are_coplanar(std::int32_t first, std::int32_t second) const {
    const Corners plane = geometry::corners(mesh_, first);
    const Corners other = geometry::corners(mesh_, second);
    return std::all_of(other.begin(), other.end(), [&](const Vector3d& corner) {
      return internal::orientation(plane[0], plane[1], plane[2], corner) == 0;
    });
  }

  /// Adds the faces that cross nothing and bound the solid. The sides of such faces are the same
  /// throughout a set of them that is connected by edges with two faces.
  void add_whole_faces(const std::vector<Crossings>& met) {
    base::DisjointSets regions(mesh_.faces.size());
    internal::for_each_edge(internal::sorted_sides(mesh_), [&](auto first, auto last) {
      if (last - first == 2 && met[first->face].empty() && met[(first + 1)->face].empty()) {
        regions.unite(first->face, (first + 1)->face);
      }
    });
    // Whether faces stay as they are (1), stay turned (−1) or are dropped (0), by the region's
    // first face.
    std::vector<int> fate(mesh_.faces.size(), 0);
    for (std::int32_t face = 0; face < std::ssize(mesh_.faces); ++face) {
      if (!met[face].empty()) continue;
      const std::int32_t first = regions.root(face);
      if (first == face) {
        const Corners corners = geometry::corners(mesh_, face);
        const int axis = main_axis(corners);
        std::array<Exact::FT, 3> center;
        for (int i = 0; i < 3; ++i) {
          center[i] =
              (Exact::FT(corners[0][i]) + Exact::FT(corners[1][i]) + Exact::FT(corners[2][i])) /
              Exact::FT(3);
        }
        const Sides sides = sides_at(*tree_, ExactPoint(center), face, axis);
        if (sides.is_solid_above != sides.is_solid_below) {
          const int up = internal::orientation_2d(corners[0], corners[1], corners[2],
                                                  (axis + 1) % 3, (axis + 2) % 3);
          fate[face] = sides.is_solid_below ? up : -up;
        }
      }
      const auto& [a, b, c] = mesh_.faces[face];
      if (fate[first] > 0) result_.faces.push_back({a, b, c});
      if (fate[first] < 0) result_.faces.push_back({a, c, b});
    }
  }

  /// Cuts a face by all that it meets and adds the pieces that bound the solid.
  void add_pieces(std::int32_t face, const Crossings& crossings) {
    const Corners corners = geometry::corners(mesh_, face);
    const int axis = main_axis(corners);
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    Cut cut;
    std::map<Cut::Vertex_handle, std::int32_t> vertex_of;
    std::array<Cut::Vertex_handle, 3> own;
    for (int i = 0; i < 3; ++i) {
      own[i] = cut.insert(Exact::Point_2(corners[i][a], corners[i][b]));
      vertex_of[own[i]] = mesh_.faces[face][i];
    }
    for (int i = 0; i < 3; ++i) cut.insert_constraint(own[i], own[(i + 1) % 3]);
    insert_cuts(crossings.cuts, a, b, cut);
    // Edges of coplanar faces cut as they are: what they have in common with this face would only
    // be computed to be forgotten. What lies beyond this face is left out below; edges that are
    // wholly beyond one of its sides are left out at once, since each would cross all others there.
    const int around = internal::orientation_2d(corners[0], corners[1], corners[2], a, b);
    const auto is_beyond_a_side = [&](const Vector3d& u, const Vector3d& v) {
      for (int i = 0; i < 3; ++i) {
        const Vector3d& from = corners[i];
        const Vector3d& to = corners[(i + 1) % 3];
        if (internal::orientation_2d(from, to, u, a, b) == -around &&
            internal::orientation_2d(from, to, v, a, b) == -around) {
          return true;
        }
      }
      return false;
    };
    for (const std::int32_t other : crossings.coplanar) {
      const Corners c = geometry::corners(mesh_, other);
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (is_beyond_a_side(c[i], c[j])) continue;
        cut.insert_constraint(Exact::Point_2(c[i][a], c[i][b]), Exact::Point_2(c[j][a], c[j][b]));
      }
    }
    const CGAL::Orientation turn =
        CGAL::orientation(own[0]->point(), own[1]->point(), own[2]->point());
    const auto is_in_face = [&](const Exact::Point_2& p) {
      for (int i = 0; i < 3; ++i) {
        if (CGAL::orientation(own[i]->point(), own[(i + 1) % 3]->point(), p) != turn) return false;
      }
      return true;
    };

    // Lifts a point of the projection back to the plane of the face.
    const Exact::Triangle_3 triangle = this->triangle(face);
    const Exact::Vector_3 normal =
        CGAL::cross_product(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const auto lifted = [&](const Exact::Point_2& p) {
      std::array<Exact::FT, 3> coordinates;
      const Exact::FT height = triangle[0][axis] - (normal[a] * (p.x() - triangle[0][a]) +
                                                    normal[b] * (p.y() - triangle[0][b])) /
                                                       normal[axis];
      coordinates[a] = p.x();
      coordinates[b] = p.y();
      coordinates[axis] = height;
      return ExactPoint(coordinates);
    };

    std::map<Cut::Face_handle, bool> is_done;
    for (const Cut::Face_handle start : cut.finite_face_handles()) {
      if (is_done[start]) continue;
      // A piece is all triangles up to the next cuts. The sides are found at its largest triangle.
      std::vector<Cut::Face_handle> piece = {start};
      is_done[start] = true;
      Cut::Face_handle largest = start;
      for (std::size_t next = 0; next < piece.size(); ++next) {
        if (area(cut, piece[next]) > area(cut, largest)) largest = piece[next];
        for (int i = 0; i < 3; ++i) {
          const Cut::Face_handle neighbor = piece[next]->neighbor(i);
          if (piece[next]->is_constrained(i) || cut.is_infinite(neighbor) || is_done[neighbor]) {
            continue;
          }
          is_done[neighbor] = true;
          piece.push_back(neighbor);
        }
      }
      const Cut::Triangle t = cut.triangle(largest);
      const Exact::Point_2 within = CGAL::centroid(t[0], t[1], t[2]);
      if (!is_in_face(within)) continue;
      const Sides sides = sides_at(*tree_, lifted(within), face, axis);
      // Where faces cover each other only the first one adds the piece.
      if (sides.first_face != face || sides.is_solid_above == sides.is_solid_below) continue;
      for (const Cut::Face_handle part : piece) {
        Face added;
        for (int i = 0; i < 3; ++i) {
          const Cut::Vertex_handle vertex = part->vertex(i);
          const auto [known, is_new] =
              vertex_of.try_emplace(vertex, base::as_index<std::int32_t>(result_.vertices.size()));
          if (is_new) result_.vertices.push_back(lifted(vertex->point()).rounded());
          added[i] = known->second;
        }
        // Triangles of the cut run counter-clockwise seen from the end of the axis.
        if (!sides.is_solid_below) std::swap(added[1], added[2]);
        result_.faces.push_back(added);
      }
    }
  }

  /// Planes that are not the same have a point or a segment in common.
  static void insert_cuts(const std::vector<Common>& cuts, int a, int b, Cut& cut) {
    const auto flat = [&](const Exact::Point_3& p) { return Exact::Point_2(p[a], p[b]); };
    for (const Common& common : cuts) {
      using internal::intersection_part;
      if (const auto* point = intersection_part<Exact::Point_3>(common)) {
        cut.insert(flat(*point));
      } else if (const auto* segment = intersection_part<Exact::Segment_3>(common)) {
        cut.insert_constraint(flat(segment->source()), flat(segment->target()));
      }
    }
  }

  static double area(const Cut& cut, Cut::Face_handle face) {
    return CGAL::to_double(cut.triangle(face).area());
  }

  /// The result with equal vertices welded, and without collapsed faces and unused vertices.
  TriangleMesh cleaned() {
    internal::weld(result_, 0.0);
    internal::remove_collapsed_faces(result_);
    internal::remove_unused_vertices(result_);
    return std::move(result_);
  }

  const TriangleMesh mesh_;
  TriangleMesh result_;
  std::optional<FaceTree> tree_;
};

}  // namespace

TriangleMesh solid_boundary(const TriangleMesh& mesh) {
  internal::require_usable(mesh, "solid_boundary");
  return Builder(mesh).build();
}

}  // namespace graspfit::geometry
