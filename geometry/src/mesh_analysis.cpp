#include "graspfit/geometry/mesh_analysis.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "internal/mesh_edges.hpp"

namespace graspfit::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// Faces beyond the first with the same three vertices, in whatever order.
std::size_t count_doubled(const TriangleMesh& mesh) {
  std::vector<Face> sorted = mesh.faces;
  for (Face& face : sorted) std::sort(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(
      std::distance(std::unique(sorted.begin(), sorted.end()), sorted.end()));
}

/// Vertices whose faces form more than one fan.
bool has_pinched_vertex(const TriangleMesh& mesh, const std::vector<FaceSide>& sides) {
  // Corners (3 · face + k) are one fan if they are joined through shared edges at their vertex.
  DisjointSets fans(3 * mesh.faces.size());
  const auto corner_at = [&](const FaceSide& side, std::int32_t vertex) {
    return 3 * side.face + (side.tail == vertex ? side.corner : (side.corner + 1) % 3);
  };
  for_each_edge(sides, [&](auto first, auto last) {
    for (auto other = first + 1; other < last; ++other) {
      fans.unite(corner_at(*first, first->low()), corner_at(*other, first->low()));
      fans.unite(corner_at(*first, first->high()), corner_at(*other, first->high()));
    }
  });
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t fan = fans.root(static_cast<std::int32_t>(3 * face) + k);
      std::int32_t& known = fan_of[mesh.faces[face][k]];
      if (known >= 0 && known != fan) return true;
      known = fan;
    }
  }
  return false;
}

/// Pairs of faces without a common vertex that share a point. Exact.
std::size_t count_self_intersections(const TriangleMesh& mesh) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Box> boxes;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (is_degenerate(mesh, face)) continue;
    const auto [a, b, c] = corners(mesh, face);
    boxes.emplace_back(to_cgal(a).bbox() + to_cgal(b).bbox() + to_cgal(c).bbox(), face);
  }
  const auto triangle = [&](std::size_t face) {
    const auto [a, b, c] = corners(mesh, face);
    return Kernel::Triangle_3(to_cgal(a), to_cgal(b), to_cgal(c));
  };
  std::size_t count = 0;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    const Face& first = mesh.faces[a.info()];
    const Face& second = mesh.faces[b.info()];
    const bool share_vertex = std::any_of(first.begin(), first.end(), [&](std::int32_t v) {
      return std::find(second.begin(), second.end(), v) != second.end();
    });
    if (!share_vertex && CGAL::do_intersect(triangle(a.info()), triangle(b.info()))) ++count;
  });
  return count;
}

}  // namespace

std::vector<FaceSide> sorted_sides(const TriangleMesh& mesh) {
  std::vector<FaceSide> sides;
  sides.reserve(3 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    for (std::int32_t k = 0; k < 3; ++k) {
      sides.push_back({face[k], face[(k + 1) % 3], static_cast<std::int32_t>(f), k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
    return std::make_tuple(a.low(), a.high(), a.face, a.corner) <
           std::make_tuple(b.low(), b.high(), b.face, b.corner);
  });
  return sides;
}

std::vector<std::int32_t> parts_of_faces(const TriangleMesh& mesh,
                                         const std::vector<FaceSide>& sides) {
  DisjointSets sets(mesh.faces.size());
  for_each_edge(sides, [&](auto first, auto last) {
    for (auto other = first + 1; other < last; ++other) sets.unite(first->face, other->face);
  });
  std::vector<std::int32_t> parts(mesh.faces.size(), -1);
  std::int32_t next = 0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    // The root is the part's first face, so it has been numbered by now.
    const std::int32_t root = sets.root(static_cast<std::int32_t>(face));
    parts[face] = root == static_cast<std::int32_t>(face) ? next++ : parts[root];
  }
  return parts;
}

bool is_degenerate(const TriangleMesh& mesh, std::size_t face) {
  const auto [a, b, c] = corners(mesh, face);
  return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& parts,
                     std::int32_t part) {
  TriangleMesh result;
  std::vector<std::int32_t> new_index(mesh.vertices.size(), -1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (parts[f] != part) continue;
    Face face = mesh.faces[f];
    for (std::int32_t& vertex : face) {
      if (new_index[vertex] < 0) {
        new_index[vertex] = static_cast<std::int32_t>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[vertex]);
      }
      vertex = new_index[vertex];
    }
    result.faces.push_back(face);
  }
  return result;
}

