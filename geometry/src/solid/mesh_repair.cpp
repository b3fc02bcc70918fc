#include "graspfit/geometry/mesh_repair.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "mesh/input_check.hpp"
#include "query/one_sided_distance.hpp"
#include "solid/alpha_wrapping.hpp"
#include "solid/mesh_edges.hpp"
#include "solid/mesh_holes.hpp"
#include "solid/mesh_operations.hpp"
#include "solid/misfilled_share.hpp"

namespace graspfit::geometry {
namespace {

using internal::HoleRim;
using internal::TwoSided;
using Triangle = std::array<Eigen::Vector3d, 3>;

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

bool is_good(const MeshAnalysis& analysis) {
  return analysis.is_outward && analysis.is_manifold && defects_of(analysis).empty();
}

/// Faces of `from` that `to` does not have on the same vertices, in whatever order.
std::vector<Face> faces_beyond(const std::vector<Face>& from, const std::vector<Face>& to) {
  const auto sorted = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::vector<Face> known;
  known.reserve(to.size());
  for (const Face& face : to) known.push_back(sorted(face));
  std::sort(known.begin(), known.end());
  std::vector<Face> result;
  for (const Face& face : from) {
    if (!std::binary_search(known.begin(), known.end(), sorted(face))) result.push_back(face);
  }
  return result;
}

/// Faces with a repeated vertex that are no edge or vertex of another face of `kept`.
std::vector<Face> loose_segments(const std::vector<Face>& removed, const std::vector<Face>& kept) {
  if (removed.empty()) return {};
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const Face& f : kept) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(f[i], f[(i + 1) % 3]);
      edges.push_back({low, low});
      edges.push_back({low, high});
      edges.push_back({high, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Face> result;
  for (const Face& f : removed) {
    const auto [low, high] = std::minmax({f[0], f[1], f[2]});
    if (!std::binary_search(edges.begin(), edges.end(), std::array{low, high})) result.push_back(f);
  }
  return result;
}

std::vector<HoleRim> concatenation(std::vector<HoleRim> rims, const std::vector<HoleRim>& more) {
  rims.insert(rims.end(), more.begin(), more.end());
  return rims;
}

/// Extent of a rim over the longest extent of the mesh, as in `max_hole_extent_rel`.
double rim_extent_rel(const TriangleMesh& mesh, const HoleRim& rim) {
  return internal::rim_extent(mesh, rim) / longest_extent(mesh);
}

std::string percent(double share) {
  return base::shortest_decimal(std::round(1000.0 * share) / 10.0) + " %";
}

/// The faces of `mesh` that are among `triangles`, by their corners in whatever order.
std::vector<Triangle> found_in(const TriangleMesh& mesh, std::vector<Triangle> triangles) {
  const auto is_before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  const auto sorted = [&](Triangle triangle) {
    std::sort(triangle.begin(), triangle.end(), is_before);
    return triangle;
  };
  const auto comes_first = [&](const Triangle& a, const Triangle& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_before);
  };
  for (Triangle& triangle : triangles) triangle = sorted(triangle);
  std::sort(triangles.begin(), triangles.end(), comes_first);
  std::vector<Triangle> found;
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    const Triangle triangle = corners(mesh, face);
    if (std::binary_search(triangles.begin(), triangles.end(), sorted(triangle), comes_first)) {
      found.push_back(triangle);
    }
  }
  return found;
}

/// The repair of one mesh, step by step.
class Repair {
 public:
  /// What a refusal says beyond its reason.
  enum class Advice {
    None,
    Tried  ///< Other options that help: they are tried out.
  };

  /// `mesh` and `options` outlive the repair.
  Repair(const TriangleMesh& mesh, const MeshRepairOptions& options, Advice advice)
      : given_(mesh), options_(options), advice_(advice), extent_(longest_extent(mesh)) {
    result_.mesh = mesh;
  }

