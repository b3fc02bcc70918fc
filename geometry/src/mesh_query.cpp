#include "graspfit/geometry/mesh_query.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "graspfit/geometry/errors.hpp"
#include "internal/disjoint_sets.hpp"
#include "internal/mesh_query_impl.hpp"
#include "internal/winding.hpp"

namespace graspfit::geometry {
namespace {

using internal::BoxTree;

// More than any tree is deep: the builder halves below level 48.
constexpr int kStackSize = 128;

// Calls visit(triangle) for all triangles in leaves that enter(node) admits.
template <typename Enter, typename Visit>
void traverse(const BoxTree& tree, const Enter& enter, const Visit& visit) {
  std::array<std::int32_t, kStackSize> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::int32_t index = stack[--size];
    const BoxTree::Node& node = tree.nodes[index];
    if (!enter(node)) continue;
    if (node.count > 0) {
      for (std::int32_t i = 0; i < node.count; ++i) visit(tree.triangles[node.first + i]);
    } else {
      stack[size++] = node.first;
      stack[size++] = index + 1;
    }
  }
}

std::vector<std::int32_t> one_vertex_per_part(const TriangleMesh& mesh) {
  internal::DisjointSets sets(mesh.vertices.size());
  std::vector<char> is_used(mesh.vertices.size(), 0);
  for (const Face& f : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      is_used[f[i]] = 1;
      sets.unite(f[i], f[(i + 1) % 3]);
    }
  }
  std::vector<std::int32_t> result;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(is_used.size()); ++v) {
    if (is_used[v] && sets.root(v) == v) result.push_back(v);
  }
  return result;
}

const TriangleMesh& checked(const TriangleMesh& mesh) {
  if (mesh.faces.empty()) throw InvalidInput("MeshQuery: the mesh has no faces");
  return mesh;
}

}  // namespace

MeshQuery::Impl::Impl(TriangleMesh the_mesh)
    : mesh(std::move(the_mesh)),
      tree(checked(mesh)),
      box(tree.nodes[0].lower, tree.nodes[0].upper),
      part_vertices(one_vertex_per_part(mesh)) {}

MeshQuery::MeshQuery(TriangleMesh mesh) : impl_(std::make_shared<const Impl>(std::move(mesh))) {}

const TriangleMesh& MeshQuery::mesh() const { return impl_->mesh; }

const Eigen::AlignedBox3d& MeshQuery::box() const { return impl_->box; }

ClosestPoint MeshQuery::closest_point(const Eigen::Vector3d& point) const {
  struct Entry {
    std::int32_t node;
    double squared_distance;
  };
  const BoxTree& tree = impl_->tree;
  ClosestPoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  std::array<Entry, kStackSize> stack;
  int size = 0;
  stack[size++] = {0, 0.0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared_distance > best.squared_distance) continue;
    const BoxTree::Node& node = tree.nodes[entry.node];
    if (node.count > 0) {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
        const BoxTree::Triangle& triangle = tree.triangles[i];
        const Eigen::Vector3d candidate = internal::closest_on_triangle(point, triangle.corners);
        const double squared = (candidate - point).squaredNorm();
        // Equally near faces: the least index, whatever the shape of the tree.
        if (squared < best.squared_distance ||
            (squared == best.squared_distance && triangle.face < best.face)) {
          best = {candidate, squared, triangle.face};
        }
      }
      continue;
    }
    Entry near{entry.node + 1, internal::squared_distance(point, tree.nodes[entry.node + 1])};
    Entry far{node.first, internal::squared_distance(point, tree.nodes[node.first])};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    if (far.squared_distance <= best.squared_distance) stack[size++] = far;
    if (near.squared_distance <= best.squared_distance) stack[size++] = near;
  }
  return best;
}

Containment MeshQuery::containment(const Eigen::Vector3d& point) const {
  internal::Winding winding(point);
  traverse(
      impl_->tree,
      [&](const BoxTree::Node& node) { return winding.may_meet(node.lower, node.upper); },
      [&](const BoxTree::Triangle& triangle) { winding.add(triangle.corners); });
  return winding.result();
}

