#include "solid/mesh_holes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry::internal {
namespace {

/// For each vertex the vertices to which sides with one face lead, in the direction in which faces
/// that fill a hole would run.
using Ways = std::map<std::int32_t, std::vector<std::int32_t>>;

Ways boundary_ways(const TriangleMesh& mesh) {
  Ways ways;
  for_each_edge(sorted_sides(mesh), [&](auto first, auto last) {
    if (last - first == 1) ways[first->head].push_back(first->tail);
  });
  return ways;
}

/// Vertices to or from which more than one boundary side leads.
std::set<std::int32_t> junctions_of(const Ways& ways) {
  std::set<std::int32_t> junctions;
  std::set<std::int32_t> reached;
  for (const auto& [vertex, targets] : ways) {
    if (targets.size() > 1) junctions.insert(vertex);
    for (const std::int32_t target : targets) {
      if (!reached.insert(target).second) junctions.insert(target);
    }
  }
  return junctions;
}

/// A path along the boundary from one junction to the next.
struct Chain {
  std::vector<std::int32_t> vertices;
  double length = 0.0;
  bool is_used = false;

  std::int32_t begin() const { return vertices.front(); }
  std::int32_t end() const { return vertices.back(); }
};

/// Chains from every junction, shortest first; no two share a side. Paths that end at no junction
/// are no chains.
std::vector<Chain> chains_between_junctions(const TriangleMesh& mesh, const Ways& ways) {
  const std::set<std::int32_t> junctions = junctions_of(ways);
  std::vector<Chain> chains;
  for (const std::int32_t junction : junctions) {
    const auto targets = ways.find(junction);
    if (targets == ways.end()) continue;
    for (const std::int32_t target : targets->second) {
      Chain chain{.vertices = {junction, target}};
      // A vertex that is no junction is reached once, so that the walk comes to an end.
      for (auto next = ways.find(target); next != ways.end() && !junctions.contains(chain.end());
           next = ways.find(chain.end())) {
        chain.vertices.push_back(next->second.front());
      }
      if (!junctions.contains(chain.end())) continue;
      for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
        chain.length +=
            (mesh.vertices[chain.vertices[i]] - mesh.vertices[chain.vertices[i - 1]]).norm();
      }
      chains.push_back(std::move(chain));
    }
  }
  std::stable_sort(chains.begin(), chains.end(),
                   [](const Chain& a, const Chain& b) { return a.length < b.length; });
  return chains;
}

/// Indices of the unused chains on the shortest path from the end of `start` back to its beginning
/// [Dijkstra 1959]; empty if `start` begins where it ends, or if no path is found among the nearest
/// junctions.
std::vector<std::size_t> shortest_way_back(
    const std::vector<Chain>& chains, const std::map<std::int32_t, std::vector<std::size_t>>& from,
    const Chain& start) {
  // A hole between patches passes few junctions; the bound keeps the work linear in their number.
  constexpr int kMostJunctions = 500;
  struct Reached {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t by = 0;
  };
  std::map<std::int32_t, Reached> reached;
  using Item = std::pair<double, std::int32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  reached[start.end()] = {0.0, 0};
  queue.push({0.0, start.end()});
  for (int seen = 0; !queue.empty() && seen < kMostJunctions; ++seen) {
    const auto [distance, junction] = queue.top();
    queue.pop();
    if (junction == start.begin()) break;
    if (distance > reached[junction].distance) continue;
    const auto onward = from.find(junction);
    if (onward == from.end()) continue;
    for (const std::size_t number : onward->second) {
      const Chain& chain = chains[number];
      if (chain.is_used || &chain == &start) continue;
      Reached& next = reached[chain.end()];
      if (!(distance + chain.length < next.distance)) continue;
      next = {distance + chain.length, number};
      queue.push({next.distance, chain.end()});
    }
  }
  std::vector<std::size_t> way;
  // A path of infinite length does not count.
  const auto back = reached.find(start.begin());
  if (back == reached.end() || std::isinf(back->second.distance)) return way;
  for (std::int32_t at = start.begin(); at != start.end();) {
    way.push_back(reached.at(at).by);
    at = chains[way.back()].begin();
  }
  std::reverse(way.begin(), way.end());
  return way;
}

/// Removes the side from one vertex to another from the boundary sides.
void erase_way(Ways& ways, std::int32_t from, std::int32_t to) {
  const auto entry = ways.find(from);
  entry->second.erase(std::find(entry->second.begin(), entry->second.end(), to));
  if (entry->second.empty()) ways.erase(entry);
}

}  // namespace

Holes holes_of(const TriangleMesh& mesh) {
  Holes holes;
  Ways ways = boundary_ways(mesh);
  std::vector<Chain> chains = chains_between_junctions(mesh, ways);
  std::map<std::int32_t, std::vector<std::size_t>> from;
  for (std::size_t i = 0; i < chains.size(); ++i) from[chains[i].begin()].push_back(i);
  for (std::size_t i = 0; i < chains.size(); ++i) {
    if (chains[i].is_used) continue;
    std::vector<std::size_t> around = shortest_way_back(chains, from, chains[i]);
    if (around.empty() && chains[i].begin() != chains[i].end()) continue;
    around.insert(around.begin(), i);
    HoleRim rim;
    for (const std::size_t number : around) {
      Chain& chain = chains[number];
      chain.is_used = true;
      rim.insert(rim.end(), chain.vertices.begin(), chain.vertices.end() - 1);
      for (std::size_t k = 1; k < chain.vertices.size(); ++k) {
        erase_way(ways, chain.vertices[k - 1], chain.vertices[k]);
      }
    }
    holes.meeting.push_back(std::move(rim));
  }
  while (!ways.empty()) {
    HoleRim rim;
    std::int32_t vertex = ways.begin()->first;
    for (auto entry = ways.find(vertex); entry != ways.end(); entry = ways.find(vertex)) {
      rim.push_back(vertex);
      vertex = entry->second.back();
      ways.erase(entry);
    }
    if (vertex == rim.front() && rim.size() >= 3) holes.single.push_back(std::move(rim));
  }
  return holes;
}

double rim_extent(const TriangleMesh& mesh, const HoleRim& rim) {
  Eigen::AlignedBox3d box;
  for (const std::int32_t vertex : rim) box.extend(mesh.vertices[vertex]);
  return box.sizes().maxCoeff();
}

double coned_volume(const TriangleMesh& mesh) {
  TriangleMesh closed = mesh;
  const Holes holes = holes_of(mesh);
  for (const auto& rims : {holes.meeting, holes.single}) {
    for (const HoleRim& rim : rims) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const std::int32_t vertex : rim) {
        middle += mesh.vertices[vertex] / static_cast<double>(rim.size());
      }
      const auto apex = base::as_index<std::int32_t>(closed.vertices.size());
      closed.vertices.push_back(middle);
      for (std::size_t i = 0; i < rim.size(); ++i) {
        closed.faces.push_back({rim[i], rim[(i + 1) % rim.size()], apex});
      }
    }
  }
  return signed_volume(closed);
}

}  // namespace graspfit::geometry::internal