  RepairedMesh run() {
    result_.before = analyzed(result_.mesh);
    result_.after = result_.before;
    if (options_.mode == RepairMode::AsIs) return std::move(result_);
    if (options_.mode == RepairMode::Strict) refuse_defects();
    volume_ = volume_of(given_, result_.before.is_closed);
    if (options_.mode == RepairMode::Repair) {
      if (!is_good(result_.before)) mend_either_way();
      if (options_.self_intersections == SelfIntersections::Resolve) resolve_self_intersections();
      if (options_.wrap && !is_solid()) wrap();
    }
    refuse_open();
    if (!(volume_ > 0.0)) {
      throw base::DegenerateGeometry("the mesh encloses no volume" + advice_to_wrap("; "));
    }
    refuse_failure();
    return std::move(result_);
  }

 private:
  MeshAnalysis analyzed(const TriangleMesh& mesh) const {
    return analyze(mesh, {.count_self_intersections =
                              options_.self_intersections != SelfIntersections::Leave});
  }

  static double volume_of(const TriangleMesh& mesh, bool is_closed) {
    return is_closed ? signed_volume(mesh) : internal::coned_volume(mesh);
  }

  bool is_misfilled() const { return misfilled_rel_ > options_.max_misfilled_rel; }
  bool is_stripped() const { return removed_rel_ > options_.max_removed_rel; }
  bool is_solid() const {
    return result_.after.is_closed && volume_ > 0.0 && !is_misfilled() && !is_stripped();
  }

  void add_step(const char* what, std::size_t count, double hausdorff_bound) {
    if (count == 0) return;
    const double after = volume_of(result_.mesh, false);
    result_.steps.push_back({what, count, after - volume_, hausdorff_bound});
    volume_ = after;
  }

  HausdorffOptions distance_options() const {
    constexpr double kToleranceRel = 1e-4;  // Of the longest extent: a tenth of a voxel and less.
    constexpr int kMaxSteps = 4'000;        // The bound holds as it is then; it is not worth more.
    const double tolerance = kToleranceRel * extent_;
    return {.tolerance = tolerance > 0.0 ? tolerance : 1.0, .max_steps = kMaxSteps};
  }

  /// Bound for removing or adding `faces`: how far they reach from the rest of the surface.
  double reach_of(const std::vector<Face>& faces, const TriangleMesh& rest) const {
    if (faces.empty()) return 0.0;
    if (rest.faces.empty()) return std::numeric_limits<double>::infinity();
    return internal::one_sided_distance(internal::triangles_of(result_.mesh.vertices, faces),
                                        MeshQuery(rest), distance_options())
        .upper;
  }

  /// When holes that meet at vertices are filled.
  enum class MeetingHoles {
    AfterSplitting,  ///< The surface is split at these vertices, and each patch closed by itself.
    BeforeSplitting  ///< Patches that the file connects stay connected.
  };

  /// Mends the mesh and judges the result. Where holes meet at vertices, there are two ways to
  /// close the surface. Solids that only touch come apart as they should; a surface of patches
  /// that are connected by vertices only does so too, and then every patch is closed by a filling
  /// along its own inside, which leaves a hollow skin. So where the first way is no success, the
  /// other is tried.
  void mend_either_way() {
    mend(MeetingHoles::AfterSplitting);
    if (largest_meeting_rel_ == 0.0 || is_solid()) return;
    Repair other(given_, options_, Advice::None);
    other.result_.before = result_.before;
    other.volume_ = volume_of(given_, result_.before.is_closed);
    other.mend(MeetingHoles::BeforeSplitting);
    if (other.is_solid()) {
      result_ = std::move(other.result_);
      volume_ = other.volume_;
      misfilled_rel_ = other.misfilled_rel_;
      removed_rel_ = other.removed_rel_;
    } else if (is_misfilled()) {
      largest_open_rel_ = other.largest_hole_rel();
    }
  }