double MeshQuery::signed_distance(const Eigen::Vector3d& point) const {
  const double distance = std::sqrt(closest_point(point).squared_distance);
  switch (containment(point)) {
    case Containment::Inside:
      return -distance;
    case Containment::OnSurface:
      return 0.0;
    case Containment::Outside:
      break;
  }
  return distance;
}

std::optional<RayHit> MeshQuery::first_hit(const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d unit = direction.stableNormalized();
  if (!direction.allFinite() || unit.squaredNorm() == 0.0) {
    throw InvalidInput("MeshQuery::first_hit: the direction has no length");
  }
  if (!origin.allFinite()) throw InvalidInput("MeshQuery::first_hit: the origin is not finite");
  // The ray is the one through origin and `ahead`, as doubles; so far ahead that rounding `ahead`
  // turns it by rounding error only. Faces on both sides of an edge ask for the same exact sign, so
  // that no ray slips through a closed surface.
  const double reach = impl_->box.exteriorDistance(origin) + impl_->box.diagonal().norm() + 1e-300;
  const Eigen::Vector3d ahead = origin + 2.0 * reach * unit;
  const Eigen::Vector3d inverse = (ahead - origin).cwiseInverse();
  const double slack = 1e-12;  // Of the ray's length; boxes only have to be too large.

  std::optional<RayHit> best;
  double best_t = 1.0;  // In units of ahead − origin.
  traverse(
      impl_->tree,
      [&](const BoxTree::Node& node) {
        double t_in = 0.0;
        double t_out = best_t;
        for (int axis = 0; axis < 3; ++axis) {
          if (ahead[axis] == origin[axis]) {
            if (origin[axis] < node.lower[axis] || origin[axis] > node.upper[axis]) return false;
            continue;
          }
          double t0 = (node.lower[axis] - origin[axis]) * inverse[axis];
          double t1 = (node.upper[axis] - origin[axis]) * inverse[axis];
          if (t0 > t1) std::swap(t0, t1);
          t_in = std::max(t_in, t0 - slack);
          t_out = std::min(t_out, t1 + slack);
        }
        return t_in <= t_out;
      },
      [&](const BoxTree::Triangle& triangle) {
        const auto& [a, b, c] = triangle.corners;
        const int s0 = internal::orientation(origin, ahead, a, b);
        const int s1 = internal::orientation(origin, ahead, b, c);
        const int s2 = internal::orientation(origin, ahead, c, a);
        if (std::min({s0, s1, s2}) < 0 && std::max({s0, s1, s2}) > 0) return;
        if (s0 == 0 && s1 == 0 && s2 == 0) return;  // In the triangle's plane: its neighbors count.
        const Eigen::Vector3d normal = (b - a).cross(c - a);
        const int side = internal::orientation(a, b, c, origin);
        double t = 0.0;
        if (side != 0) {
          if (side * internal::orientation(a, b, c, ahead) > 0)
            return;  // Does not reach the plane.
          const double height = normal.dot(origin - a);
          const double fall = normal.dot(ahead - origin);
          t = fall != 0.0 ? std::clamp(-height / fall, 0.0, 1.0) : 0.0;
        }
        if (!best || t < best_t || (t == best_t && triangle.face < best->face)) {
          best_t = t;
          best = RayHit{origin + t * (ahead - origin), 2.0 * reach * t, triangle.face};
        }
      });
  return best;
}

std::vector<std::int32_t> MeshQuery::faces_near(const Eigen::AlignedBox3d& box) const {
  std::vector<std::int32_t> faces;
  const auto meets = [&](const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
    return (lower.array() <= box.max().array()).all() && (upper.array() >= box.min().array()).all();
  };
  traverse(
      impl_->tree, [&](const BoxTree::Node& node) { return meets(node.lower, node.upper); },
      [&](const BoxTree::Triangle& triangle) {
        const auto& [a, b, c] = triangle.corners;
        if (meets(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c))) {
          faces.push_back(triangle.face);
        }
      });
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace graspfit::geometry
