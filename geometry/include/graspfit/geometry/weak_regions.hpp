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

/// What counts as fragile: a recipe of this library [R], since the paper leaves it to an analysis
/// of its own.
struct WeakRegionOptions {
  double weak_thickness = 0.006;  ///< [m], > 0. An absolute length, since fragility is; 6 mm
                                  ///< makes the ears of a 9 cm bunny weak, not of a 30 cm one.
  double min_length_ratio = 2.0;  ///< Least length over thickness, ≥ 0: slender, not just thin.
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
  NoNeck,         ///< A part of its own, of which the opening leaves nothing.
};

/// A piece of the object that is left over where balls of the diameter weak_thickness roll inside
/// it, and that is not the body they roll in, or a branch of such a piece; at least one of its
/// faces is thinner than weak_thickness.
struct WeakRegion {
  std::vector<std::int32_t> faces;  ///< All its faces, ascending, thin or not.
  double thickness = 0.0;           ///< Median by area of the local thickness of its faces [m].
  double length = 0.0;              ///< Longest way inside it from the body to its end [m].
  int num_necks = 0;                ///< Separate places at which it hangs on the body.
  WeakVerdict verdict = WeakVerdict::Weak;
  bool operator==(const WeakRegion&) const = default;
};

/// How the search ended.
enum class WeakOutcome : std::uint8_t {
  Searched,
  NothingLeft,  ///< No ball of that diameter fits anywhere, as in a thin tool: nothing is weak.
  TooCoarse,    ///< The object is too large for its voxels to show that thickness: nothing is known
                ///< and nothing is weak. Raise max_resolution or weak_thickness.
};

/// Fragile features of an object.
struct WeakRegions {
  /// Local thickness of each face on a residue of the opening, as by `shape_diameter` [m]; infinity
  /// for all others: balls of weak_thickness roll beneath them, and they are not measured.
  std::vector<double> thickness;
  std::vector<bool> is_weak;        ///< One per face: thin, in a region with the verdict Weak.
  std::vector<WeakRegion> regions;  ///< Those with a thin face, by their first face.
  WeakOutcome outcome = WeakOutcome::Searched;
  double voxel_size = 0.0;  ///< Of the lattice that was used [m].
  bool operator==(const WeakRegions&) const = default;
};

/// Finds thin, slender features: ears, legs, tails, fins; not handles, walls or edges.
///
/// A face is weak iff its local thickness (`shape_diameter`) is below weak_thickness *and* it lies
/// on a residue of the morphological opening by a ball of that diameter which hangs on the body by
/// a single neck and is at least min_length_ratio times as long as thick. If the opening leaves
/// nothing, nothing is weak.
///
/// How it is read where the recipe leaves a choice:
/// - the *body* is the largest connected piece of the opened solid. Smaller ones (a hoof on a thin
///   leg) belong to the region through which they hang on it, but their thick faces are not weak.
/// - a neck is where a region touches the body; necks less than three voxels apart are one. A
///   neck that closes to a ring around an opening wider than weak_thickness does not count as
///   single: it holds a wall or a floor. Around a narrower one it is that of a hollow leg.
/// - a piece on several necks or on a ring may be a root that several features share, as arms that
///   meet around a body do. What of it is farther than weak_thickness from the body, along the
///   piece, is its *branches*: one that hangs on the rest by a single neck, and is long enough,
///   reckoned from the body, is a region of its own. The rest stays what the piece was. A handle or
///   a wall has one branch, which hangs on it at both ends or all around.
/// - what lies within a quarter of weak_thickness of the opened solid belongs to it: otherwise the
///   creases at the roots of neighboring features would join them. Lengths count it.
/// - regions are told apart at the resolution of the lattice: surfaces less than two voxels apart
///   hang together.
///
/// Approximate. The lattice has voxels of weak_thickness / voxels_per_thickness. That a ball fits
/// is found by moving it inside its voxel against distances to the true surface, which may miss one
/// that barely fits; bars are told apart within 1 in 1000 of their width. Whether a voxel is within
/// a quarter of weak_thickness of a ball is decided in favor of yes, by at most half its diagonal
/// or, where the surface passes, by the whole. Lengths start where the balls end, are at most 5 %
/// too long from the directions of the voxels' paths, and within two voxels of the true end.
/// Deterministic for any number of threads. Cost: voxels, which grow with the third power of the
/// resolution, and rays of `shape_diameter` from the residues' faces.
///
/// Precondition, not checked: a closed outward mesh (`repair_mesh`). For others the answer is
/// meaningless, but there is one.
WeakRegions find_weak_regions(const MeshQuery& object, const WeakRegionOptions& options = {});

/// The kind of entry that `cached_weak_regions` keeps.
inline constexpr std::string_view kWeakRegionKind = "weak_regions";

/// SHA-256 of all that the result depends on: vertices, faces, options but for the number of
/// threads, and the version of the algorithm.
std::string weak_region_key(const TriangleMesh& mesh, const WeakRegionOptions& options);

/// As `find_weak_regions`, but a result found before is read from the cache, and a new one kept
/// there. Entries that are damaged, or not ours, are as good as none and replaced. A folder that
/// cannot be written to, or no home to put one in, is no error: nothing is kept.
WeakRegions cached_weak_regions(const MeshQuery& object, const WeakRegionOptions& options = {},
                                const base::ContentCache& cache = {});

}  // namespace graspfit::geometry