  void mend(MeetingHoles meeting_holes) {
    TriangleMesh& mesh = result_.mesh;
    const auto [num_welded, farthest] = internal::weld(mesh, options_.weld_distance_rel * extent_);
    add_step("welded vertices", num_welded, farthest);
    drop_collapsed_faces();
    drop_doubled_faces(TwoSided::Halved);
    add_step("removed unused vertices", internal::remove_unused_vertices(mesh), 0.0);
    add_step("turned faces", internal::make_consistent(mesh), 0.0);
    const std::vector<HoleRim> meeting = internal::holes_of(mesh).meeting;
    for (const HoleRim& rim : meeting) {
      largest_meeting_rel_ = std::max(largest_meeting_rel_, rim_extent_rel(mesh, rim));
    }
    std::size_t num_filled = 0;
    if (meeting_holes == MeetingHoles::BeforeSplitting) num_filled += fill(meeting);
    add_step("split non-manifold vertices", internal::split_nonmanifold(mesh), 0.0);
    const internal::Holes holes = internal::holes_of(mesh);
    num_filled += fill(concatenation(holes.single, holes.meeting));
    // A sheet without thickness is closed by its own mirror image: both are removed, as they bound
    // nothing.
    if (num_filled > 0) drop_doubled_faces(TwoSided::Removed);
    add_step("removed unused vertices", internal::remove_unused_vertices(mesh), 0.0);
    add_step("turned parts", internal::turn_inside_out_parts(mesh), 0.0);
    if (!result_.steps.empty()) result_.after = analyzed(mesh);
    if (!result_.after.is_closed || mesh.faces.empty()) return;
    if (num_filled > 0) misfilled_rel_ = internal::misfilled_share(mesh, found_in(mesh, fillings_));
    removed_rel_ = removed_share();
  }

  /// Area that was removed, over the area of the surface with it. Walls inside the solid do not
  /// count: where solids share faces, these are removed and nothing is lost.
  double removed_share() const {
    if (removed_.empty()) return 0.0;
    const MeshQuery solid(result_.mesh);
    double removed = 0.0;
    for (const auto& [a, b, c] : removed_) {
      if (solid.containment((a + b + c) / 3.0) == Containment::Inside) continue;
      removed += 0.5 * (b - a).cross(c - a).norm();
    }
    return removed > 0.0 ? removed / (removed + surface_area(result_.mesh)) : 0.0;
  }

  /// Fills the holes that are small enough. Returns how many.
  std::size_t fill(const std::vector<HoleRim>& rims) {
    TriangleMesh& mesh = result_.mesh;
    if (rims.empty() || mesh.faces.empty()) return 0;
    const TriangleMesh open = mesh;
    const std::size_t count =
        internal::fill_holes(mesh, rims, options_.max_hole_extent_rel * longest_extent(mesh));
    // Faces without area reach no farther than the rim and the other faces of their patch.
    std::vector<Face> patches;
    for (auto face = base::as_index<std::int32_t>(open.faces.size()); face < std::ssize(mesh.faces);
         ++face) {
      if (!internal::is_degenerate(mesh, face)) patches.push_back(mesh.faces[face]);
    }
    add_step("filled holes", count, reach_of(patches, open));
    for (const Triangle& triangle : internal::triangles_of(mesh.vertices, patches)) {
      fillings_.push_back(triangle);
    }
    return count;
  }

  void drop_collapsed_faces() {
    std::vector<Face> collapsed;
    for (const Face& face : result_.mesh.faces) {
      if (internal::has_repeated_vertex(face)) collapsed.push_back(face);
    }
    const std::size_t count = internal::remove_collapsed_faces(result_.mesh);
    add_removal("removed degenerate faces", count, loose_segments(collapsed, result_.mesh.faces));
  }

  void drop_doubled_faces(TwoSided two_sided) {
    const std::vector<Face> faces = result_.mesh.faces;
    const std::size_t count = internal::remove_doubled_faces(result_.mesh, two_sided);
    if (count == 0) return;
    add_removal("removed doubled faces", count, faces_beyond(faces, result_.mesh.faces));
  }

  void add_removal(const char* what, std::size_t count, std::vector<Face> faces) {
    add_step(what, count, reach_of(faces, result_.mesh));
    // Both sides of a sheet count once.
    for (Face& face : faces) std::sort(face.begin(), face.end());
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    for (const Triangle& triangle : internal::triangles_of(result_.mesh.vertices, faces)) {
      removed_.push_back(triangle);
    }
  }

