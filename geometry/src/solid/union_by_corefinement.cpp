#include "solid/union_by_corefinement.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "exact/exact_number.hpp"
#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = Exact::Point_3;
using Graph = CGAL::Surface_mesh<ExactPoint>;
using Coordinates = std::array<double, 3>;

Coordinates coordinates(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// Starts with the lowest index, so that one face is one triple.
Face turned_to_lowest(Face face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

bool is_every_edge_of_two_faces(const std::vector<FaceSide>& sides) {
  bool is_met = true;
  for_each_edge(sides, [&](auto first, auto last) {
    is_met = is_met && last - first == 2 && first->runs_up() != (first + 1)->runs_up();
  });
  return is_met;
}

bool have_common_vertices(const TriangleMesh& mesh, const std::vector<std::int32_t>& parts) {
  std::vector<std::int32_t> part_of(mesh.vertices.size(), -1);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face]) {
      std::int32_t& part = part_of[vertex];
      if (part >= 0 && part != parts[face]) return true;
      part = parts[face];
    }
  }
  return false;
}

using Corners = std::array<Vector3d, 3>;
using Segment = CGAL::Exact_predicates_inexact_constructions_kernel::Segment_3;

Segment edge_of(const Corners& face, int side) {
  const Vector3d& p = face[side];
  const Vector3d& q = face[(side + 1) % 3];
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z()}};
}

/// Whether edges go through the inside of faces only: no corner lies on the other face, and no edge
/// meets another.
bool cross_in_general_position(const Corners& a, const Corners& b) {
  const auto is_on = [](const Corners& face) {
    return [&face](const Vector3d& p) { return is_on_triangle(p, face[0], face[1], face[2]); };
  };
  if (std::any_of(a.begin(), a.end(), is_on(b)) || std::any_of(b.begin(), b.end(), is_on(a))) {
    return false;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (CGAL::do_intersect(edge_of(a, i), edge_of(b, j))) return false;
    }
  }
  return true;
}

/// Every part as a graph of CGAL; empty if one is no manifold, or does not point outward.
std::vector<Graph> graphs_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& parts) {
  std::vector<Graph> graphs(
      static_cast<std::size_t>(*std::max_element(parts.begin(), parts.end()) + 1));
  std::vector<Graph::Vertex_index> vertex_of(mesh.vertices.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    Graph& graph = graphs[parts[face]];
    std::array<Graph::Vertex_index, 3> vertices;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t index = mesh.faces[face][i];
      if (!vertex_of[index].is_valid()) {
        const Vector3d& p = mesh.vertices[index];
        vertex_of[index] = graph.add_vertex(ExactPoint(p.x(), p.y(), p.z()));
      }
      vertices[i] = vertex_of[index];
    }
    if (graph.add_face(vertices) == Graph::null_face()) return {};
  }
  const bool are_outward = std::all_of(graphs.begin(), graphs.end(), [](const Graph& graph) {
    return CGAL::is_closed(graph) && CGAL::Polygon_mesh_processing::is_outward_oriented(graph);
  });
  return are_outward ? std::move(graphs) : std::vector<Graph>{};
}

/// Exact numbers are asked for only where the interval is not a double already, as that of a point
/// which was given.
double rounded(const Exact::FT& number) {
  const auto [low, high] = CGAL::to_interval(number);
  return low == high ? low : nearest_double(CGAL::exact(number));
}

/// The graph with the vertices of `mesh`, then new ones.
TriangleMesh rounded_mesh(const Graph& graph, const TriangleMesh& mesh) {
  TriangleMesh result{mesh.vertices, {}};
  std::map<Coordinates, std::int32_t> known;
  for (std::int32_t i = 0; i < std::ssize(mesh.vertices); ++i) {
    known.emplace(coordinates(mesh.vertices[i]), i);
  }
  std::vector<std::int32_t> index_of(graph.num_vertices(), -1);
  std::vector<std::pair<Coordinates, std::size_t>> added;
  for (const Graph::Vertex_index vertex : graph.vertices()) {
    const ExactPoint& p = graph.point(vertex);
    const Coordinates nearest = {rounded(p.x()), rounded(p.y()), rounded(p.z())};
    const auto at = known.find(nearest);
    const bool is_known = at != known.end() && p == ExactPoint(nearest[0], nearest[1], nearest[2]);
    if (is_known) {
      index_of[vertex] = at->second;
    } else {
      added.emplace_back(nearest, static_cast<std::size_t>(vertex));
    }
  }
  std::sort(added.begin(), added.end());
  for (const auto& [at, vertex] : added) {
    index_of[vertex] = base::as_index<std::int32_t>(result.vertices.size());
    result.vertices.emplace_back(at[0], at[1], at[2]);
  }
  std::map<Face, std::size_t> whole;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    whole.emplace(turned_to_lowest(mesh.faces[face]), face);
  }
  std::vector<std::size_t> kept;
  std::vector<Face> pieces;
  for (const Graph::Face_index face : graph.faces()) {
    Face indices{};
    int corner = 0;
    for (const Graph::Vertex_index vertex : graph.vertices_around_face(graph.halfedge(face))) {
      indices[corner++] = index_of[vertex];
    }
    const Face turned = turned_to_lowest(indices);
    const auto at = whole.find(turned);
    if (at != whole.end()) {
      kept.push_back(at->second);
    } else {
      pieces.push_back(turned);
    }
  }
  std::sort(kept.begin(), kept.end());
  std::sort(pieces.begin(), pieces.end());
  for (const std::size_t face : kept) result.faces.push_back(mesh.faces[face]);
  result.faces.insert(result.faces.end(), pieces.begin(), pieces.end());
  return result;
}

}  // namespace

std::optional<TriangleMesh> union_by_corefinement(const TriangleMesh& mesh,
                                                  std::span<const FacePair> crossings) {
  if (crossings.empty()) return std::nullopt;
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  if (!is_every_edge_of_two_faces(sides)) return std::nullopt;
  const std::vector<std::int32_t> parts = parts_of_faces(mesh, sides);
  if (have_common_vertices(mesh, parts)) return std::nullopt;
  for (const FacePair& pair : crossings) {
    const auto [first, second] = pair;
    if (parts[first] == parts[second] ||
        !cross_in_general_position(corners(mesh, first), corners(mesh, second))) {
      return std::nullopt;
    }
  }
  std::vector<Graph> graphs = graphs_of(mesh, parts);
  if (graphs.empty()) return std::nullopt;
  for (std::size_t part = 1; part < graphs.size(); ++part) {
    Graph united;
    if (!CGAL::Polygon_mesh_processing::corefine_and_compute_union(graphs[0], graphs[part],
                                                                   united)) {
      return std::nullopt;
    }
    graphs[0] = std::move(united);
  }
  return rounded_mesh(graphs[0], mesh);
}

}  // namespace graspfit::geometry::internal
