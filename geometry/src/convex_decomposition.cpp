#include "graspfit/geometry/convex_decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "internal/cut_choice.hpp"
#include "internal/mesh_edges.hpp"
#include "internal/outside_depth.hpp"
#include "internal/piece_hull.hpp"
#include "internal/piece_measures.hpp"
#include "internal/solid_part.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::PieceHull;
using internal::SolidPart;

// All relative to the longest extent of the solid.
constexpr double kOnPlaneRel = 1e-9;     // corners this near to a cut are on it: 1000 ulps
constexpr double kLeastWidthRel = 1e-5;  // thinner pieces are left out: engines refuse them
// Relative to the wanted deviation.
constexpr double kAimedRel = 0.9;  // sampled depths miss some of the true one
constexpr double kHullToleranceRel = 0.02;
constexpr double kMeasuredRel = 0.05;  // of the outward deviation's bound
constexpr int kDepthResolution = 128;
constexpr int kVolumeLines = 128;

struct Piece {
  std::vector<Vector3d> points;  ///< Their hull holds all parts of the piece.
  PieceHull hull;
  double depth = 0.0;  ///< Sampled [m].
};

bool is_closed(const TriangleMesh& mesh) {
  bool is_closed = !mesh.faces.empty();
  internal::for_each_edge(internal::sorted_sides(mesh), [&](auto first, auto last) {
    const auto up = std::count_if(first, last, [](const auto& side) { return side.runs_up(); });
    is_closed = is_closed && 2 * up == last - first;
  });
  return is_closed;
}

/// Without vertices of no face.
TriangleMesh used_part(const TriangleMesh& mesh) {
  std::vector<std::int32_t> index(mesh.vertices.size(), -1);
  TriangleMesh used;
  for (const Face& face : mesh.faces) {
    Face mapped;
    for (int k = 0; k < 3; ++k) {
      std::int32_t& to = index[face[k]];
      if (to < 0) {
        to = static_cast<std::int32_t>(used.vertices.size());
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

  void split_all() {
    add(internal::whole_solid(solid_));
    const auto most = static_cast<std::size_t>(options_.max_pieces);
    while (pieces_.size() < most) {
      std::size_t worst = pieces_.size();
      double depth = aimed();
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (can_split_[i] && pieces_[i].depth > depth) {
          worst = i;
          depth = pieces_[i].depth;
        }
      }
      if (worst == pieces_.size()) break;
      split(worst);
    }
  }

  std::vector<Piece>& pieces() { return pieces_; }

  double aimed() const { return kAimedRel * options_.largest_deviation; }

  std::optional<Piece> piece_of(std::vector<Vector3d> points,
                                double limit = std::numeric_limits<double>::infinity()) const {
    const auto hull =
        internal::piece_hull(points, {.tolerance = kHullToleranceRel * options_.largest_deviation,
                                      .max_vertices = options_.max_piece_vertices,
                                      .least_width = kLeastWidthRel * extent_});
    if (!hull) return std::nullopt;
    const double depth = internal::sampled_depth(*hull, depth_, limit);
    return Piece{std::move(points), *hull, depth};
  }

  void merge_all();

 private:
  void add(SolidPart part) {
    std::optional<Piece> piece = piece_of(part.hull_points());
    if (!piece) return;
    pieces_.push_back(*std::move(piece));
    parts_.push_back(std::move(part));
    can_split_.push_back(true);
  }

  void split(std::size_t index) {
    const double allowed = std::min(aimed(), 0.5 * pieces_[index].depth);
    const auto plane = internal::choose_cut(parts_[index], pieces_[index].hull, depth_,
                                            solid_.mesh(), allowed, index);
    if (!plane) {
      can_split_[index] = false;
      return;
    }
    auto [below, above] = internal::cut(parts_[index], *plane, kOnPlaneRel * extent_, solid_);
    if (below.num_polygons() == 0 || above.num_polygons() == 0) {
      can_split_[index] = false;
      return;
    }
    std::optional<Piece> lower = piece_of(below.hull_points());
    std::optional<Piece> upper = piece_of(above.hull_points());
    if (!lower && !upper) {
      can_split_[index] = false;
      return;
    }
    if (!lower) {
      std::swap(lower, upper);
      std::swap(below, above);
    }
    pieces_[index] = *std::move(lower);
    parts_[index] = std::move(below);
    if (!upper) return;
    pieces_.push_back(*std::move(upper));
    parts_.push_back(std::move(above));
    can_split_.push_back(true);
  }

  const MeshQuery& solid_;
  ConvexDecompositionOptions options_;
  double extent_;
  internal::OutsideDepth depth_;
  std::vector<Piece> pieces_;
  std::vector<SolidPart> parts_;
  std::vector<bool> can_split_;
};

/// Merges the two pieces whose common hull is the least deep, as long as it is shallow enough.
void Decomposer::merge_all() {
  struct Candidate {
    std::size_t a = 0;
    std::size_t b = 0;
    double depth = 0.0;
  };
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Piece& piece : pieces_) boxes.push_back(bounding_box(piece.hull.mesh));
  const double reach = options_.largest_deviation;
  const auto are_near = [&](std::size_t a, std::size_t b) {
    return boxes[a].exteriorDistance(boxes[b]) <= reach;
  };
  const auto merged_depth = [&](std::size_t a, std::size_t b) {
    const std::vector<Vector3d>& points_a = pieces_[a].hull.mesh.vertices;
    const std::vector<Vector3d>& points_b = pieces_[b].hull.mesh.vertices;
    const double on_segments = internal::deepest_segment(
        points_a, points_b, depth_, points_a.size() + points_b.size(), aimed());
    if (on_segments > aimed()) return on_segments;
    std::vector<Vector3d> points = points_a;
    points.insert(points.end(), points_b.begin(), points_b.end());
    const auto merged = piece_of(std::move(points), aimed());
    return merged ? merged->depth : 0.0;
  };
  std::vector<Candidate> candidates;
  const auto add_candidate = [&](std::size_t a, std::size_t b) {
    if (!are_near(a, b)) return;
    const double depth = merged_depth(a, b);
    if (depth <= aimed()) candidates.push_back({a, b, depth});
  };
  for (std::size_t a = 0; a < pieces_.size(); ++a) {
    for (std::size_t b = a + 1; b < pieces_.size(); ++b) add_candidate(a, b);
  }
  std::vector<bool> is_alive(pieces_.size(), true);
  while (!candidates.empty()) {
    const auto best =
        std::min_element(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.depth < b.depth; });
    const auto [a, b, depth] = *best;
    std::vector<Vector3d> points = std::move(pieces_[a].points);
    points.insert(points.end(), pieces_[b].points.begin(), pieces_[b].points.end());
    pieces_[a] = *piece_of(std::move(points));
    boxes[a] = bounding_box(pieces_[a].hull.mesh);
    is_alive[b] = false;
    std::erase_if(candidates, [a = a, b = b](const Candidate& c) {
      return c.a == a || c.a == b || c.b == a || c.b == b;
    });
    for (std::size_t other = 0; other < pieces_.size(); ++other) {
      if (other != a && is_alive[other]) add_candidate(std::min(a, other), std::max(a, other));
    }
  }
  std::vector<Piece> left;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (is_alive[i]) left.push_back(std::move(pieces_[i]));
  }
  pieces_ = std::move(left);
}

}  // namespace

