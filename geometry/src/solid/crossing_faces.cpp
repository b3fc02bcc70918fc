#include "solid/crossing_faces.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>

#include "exact/predicates.hpp"
#include "mesh/vertex_welding.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::array<Vector3d, 3>;

Kernel::Point_3 to_cgal(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Kernel::Triangle_3 to_cgal(const Corners& c) {
  return {to_cgal(c[0]), to_cgal(c[1]), to_cgal(c[2])};
}

/// Whether two triangles that share their corner 0 and no other have another common point p: the
/// ray from that corner through p then leaves one triangle through the opposite side while it is
/// still in the other.
bool fans_cross(const Corners& a, const Corners& b) {
  const auto stays_beside = [](const Corners& plane, const Corners& other) {
    const int side = orientation(plane[0], plane[1], plane[2], other[1]);
    return side != 0 && side == orientation(plane[0], plane[1], plane[2], other[2]);
  };
  if (stays_beside(a, b) || stays_beside(b, a)) return false;
  const auto side_meets = [](const Corners& side_of, const Corners& triangle) {
    return CGAL::do_intersect(Kernel::Segment_3(to_cgal(side_of[1]), to_cgal(side_of[2])),
                              to_cgal(triangle));
  };
  return side_meets(a, b) || side_meets(b, a);
}

/// Whether two triangles that share the edge from corner 0 to 1 overlap: they do exactly if they
/// are folded onto each other.
bool hinge_overlaps(const Corners& a, const Corners& b) {
  if (orientation(a[0], a[1], a[2], b[2]) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const int side = orientation_2d(a[0], a[1], a[2], u, v);
    if (side != 0) return side == orientation_2d(a[0], a[1], b[2], u, v);
  }
  return false;
}

class PairTest {
 public:
  explicit PairTest(const TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<Vector3d> positions = mesh.vertices;
    place_of_ = weld_equal(positions);
  }

  bool operator()(std::int32_t first, std::int32_t second) const {
    const Face& f = mesh_.faces[first];
    const Face& g = mesh_.faces[second];
    // Common corners first, in the same order in both.
    std::array<int, 3> of_f = {0, 1, 2};
    std::array<int, 3> of_g = {0, 1, 2};
    int common = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = common; j < 3; ++j) {
        if (place_of_[f[of_f[i]]] != place_of_[g[of_g[j]]]) continue;
        std::swap(of_f[common], of_f[i]);
        std::swap(of_g[common], of_g[j]);
        ++common;
        break;
      }
    }
    const Corners a = corners_of(f, of_f);
    const Corners b = corners_of(g, of_g);
    switch (common) {
      case 0:
        return !is_beside(a, b) && !is_beside(b, a) && CGAL::do_intersect(to_cgal(a), to_cgal(b));
      case 1:
        return fans_cross(a, b);
      case 2:
        return hinge_overlaps(a, b);
      default:
        return true;
    }
  }

 private:
  Corners corners_of(const Face& face, const std::array<int, 3>& order) const {
    return {mesh_.vertices[face[order[0]]], mesh_.vertices[face[order[1]]],
            mesh_.vertices[face[order[2]]]};
  }

  const TriangleMesh& mesh_;
  std::vector<std::int32_t> place_of_;  ///< Equal for vertices with the same coordinates.
};

}  // namespace

std::vector<std::pair<std::int32_t, std::int32_t>> crossing_faces(
    const TriangleMesh& mesh, std::span<const std::int32_t> parts) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int32_t>;
  std::vector<Box> boxes;
  boxes.reserve(mesh.faces.size());
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    if (is_degenerate(mesh, face)) continue;
    const auto [a, b, c] = corners(mesh, face);
    const Vector3d lower = a.cwiseMin(b).cwiseMin(c);
    const Vector3d upper = a.cwiseMax(b).cwiseMax(c);
    boxes.emplace_back(CGAL::Bbox_3(lower[0], lower[1], lower[2], upper[0], upper[1], upper[2]),
                       face);
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  const PairTest do_cross(mesh);
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    const std::int32_t first = std::min(a.info(), b.info());
    const std::int32_t second = std::max(a.info(), b.info());
    if (!parts.empty() && parts[first] == parts[second]) return;
    if (do_cross(first, second)) pairs.emplace_back(first, second);
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace graspfit::geometry::internal