std::vector<std::int32_t> inside_out_parts(const TriangleMesh& mesh,
                                           const std::vector<std::int32_t>& parts,
                                           const std::vector<bool>& is_part_closed) {
  const auto num_parts = static_cast<std::int32_t>(is_part_closed.size());
  std::vector<TriangleMesh> meshes;
  for (std::int32_t part = 0; part < num_parts; ++part) {
    meshes.push_back(part_of(mesh, parts, part));
  }
  std::vector<std::int32_t> result;
  for (std::int32_t part = 0; part < num_parts; ++part) {
    if (!is_part_closed[part] || signed_volume(meshes[part]) >= 0.0) continue;
    const Eigen::Vector3d& point = meshes[part].vertices.front();
    bool is_enclosed = false;
    for (std::int32_t other = 0; other < num_parts && !is_enclosed; ++other) {
      if (other == part || !is_part_closed[other]) continue;
      if (!bounding_box(meshes[other]).contains(bounding_box(meshes[part]))) continue;
      is_enclosed = MeshQuery(meshes[other]).containment(point) == Containment::Inside;
    }
    if (!is_enclosed) result.push_back(part);
  }
  return result;
}

MeshAnalysis analyze(const TriangleMesh& mesh, const MeshAnalysisOptions& options) {
  MeshAnalysis analysis;
  analysis.num_vertices = mesh.vertices.size();
  analysis.num_faces = mesh.faces.size();
  analysis.box = bounding_box(mesh);

  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) is_used[vertex] = true;
  }
  analysis.num_unused_vertices =
      static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), false));
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (is_degenerate(mesh, face)) ++analysis.num_degenerate_faces;
  }
  analysis.num_doubled_faces = count_doubled(mesh);

  const std::vector<FaceSide> sides = sorted_sides(mesh);
  const std::vector<std::int32_t> parts = parts_of_faces(mesh, sides);
  analysis.num_parts =
      parts.empty() ? 0
                    : static_cast<std::size_t>(*std::max_element(parts.begin(), parts.end())) + 1;
  std::vector<bool> is_part_closed(analysis.num_parts, true);
  for_each_edge(sides, [&](auto first, auto last) {
    const auto count = last - first;
    const bool is_consistent = count == 2 && first->runs_up() != (first + 1)->runs_up();
    if (count == 1) ++analysis.num_boundary_edges;
    if (count > 2) ++analysis.num_nonmanifold_edges;
    if (count == 2 && !is_consistent) ++analysis.num_inconsistent_edges;
    if (!is_consistent) is_part_closed[parts[first->face]] = false;
  });
  // A face with a repeated vertex has no sides; its part is only itself and not closed.
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Face& f = mesh.faces[face];
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) is_part_closed[parts[face]] = false;
  }
  analysis.num_inward_parts = inside_out_parts(mesh, parts, is_part_closed).size();
  analysis.is_closed =
      !mesh.faces.empty() && std::all_of(is_part_closed.begin(), is_part_closed.end(),
                                         [](bool is_closed) { return is_closed; });
  analysis.is_manifold = analysis.num_nonmanifold_edges == 0 && !has_pinched_vertex(mesh, sides);
  analysis.is_outward = analysis.is_closed && analysis.num_inward_parts == 0;
  if (options.count_self_intersections) {
    analysis.num_self_intersections = count_self_intersections(mesh);
  }
  return analysis;
}

}  // namespace graspfit::geometry
