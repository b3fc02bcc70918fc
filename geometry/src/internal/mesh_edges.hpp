#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Edges of a mesh with their faces, and disjoint sets: what analysis and repair both stand on.

namespace graspfit::geometry {

/// One side of a face: the edge from `tail` to `head` as the face runs through it.
struct FaceSide {
  std::int32_t tail = -1;
  std::int32_t head = -1;
  std::int32_t face = -1;
  std::int32_t corner = -1;  ///< Corner of the face at the tail.

  std::int32_t low() const { return std::min(tail, head); }
  std::int32_t high() const { return std::max(tail, head); }
  bool runs_up() const { return tail < head; }
};

/// All sides of all faces without a repeated vertex, those of one edge next to each other, in face
/// order.
std::vector<FaceSide> sorted_sides(const TriangleMesh& mesh);

/// Calls `visit(first, last)` with the range of sides of every edge.
template <typename Visit>
void for_each_edge(const std::vector<FaceSide>& sides, Visit visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    auto last = first;
    while (last != sides.end() && last->low() == first->low() && last->high() == first->high()) {
      ++last;
    }
    visit(first, last);
    first = last;
  }
}

/// Union–find with path halving; the root of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::int32_t root(std::int32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void unite(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

/// Part (connected component over shared edges) of every face, numbered by first face.
std::vector<std::int32_t> parts_of_faces(const TriangleMesh& mesh,
                                         const std::vector<FaceSide>& sides);

/// Exact: a repeated index, or three collinear corners.
bool is_degenerate(const TriangleMesh& mesh, std::size_t face);

/// The faces of one part, in order, as a mesh of its own: only the vertices they use, renumbered.
TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& parts,
                     std::int32_t part);

/// Closed parts that are inside-out: negative signed volume and no other closed part around them. A
/// part inside another one that is inside-out bounds a cavity and is right.
std::vector<std::int32_t> inside_out_parts(const TriangleMesh& mesh,
                                           const std::vector<std::int32_t>& parts,
                                           const std::vector<bool>& is_part_closed);

}  // namespace graspfit::geometry
