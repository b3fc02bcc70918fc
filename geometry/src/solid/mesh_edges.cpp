#include "solid/mesh_edges.hpp"

#include <cmath>
#include <map>

#include "graspfit/base/disjoint_sets.hpp"
#include "query/face_tree.hpp"
#include "query/overlapping_boxes.hpp"
#include "query/winding.hpp"

namespace graspfit::geometry::internal {
namespace {

/// Sorts the sides of one lower vertex by the higher one; they are in face order and stay so.
void sort_bucket(std::vector<FaceSide>::iterator first, std::vector<FaceSide>::iterator last) {
  const auto by_high = [](const FaceSide& a, const FaceSide& b) { return a.high() < b.high(); };
  constexpr std::ptrdiff_t kFew = 32;  // A stable sort of more allocates and is worth it.
  if (last - first > kFew) {
    std::stable_sort(first, last, by_high);
    return;
  }
  for (auto next = first; next != last; ++next) {
    const FaceSide side = *next;
    auto hole = next;
    for (; hole != first && by_high(side, *(hole - 1)); --hole) *hole = *(hole - 1);
    *hole = side;
  }
}

/// Parts with a face whose box meets `box`, ascending.
std::vector<std::int32_t> parts_near(const FaceTree& tree, const std::vector<std::int32_t>& parts,
                                     const Eigen::AlignedBox3d& box) {
  std::vector<std::int32_t> near;
  tree.traverse_near(
      box, [&](const IndexedTriangle& triangle) { near.push_back(parts[triangle.face]); });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

/// Signed volume of every part, from a vertex of its own.
std::vector<double> volumes_of_parts(const TriangleMesh& mesh,
                                     const std::vector<std::int32_t>& parts,
                                     std::size_t num_parts) {
  std::vector<double> volumes(num_parts, 0.0);
  std::vector<std::int32_t> apex(num_parts, -1);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Face& f = mesh.faces[face];
    std::int32_t& at = apex[parts[face]];
    if (at < 0) at = f[0];
    const Eigen::Vector3d& origin = mesh.vertices[at];
    volumes[parts[face]] += (mesh.vertices[f[0]] - origin)
                                .cross(mesh.vertices[f[1]] - origin)
                                .dot(mesh.vertices[f[2]] - origin) /
                            6.0;
  }
  return volumes;
}

}  // namespace

std::vector<FaceSide> sorted_sides(const TriangleMesh& mesh) {
  std::vector<std::int32_t> begin(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&mesh](auto visit) {
    for (std::int32_t f = 0; f < std::ssize(mesh.faces); ++f) {
      const Face& face = mesh.faces[f];
      if (has_repeated_vertex(face)) continue;
      for (std::int32_t k = 0; k < 3; ++k) {
        visit(FaceSide{face[k], face[k == 2 ? 0 : k + 1], f, k});
      }
    }
  };
  for_each_side([&begin](const FaceSide& side) { ++begin[side.low() + 1]; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) begin[v + 1] += begin[v];
  std::vector<FaceSide> sides(begin.back());
  std::vector<std::int32_t> next(begin.begin(), begin.end() - 1);
  for_each_side([&](const FaceSide& side) { sides[next[side.low()]++] = side; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    sort_bucket(sides.begin() + begin[v], sides.begin() + begin[v + 1]);
  }
  return sides;
}

std::vector<std::int32_t> parts_of_faces(const TriangleMesh& mesh,
                                         const std::vector<FaceSide>& sides) {
  base::DisjointSets sets(mesh.faces.size());
  for_each_edge(sides, [&](auto first, auto last) {
    for (auto other = first + 1; other < last; ++other) sets.unite(first->face, other->face);
  });
  return sets.numbered();
}

bool bounds_solid(const TriangleMesh& mesh) {
  bool is_even = true;
  for_each_edge(sorted_sides(mesh), [&](auto first, auto last) {
    const auto up = std::count_if(first, last, [](const auto& side) { return side.runs_up(); });
    is_even = is_even && 2 * up == last - first;
  });
  return is_even;
}

bool is_degenerate(const TriangleMesh& mesh, std::int32_t face) {
  const auto [a, b, c] = corners(mesh, face);
  return are_collinear(a, b, c);
}

std::vector<std::int32_t> inside_out_parts(const TriangleMesh& mesh,
                                           const std::vector<std::int32_t>& parts,
                                           const std::vector<bool>& is_part_closed) {
  const std::vector<double> volumes = volumes_of_parts(mesh, parts, is_part_closed.size());
  const auto is_candidate = [&](std::int32_t part) {
    return is_part_closed[part] && volumes[part] < 0.0;
  };
  std::vector<std::int32_t> result;
  for (std::int32_t part = 0; part < std::ssize(is_part_closed); ++part) {
    if (is_candidate(part)) result.push_back(part);
  }
  if (result.empty() || is_part_closed.size() == 1) return result;

  const FaceTree tree(mesh);
  const std::vector<Eigen::AlignedBox3d> boxes = boxes_of_parts(mesh, parts, is_part_closed.size());
  std::map<std::int32_t, std::vector<std::int32_t>> vertices;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (!is_candidate(parts[face])) continue;
    std::vector<std::int32_t>& own = vertices[parts[face]];
    own.insert(own.end(), mesh.faces[face].begin(), mesh.faces[face].end());
  }
  const auto is_enclosed = [&](std::int32_t part) {
    // A part whose faces stay clear of this part's box encloses all of the box or nothing of it, so
    // that one point of the box decides. The point is off the lines through the vertices that
    // define the box, so that no rational numbers are needed. Parts that come near are tested at
    // every vertex.
    const Eigen::AlignedBox3d& box = boxes[part];
    const std::vector<std::int32_t> near = parts_near(tree, parts, box);
    const auto is_near = [&near](std::int32_t other) {
      return std::binary_search(near.begin(), near.end(), other);
    };
    const Eigen::Vector3d within(0.3701, 0.4307, 0.5903);
    const std::vector<std::int32_t> around =
        parts_around(tree, parts, box.min() + within.cwiseProduct(box.sizes()));
    if (std::any_of(around.begin(), around.end(),
                    [&](std::int32_t other) { return is_part_closed[other] && !is_near(other); })) {
      return true;
    }
    std::vector<std::int32_t> holders = near;
    std::erase_if(holders, [&](std::int32_t other) {
      return other == part || !is_part_closed[other] || !boxes[other].contains(box);
    });
    std::vector<std::int32_t>& own = vertices[part];
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    for (std::size_t i = 0; i < own.size() && !holders.empty(); ++i) {
      const std::vector<std::int32_t> here = parts_around(tree, parts, mesh.vertices[own[i]]);
      std::erase_if(holders, [&](std::int32_t other) {
        return !std::binary_search(here.begin(), here.end(), other);
      });
    }
    return !holders.empty();
  };
  std::erase_if(result, is_enclosed);
  return result;
}

std::vector<std::int32_t> parts_around(const FaceTree& tree, const std::vector<std::int32_t>& parts,
                                       const Eigen::Vector3d& point) {
  const Winding none(point);
  std::map<std::int32_t, Winding> winding_of_part;
  tree.traverse([&](const Eigen::AlignedBox3d& box) { return none.may_meet(box.min(), box.max()); },
                [&](const IndexedTriangle& triangle) {
                  winding_of_part.try_emplace(parts[triangle.face], point)
                      .first->second.add(triangle.corners);
                });
  std::vector<std::int32_t> inside;
  for (const auto& [part, winding] : winding_of_part) {
    if (winding.result() == Containment::Inside) inside.push_back(part);
  }
  return inside;
}

}  // namespace graspfit::geometry::internal
