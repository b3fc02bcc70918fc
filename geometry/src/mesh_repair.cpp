#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "internal/mesh_edges.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Whether the three numbers run upward, up to rotation.
bool is_even(const Face& f) {
  return (f[0] < f[1] && f[1] < f[2]) || (f[1] < f[2] && f[2] < f[0]) ||
         (f[2] < f[0] && f[0] < f[1]);
}

/// Each function below changes the mesh and returns how many things it changed.

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
  const std::size_t removed = mesh.vertices.size() - static_cast<std::size_t>(next);
  mesh.vertices.resize(static_cast<std::size_t>(next));
  for (Face& face : mesh.faces) {
    for (std::int32_t& vertex : face) vertex = new_index[vertex];
  }
  return removed;
}

/// Faces with a repeated vertex bound nothing and go. Collinear faces with three vertices carry the
/// connection between their neighbors and stay: removing one would open the surface.
std::size_t remove_collapsed_faces(TriangleMesh& mesh) {
  return std::erase_if(mesh.faces,
                       [](const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
}

/// Faces on the same three vertices cancel in pairs of opposite orientation; of those left one
/// stays. Where every face has its opposite, one of each pair is left.
std::size_t remove_doubled_faces(TriangleMesh& mesh) {
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
  const bool is_double_sided = std::all_of(tallies.begin(), tallies.end(),
                                           [](const auto& t) { return t.second.balance == 0; });
  if (is_double_sided) {
    // A surface drawn on both sides throughout: the first face of each pair stays.
    return std::erase_if(mesh.faces,
                         [&](const Face& face) { return tallies[key(face)].kept++ > 0; });
  }
  return std::erase_if(mesh.faces, [&](const Face& face) {
    Tally& tally = tallies[key(face)];
    const bool is_majority = is_even(face) ? tally.balance > 0 : tally.balance < 0;
    return !is_majority || tally.kept++ > 0;
  });
}

void flip(Face& face) { std::swap(face[1], face[2]); }

/// Turns faces until neighbors over two-face edges agree, the first face of each part as it is.
/// Returns the faces turned.
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
  for (std::size_t start = 0; start < mesh.faces.size(); ++start) {
    if (state[start] != 0) continue;
    state[start] = 1;
    std::vector<std::int32_t> component = {static_cast<std::int32_t>(start)};
    for (std::size_t next = 0; next < component.size(); ++next) {
      for (const auto& [neighbor, agree] : neighbors[component[next]]) {
        if (state[neighbor] != 0) continue;
        state[neighbor] = agree ? state[component[next]] : -state[component[next]];
        component.push_back(neighbor);
      }
    }
    // The majority was right.
    const auto turned =
        std::count_if(component.begin(), component.end(), [&](auto f) { return state[f] < 0; });
    if (2 * turned > static_cast<std::ptrdiff_t>(component.size())) {
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

/// Angle of the third corner of a side's face around the edge low → high.
double angle_around(const TriangleMesh& mesh, const FaceSide& side, const Vector3d& origin,
                    const Vector3d& x, const Vector3d& y) {
  const Vector3d third = mesh.vertices[mesh.faces[side.face][(side.corner + 2) % 3]] - origin;
  return std::atan2(third.dot(y), third.dot(x));
}

/// Gives every fan of faces around a vertex a vertex of its own. Around an edge with more than two
/// faces the two that bound the same wedge of solid stay together, so that solids which touch along
/// an edge come apart. Returns the vertices added.
std::size_t split_nonmanifold(TriangleMesh& mesh) {
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  DisjointSets fans(3 * mesh.faces.size());
  const auto join = [&](const FaceSide& a, const FaceSide& b) {
    for (const std::int32_t vertex : {a.low(), a.high()}) {
      const auto corner = [&](const FaceSide& side) {
        return 3 * side.face + (side.tail == vertex ? side.corner : (side.corner + 1) % 3);
      };
      fans.unite(corner(a), corner(b));
    }
  };
  for_each_edge(sides, [&](auto first, auto last) {
    const auto count = last - first;
    if (count == 2) join(*first, *(first + 1));
    if (count <= 2) return;
    const Vector3d& origin = mesh.vertices[first->low()];
    const Vector3d axis = mesh.vertices[first->high()] - origin;
    const Vector3d x = axis.unitOrthogonal();
    const Vector3d y = axis.cross(x);
    std::vector<std::pair<double, FaceSide>> around;
    for (auto side = first; side != last; ++side) {
      around.emplace_back(angle_around(mesh, *side, origin, x, y), *side);
    }
    std::stable_sort(around.begin(), around.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    // Seen along the edge, a face that runs down it has the solid on its counter-clockwise side;
    // the next face then runs up and closes that wedge.
    for (std::size_t i = 0; i < around.size(); ++i) {
      const FaceSide& opening = around[i].second;
      const FaceSide& closing = around[(i + 1) % around.size()].second;
      if (!opening.runs_up() && closing.runs_up()) join(opening, closing);
    }
  });
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  std::map<std::int32_t, std::int32_t> vertex_of_fan;
  std::size_t added = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t fan = fans.root(static_cast<std::int32_t>(3 * f) + k);
      std::int32_t& vertex = mesh.faces[f][k];
      if (fan_of[vertex] < 0) fan_of[vertex] = fan;
      if (fan_of[vertex] == fan) continue;
      const auto [entry, is_new] =
          vertex_of_fan.try_emplace(fan, static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back(Vector3d(mesh.vertices[vertex]));
        ++added;
      }
      vertex = entry->second;
    }
  }
  return added;
}

/// Boundary loops: vertices in the order in which faces to fill them run.
std::vector<std::vector<std::int32_t>> boundary_loops(const TriangleMesh& mesh) {
  std::map<std::int32_t, std::int32_t> next;  // head → tail of each boundary side
  for_each_edge(sorted_sides(mesh), [&](auto first, auto last) {
    if (last - first == 1) next[first->head] = first->tail;
  });
  std::vector<std::vector<std::int32_t>> loops;
  while (!next.empty()) {
    std::vector<std::int32_t> loop;
    std::int32_t vertex = next.begin()->first;
    for (auto entry = next.find(vertex); entry != next.end(); entry = next.find(vertex)) {
      loop.push_back(vertex);
      vertex = entry->second;
      next.erase(entry);
    }
    if (vertex == loop.front() && loop.size() >= 3) loops.push_back(std::move(loop));
  }
  return loops;
}

double loop_extent(const TriangleMesh& mesh, const std::vector<std::int32_t>& loop) {
  Eigen::AlignedBox3d box;
  for (const std::int32_t vertex : loop) box.extend(mesh.vertices[vertex]);
  return box.sizes().maxCoeff();
}

/// Fills holes up to `largest_extent` [m]. Returns how many.
std::size_t fill_holes(TriangleMesh& mesh, double largest_extent) {
  std::size_t filled = 0;
  for (const std::vector<std::int32_t>& loop : boundary_loops(mesh)) {
    if (loop_extent(mesh, loop) > largest_extent) continue;
    std::vector<Kernel::Point_3> points;
    for (const std::int32_t vertex : loop) {
      const Vector3d& p = mesh.vertices[vertex];
      points.emplace_back(p.x(), p.y(), p.z());
    }
    std::vector<CGAL::Triple<int, int, int>> patch;
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(patch));
    if (patch.empty()) continue;
    for (const auto& triangle : patch) {
      Face face = {loop[triangle.first], loop[triangle.second], loop[triangle.third]};
      // The patch runs along the loop where its corners are numbered upward.
      if (!is_even({triangle.first, triangle.second, triangle.third})) flip(face);
      mesh.faces.push_back(face);
    }
    ++filled;
  }
  return filled;
}

std::size_t turn_inside_out_parts(TriangleMesh& mesh) {
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  const std::vector<std::int32_t> parts = parts_of_faces(mesh, sides);
  const std::size_t num_parts =
      parts.empty() ? 0
                    : static_cast<std::size_t>(*std::max_element(parts.begin(), parts.end())) + 1;
  std::vector<bool> is_closed(num_parts, true);
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2) is_closed[parts[first->face]] = false;
  });
  const std::vector<std::int32_t> turned = inside_out_parts(mesh, parts, is_closed);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (std::binary_search(turned.begin(), turned.end(), parts[face])) flip(mesh.faces[face]);
  }
  return turned.size();
}

