#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Edges of a mesh with their faces, and the parts of a mesh, as analysis and repair both use them.

namespace graspfit::geometry::internal {

class FaceTree;

/// One side of a face: the edge from `tail` to `head` as the face runs through it.
struct FaceSide {
  std::int32_t tail = -1;
  std::int32_t head = -1;
  std::int32_t face = -1;
  std::int32_t corner = -1;  ///< Corner of the face at the tail.

  std::int32_t low() const { return std::min(tail, head); }
  std::int32_t high() const { return std::max(tail, head); }
  bool runs_up() const { return tail < head; }
  /// Corner number (3 · face + k) of `vertex`, one of the two ends.
  std::int32_t corner_at(std::int32_t vertex) const {
    return 3 * face + (tail == vertex ? corner : (corner + 1) % 3);
  }
};

/// Whether a face names a vertex twice.
inline bool has_repeated_vertex(const Face& f) {
  return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
}

/// All sides of all faces without a repeated vertex, those of one edge next to each other, in face
/// order; edges by lower, then by higher vertex. Linear: a counting sort.
std::vector<FaceSide> sorted_sides(const TriangleMesh& mesh);

/// Calls `visit(first, last)` with the range of sides of every edge.
template <typename Visit>
void for_each_edge(const std::vector<FaceSide>& sides, Visit visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    const std::int32_t low = first->low();
    const std::int32_t high = first->high();
    auto last = first + 1;
    while (last != sides.end() && last->low() == low && last->high() == high) ++last;
    visit(first, last);
    first = last;
  }
}

/// Part (connected component over shared edges) of every face, numbered by first face.
std::vector<std::int32_t> parts_of_faces(const TriangleMesh& mesh,
                                         const std::vector<FaceSide>& sides);

/// Whether every edge is run through as often up as down, as in a mesh without faces.
bool bounds_solid(const TriangleMesh& mesh);

/// Whether a face has a repeated index or three collinear corners. Exact.
bool is_degenerate(const TriangleMesh& mesh, std::int32_t face);

/// Parts whose own surface winds around `point`, ascending; parts on whose surface `point` lies are
/// left out. Exact. `tree` is that of the mesh whose faces `parts` numbers.
std::vector<std::int32_t> parts_around(const FaceTree& tree, const std::vector<std::int32_t>& parts,
                                       const Eigen::Vector3d& point);

/// Closed parts that are inside-out, ascending: negative signed volume and no other closed part
/// that holds all their vertices. An inside-out part inside another part bounds a cavity and is
/// correct.
std::vector<std::int32_t> inside_out_parts(const TriangleMesh& mesh,
                                           const std::vector<std::int32_t>& parts,
                                           const std::vector<bool>& is_part_closed);

}  // namespace graspfit::geometry::internal
