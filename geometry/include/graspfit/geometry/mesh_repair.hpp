#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// What to do with a mesh that is not a closed outward surface.
enum class RepairMode {
  Repair,  ///< Mend what the options allow, refuse what remains open.
  Strict,  ///< Refuse any defect.
  AsIs,    ///< Change nothing.
};

/// What to do about faces that cross other faces of the mesh.
enum class SelfIntersections {
  Leave,   ///< Crossings are not searched for. The solid is well defined all the same: what crosses
           ///< is united (see `MeshQuery::containment`).
  Report,  ///< Crossings are counted before and after the repair, but not changed; `Strict` refuses
           ///< them.
  Resolve,  ///< Faces are cut where they cross, and only the pieces that bound the solid stay (see
            ///< `MeshQuery::containment`): the solid remains, faces inside it are removed. The
            ///< result is not taken where rounding the cuts would open the surface; crossings that
            ///< are left are counted in `after`. `Strict` refuses crossings as with `Report`.
};

/// A closed surface wrapped around whatever the mesh is [CGAL Alpha_wrap_3; Portaneri et al. 2022].
/// It lies outside the mesh and shrinks into no gap narrower than `alpha`. The wrap is computed
/// from the mesh as given, so that wrapping is then the only step of the repair. No wrap is made
/// where CGAL's refinement would not terminate (as for a needle 3e8 times as long as thick): the
/// work is bounded.
struct AlphaWrap {
  double alpha_rel = 0.02;  ///< Narrowest gap that the wrap enters, over the longest extent of the
                            ///< mesh, in [1e-3, 1]. Smaller values follow the mesh better and cost
                            ///< more.
  double offset_rel = 0.002;  ///< Distance of the wrap's vertices from the mesh, over the longest
                              ///< extent, in [1e-4, 1]. Across gaps that are not entered its faces
                              ///< are farther away.
};

/// Limits of `repair_mesh`.
struct MeshRepairOptions {
  RepairMode mode = RepairMode::Repair;
  double weld_distance_rel = 0.0;    ///< Welding distance over the longest extent of the mesh, in
                                     ///< [0, 0.01]: a vertex this close to an earlier one that is
                                     ///< kept is merged into it. Zero welds equal coordinates only
                                     ///< (−0 equals 0).
  double max_hole_extent_rel = 0.5;  ///< Largest hole that is filled: longest extent of its
                                     ///< boundary over that of the mesh, in [0, 1]. Half lets a
                                     ///< missing base plate be closed, not a missing half.
  double max_misfilled_rel = 0.25;  ///< Largest share of the volume by which the repaired solid may
                                    ///< differ from the solid that the surface means without its
                                    ///< fillings (see `repair_mesh`), in [0, 1]. Six patches of a
                                    ///< sphere, each closed along its own inside, leave a skin that
                                    ///< lacks a third and more.
  double max_removed_rel = 0.25;    ///< Largest share of the surface's area that may be removed
                                    ///< because it has no thickness (sheets, stray triangles; walls
                                    ///< inside the solid do not count), in [0, 1].
  SelfIntersections self_intersections = SelfIntersections::Leave;
  std::optional<AlphaWrap> wrap = std::nullopt;  ///< Last resort, taken only where the mesh would
                                                 ///< be refused. If empty, the mesh is refused.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// One thing that a repair did.
struct RepairStep {
  std::string what;       ///< One of "welded vertices", "removed degenerate faces",
                          ///< "removed doubled faces", "removed unused vertices",
                          ///< "turned faces", "split non-manifold vertices", "filled holes",
                          ///< "turned parts", "resolved self-intersections", "wrapped".
  std::size_t count = 0;  ///< Number of elements concerned, > 0. For "welded vertices" these are
                          ///< the vertices that were merged into another, for "resolved
                          ///< self-intersections" the pairs of crossing faces that are gone, for
                          ///< "wrapped" the faces of the wrap.
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
/// The steps are taken in this order: vertices are welded; faces with a repeated vertex, doubled
/// faces (opposite ones cancel) and unused vertices are removed; orientation is made consistent;
/// non-manifold edges and vertices are split (solids that touch along an edge come apart); holes up
/// to the stated size are filled; doubled faces and unused vertices are removed once more (the
/// filling of a sheet without thickness is its mirror image); inside-out parts are turned;
/// self-intersections are resolved if asked for.
///
/// The result is judged by two limits. `max_misfilled_rel` limits the difference of the repaired
/// solid from the solid that the surface means without the fillings: the points where the
/// generalized winding number of that surface rounds to another number than zero (a flat hole makes
/// no difference). `max_removed_rel` limits the area that is removed. Beyond a limit the repair has
/// failed: the mesh is wrapped if asked for, or refused.
///
/// Where holes meet at vertices and the result is open or has failed, these holes are filled before
/// the vertices are split. Otherwise patches that are connected by single vertices only, as where
/// the border of one is subdivided and its neighbor's is not, would come apart, and a filling along
/// the inside of each patch would leave a hollow skin.
///
/// Collinear faces stay, because they connect their neighbors. Parts that overlap or lie in each
/// other are kept: the solid is their union, and an inward part inside an outward one is a cavity.
/// A mesh that is closed, outward and manifold and has no degenerate faces, doubled faces or unused
/// vertices is returned as it is, byte for byte, even if faces cross or vertices are close, unless
/// self-intersections are to be resolved.
/// @throws InvalidInput with a message of one line if the result is not closed, if a limit above is
/// exceeded, if `Strict` meets any defect, or if the mesh has no faces. For an open result the
/// message tells the number of boundary edges, the size of the largest hole, the program's option
/// with the limit for holes that would suffice, and whether a wrap is possible.
/// @throws DegenerateGeometry if the mesh has no volume.
RepairedMesh repair_mesh(const TriangleMesh& mesh, const MeshRepairOptions& options = {});

}  // namespace graspfit::geometry