std::string defects_of(const MeshAnalysis& analysis) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(analysis.num_boundary_edges, "boundary edges");
  add(analysis.num_nonmanifold_edges, "non-manifold edges");
  add(analysis.num_inconsistent_edges, "inconsistently oriented edges");
  add(analysis.num_inward_parts, "inside-out parts");
  add(analysis.num_degenerate_faces, "degenerate faces");
  add(analysis.num_doubled_faces, "doubled faces");
  add(analysis.num_unused_vertices, "unused vertices");
  return text;
}

}  // namespace

void MeshRepairOptions::validate() const {
  if (!(max_hole_extent_rel >= 0.0 && max_hole_extent_rel <= 1.0)) {
    throw InvalidInput("MeshRepairOptions: max_hole_extent_rel = " +
                       shortest_decimal(max_hole_extent_rel) + ", must be in [0, 1]");
  }
}

RepairedMesh repair_mesh(const TriangleMesh& mesh, const MeshRepairOptions& options) {
  options.validate();
  RepairedMesh result;
  result.mesh = mesh;
  if (mesh.faces.empty()) throw InvalidInput("the mesh has no faces");
  result.before = analyze(mesh);
  if (options.mode == RepairMode::AsIs) {
    result.after = result.before;
    return result;
  }
  if (options.mode == RepairMode::Strict) {
    const std::string defects = defects_of(result.before);
    if (!defects.empty() || !result.before.is_manifold) {
      throw InvalidInput("the mesh has " + (defects.empty() ? "pinched vertices" : defects) +
                         "; strict mode repairs nothing");
    }
  }

  double volume = signed_volume(result.mesh);
  const auto step = [&](const char* what, std::size_t count) {
    if (count == 0) return;
    const double after = signed_volume(result.mesh);
    result.steps.push_back({what, count, after - volume});
    volume = after;
  };
  const bool is_good =
      result.before.is_outward && result.before.is_manifold && defects_of(result.before).empty();
  if (options.mode == RepairMode::Repair && !is_good) {
    step("removed degenerate faces", remove_collapsed_faces(result.mesh));
    step("removed doubled faces", remove_doubled_faces(result.mesh));
    step("removed unused vertices", remove_unused_vertices(result.mesh));
    step("turned faces", make_consistent(result.mesh));
    step("split non-manifold vertices", split_nonmanifold(result.mesh));
    const double largest_hole = options.max_hole_extent_rel * longest_extent(result.mesh);
    step("filled holes", fill_holes(result.mesh, largest_hole));
    // A sheet without thickness is closed by its own mirror image: both go, it bounds nothing.
    step("removed doubled faces", remove_doubled_faces(result.mesh));
    step("removed unused vertices", remove_unused_vertices(result.mesh));
    step("turned parts", turn_inside_out_parts(result.mesh));
  }
  result.after = result.steps.empty() ? result.before : analyze(result.mesh);

  if (!result.after.is_closed) {
    double largest = 0.0;
    for (const auto& loop : boundary_loops(result.mesh)) {
      largest = std::max(largest, loop_extent(result.mesh, loop));
    }
    std::string holes;
    if (largest > 0.0) {
      holes =
          "; its largest hole spans " +
          shortest_decimal(std::round(1000.0 * largest / longest_extent(result.mesh)) / 1000.0) +
          " of its longest extent, holes up to " + shortest_decimal(options.max_hole_extent_rel) +
          " are filled";
    }
    throw InvalidInput(
        "the mesh is not closed and could not be repaired: " + defects_of(result.after) + holes);
  }
  if (!(signed_volume(result.mesh) > 0.0)) {
    throw DegenerateGeometry("the mesh encloses no volume");
  }
  return result;
}

}  // namespace graspfit::geometry
