#pragma once

#include <optional>
#include <string>
#include <vector>

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
  /// the neighbors across a collinear face count too. Empty if not asked for, as the two below.
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
  bool count_part_overlaps = false;       ///< As much, where the boxes of parts overlap.
};

/// Analyzes a mesh of any quality. Throws nothing on bad meshes: that is what it is for.
/// Precondition, not checked: every index of a face is that of a vertex, and coordinates are finite
/// (`read_mesh` sees to both).
MeshAnalysis analyze(const TriangleMesh& mesh, const MeshAnalysisOptions& options = {});

/// What to do with a mesh that is not a closed outward surface.
enum class RepairMode {
  Repair,  ///< Mend what the options allow, refuse what remains open.
  Strict,  ///< Refuse any defect.
  AsIs,    ///< Change nothing.
};

/// What to do about faces that cross other faces of the mesh.
enum class SelfIntersections {
  Leave,    ///< Not looked for. Sound all the same: what crosses is united (see `containment`).
  Report,   ///< Counted before and after, nothing changed; `Strict` refuses them.
  Resolve,  ///< Faces are cut where they cross, and of the pieces those stay that bound the solid
            ///< (see `containment`): the solid remains, what lies inside it goes. Not taken where
            ///< rounding the cuts would open the surface; what is left is counted in `after`.
            ///< `Strict` refuses crossings as with `Report`.
};

/// A closed surface wrapped around whatever the mesh is [CGAL Alpha_wrap_3; Portaneri et al. 2022].
/// It lies outside the mesh and shrinks into no gap narrower than `alpha`. It is made of the mesh
/// as given, so it is then the only step of the repair. It is not made where CGAL's refinement
/// would not come to an end (a needle 3e8 times as long as thick): the work is bounded.
struct AlphaWrap {
  double alpha_rel = 0.02;    ///< Narrowest gap that is entered, over the longest extent, in
                              ///< [1e-3, 1]. Smaller follows the mesh better and costs more.
  double offset_rel = 0.002;  ///< Distance of the wrap's vertices from the mesh, over the longest
                              ///< extent, in [1e-4, 1]. Across gaps that are not entered its faces
                              ///< are farther away.
};

/// Limits of `repair_mesh`.
struct MeshRepairOptions {
  RepairMode mode = RepairMode::Repair;
  double weld_distance_rel = 0.0;    ///< A vertex this close to an earlier one that stays becomes
                                     ///< that one; over the longest extent of the mesh, in [0,
                                     ///< 0.01]. Zero: equal coordinates only (−0 equals 0).
  double max_hole_extent_rel = 0.5;  ///< Largest hole that is filled: longest extent of its
                                     ///< boundary over that of the mesh, in [0, 1]. Half lets a
                                     ///< missing base plate be closed, not a missing half.
  double max_misfilled_rel = 0.25;   ///< Most of its volume by which the solid may differ from what
                                     ///< the surface means without its fillings, in [0, 1]. Six
                                     ///< patches of a sphere, each closed along its own inside,
                                     ///< leave a skin that lacks a third and more.
  double max_removed_rel = 0.25;     ///< Most of the surface's area that may go for being without
                                     ///< thickness (sheets, stray triangles; walls inside the
                                     ///< solid do not count), in [0, 1].
  SelfIntersections self_intersections = SelfIntersections::Leave;
  std::optional<AlphaWrap> wrap =
      std::nullopt;       ///< The last resort, only where the mesh would be refused. Empty: refuse.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// One thing that a repair did.
struct RepairStep {
  std::string what;              ///< One of "welded vertices", "removed degenerate faces",
                                 ///< "removed doubled faces", "removed unused vertices",
                                 ///< "turned faces", "split non-manifold vertices", "filled holes",
                                 ///< "turned parts", "resolved self-intersections", "wrapped".
  std::size_t count = 0;         ///< How many of them, > 0. "welded vertices": those that became
                                 ///< another; "resolved self-intersections": pairs of faces fewer;
                                 ///< "wrapped": faces of the wrap.
  double volume_change = 0.0;    ///< Change of the signed volume by this step [m³]; open surfaces
                                 ///< are measured with every hole closed by a cone to the middle
                                 ///< of its rim, so that a flat hole filled changes nothing.
  double hausdorff_bound = 0.0;  ///< Upper bound of the Hausdorff distance between the surfaces
                                 ///< before and after the step [m]; 0 where the set of points is
                                 ///< the same.
};

/// A mesh after repair with everything that was done and what is true of it now.
struct RepairedMesh {
  TriangleMesh mesh;
  MeshAnalysis before;
  MeshAnalysis after;
  std::vector<RepairStep> steps;  ///< In order; empty if nothing was changed.
};

/// Makes a closed, consistently outward mesh of `mesh`, or refuses.
///
/// Order: vertices welded, faces with a repeated vertex, doubled faces (opposite ones cancel),
/// unused vertices, orientation made consistent, non-manifold edges and vertices split (solids that
/// touch along an edge come apart), holes filled up to the stated size, doubled faces and unused
/// vertices once more (what fills a sheet without thickness is its mirror image), inside-out parts
/// turned, self-intersections resolved if asked for. The result is judged by
/// `max_misfilled_rel`, where what the surface means is where its generalized winding number
/// without the fillings rounds to another number than zero (a flat hole makes no difference), and
/// by `max_removed_rel`. Where holes meet at vertices and the result is open or no success, they
/// are filled before the vertices are split: patches that hang together by single vertices, as
/// where the border of one is subdivided and its neighbor's is not, would come apart otherwise, and
/// a filling along the inside of each would leave a hollow skin. Beyond a limit the repair is no
/// success: the mesh is wrapped if asked for, or refused. Collinear faces stay: they carry the
/// connection between their neighbors. Parts that overlap or lie in each other are kept: their
/// union is meant, and an inward part inside an outward one is a cavity. A mesh that is closed,
/// outward and manifold and has no degenerate, doubled or unused parts comes back as it is, byte
/// for byte, crossing or not, close vertices or not, unless self-intersections are to be resolved.
/// @throws InvalidInput in one line if what remains is not closed (how many boundary edges, how
/// large the largest hole is, which limit for holes would do, by its option of the program, and
/// whether a wrap is to be had), if a limit above is not kept, if `Strict` meets any defect, or if
/// the mesh has no faces.
/// @throws DegenerateGeometry if the mesh has no volume.
RepairedMesh repair_mesh(const TriangleMesh& mesh, const MeshRepairOptions& options = {});

}  // namespace graspfit::geometry