  /// Replaces the surface by the boundary of the solid that it means, if that is in order and
  /// crosses itself less. Rounding the cuts may leave crossings of an ulp; another round on what is
  /// left takes most of them.
  void resolve_self_intersections() {
    const std::size_t before = result_.after.num_self_intersections.value_or(0);
    if (before == 0 || !result_.after.is_closed) return;
    constexpr int kMaxRounds = 4;
    const TriangleMesh given = result_.mesh;
    std::size_t left = before;
    for (int round = 0; round < kMaxRounds && left > 0; ++round) {
      TriangleMesh resolved = solid_boundary(result_.mesh);
      internal::remove_doubled_faces(resolved, TwoSided::Removed);
      internal::remove_unused_vertices(resolved);
      if (resolved.faces.empty()) break;
      internal::split_nonmanifold(resolved);
      const MeshAnalysis analysis = analyzed(resolved);
      const bool is_sound = analysis.is_outward && analysis.is_manifold;
      if (!is_sound || *analysis.num_self_intersections >= left) break;
      left = *analysis.num_self_intersections;
      result_.mesh = std::move(resolved);
      result_.after = analysis;
    }
    if (left == before) return;
    const double bound =
        hausdorff_distance(MeshQuery(given), MeshQuery(result_.mesh), distance_options()).upper;
    add_step("resolved self-intersections", before - left, bound);
  }

  void wrap() {
    if (!(extent_ > 0.0)) return;
    TriangleMesh wrapped =
        internal::alpha_wrap(given_, options_.wrap->alpha_rel, options_.wrap->offset_rel, extent_);
    if (wrapped.faces.empty()) return;
    const MeshAnalysis analysis = analyzed(wrapped);
    if (!is_good(analysis) || !(signed_volume(wrapped) > 0.0) ||
        !internal::encloses(wrapped, given_))
      return;
    result_.steps.clear();
    misfilled_rel_ = 0.0;
    removed_rel_ = 0.0;
    volume_ = volume_of(given_, result_.before.is_closed);
    const double bound =
        hausdorff_distance(MeshQuery(given_), MeshQuery(wrapped), distance_options()).upper;
    result_.mesh = std::move(wrapped);
    result_.after = analysis;
    add_step("wrapped", result_.mesh.faces.size(), bound);
  }

  void refuse_defects() const {
    const MeshAnalysis& mesh = result_.before;
    std::string defects = defects_of(mesh);
    if (defects.empty() && !mesh.is_manifold) defects = "pinched vertices";
    if (mesh.num_self_intersections.value_or(0) > 0) {
      defects += (defects.empty() ? "" : ", ") + std::to_string(*mesh.num_self_intersections) +
                 " pairs of crossing faces";
    }
    if (!defects.empty()) {
      throw base::InvalidInput("the mesh has " + defects +
                               "; strict mode repairs nothing, --repair repair mends what it can");
    }
  }

  void refuse_open() const {
    if (result_.after.is_closed) return;
    if (result_.mesh.faces.empty()) {
      throw base::DegenerateGeometry("the mesh encloses no volume: its faces cancel each other" +
                                     advice_to_wrap("; "));
    }
    const double share = largest_hole_rel();
    std::string advice = advice_to_fill(share);
    advice += advice_to_wrap(advice.empty() ? "" : "; ");
    throw base::InvalidInput(
        "the mesh is not closed and could not be repaired: " + defects_of(result_.after) +
        hole_text(share) + (advice.empty() ? "" : "; ") + advice);
  }

  void refuse_failure() const {
    if (is_misfilled()) {
      const std::string advice = advice_to_fill(largest_open_rel_);
      throw base::InvalidInput(
          "the mesh is not closed, and filling its holes would miss the solid that "
          "its surface means by " +
          percent(misfilled_rel_) + " of the volume" + hole_text(largest_open_rel_) +
          (advice.empty() ? "" : "; ") + advice + advice_to_wrap("; "));
    }
    if (is_stripped()) {
      throw base::InvalidInput(percent(removed_rel_) +
                               " of the mesh's surface are sheets without thickness" +
                               advice_to_wrap("; "));
    }
  }

