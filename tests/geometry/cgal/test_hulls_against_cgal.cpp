#ifndef CGAL_EIGEN3_ENABLED
// Epick_d computes determinants with Eigen and wants to be told, before any of CGAL's headers, that
// it is there.
#define CGAL_EIGEN3_ENABLED
#endif
#include <CGAL/Epick_d.h>
#include <CGAL/Triangulation.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "exact/predicates.hpp"
#include "geometry/cgal/cgal_oracle.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "support/catch.hpp"

namespace graspfit::test_hulls_against_cgal {

using base::Random;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::Containment;
using testing::ContainmentCounts;

namespace {

/// Returns the indices that both have; both are ascending.
template <class Index>
std::vector<Index> common_indices(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::vector<Index> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common;
}

/// The hull of the columns of a matrix by CGAL's triangulation of points in `d` dimensions.
template <int d>
class HullByCgal {
 public:
  using Indices = std::vector<int>;

  explicit HullByCgal(const MatrixXd& points) : matrix_(points), triangulation_(d) {
    std::map<typename Triangulation::Vertex_handle, int> index_of;
    for (int i = 0; i < static_cast<int>(points.cols()); ++i) {
      points_.push_back(point_of(points.col(i)));
      // Of equal points the first is taken.
      if (index_of.emplace(triangulation_.insert(points_.back()), i).second) distinct_.push_back(i);
    }
    if (!is_full()) return;
    std::vector<typename Triangulation::Full_cell_handle> outer_cells;
    triangulation_.incident_full_cells(triangulation_.infinite_vertex(),
                                       std::back_inserter(outer_cells));
    for (const auto cell : outer_cells) {
      Indices corners;
      for (int i = 0; i <= d; ++i) {
        if (!triangulation_.is_infinite(cell->vertex(i))) {
          corners.push_back(index_of.at(cell->vertex(i)));
        }
      }
      add_facet_of(corners);
    }
  }

  bool is_full() const { return triangulation_.current_dimension() == d; }

  /// What the points are to the hyperplane through `d` of them.
  struct Plane {
    Indices points;  ///< Those that lie in it, ascending.
    int inside = 0;  ///< The side of all others; 0 if they are on both sides, or there are none.
  };
  Plane plane_through(const Indices& corners) const {
    Plane plane;
    bool is_above = false;
    bool is_below = false;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const int side = side_of(corners, points_[i]);
      is_above = is_above || side > 0;
      is_below = is_below || side < 0;
      if (side == 0) plane.points.push_back(i);
    }
    if (is_above != is_below) plane.inside = is_above ? 1 : -1;
    return plane;
  }

  /// The points in the hyperplane of each facet. They are unique, whereas facets may be cut into
  /// simplices in many ways, here also with corners that are not extreme.
  std::set<Indices> facets() const {
    std::set<Indices> facets;
    for (const Facet& facet : facets_) facets.insert(facet.plane.points);
    return facets;
  }

  /// The extreme points: those that are alone in all facets through them, which have the smallest
  /// face around a point in common.
  Indices vertices() const {
    Indices vertices;
    for (const int index : distinct_) {
      std::optional<Indices> face;
      for (const Facet& facet : facets_) {
        const Indices& on_facet = facet.plane.points;
        if (!std::binary_search(on_facet.begin(), on_facet.end(), index)) continue;
        face = face ? common_indices(*face, on_facet) : on_facet;
      }
      const bool is_alone = face && std::all_of(face->begin(), face->end(), [&](int other) {
                              return matrix_.col(other) == matrix_.col(index);
                            });
      if (is_alone) vertices.push_back(index);
    }
    return vertices;
  }

  Containment containment(const VectorXd& query) const {
    const Point point = point_of(query);
    bool is_on_facet = false;
    for (const Facet& facet : facets_) {
      const int side = side_of(facet.corners, point);
      if (side == -facet.plane.inside) return Containment::Outside;
      is_on_facet = is_on_facet || side == 0;
    }
    return is_on_facet ? Containment::OnSurface : Containment::Inside;
  }