void ConvexDecompositionOptions::validate() const {
  const auto refuse = [](const std::string& what) {
    throw InvalidInput("ConvexDecompositionOptions: " + what);
  };
  if (!(largest_deviation > 0.0) || !std::isfinite(largest_deviation)) {
    refuse("largest_deviation must be > 0 and finite, is " + shortest_decimal(largest_deviation));
  }
  if (max_pieces < 1) refuse("max_pieces must be >= 1, is " + std::to_string(max_pieces));
  if (max_piece_vertices < 32) {
    refuse("max_piece_vertices must be >= 32, is " + std::to_string(max_piece_vertices));
  }
}

ConvexDecomposition convex_decomposition(const TriangleMesh& mesh,
                                         const ConvexDecompositionOptions& options) {
  options.validate();
  if (!is_closed(mesh)) {
    throw DegenerateGeometry(
        "convex_decomposition: the mesh is not closed and bounds no solid; repair it first");
  }
  const double volume = mass_properties(mesh).volume;
  const MeshQuery solid(used_part(solid_boundary(mesh)));
  Decomposer decomposer(solid, options);
  decomposer.split_all();
  decomposer.merge_all();
  ConvexDecomposition result;
  std::vector<PieceHull> hulls;
  for (Piece& piece : decomposer.pieces()) {
    result.inward_deviation = std::max(result.inward_deviation, piece.hull.left_out);
    result.pieces.push_back(piece.hull.mesh);
    hulls.push_back(std::move(piece.hull));
  }
  result.outward_deviation =
      internal::outward_deviation(hulls, solid, kMeasuredRel * options.largest_deviation);
  result.volume_error = internal::volume_difference(hulls, solid, kVolumeLines) / volume;
  result.is_within_deviation = result.outward_deviation <= options.largest_deviation;
  return result;
}

}  // namespace graspfit::geometry
