#pragma once

#include <cstddef>
#include <optional>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// What is true of a mesh. Combinatorial counts are exact; vertices count as the same only if
/// they have the same index (weld first).
struct MeshAnalysis {
  std::size_t num_vertices = 0;
  std::size_t num_faces = 0;
  std::size_t num_parts = 0;               ///< Connected components over shared edges.
  std::size_t num_unused_vertices = 0;     ///< Vertices of no face.
  std::size_t num_degenerate_faces = 0;    ///< Repeated index or collinear corners (exact).
  std::size_t num_doubled_faces = 0;       ///< Faces beyond the first with the same three vertices.
  std::size_t num_boundary_edges = 0;      ///< Edges with one face.
  std::size_t num_nonmanifold_edges = 0;   ///< Edges with more than two faces.
  std::size_t num_inconsistent_edges = 0;  ///< Two-face edges run through in the same direction.
  std::size_t num_inward_parts = 0;  ///< Closed parts whose signed volume is negative and that
                                     ///< no other part encloses.
  /// Pairs of faces that share a point other than their common corners and edges (exact; corners
  /// are common where their coordinates are; faces without area are left out). Touching counts, so
  /// the neighbors across a collinear face count too. Empty if not asked for; the same holds for
  /// the next two counts.
  std::optional<std::size_t> num_self_intersections;
  std::optional<std::size_t> num_overlapping_part_pairs;  ///< Pairs of parts with such a pair of
                                                          ///< faces.
  std::optional<std::size_t> num_nested_parts;  ///< Parts that lie inside another closed part and
                                                ///< do not cross it; cavities too.
  Eigen::AlignedBox3d box;                      ///< [m]

  bool is_closed = false;    ///< Every edge has exactly two faces, consistently oriented.
  bool is_manifold = false;  ///< No edge with more than two faces, no pinched vertex.
  bool is_outward = false;   ///< Closed, and no part is inside-out.
};

/// What `analyze` looks at.
struct MeshAnalysisOptions {
  bool count_self_intersections = false;  ///< Costs a few times the rest of the analysis.
  bool count_part_overlaps = false;  ///< Costs as much as count_self_intersections where the boxes
                                     ///< of parts overlap.
};

/// Analyzes a mesh of any quality, which is not refused for its defects.
/// @throws InvalidInput if an index of a face is not that of a vertex or a coordinate is not finite
/// (`read_mesh` gives no such mesh).
MeshAnalysis analyze(const TriangleMesh& mesh, const MeshAnalysisOptions& options = {});

}  // namespace graspfit::geometry