  /// Whether the triangulation itself, asked where the point is, finds it beyond its hull.
  bool is_beyond(const VectorXd& query) const {
    typename Triangulation::Locate_type where;
    typename Triangulation::Face face(d);
    typename Triangulation::Facet facet;
    triangulation_.locate(point_of(query), where, face, facet);
    return where == Triangulation::OUTSIDE_CONVEX_HULL;
  }

 private:
  using Kernel = CGAL::Epick_d<CGAL::Dimension_tag<d>>;
  using Triangulation = CGAL::Triangulation<Kernel>;
  using Point = typename Triangulation::Point;

  struct Facet {
    Indices corners;
    Plane plane;
  };

  template <class Column>
  static Point point_of(const Column& column) {
    std::array<double, d> coordinates;
    for (int i = 0; i < d; ++i) coordinates[i] = column[i];
    return Point(d, coordinates.begin(), coordinates.end());
  }

  /// On which side of the hyperplane through `d` points another one is.
  int side_of(const Indices& corners, const Point& point) const {
    std::vector<Point> simplex;
    for (const int corner : corners) simplex.push_back(points_[corner]);
    simplex.push_back(point);
    return static_cast<int>(Kernel().orientation_d_object()(simplex.begin(), simplex.end()));
  }

  void add_facet_of(Indices corners) {
    std::sort(corners.begin(), corners.end());
    const bool is_known = std::any_of(facets_.begin(), facets_.end(), [&](const Facet& facet) {
      const Indices& on_facet = facet.plane.points;
      return std::includes(on_facet.begin(), on_facet.end(), corners.begin(), corners.end());
    });
    if (!is_known) facets_.push_back({corners, plane_through(corners)});
  }

  MatrixXd matrix_;
  Triangulation triangulation_;
  std::vector<Point> points_;
  Indices distinct_;
  std::vector<Facet> facets_;
};

MatrixXd random_points(Random& random, int d, int count) {
  MatrixXd points(d, count);
  for (double& x : points.reshaped()) x = random.uniform(-1.0, 1.0);
  return points;
}

/// Returns points with coordinates 0 … size − 1, of which many are coplanar; the last two are the
/// middle of two others and the first once more.
MatrixXd lattice_points(Random& random, int d, int count, std::uint64_t size) {
  MatrixXd points(d, count);
  for (double& x : points.reshaped()) x = static_cast<double>(random.index(size));
  points.col(count - 2) = 0.5 * (points.col(1) + points.col(2));
  points.col(count - 1) = points.col(0);
  return points;
}

struct PolytopeCounts {
  int not_extreme = 0;  ///< Points that are not vertices of their hull.
  int wide_facets = 0;  ///< Facets that are no simplices.
  testing::ContainmentCounts answers;
};

template <int d>
void compare_hulls(const MatrixXd& points, Random& random, PolytopeCounts& counts) {
  const geometry::ConvexPolytope ours(points);
  const HullByCgal<d> theirs(points);
  REQUIRE(theirs.is_full());
  CHECK(ours.rank() == d);
  const std::vector<int>& vertices = ours.vertices();
  CHECK(vertices == theirs.vertices());
  std::set<std::vector<int>> facets;
  int num_wrong = 0;
  for (Eigen::Index f = 0; f < ours.num_facets(); ++f) {
    const auto column = ours.facets().col(f);
    const auto plane = theirs.plane_through({column.begin(), column.end()});
    num_wrong += plane.inside == 0;
    facets.insert(plane.points);
  }
  CHECK(num_wrong == 0);
  CHECK(facets == theirs.facets());
  counts.not_extreme += static_cast<int>(points.cols()) - static_cast<int>(vertices.size());
  for (const auto& facet : facets) {
    counts.wide_facets += std::count_if(facet.begin(), facet.end(), [&](int index) {
                            return std::binary_search(vertices.begin(), vertices.end(), index);
                          }) > d;
  }

  const auto any_point = [&]() -> VectorXd {
    return points.col(
        static_cast<Eigen::Index>(random.index(static_cast<std::uint64_t>(points.cols()))));
  };
  for (int i = 0; i < 40; ++i) {
    VectorXd query = any_point();
    if (i % 2 == 0) {
      // It lies on the line through two points, where those of a lattice are not rounded.
      query += (static_cast<double>(random.index(7)) - 1.0) / 4.0 * (any_point() - query);
    } else {
      for (int k = 1; k < 8; ++k) query += any_point();
      query /= 8.0;
    }
    const Containment containment = ours.containment(query);
    CHECK(containment == theirs.containment(query));
    CHECK((containment == Containment::Outside) == theirs.is_beyond(query));
    counts.answers.add(containment);
  }
}

template <int d>
void compare_all_hulls(int count) {
  CAPTURE(d);
  Random random(110 + d);
  PolytopeCounts counts;
  compare_hulls<d>(random_points(random, d, d + 1), random, counts);
  compare_hulls<d>(random_points(random, d, count), random, counts);
  compare_hulls<d>(lattice_points(random, d, count, 2), random, counts);
  compare_hulls<d>(lattice_points(random, d, count, 3), random, counts);
  // Thirds are rounded, which leaves oblique planes of the lattice only nearly planes.
  compare_hulls<d>(
      lattice_points(random, d, count, 3) / 3.0 + MatrixXd::Constant(d, count, 1.0 / 7.0), random,
      counts);
  CHECK(counts.not_extreme > 2);
  CHECK(counts.wide_facets > 3);
  CHECK(counts.answers.inside > 15);
  CHECK(counts.answers.on_surface > 15);
  CHECK(counts.answers.outside > 15);
}

}  // namespace

