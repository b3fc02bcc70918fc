#include "graspfit/geometry/mesh_query.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "exact/exact_number.hpp"
#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "mesh/input_check.hpp"
#include "query/indexed_mesh.hpp"
#include "query/winding.hpp"

namespace graspfit::geometry {
namespace {

using internal::IndexedTriangle;

std::vector<std::int32_t> one_vertex_per_part(const TriangleMesh& mesh) {
  base::DisjointSets sets(mesh.vertices.size());
  std::vector<char> is_used(mesh.vertices.size(), 0);
  for (const Face& f : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      is_used[f[i]] = 1;
      sets.unite(f[i], f[(i + 1) % 3]);
    }
  }
  std::vector<std::int32_t> result;
  for (std::int32_t v = 0; v < std::ssize(is_used); ++v) {
    if (is_used[v] && sets.root(v) == v) result.push_back(v);
  }
  return result;
}

// Height of `origin` over the plane of a triangle and how much of it the way to `ahead` takes, both
// times the length of the triangle's normal.
template <typename Number>
std::pair<Number, Number> height_and_fall(const std::array<Eigen::Vector3d, 3>& corners,
                                          const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& ahead) {
  const auto minus = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return std::array<Number, 3>{Number(Number(p[0]) - Number(q[0])),
                                 Number(Number(p[1]) - Number(q[1])),
                                 Number(Number(p[2]) - Number(q[2]))};
  };
  const auto ab = minus(corners[1], corners[0]);
  const auto ac = minus(corners[2], corners[0]);
  const auto over = minus(origin, corners[0]);
  const auto way = minus(origin, ahead);
  Number height(0);
  Number fall(0);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const Number normal(ab[j] * ac[k] - ab[k] * ac[j]);
    height += normal * over[i];
    fall += normal * way[i];
  }
  return {height, fall};
}

// The line through an origin and a point `ahead`, both doubles. `ahead` is so far that rounding it
// turns the line by rounding error only; from then on all signs are exact for this line, and faces
// on both sides of an edge use the same sign, so that no line slips through a closed surface.
class Line {
 public:
  struct Meeting {
    double t;  // In units of ahead − origin.
    std::array<int, 3> sides;
    int crossing;
  };

  Line(const char* who, const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
       const Eigen::Vector3d& direction)
      : origin_(origin) {
    const Eigen::Vector3d unit = direction.stableNormalized();
    if (!direction.allFinite() || unit.squaredNorm() == 0.0) {
      throw base::InvalidInput(std::string(who) + ": the direction has no length");
    }
    if (!origin.allFinite())
      throw base::InvalidInput(std::string(who) + ": the origin is not finite");
    length_ = 2.0 * (box.exteriorDistance(origin) + box.diagonal().norm() + 1e-300);
    ahead_ = origin + length_ * unit;
    if (!ahead_.allFinite()) {
      throw base::InvalidInput(std::string(who) + ": the origin is too far from the mesh");
    }
    inverse_ = (ahead_ - origin).cwiseInverse();
  }

