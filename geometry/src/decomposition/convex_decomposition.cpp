#include "graspfit/geometry/convex_decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "decomposition/cut_choice.hpp"
#include "decomposition/outside_depth.hpp"
#include "decomposition/piece_hull.hpp"
#include "decomposition/piece_measures.hpp"
#include "decomposition/solid_part.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "mesh/input_check.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::PieceHull;
using internal::SolidPart;

// All relative to the longest extent of the solid.
constexpr double kOnPlaneRel = 1e-9;     // corners this near to a cut are on it
constexpr double kLeastWidthRel = 1e-5;  // thinner pieces are left out: engines refuse them
// Relative to the wanted deviation.
constexpr double kAimedRel = 0.9;  // sampled depths miss some of the true one
constexpr double kHullToleranceRel = 0.05;
constexpr double kLeastMeasuredRel = 0.5;  // outward deviations below cost too many cubes
constexpr double kMeasuredRel = 0.05;      // of the outward deviation's bound
// Largest relative difference of volumes at which the pieces together count as the solid itself:
// they cover it and are no larger.
constexpr double kSameVolumeRel = 1e-12;
constexpr int kDepthResolution = 128;
constexpr int kVolumeLines = 128;
// Share of a part's depth: a cut that leaves a single piece with more than this share is useless.
constexpr double kLeastGainRel = 0.9;

// There are more parts than pieces, because early cuts may separate what can be united later.
constexpr std::size_t kPartsPerPiece = 3;

struct Piece {
  std::vector<Vector3d> points;  ///< Their hull holds all parts of the piece.
  PieceHull hull;
  double depth = 0.0;      ///< Sampled, or a proven bound [m].
  bool is_proven = false;  ///< Whether `depth` is a proven bound.
};

/// The mesh without the vertices that belong to no face.
TriangleMesh used_part(const TriangleMesh& mesh) {
  std::vector<std::int32_t> index(mesh.vertices.size(), -1);
  TriangleMesh used;
  for (const Face& face : mesh.faces) {
    Face mapped;
    for (int k = 0; k < 3; ++k) {
      std::int32_t& to = index[face[k]];
      if (to < 0) {
        to = base::as_index<std::int32_t>(used.vertices.size());
        used.vertices.push_back(mesh.vertices[face[k]]);
      }
      mapped[k] = to;
    }
    used.faces.push_back(mapped);
  }
  return used;
}

class Decomposer {
 public:
  Decomposer(const MeshQuery& solid, const ConvexDecompositionOptions& options)
      : solid_(solid),
        options_(options),
        extent_(solid.box().sizes().maxCoeff()),
        depth_(solid, kDepthResolution) {}

