#include "solid/mesh_operations.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

#include <algorithm>
#include <cstdint>
#include <map>

#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "mesh/vertex_welding.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Whether the three numbers run upward, up to rotation.
bool is_even(const Face& f) {
  return (f[0] < f[1] && f[1] < f[2]) || (f[1] < f[2] && f[2] < f[0]) ||
         (f[2] < f[0] && f[0] < f[1]);
}

void flip(Face& face) { std::swap(face[1], face[2]); }

/// Sides of one edge in the order in which their faces stand around it, counter-clockwise seen from
/// its higher vertex; exact. Of coincident faces those that run up come first: seen along the edge
/// they end a wedge of solid, and the others begin one.
std::vector<FaceSide> sorted_around(const TriangleMesh& mesh, std::vector<FaceSide> sides) {
  const Vector3d& low = mesh.vertices[sides.front().low()];
  const Vector3d& high = mesh.vertices[sides.front().high()];
  const auto third = [&mesh](const FaceSide& side) -> const Vector3d& {
    return mesh.vertices[mesh.faces[side.face][(side.corner + 2) % 3]];
  };
  const auto has_area = [&](const FaceSide& side) {
    return !are_collinear(low, high, third(side));
  };
  const auto found = std::find_if(sides.begin(), sides.end(), has_area);
  if (found == sides.end()) return sides;
  const Vector3d reference = third(*found);
  struct Item {
    FaceSide side;
    int half;  ///< Angle from the reference: 0 none, 1 below half a turn, 2 half a turn, 3 beyond;
               ///< −1 no area.
  };
  std::vector<Item> items;
  for (const FaceSide& side : sides) {
    int half = -1;
    if (has_area(side)) {
      const int turn = orientation(low, high, reference, third(side));
      bool is_ahead = false;
      for (int u = 0; u < 3 && turn == 0; ++u) {
        const int v = (u + 1) % 3;
        const int seen = orientation_2d(low, high, reference, u, v);
        is_ahead = seen != 0 && seen == orientation_2d(low, high, third(side), u, v);
        if (seen != 0) break;
      }
      half = turn > 0 ? 1 : turn < 0 ? 3 : is_ahead ? 0 : 2;
    }
    items.push_back({side, half});
  }
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
    if (a.half != b.half) return a.half < b.half;
    if (a.half == 1 || a.half == 3) {
      const int turn = orientation(low, high, third(a.side), third(b.side));
      if (turn != 0) return turn > 0;
    }
    return a.side.runs_up() && !b.side.runs_up();
  });
  for (std::size_t i = 0; i < items.size(); ++i) sides[i] = items[i].side;
  return sides;
}

/// Triangles that close a hole, as indices into its rim. A rim without area, as where a vertex of
/// one face lies on an edge of another, gets triangles without area.
std::vector<Face> patch_of(const TriangleMesh& mesh, const HoleRim& rim) {
  const auto point = [&](std::size_t i) -> const Vector3d& { return mesh.vertices[rim[i]]; };
  std::size_t num_on_line = 2;
  while (num_on_line < rim.size() && are_collinear(point(0), point(1), point(num_on_line))) {
    ++num_on_line;
  }
  std::vector<Face> patch;
  if (rim.size() == 3 || num_on_line == rim.size()) {
    for (std::int32_t i = 2; i < std::ssize(rim); ++i) {
      patch.push_back({0, i - 1, i});
    }
    return patch;
  }
  std::vector<Kernel::Point_3> points;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    points.emplace_back(point(i).x(), point(i).y(), point(i).z());
  }
  std::vector<CGAL::Triple<int, int, int>> triangles;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(triangles));
  for (const auto& t : triangles) {
    // The patch runs along the rim where its corners are numbered upward.
    Face face = {t.first, t.second, t.third};
    if (!is_even(face)) flip(face);
    patch.push_back(face);
  }
  return patch;
}

}  // namespace

std::pair<std::size_t, double> weld(TriangleMesh& mesh, double distance) {
  const std::vector<Vector3d> before = mesh.vertices;
  const std::vector<std::int32_t> target =
      distance > 0.0 ? weld_near(mesh.vertices, distance) : weld_equal(mesh.vertices);
  for (Face& face : mesh.faces) {
    for (std::int32_t& vertex : face) vertex = target[vertex];
  }
  double farthest = 0.0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    farthest = std::max(farthest, (before[v] - mesh.vertices[target[v]]).norm());
  }
  // A length is off by 3.5 units of 2^-53; 8 are added.
  return {before.size() - mesh.vertices.size(), farthest * (1.0 + 0x1p-50)};
}

std::size_t remove_unused_vertices(TriangleMesh& mesh) {
  std::vector<std::int32_t> new_index(mesh.vertices.size(), -1);
  for (const Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) new_index[vertex] = 0;
  }
  std::int32_t next = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (new_index[v] < 0) continue;
    mesh.vertices[next] = mesh.vertices[v];
    new_index[v] = next++;
  }
  const std::size_t removed = mesh.vertices.size() - next;
  mesh.vertices.resize(next);
  for (Face& face : mesh.faces) {
    for (std::int32_t& vertex : face) vertex = new_index[vertex];
  }
  return removed;
}

std::size_t remove_collapsed_faces(TriangleMesh& mesh) {
  return std::erase_if(mesh.faces, has_repeated_vertex);
}