  // Whether the part from..to of the line may meet the box; the answer "no" is certain.
  bool may_meet(const Eigen::AlignedBox3d& box, double from, double to) const {
    // Of the line's length: above the rounding here, 4 u of it, and `kPlaceTolerance` together, so
    // that the face of the least rounded distance is never passed over.
    constexpr double kSlack = 1e-12;
    double t_in = from;
    double t_out = to;
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(inverse_[axis])) {
        // The line does not move along this axis, or by so little that its inverse overflows.
        const double reach = std::abs(ahead_[axis] - origin_[axis]);
        if (origin_[axis] + reach < box.min()[axis] || origin_[axis] - reach > box.max()[axis]) {
          return false;
        }
        continue;
      }
      double t0 = (box.min()[axis] - origin_[axis]) * inverse_[axis];
      double t1 = (box.max()[axis] - origin_[axis]) * inverse_[axis];
      if (t0 > t1) std::swap(t0, t1);
      t_in = std::max(t_in, t0 - kSlack);
      t_out = std::min(t_out, t1 + kSlack);
    }
    return t_in <= t_out;
  }

  // Whether the line meets the closed triangle, from the origin on or anywhere; exact.
  std::optional<Meeting> meet(const std::array<Eigen::Vector3d, 3>& corners, double from) const {
    const auto& [a, b, c] = corners;
    Meeting meeting;
    meeting.sides = {internal::orientation(origin_, ahead_, a, b),
                     internal::orientation(origin_, ahead_, b, c),
                     internal::orientation(origin_, ahead_, c, a)};
    const auto [least, most] = std::minmax_element(meeting.sides.begin(), meeting.sides.end());
    if (*least < 0 && *most > 0) return std::nullopt;
    if (*least == 0 && *most == 0) return std::nullopt;  // In its plane: its neighbors count.
    const int side = internal::orientation(a, b, c, origin_);
    meeting.t = 0.0;
    if (side != 0) {
      const bool is_ahead = side * internal::orientation(a, b, c, ahead_) <= 0;
      if (!is_ahead && from == 0.0) return std::nullopt;
      // Exact signs have the last word over a rounded quotient.
      const double t = place_in_plane(corners);
      meeting.t = is_ahead ? std::clamp(t, 0.0, 1.0) : std::clamp(t, -1.0, 0.0);
    }
    const int around = moved_side(meeting.sides[0], a, b);
    const bool crosses = around != 0 && moved_side(meeting.sides[1], b, c) == around &&
                         moved_side(meeting.sides[2], c, a) == around;
    meeting.crossing = crosses ? around : 0;
    return meeting;
  }

  double distance(const Meeting& meeting) const { return length_ * meeting.t; }

  RayHit hit(const Meeting& meeting, const IndexedTriangle& triangle) const {
    RayHit hit;
    hit.point = origin_ + meeting.t * (ahead_ - origin_);
    hit.distance = distance(meeting);
    hit.face = triangle.face;
    hit.crossing = meeting.crossing;
    // A corner's weight is the volume that the line spans with the edge opposite it.
    const int around = *std::max_element(meeting.sides.begin(), meeting.sides.end()) > 0 ? 1 : -1;
    const Eigen::Vector3d along = ahead_ - origin_;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double volume =
          along.dot((triangle.corners[i] - origin_).cross(triangle.corners[j] - origin_));
      hit.barycentric[(i + 2) % 3] = meeting.sides[i] == 0 ? 0.0 : std::max(0.0, around * volume);
    }
    const double sum = hit.barycentric.sum();
    if (sum > 0.0 && std::isfinite(1.0 / sum)) {
      hit.barycentric /= sum;
    } else {
      hit.barycentric = internal::nearest_on_triangle(hit.point, triangle.corners).barycentric;
    }
    return hit;
  }

 private:
  // Where the line meets the plane of a triangle that it meets, off by at most kPlaceTolerance.
  //
  // With A and B the largest coordinates of the two edges of the normal, each coordinate of it is
  // off by 8 u A B, its product with a vector by 16 u A B times the sum of the vector's
  // coordinates. Since the quotient is at most 1, it is off by 16 u A B (D + E) over `fall`, D and
  // E those sums; 32 u are allowed. Only faces seen edge-on and needles are beyond what long
  // doubles can do.
  double place_in_plane(const std::array<Eigen::Vector3d, 3>& corners) const {
    const auto& [a, b, c] = corners;
    const double edges = (b - a).lpNorm<Eigen::Infinity>() * (c - a).lpNorm<Eigen::Infinity>();
    const double size = edges * ((origin_ - a).lpNorm<1>() + (ahead_ - origin_).lpNorm<1>());
    const auto is_precise = [&](double fall, double epsilon) {
      // Products below this may have lost bits to underflow.
      constexpr double kLeast = 0x1p-900;
      return std::min(edges, size) > kLeast && std::isfinite(fall) &&
             16.0 * epsilon * size <= kPlaceTolerance * std::abs(fall);
    };
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double height = normal.dot(origin_ - a);
    const double fall = normal.dot(origin_ - ahead_);
    if (is_precise(fall, std::numeric_limits<double>::epsilon())) return height / fall;
    const auto [long_height, long_fall] = height_and_fall<long double>(corners, origin_, ahead_);
    constexpr auto kLongEpsilon = static_cast<double>(std::numeric_limits<long double>::epsilon());
    if (is_precise(static_cast<double>(long_fall), kLongEpsilon)) {
      return static_cast<double>(long_height / long_fall);
    }
    using internal::Rational;
    const auto [exact_height, exact_fall] = height_and_fall<Rational>(corners, origin_, ahead_);
    return internal::nearest_double(Rational(exact_height / exact_fall));
  }

  // `side` of the line moved by (ε, ε², ε³) for an infinitely small ε against the line from u to v:
  // where it is zero, the first of its derivatives (u − v) × (ahead − origin) that is not.
  int moved_side(int side, const Eigen::Vector3d& u, const Eigen::Vector3d& v) const {
    for (int axis = 0; axis < 3 && side == 0; ++axis) {
      side = internal::cross_2d(v, u, origin_, ahead_, (axis + 1) % 3, (axis + 2) % 3);
    }
    return side;
  }

  static constexpr double kPlaceTolerance = 0x1p-40;

  Eigen::Vector3d origin_;
  Eigen::Vector3d ahead_;
  Eigen::Vector3d inverse_;
  double length_ = 0.0;
};

Eigen::AlignedBox3d box_of_faces(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Face& f : mesh.faces) {
    for (const std::int32_t vertex : f) box.extend(mesh.vertices[vertex]);
  }
  return box;
}

TriangleMesh checked(TriangleMesh mesh) {
  if (mesh.faces.empty()) throw base::InvalidInput("MeshQuery: the mesh has no faces");
  internal::require_usable(mesh, "MeshQuery");
  return mesh;
}