TEST_CASE("Polytopes in 4, 5 and 6 dimensions are the hulls of CGAL's triangulations",
          "[geometry][cgal_oracle]") {
  compare_all_hulls<4>(26);
  compare_all_hulls<5>(20);
  compare_all_hulls<6>(17);
}

namespace {

using Points = std::vector<Vector3d>;
using Indices = std::vector<std::size_t>;
using geometry::internal::orientation;

/// The hull of points in space by looking at every triple of them: empty if they do not span space.
struct EveryTriple {
  std::set<Indices> facets;  ///< The points in the plane of each facet, ascending.
  Indices vertices;
};

EveryTriple hull_of_every_triple(const Points& points) {
  EveryTriple hull;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        Indices on_plane;
        bool is_above = false;
        bool is_below = false;
        for (std::size_t other = 0; other < points.size(); ++other) {
          const int side = orientation(points[i], points[j], points[k], points[other]);
          is_above = is_above || side > 0;
          is_below = is_below || side < 0;
          if (side == 0) on_plane.push_back(other);
        }
        // Beside three points on a line there is nothing on either side.
        if (is_above != is_below) hull.facets.insert(on_plane);
      }
    }
  }
  // An extreme point is alone in all facets through it.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto first = std::find(points.begin(), points.end(), points[i]);
    if (first != points.begin() + static_cast<std::ptrdiff_t>(i)) continue;
    std::optional<Indices> face;
    for (const Indices& facet : hull.facets) {
      if (!std::binary_search(facet.begin(), facet.end(), i)) continue;
      face = face ? common_indices(*face, facet) : facet;
    }
    if (face && std::all_of(face->begin(), face->end(),
                            [&](std::size_t other) { return points[other] == points[i]; })) {
      hull.vertices.push_back(i);
    }
  }
  return hull;
}

/// Checks a hull that has volume: its vertices, that each triangle lies in a facet and is turned
/// outward, that each facet has as many as it needs, and that they close up.
void check_solid_hull(const Points& points, const geometry::ConvexHull3& hull,
                      const EveryTriple& expected) {
  CHECK(hull.vertices == expected.vertices);
  std::map<Indices, std::size_t> num_triangles;
  std::map<std::pair<std::size_t, std::size_t>, int> sides;
  int num_wrong = 0;
  for (const geometry::HullFacet& facet : hull.facets) {
    REQUIRE(facet.size() == 3);
    Indices on_plane;
    int num_below = 0;
    for (std::size_t other = 0; other < points.size(); ++other) {
      const int side =
          orientation(points[facet[0]], points[facet[1]], points[facet[2]], points[other]);
      num_wrong += side > 0;
      num_below += side < 0;
      if (side == 0) on_plane.push_back(other);
    }
    num_wrong += num_below == 0;
    ++num_triangles[on_plane];
    for (std::size_t i = 0; i < 3; ++i) {
      ++sides[{facet[i], facet[(i + 1) % 3]}];
      num_wrong += !std::binary_search(hull.vertices.begin(), hull.vertices.end(), facet[i]);
    }
  }
  for (const auto& [side, count] : sides) {
    num_wrong += count != 1 || sides.count({side.second, side.first}) != 1;
  }
  CHECK(num_wrong == 0);
  CHECK(num_triangles.size() == expected.facets.size());
  for (const Indices& facet : expected.facets) {
    CHECK(num_triangles[facet] == common_indices(facet, expected.vertices).size() - 2);
  }
}