  /// Cuts the solid into at most `most` pieces, none deeper than wanted if that many suffice.
  std::vector<Piece> parts(std::size_t most) {
    add(internal::whole_solid(solid_));
    while (pieces_.size() < most) {
      std::size_t worst = pieces_.size();
      double depth = options_.largest_deviation;
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (can_split_[i] && pieces_[i].depth > depth) {
          worst = i;
          depth = pieces_[i].depth;
        }
      }
      if (worst == pieces_.size()) break;
      split(worst);
    }
    return std::move(pieces_);
  }

  double largest_deviation() const { return options_.largest_deviation; }
  /// Pieces farther apart than this are no neighbors [m].
  double reach() const { return options_.largest_deviation; }

  double depth_between(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b,
                       double limit) const {
    return internal::deepest_segment(a, b, depth_, a.size() + b.size(), limit);
  }

  double aimed() const { return kAimedRel * options_.largest_deviation; }

  std::optional<Piece> piece_of(std::vector<Vector3d> points,
                                double limit = std::numeric_limits<double>::infinity()) const {
    const auto hull =
        internal::piece_hull(points, {.tolerance = kHullToleranceRel * options_.largest_deviation,
                                      .max_vertices = options_.max_piece_vertices,
                                      .least_width = kLeastWidthRel * extent_});
    if (!hull) return std::nullopt;
    const double depth = internal::sampled_depth(*hull, depth_, limit);
    return Piece{std::move(points), *hull, depth, false};
  }

  /// Proves the depth of a piece that is shallow enough according to samples.
  void verify(Piece& piece) const {
    if (piece.depth <= options_.largest_deviation) prove(piece, aimed());
  }

  /// Replaces the depth by a proven bound, where depths below `floor` [m] do not matter.
  void prove(Piece& piece, double floor) const {
    piece.is_proven = true;
    piece.depth = internal::outward_deviation(
        {&piece.hull, 1}, solid_,
        {.tolerance = kMeasuredRel * options_.largest_deviation, .floor = floor});
  }

 private:
  void add(SolidPart part) {
    std::optional<Piece> piece = piece_of(part.hull_points());
    if (!piece) return;
    verify(*piece);
    pieces_.push_back(*std::move(piece));
    parts_.push_back(std::move(part));
    can_split_.push_back(true);
  }

  void remove(std::size_t index) {
    pieces_.erase(pieces_.begin() + index);
    parts_.erase(parts_.begin() + index);
    can_split_.erase(can_split_.begin() + index);
  }

  void split(std::size_t index) {
    const double allowed = std::min(aimed(), 0.5 * pieces_[index].depth);
    const auto plane = internal::choose_cut(parts_[index], pieces_[index].hull, depth_,
                                            solid_.mesh(), allowed, index);
    if (plane && cut_at(index, *plane)) return;
    // From long slivers the planes of faces only shave layers; slivers cut in the middle become
    // shallower.
    if (!cut_at(index, across(pieces_[index].hull))) can_split_[index] = false;
  }

  /// The perpendicular plane halfway between the two corners that are the farthest apart.
  static internal::CutPlane across(const PieceHull& hull) {
    const std::vector<Vector3d>& corners = hull.mesh.vertices;
    Vector3d longest = Vector3d::Zero();
    Vector3d middle = Vector3d::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = i + 1; j < corners.size(); ++j) {
        const Vector3d between = corners[j] - corners[i];
        if (between.squaredNorm() <= longest.squaredNorm()) continue;
        longest = between;
        middle = 0.5 * (corners[i] + corners[j]);
      }
    }
    const Vector3d normal = longest.normalized();
    return {normal, normal.dot(middle)};
  }

  /// Cuts a part by a plane. Returns whether that improved anything; if not, the part is unchanged.
  bool cut_at(std::size_t index, const internal::CutPlane& plane) {
    auto [below, above] = internal::cut(parts_[index], plane, kOnPlaneRel * extent_, solid_);
    if (below.num_polygons() == 0 || above.num_polygons() == 0) return false;
    std::optional<Piece> lower = piece_of(below.hull_points());
    std::optional<Piece> upper = piece_of(above.hull_points());
    if (!lower && !upper) {
      // The part is a sliver, which may still reach far out, and neither side of it is thick
      // enough.
      remove(index);
      return true;
    }
    if (!lower) {
      std::swap(lower, upper);
      std::swap(below, above);
    }
    verify(*lower);
    // If this cut takes off only a layer too thin for a piece, the next one would take the next
    // layer.
    if (!upper && lower->depth > kLeastGainRel * pieces_[index].depth) return false;
    pieces_[index] = *std::move(lower);
    parts_[index] = std::move(below);
    if (!upper) return true;
    verify(*upper);
    pieces_.push_back(*std::move(upper));
    parts_.push_back(std::move(above));
    can_split_.push_back(true);
    return true;
  }

  const MeshQuery& solid_;
  ConvexDecompositionOptions options_;
  double extent_;
  internal::OutsideDepth depth_;
  std::vector<Piece> pieces_;
  std::vector<SolidPart> parts_;
  std::vector<bool> can_split_;
};

/// Unites the two neighbors whose common hull is the least deep, as long as it is shallow enough or
/// there are too many pieces. Where no pieces are neighbors any more, too many may be left.
class Merger {
 public:
  Merger(const Decomposer& decomposer, std::vector<Piece> pieces)
      : decomposer_(decomposer), pieces_(std::move(pieces)), is_alive_(pieces_.size(), true) {
    for (const Piece& piece : pieces_) boxes_.push_back(bounding_box(piece.hull.mesh));
  }