std::size_t remove_doubled_faces(TriangleMesh& mesh, TwoSided two_sided) {
  struct Tally {
    int balance = 0;
    int kept = 0;
  };
  const auto key = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::map<Face, Tally> tallies;
  for (const Face& face : mesh.faces) tallies[key(face)].balance += is_even(face) ? 1 : -1;
  const bool is_two_sided = std::all_of(tallies.begin(), tallies.end(),
                                        [](const auto& t) { return t.second.balance == 0; });
  if (is_two_sided && two_sided == TwoSided::Halved) {
    return std::erase_if(mesh.faces,
                         [&](const Face& face) { return tallies[key(face)].kept++ > 0; });
  }
  return std::erase_if(mesh.faces, [&](const Face& face) {
    Tally& tally = tallies[key(face)];
    const bool is_majority = is_even(face) ? tally.balance > 0 : tally.balance < 0;
    return !is_majority || tally.kept++ > 0;
  });
}

std::size_t make_consistent(TriangleMesh& mesh) {
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  std::vector<std::vector<std::pair<std::int32_t, bool>>> neighbors(mesh.faces.size());
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2) return;
    const auto second = first + 1;
    const bool agree = first->runs_up() != second->runs_up();
    neighbors[first->face].emplace_back(second->face, agree);
    neighbors[second->face].emplace_back(first->face, agree);
  });
  std::vector<int> state(mesh.faces.size(), 0);  // 0 unseen, +1 keep, −1 turn
  for (std::int32_t start = 0; start < std::ssize(mesh.faces); ++start) {
    if (state[start] != 0) continue;
    state[start] = 1;
    std::vector<std::int32_t> component = {start};
    for (std::size_t next = 0; next < component.size(); ++next) {
      for (const auto& [neighbor, agree] : neighbors[component[next]]) {
        if (state[neighbor] != 0) continue;
        state[neighbor] = agree ? state[component[next]] : -state[component[next]];
        component.push_back(neighbor);
      }
    }
    // The orientation of the majority is kept.
    const auto turned =
        std::count_if(component.begin(), component.end(), [&](auto f) { return state[f] < 0; });
    if (2 * turned > std::ssize(component)) {
      for (const std::int32_t face : component) state[face] = -state[face];
    }
  }
  std::size_t num_turned = 0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (state[face] < 0) {
      flip(mesh.faces[face]);
      ++num_turned;
    }
  }
  return num_turned;
}

std::size_t split_nonmanifold(TriangleMesh& mesh) {
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  base::DisjointSets fans(3 * mesh.faces.size());
  const auto join = [&](const FaceSide& a, const FaceSide& b) {
    for (const std::int32_t vertex : {a.low(), a.high()}) {
      fans.unite(a.corner_at(vertex), b.corner_at(vertex));
    }
  };
  for_each_edge(sides, [&](auto first, auto last) {
    const auto count = last - first;
    if (count == 2) join(*first, *(first + 1));
    if (count <= 2) return;
    const std::vector<FaceSide> around = sorted_around(mesh, {first, last});
    // Seen along the edge, a face that runs down it has the solid on its counter-clockwise side;
    // the next face then runs up and closes that wedge.
    for (std::size_t i = 0; i < around.size(); ++i) {
      const FaceSide& opening = around[i];
      const FaceSide& closing = around[(i + 1) % around.size()];
      if (!opening.runs_up() && closing.runs_up()) join(opening, closing);
    }
  });
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  std::map<std::int32_t, std::int32_t> vertex_of_fan;
  std::size_t added = 0;
  for (std::int32_t f = 0; f < std::ssize(mesh.faces); ++f) {
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t fan = fans.root(3 * f + k);
      std::int32_t& vertex = mesh.faces[f][k];
      if (fan_of[vertex] < 0) fan_of[vertex] = fan;
      if (fan_of[vertex] == fan) continue;
      const auto [entry, is_new] =
          vertex_of_fan.try_emplace(fan, base::as_index<std::int32_t>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back(Vector3d(mesh.vertices[vertex]));
        ++added;
      }
      vertex = entry->second;
    }
  }
  return added;
}

std::size_t fill_holes(TriangleMesh& mesh, const std::vector<HoleRim>& rims,
                       double largest_extent) {
  std::size_t filled = 0;
  for (const HoleRim& rim : rims) {
    if (rim_extent(mesh, rim) > largest_extent) continue;
    const std::vector<Face> patch = patch_of(mesh, rim);
    for (const Face& f : patch) mesh.faces.push_back({rim[f[0]], rim[f[1]], rim[f[2]]});
    if (!patch.empty()) ++filled;
  }
  return filled;
}

std::size_t turn_inside_out_parts(TriangleMesh& mesh) {
  if (mesh.faces.empty()) return 0;
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  const std::vector<std::int32_t> parts = parts_of_faces(mesh, sides);
  const std::int32_t last_part = *std::max_element(parts.begin(), parts.end());
  std::vector<bool> is_closed(static_cast<std::size_t>(last_part) + 1, true);
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2) is_closed[parts[first->face]] = false;
  });
  const std::vector<std::int32_t> turned = inside_out_parts(mesh, parts, is_closed);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (std::binary_search(turned.begin(), turned.end(), parts[face])) flip(mesh.faces[face]);
  }
  return turned.size();
}

}  // namespace graspfit::geometry::internal