using Place = std::array<double, 3>;

Place place_of(const Vector3d& point) { return {point.x(), point.y(), point.z()}; }

std::set<Place> places_of(const Points& points, const Indices& indices) {
  std::set<Place> places;
  for (const std::size_t i : indices) places.insert(place_of(points[i]));
  return places;
}

/// Returns the corners of each facet: those of all triangles in one plane, whose diagonals depend
/// on the order of the points.
std::set<std::set<Place>> whole_facets(const Points& points, const geometry::ConvexHull3& hull) {
  std::set<std::set<Place>> facets;
  for (const geometry::HullFacet& facet : hull.facets) {
    if (hull.rank < 3) {
      facets.insert(places_of(points, facet));
      continue;
    }
    Indices on_plane;
    for (const std::size_t vertex : hull.vertices) {
      if (orientation(points[facet[0]], points[facet[1]], points[facet[2]], points[vertex]) == 0) {
        on_plane.push_back(vertex);
      }
    }
    facets.insert(places_of(points, on_plane));
  }
  return facets;
}

}  // namespace

TEST_CASE("Hulls in space are those of all triples of points, in whatever order the points come",
          "[geometry][cgal_oracle]") {
  Random random(117);
  int num_solid = 0;
  int num_flat = 0;
  int num_with_equal_points = 0;
  int num_with_wide_facets = 0;
  int num_with_inner_points = 0;
  for (int round = 0; round < 600; ++round) {
    CAPTURE(round);
    Points points(1 + random.index(12));
    const std::uint64_t size = 2 + random.index(3);
    for (Vector3d& point : points) {
      for (double& x : point) {
        x = static_cast<double>(random.index(size));
        // Thirds are rounded, which leaves oblique planes of the lattice only nearly planes.
        if (round % 3 == 2) x = x / 3.0 + 1.0 / 7.0;
      }
    }
    const geometry::ConvexHull3 hull = geometry::convex_hull(points);
    const EveryTriple expected = hull_of_every_triple(points);
    CHECK((hull.rank == 3) == !expected.facets.empty());
    if (hull.rank == 3) check_solid_hull(points, hull, expected);

    Points shuffled = points;
    for (std::size_t i = shuffled.size(); i > 1; --i) {
      std::swap(shuffled[i - 1], shuffled[random.index(i)]);
    }
    const geometry::ConvexHull3 again = geometry::convex_hull(shuffled);
    CHECK(again.rank == hull.rank);
    CHECK(again.vertices.size() == hull.vertices.size());
    CHECK(places_of(shuffled, again.vertices) == places_of(points, hull.vertices));
    CHECK(again.facets.size() == hull.facets.size());
    CHECK(whole_facets(shuffled, again) == whole_facets(points, hull));
    // Volumes of flat hulls are good to 36 bits, 1.5e-11.
    CHECK(again.measure == Approx(hull.measure).epsilon(1e-10));

    std::set<Place> distinct;
    for (const Vector3d& point : points) distinct.insert(place_of(point));
    num_with_equal_points += distinct.size() < points.size();
    num_solid += hull.rank == 3;
    num_flat += hull.rank == 2;
    num_with_wide_facets += hull.rank == 3 && hull.facets.size() > expected.facets.size();
    num_with_inner_points += hull.vertices.size() < distinct.size();
  }
  CHECK(num_solid > 200);
  CHECK(num_flat > 20);
  CHECK(num_with_equal_points > 100);
  CHECK(num_with_wide_facets > 60);
  CHECK(num_with_inner_points > 40);
}

}  // namespace graspfit::test_hulls_against_cgal