/// The nearest point of the surface, where the face `first` is looked at before all others.
ClosestPoint nearest_point(const internal::IndexedMesh& indexed, const Eigen::Vector3d& point,
                           std::optional<std::int32_t> first) {
  ClosestPoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  const auto offer = [&](const std::array<Eigen::Vector3d, 3>& corners, std::int32_t face) {
    const internal::TrianglePoint candidate = internal::nearest_on_triangle(point, corners);
    const double squared = (candidate.point - point).squaredNorm();
    // Equally near faces: the least index, whatever the order.
    if (squared < best.squared_distance || (squared == best.squared_distance && face < best.face)) {
      best = {candidate.point, squared, face, candidate.barycentric};
    }
  };
  if (first) offer(corners(indexed.mesh, *first), *first);
  indexed.tree().traverse_by_bound(
      [&](const Eigen::AlignedBox3d& box) { return box.squaredExteriorDistance(point); },
      // Each coordinate of a point in its box is at least as far as the box, and so are rounded
      // differences and squares; only the order of two additions differs: 4 u of 8 u.
      [&] { return best.squared_distance * (1.0 + 0x1p-50); },
      [&](const IndexedTriangle& triangle) { offer(triangle.corners, triangle.face); });
  if (!(best.squared_distance < std::numeric_limits<double>::infinity())) {
    throw base::InvalidInput(
        "MeshQuery::closest_point: the point is not finite, or too far for squared distances");
  }
  return best;
}

}  // namespace

internal::IndexedMesh::IndexedMesh(TriangleMesh the_mesh)
    : mesh(checked(std::move(the_mesh))),
      box(box_of_faces(mesh)),
      part_vertices(one_vertex_per_part(mesh)) {}

MeshQuery::MeshQuery(TriangleMesh mesh)
    : indexed_(std::make_shared<const internal::IndexedMesh>(std::move(mesh))) {}

const TriangleMesh& MeshQuery::mesh() const { return indexed_->mesh; }

void MeshQuery::build() const {
  auto other = std::async(std::launch::async, [&] { indexed_->pair_tree(); });
  indexed_->tree();
  other.get();
}

const Eigen::AlignedBox3d& MeshQuery::box() const { return indexed_->box; }

ClosestPoint MeshQuery::closest_point(const Eigen::Vector3d& point) const {
  return nearest_point(*indexed_, point, std::nullopt);
}

ClosestPoint MeshQuery::closest_point(const Eigen::Vector3d& point, std::int32_t first) const {
  const auto num_faces = base::as_index<std::int32_t>(mesh().faces.size());
  base::require(first >= 0 && first < num_faces, "MeshQuery::closest_point", "first", first,
                ">= 0 and less than the number of faces");
  return nearest_point(*indexed_, point, first);
}

Containment MeshQuery::containment(const Eigen::Vector3d& point) const {
  if (!point.allFinite()) {
    throw base::InvalidInput("MeshQuery::containment: the point is not finite");
  }
  return internal::winding_around(*this, point).result();
}

double MeshQuery::signed_distance(const Eigen::Vector3d& point) const {
  const double distance = std::sqrt(closest_point(point).squared_distance);
  const Containment where = containment(point);
  if (where == Containment::OnSurface) return 0.0;
  return where == Containment::Inside ? -distance : distance;
}

std::optional<RayHit> MeshQuery::first_hit(const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& direction) const {
  const Line line("MeshQuery::first_hit", indexed_->box, origin, direction);
  std::optional<RayHit> best;
  double best_t = 1.0;
  indexed_->tree().traverse(
      [&](const Eigen::AlignedBox3d& box) { return line.may_meet(box, 0.0, best_t); },
      [&](const IndexedTriangle& triangle) {
        const std::optional<Line::Meeting> meeting = line.meet(triangle.corners, 0.0);
        if (!meeting) return;
        // As `all_hits` orders them: by the rounded distance, then by face.
        const double distance = line.distance(*meeting);
        if (!best || distance < best->distance ||
            (distance == best->distance && triangle.face < best->face)) {
          best_t = meeting->t;
          best = line.hit(*meeting, triangle);
        }
      });
  return best;
}

std::vector<RayHit> MeshQuery::all_hits(const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction, LineKind kind) const {
  const Line line("MeshQuery::all_hits", indexed_->box, origin, direction);
  const double from = kind == LineKind::Ray ? 0.0 : -1.0;
  std::vector<RayHit> hits;
  indexed_->tree().traverse(
      [&](const Eigen::AlignedBox3d& box) { return line.may_meet(box, from, 1.0); },
      [&](const IndexedTriangle& triangle) {
        if (const auto meeting = line.meet(triangle.corners, from)) {
          hits.push_back(line.hit(*meeting, triangle));
        }
      });
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
  });
  return hits;
}

std::vector<std::int32_t> MeshQuery::faces_near(const Eigen::AlignedBox3d& box) const {
  if (box.min().hasNaN() || box.max().hasNaN()) {
    throw base::InvalidInput("MeshQuery::faces_near: the box has a coordinate that is no number");
  }
  std::vector<std::int32_t> faces;
  indexed_->tree().traverse_near(
      box, [&](const IndexedTriangle& triangle) { faces.push_back(triangle.face); });
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace graspfit::geometry
