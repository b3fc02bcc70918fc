#include "graspfit/geometry/mesh_analysis.hpp"

#include <algorithm>
#include <set>

#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/geometry/used_vertices.hpp"
#include "mesh/input_check.hpp"
#include "query/face_tree.hpp"
#include "query/overlapping_boxes.hpp"
#include "solid/crossing_faces.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry {
namespace {

using base::DisjointSets;
using internal::FaceSide;

/// Faces beyond the first with the same three vertices, in whatever order.
std::size_t count_doubled(const TriangleMesh& mesh, const std::vector<FaceSide>& sides) {
  // Such faces share their edges, and for each edge the opposite vertex.
  std::vector<std::int32_t> candidates;
  const auto across = [&mesh](const FaceSide& side) {
    return mesh.faces[side.face][side.corner == 0 ? 2 : side.corner - 1];
  };
  std::vector<std::pair<std::int32_t, std::int32_t>> around;  // vertex across, face
  internal::for_each_edge(sides, [&](auto first, auto last) {
    around.clear();
    for (auto side = first; side != last; ++side) around.emplace_back(across(*side), side->face);
    if (around.size() > 2) std::sort(around.begin(), around.end());
    for (std::size_t i = 1; i < around.size(); ++i) {
      if (around[i].first != around[i - 1].first) continue;
      candidates.push_back(around[i - 1].second);
      candidates.push_back(around[i].second);
    }
  });
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    if (internal::has_repeated_vertex(mesh.faces[face])) {
      candidates.push_back(face);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::set<Face> seen;
  for (const std::int32_t face : candidates) {
    Face sorted = mesh.faces[face];
    std::sort(sorted.begin(), sorted.end());
    seen.insert(sorted);
  }
  return candidates.size() - seen.size();
}

/// Whether the faces of any vertex form more than one fan.
bool has_pinched_vertex(const TriangleMesh& mesh, const std::vector<FaceSide>& sides) {
  // Corners (3 · face + k) are one fan if they are joined through shared edges at their vertex.
  DisjointSets fans(3 * mesh.faces.size());
  internal::for_each_edge(sides, [&](auto first, auto last) {
    for (auto other = first + 1; other < last; ++other) {
      fans.unite(first->corner_at(first->low()), other->corner_at(first->low()));
      fans.unite(first->corner_at(first->high()), other->corner_at(first->high()));
    }
  });
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t fan = fans.root(3 * face + k);
      std::int32_t& known = fan_of[mesh.faces[face][k]];
      if (known >= 0 && known != fan) return true;
      known = fan;
    }
  }
  return false;
}

/// Fills in the pairs of parts that cross and the parts that lie in another one.
void count_part_overlaps(const TriangleMesh& mesh, const std::vector<std::int32_t>& parts,
                         const std::vector<bool>& is_part_closed, MeshAnalysis& analysis) {
  analysis.num_overlapping_part_pairs = 0;
  analysis.num_nested_parts = 0;
  if (!internal::do_boxes_overlap(internal::boxes_of_parts(mesh, parts, is_part_closed.size()))) {
    return;
  }
  std::set<std::pair<std::int32_t, std::int32_t>> crossing;
  for (const auto& [first, second] : internal::crossing_faces(mesh, parts)) {
    crossing.insert(std::minmax(parts[first], parts[second]));
  }
  analysis.num_overlapping_part_pairs = crossing.size();
  const internal::FaceTree tree(mesh);
  std::vector<bool> is_seen(is_part_closed.size(), false);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const std::int32_t part = parts[face];
    if (is_seen[part]) continue;
    is_seen[part] = true;
    const std::vector<std::int32_t> around =
        internal::parts_around(tree, parts, mesh.vertices[mesh.faces[face][0]]);
    const bool is_nested = std::any_of(around.begin(), around.end(), [&](std::int32_t other) {
      return other != part && is_part_closed[other] && !crossing.contains(std::minmax(part, other));
    });
    if (is_nested) ++*analysis.num_nested_parts;
  }
}

}  // namespace

MeshAnalysis analyze(const TriangleMesh& mesh, const MeshAnalysisOptions& options) {
  internal::require_usable(mesh, "analyze");
  MeshAnalysis analysis;
  analysis.num_vertices = mesh.vertices.size();
  analysis.num_faces = mesh.faces.size();
  analysis.box = bounding_box(mesh);

  analysis.num_unused_vertices = mesh.vertices.size() - used_vertices(mesh).size();
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    if (internal::is_degenerate(mesh, face)) ++analysis.num_degenerate_faces;
  }

  const std::vector<FaceSide> sides = internal::sorted_sides(mesh);
  const std::vector<std::int32_t> parts = internal::parts_of_faces(mesh, sides);
  analysis.num_doubled_faces = count_doubled(mesh, sides);
  analysis.num_parts =
      parts.empty() ? 0
                    : static_cast<std::size_t>(*std::max_element(parts.begin(), parts.end())) + 1;
  std::vector<bool> is_part_closed(analysis.num_parts, true);
  internal::for_each_edge(sides, [&](auto first, auto last) {
    const auto count = last - first;
    const bool is_consistent = count == 2 && first->runs_up() != (first + 1)->runs_up();
    if (count == 1) ++analysis.num_boundary_edges;
    if (count > 2) ++analysis.num_nonmanifold_edges;
    if (count == 2 && !is_consistent) ++analysis.num_inconsistent_edges;
    if (!is_consistent) is_part_closed[parts[first->face]] = false;
  });
  // A face with a repeated vertex has no sides; its part is only itself and not closed.
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (internal::has_repeated_vertex(mesh.faces[face])) is_part_closed[parts[face]] = false;
  }
  analysis.num_inward_parts = internal::inside_out_parts(mesh, parts, is_part_closed).size();
  analysis.is_closed =
      !mesh.faces.empty() && std::all_of(is_part_closed.begin(), is_part_closed.end(),
                                         [](bool is_closed) { return is_closed; });
  analysis.is_manifold = analysis.num_nonmanifold_edges == 0 && !has_pinched_vertex(mesh, sides);
  analysis.is_outward = analysis.is_closed && analysis.num_inward_parts == 0;
  if (options.count_self_intersections) {
    analysis.num_self_intersections = internal::crossing_faces(mesh).size();
  }
  if (options.count_part_overlaps) count_part_overlaps(mesh, parts, is_part_closed, analysis);
  return analysis;
}

}  // namespace graspfit::geometry