  std::vector<Piece> merged(std::size_t most_pieces) {
    constexpr double kRaise = 1.25;  // factor on the allowed depth while there are too many pieces
    double limit = decomposer_.aimed();
    std::size_t count = pieces_.size();
    for (std::size_t a = 0; a < pieces_.size(); ++a) {
      for (std::size_t b = a + 1; b < pieces_.size(); ++b) add_pair(a, b);
    }
    while (!pairs_.empty()) {
      for (Pair& pair : pairs_) evaluate(pair, limit);
      const auto best =
          std::min_element(pairs_.begin(), pairs_.end(),
                           [](const Pair& a, const Pair& b) { return a.depth < b.depth; });
      if (best->depth <= limit) {
        const Pair pair = *best;
        pairs_.erase(best);
        if (unite(pair, limit)) --count;
        if (limit > decomposer_.aimed() && count <= most_pieces) break;
      } else if (count > most_pieces) {
        limit = std::max(kRaise * limit, best->depth);
      } else {
        break;
      }
    }
    std::vector<Piece> left;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (is_alive_[i]) left.push_back(std::move(pieces_[i]));
    }
    return left;
  }

 private:
  struct Pair {
    std::size_t a = 0;
    std::size_t b = 0;
    double depth = 0.0;     ///< Lower bound of the depth of the common hull [m].
    bool is_known = false;  ///< Whether `depth` is the depth of the common hull itself.
  };

  void add_pair(std::size_t a, std::size_t b) {
    if (boxes_[a].exteriorDistance(boxes_[b]) <= decomposer_.reach()) pairs_.push_back({a, b});
  }

  void evaluate(Pair& pair, double limit) const {
    if (pair.is_known || pair.depth > limit) return;
    const std::vector<Vector3d>& points_a = pieces_[pair.a].hull.mesh.vertices;
    const std::vector<Vector3d>& points_b = pieces_[pair.b].hull.mesh.vertices;
    const double on_segments = decomposer_.depth_between(points_a, points_b, limit);
    pair.depth = std::max(pair.depth, on_segments);
    if (pair.depth > limit) return;
    std::vector<Vector3d> points = points_a;
    points.insert(points.end(), points_b.begin(), points_b.end());
    const std::optional<Piece> merged = decomposer_.piece_of(std::move(points), limit);
    if (merged) pair.depth = std::max(pair.depth, merged->depth);
    pair.is_known = pair.depth <= limit;
  }

  /// Unites two pieces, unless a proven bound shows their union deeper than allowed, which samples
  /// may have missed; such a pair is kept with its proven depth until the limit allows it.
  bool unite(const Pair& pair, double limit) {
    std::vector<Vector3d> points = pieces_[pair.a].points;
    points.insert(points.end(), pieces_[pair.b].points.begin(), pieces_[pair.b].points.end());
    std::optional<Piece> merged = decomposer_.piece_of(std::move(points));
    if (!merged) return false;
    const double allowed = std::max(limit / kAimedRel, decomposer_.largest_deviation());
    decomposer_.prove(*merged, kAimedRel * allowed);
    if (merged->depth > allowed) {
      pairs_.push_back({pair.a, pair.b, merged->depth, true});
      return false;
    }
    pieces_[pair.a] = *std::move(merged);
    boxes_[pair.a] = bounding_box(pieces_[pair.a].hull.mesh);
    is_alive_[pair.b] = false;
    std::erase_if(pairs_, [&](const Pair& other) {
      return other.a == pair.a || other.a == pair.b || other.b == pair.a || other.b == pair.b;
    });
    for (std::size_t other = 0; other < pieces_.size(); ++other) {
      if (other != pair.a && is_alive_[other]) {
        add_pair(std::min(pair.a, other), std::max(pair.a, other));
      }
    }
    return true;
  }

  const Decomposer& decomposer_;
  std::vector<Piece> pieces_;
  std::vector<bool> is_alive_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<Pair> pairs_;
};

}  // namespace

void ConvexDecompositionOptions::validate() const {
  const auto refuse = [](const std::string& what) {
    throw base::InvalidInput("ConvexDecompositionOptions: " + what);
  };
  if (!(largest_deviation > 0.0) || !std::isfinite(largest_deviation)) {
    refuse("largest_deviation must be > 0 and finite, is " +
           base::shortest_decimal(largest_deviation));
  }
  if (max_pieces < 1) refuse("max_pieces must be >= 1, is " + std::to_string(max_pieces));
  if (max_piece_vertices < 32) {
    refuse("max_piece_vertices must be >= 32, is " + std::to_string(max_piece_vertices));
  }
}

ConvexDecomposition convex_decomposition(const TriangleMesh& mesh,
                                         const ConvexDecompositionOptions& options) {
  options.validate();
  internal::require_usable(mesh, "convex_decomposition");
  if (mesh.faces.empty() || !internal::bounds_solid(mesh)) {
    throw base::DegenerateGeometry(
        "convex_decomposition: the mesh is not closed and bounds no solid; repair it first");
  }
  const double volume = mass_properties(mesh).volume;
  const MeshQuery solid(used_part(solid_boundary(mesh)));
  Decomposer decomposer(solid, options);
  std::vector<Piece> pieces =
      Merger(decomposer,
             decomposer.parts(kPartsPerPiece * static_cast<std::size_t>(options.max_pieces)))
          .merged(static_cast<std::size_t>(options.max_pieces));
  ConvexDecomposition result;
  std::vector<PieceHull> hulls;
  double proven = 0.0;
  for (Piece& piece : pieces) {
    proven =
        std::max(proven, piece.is_proven ? piece.depth : std::numeric_limits<double>::infinity());
    result.inward_deviation = std::max(result.inward_deviation, piece.hull.left_out);
    result.pieces.push_back(piece.hull.mesh);
    hulls.push_back(std::move(piece.hull));
  }
  double sum = 0.0;
  for (const TriangleMesh& piece : result.pieces) sum += signed_volume(piece);
  const bool is_exact =
      result.inward_deviation == 0.0 && std::abs(sum - volume) <= kSameVolumeRel * volume;
  if (!is_exact) {
    const double measured =
        internal::outward_deviation(hulls, solid,
                                    {.tolerance = kMeasuredRel * options.largest_deviation,
                                     .floor = kLeastMeasuredRel * options.largest_deviation});
    result.outward_deviation = std::min(measured, proven);
  }
  result.volume_error = internal::volume_difference(hulls, solid, kVolumeLines) / volume;
  result.is_within_deviation = result.outward_deviation <= options.largest_deviation;
  return result;
}

}  // namespace graspfit::geometry
