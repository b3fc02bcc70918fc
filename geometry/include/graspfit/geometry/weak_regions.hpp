#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shape_diameter.hpp"

namespace graspfit::geometry {

/// Criteria by which features count as fragile. They are this library's own [R], since the paper
/// leaves fragility to a separate analysis.
struct WeakRegionOptions {
  double weak_thickness = 0.006;  ///< Local thickness below which a face is thin [m], > 0. It is an
                                  ///< absolute length, since fragility does not scale with the
                                  ///< object: 6 mm makes the ears of a 9 cm bunny weak, not those
                                  ///< of a 30 cm one.
  double min_length_ratio = 2.0;  ///< Least length of a region over its thickness, ≥ 0: a weak
                                  ///< region is slender, not just thin.
  double voxels_per_thickness = 8.0;  ///< Voxels across weak_thickness, in [4, 32].
  int max_resolution = 256;  ///< Most voxels along the longest extent, in [16, 512]; larger
                             ///< objects get fewer voxels across weak_thickness.
  ShapeDiameterOptions shape_diameter = {};  ///< How local thickness is measured.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Why a region is weak, or is not.
enum class WeakVerdict : std::uint8_t {
  Weak,           ///< Slender, on a single neck: its thin faces are weak.
  Short,          ///< On a single neck, but shorter than min_length_ratio times its thickness.
  SeveralNecks,   ///< Held at more than one place, as a handle is.
  HeldAllAround,  ///< Its neck closes to a ring, as that of a wall or a floor does.
  NoNeck,         ///< It is a separate part, which does not touch the body.
};

/// A connected piece of what remains of the object without its body, or a branch of such a piece.
/// The body is the largest connected piece of the object's opening by a ball of diameter
/// weak_thickness (see `find_weak_regions`). At least one face of a region is thinner than
/// weak_thickness.
struct WeakRegion {
  std::vector<std::int32_t> faces;  ///< All its faces, ascending, thin or not.
  double thickness = 0.0;           ///< Median by area of the local thickness of its faces [m].
  double length = 0.0;  ///< Distance of the region's farthest point from the body, along shortest
                        ///< paths inside the piece [m]; 0 without a neck.
  int num_necks = 0;    ///< Number of necks, the separate places at which the region is attached to
                        ///< the body.
  WeakVerdict verdict = WeakVerdict::Weak;
  bool operator==(const WeakRegion&) const = default;
};

/// How the search ended.
enum class WeakOutcome : std::uint8_t {
  Searched,
  NothingLeft,  ///< No ball of diameter weak_thickness fits anywhere, as in a thin tool: nothing is
                ///< weak.
  TooCoarse,    ///< The object is too large for its voxels to resolve weak_thickness: nothing is
                ///< known and nothing counts as weak. Raise max_resolution or weak_thickness.
};

/// Fragile features of an object.
struct WeakRegions {
  /// Local thickness, as by `shape_diameter` [m], of each face on a connected piece outside the
  /// body that has a thin face. It is infinity for all other faces, which are not thin: balls of
  /// diameter weak_thickness fit beneath them, or their thickness is no less.
  std::vector<double> thickness;
  std::vector<bool> is_weak;        ///< One per face: thin, in a region with the verdict Weak.
  std::vector<WeakRegion> regions;  ///< Regions with a thin face, ordered by their first face.
  WeakOutcome outcome = WeakOutcome::Searched;
  double voxel_size = 0.0;  ///< Of the lattice that was used [m].
  bool operator==(const WeakRegions&) const = default;
};

/// Finds thin, slender features: ears, legs, tails, fins; not handles, walls or edges.
///
/// A face is weak iff its local thickness (`shape_diameter`) is below weak_thickness *and* it lies
/// on a residue of the morphological opening by a ball of diameter weak_thickness (a piece of the
/// solid without the body) that is attached to the body by a single neck and is at least
/// min_length_ratio times as long as thick. If the opening leaves nothing, nothing is weak.
///
/// The criteria are read as follows:
/// - the *body* is the largest connected piece of the opened solid. Smaller ones (a hoof on a thin
///   leg) belong to the region through which they are attached to the body, but their thick faces
///   are not weak.
/// - a neck is where a region touches the body; necks less than three voxels apart are one. A
///   neck that closes to a ring around an opening wider than weak_thickness does not count as
///   single: it holds a wall or a floor. A ring around a narrower opening is the neck of a hollow
///   leg.
/// - a piece on several necks or on a ring may be a root that several features share, as arms that
///   meet around a body do. The parts of the piece that are farther than weak_thickness from the
///   body, along the piece, are its *branches*: a branch that is attached to the rest of the piece
///   by a single neck, and is long enough, measured from the body, is a region of its own. The rest
///   keeps the verdict of the piece. A handle or a wall has one branch, which is attached at both
///   ends or all around.
/// - points within a quarter of weak_thickness of the opened solid belong to it: otherwise the
///   creases at the roots of neighboring features would join these features. Lengths include this
///   layer.
/// - regions are told apart at the resolution of the lattice: surfaces less than two voxels apart
///   are connected.
///
/// The result is approximate. The lattice has voxels of weak_thickness / voxels_per_thickness.
/// Whether a ball with its center in a voxel fits is found by moving the center inside the voxel by
/// distances to the true surface, which may miss a ball that barely fits; bars are told apart
/// within 1 in 1000 of their width. Whether a voxel is within a quarter of weak_thickness of a ball
/// is decided in favor of yes, by at most half the voxel's diagonal or, where the surface passes
/// through the voxel, by the whole diagonal. Lengths start where the balls end. They are at most
/// 5 % too long, because paths follow a limited number of directions between voxels, and end within
/// two voxels of the true end. Deterministic for any number of threads. The cost is that of the
/// voxels, whose number grows with the third power of the resolution, and of the rays of
/// `shape_diameter` from the residues' faces.
///
/// Precondition, not checked: a closed outward mesh (`repair_mesh`). For other meshes the function
/// returns a result, but a meaningless one.
WeakRegions find_weak_regions(const MeshQuery& object, const WeakRegionOptions& options = {});

/// The kind of entry that `cached_weak_regions` keeps.
inline constexpr std::string_view kWeakRegionKind = "weak_regions";

/// SHA-256 of all that the result depends on: vertices, faces, options but for the number of
/// threads, and the version of the algorithm.
std::string weak_region_key(const TriangleMesh& mesh, const WeakRegionOptions& options);

/// As `find_weak_regions`, but a result found before is read from the cache, and a new one kept
/// there. Entries that are damaged, or were not written by this function, are ignored and replaced.
/// If the cache's folder cannot be written to, or there is no home directory for it, nothing is
/// kept; this is no error.
WeakRegions cached_weak_regions(const MeshQuery& object, const WeakRegionOptions& options = {},
                                const base::ContentCache& cache = {});

}  // namespace graspfit::geometry