  /// Extent of the largest hole that is left, over that of the mesh. If holes that meet were too
  /// large to be filled, they are the ones that count, and not the borders of the patches that came
  /// apart at their vertices.
  double largest_hole_rel() const {
    if (largest_meeting_rel_ > options_.max_hole_extent_rel) return largest_meeting_rel_;
    double largest = 0.0;
    const internal::Holes holes = internal::holes_of(result_.mesh);
    for (const HoleRim& rim : concatenation(holes.single, holes.meeting)) {
      largest = std::max(largest, rim_extent_rel(result_.mesh, rim));
    }
    return largest;
  }

  /// What a larger limit for holes would do. It is tried out, so that the message is true.
  std::string advice_to_fill(double share) const {
    if (advice_ == Advice::None || options_.mode != RepairMode::Repair) return "";
    if (!(share > options_.max_hole_extent_rel)) return "";
    MeshRepairOptions wider = options_;
    wider.max_hole_extent_rel = std::min(1.0, std::ceil(1000.0 * share) / 1000.0);
    wider.self_intersections = SelfIntersections::Leave;
    wider.wrap.reset();
    try {
      Repair(given_, wider, Advice::None).run();
    } catch (const base::Error&) {
      return "";
    }
    return "--max-hole " + base::shortest_decimal(wider.max_hole_extent_rel) + " fills it";
  }

  /// What a message says of a hole that is left; nothing where there is none.
  std::string hole_text(double share) const {
    if (!(share > 0.0)) return "";
    return "; its largest hole spans " +
           base::shortest_decimal(std::round(1000.0 * share) / 1000.0) +
           " of its longest extent, holes up to " +
           base::shortest_decimal(options_.max_hole_extent_rel) + " are filled";
  }

  std::string advice_to_wrap(const char* before) const {
    if (options_.mode != RepairMode::Repair || !(extent_ > 0.0)) return "";
    return std::string(before) +
           (options_.wrap ? "no wrap could be laid around it either, another --wrap-alpha may do"
                          : "--wrap lays a closed surface around it");
  }

  const TriangleMesh& given_;
  const MeshRepairOptions& options_;
  const Advice advice_;
  const double extent_;
  RepairedMesh result_;
  double volume_ = 0.0;  ///< Of the mesh as it is now, holes closed by cones [m³].
  std::vector<Triangle> fillings_;
  std::vector<Triangle> removed_;     ///< Triangles removed for lack of thickness.
  double misfilled_rel_ = 0.0;        ///< See `misfilled_share`.
  double removed_rel_ = 0.0;          ///< See `removed_share`.
  double largest_meeting_rel_ = 0.0;  ///< Extent of the largest hole that meets another, over
                                      ///< that of the mesh that it was in.
  double largest_open_rel_ = 0.0;     ///< Extent of the hole that the other order left, likewise.
};

}  // namespace

void MeshRepairOptions::validate() const {
  const auto check = [](const char* field, double value, double least, double most) {
    base::require_between(least, most, "MeshRepairOptions", field, value);
  };
  check("weld_distance_rel", weld_distance_rel, 0.0, 0.01);
  check("max_hole_extent_rel", max_hole_extent_rel, 0.0, 1.0);
  check("max_misfilled_rel", max_misfilled_rel, 0.0, 1.0);
  check("max_removed_rel", max_removed_rel, 0.0, 1.0);
  if (!wrap) return;
  check("wrap.alpha_rel", wrap->alpha_rel, 1e-3, 1.0);
  check("wrap.offset_rel", wrap->offset_rel, 1e-4, 1.0);
}

RepairedMesh repair_mesh(const TriangleMesh& mesh, const MeshRepairOptions& options) {
  options.validate();
  if (mesh.faces.empty()) throw base::InvalidInput("the mesh has no faces");
  internal::require_usable(mesh, "repair_mesh");
  return Repair(mesh, options, Repair::Advice::Tried).run();
}

}  // namespace graspfit::geometry
