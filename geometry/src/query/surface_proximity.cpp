#include "graspfit/geometry/surface_proximity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "graspfit/base/option_check.hpp"
#include "mesh/input_check.hpp"
#include "query/box_tree.hpp"
#include "query/indexed_mesh.hpp"
#include "query/triangle_pair.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::BoxTree;
using internal::Corners;
using internal::Heights;

/// A unit direction in A, and half of the length along it of boxes along the axes of A and of B,
/// per half of the boxes' edges.
struct Direction {
  Direction(const Vector3d& along_A, const RigidTransform& X_AB)
      : of_A(along_A.normalized()),
        of_B(X_AB.linear().transpose() * of_A),
        origin_B(of_A.dot(X_AB.translation())),
        per_half_A(of_A.cwiseAbs()),
        per_half_B(of_B.cwiseAbs()) {}

  double lowest_A(const Corners& of) const { return -highest(of, -of_A); }
  /// Of corners in B.
  double highest_B(const Corners& of) const { return highest(of, of_B) + origin_B; }

  Vector3d of_A;
  Vector3d of_B;    ///< What a step in B is along it.
  double origin_B;  ///< Where B's origin is along it.
  Vector3d per_half_A;
  Vector3d per_half_B;

 private:
  static double highest(const Corners& of, const Vector3d& direction) {
    return std::max({direction.dot(of[0]), direction.dot(of[1]), direction.dot(of[2])});
  }
};

/// One search for nearest points, depth first, the nearer children first. Pairs of nodes and of
/// triangles that are surely no nearer than `share` times the best distance are left out.
///
/// What is farther apart is seen by boxes, by the slabs of parts that are nearly flat, and along
/// one more direction: that between the nearest points that are known. Surfaces that lie side by
/// side are apart along it nearly everywhere, where boxes at an angle to them overlap.
class Search {
 public:
  Search(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB, double enough,
         double share, double near_enough)
      : a_(a.indexed()),
        b_(b.indexed()),
        tree_a_(a_.pair_tree()),
        tree_b_(b_.pair_tree()),
        X_AB_(X_AB),
        turn_(X_AB.linear().cwiseAbs()),
        is_rotation_(is_rotation(X_AB)),
        squared_enough_(enough * enough),
        squared_share_(share * share),
        squared_near_enough_(near_enough < 0.0 ? -1.0 : near_enough * near_enough),
        noise_(kNoise * (largest_coordinate(tree_a_) + largest_coordinate(tree_b_) +
                         X_AB.translation().lpNorm<Eigen::Infinity>())),
        squared_best_(squared_enough_),
        squared_limit_(squared_enough_) {}

  void run(const std::optional<ProximitySeed>& seed) {
    if (seed) start_from(*seed);
    std::vector<Pair> open;
    open.reserve(64);
    push(open, 0, box_of_a(0), 0, box_of_b(0));
    while (!open.empty() && !is_done()) {
      const Pair pair = open.back();
      open.pop_back();
      if (!is_left_out(pair.squared_gap)) visit(pair, open);
    }
  }

  const std::optional<SurfaceProximity>& best() const { return best_; }
  /// After a search that ran to its end no pair of points is nearer than this.
  double at_least() const {
    return std::sqrt(std::min({squared_best_, squared_left_out_, squared_enough_}));
  }

 private:
  struct Pair {
    double squared_gap;
    std::int32_t node_a;
    std::int32_t node_b;
  };

  // Along the direction more than this is wanted, of the distance and of the coordinates: pairs
  // that rounding would let seem nearer than the best ones are looked at.
  static constexpr double kMargin = 1e-9;
  static constexpr double kNoise = 1e-12;

  static double largest_coordinate(const BoxTree& tree) {
    const BoxTree::Node& root = tree.nodes.front();
    return root.lower.cwiseAbs().cwiseMax(root.upper.cwiseAbs()).maxCoeff();
  }

  static Vector3d center(const BoxTree::Node& node) { return 0.5 * (node.lower + node.upper); }
  static Vector3d half(const BoxTree::Node& node) { return 0.5 * (node.upper - node.lower); }
  struct BoxOfA {
    const BoxTree::Node& node;
    Vector3d center;
    Vector3d half;
  };
  struct BoxOfB {
    const BoxTree::Node& node;
    Vector3d center_A;
    Vector3d half;    ///< Along the axes of B.
    Vector3d half_A;  ///< Of the box along the axes of A about it.
  };
  static BoxOfA box_of_a(const BoxTree::Node& node) { return {node, center(node), half(node)}; }
  BoxOfA box_of_a(std::int32_t i) const { return box_of_a(tree_a_.nodes[i]); }
  BoxOfB box_of_b(std::int32_t j) const {
    const BoxTree::Node& node = tree_b_.nodes[j];
    const Vector3d half_B = half(node);
    return {node, X_AB_ * center(node), half_B, turn_ * half_B};
  }

  /// The seed's faces are the best ones if they are near enough, and give the direction even if
  /// not.
  void start_from(const ProximitySeed& seed) {
    squared_best_ = std::numeric_limits<double>::infinity();
    improve(corners(a_.mesh, seed.face_a), seed.face_a, mapped(corners(b_.mesh, seed.face_b)),
            seed.face_b);
    if (squared_best_ < squared_enough_) return;
    best_.reset();
    squared_best_ = squared_enough_;
    set_limit(squared_enough_);
  }

  bool is_done() const {
    return squared_best_ == 0.0 || (best_ && squared_best_ <= squared_near_enough_);
  }

  Corners mapped(const Corners& c) const { return {X_AB_ * c[0], X_AB_ * c[1], X_AB_ * c[2]}; }

  /// A lower bound of the distance of two nodes, by boxes along the axes of A and along those of B,
  /// and by slabs where these leave the nodes near: seen from one frame alone turned boxes grow,
  /// and with them the number of pairs looked at.
  double squared_gap(const BoxOfA& a, const BoxOfB& b) const {
    const Vector3d between_A = b.center_A - a.center;
    double squared = (between_A.cwiseAbs() - a.half - b.half_A).cwiseMax(0.0).squaredNorm();
    if (squared >= squared_limit_ || !is_rotation_) return squared;
    const auto turned = X_AB_.linear().transpose();
    const Vector3d between_B = turned * between_A;
    squared = std::max(
        squared,
        (between_B.cwiseAbs() - b.half - turn_.transpose() * a.half).cwiseMax(0.0).squaredNorm());
    if (a.node.is_flat && squared < squared_limit_) {
      const Vector3d& normal = a.node.normal;
      squared = std::max(squared, squared_gap(a.node, normal.dot(b.center_A),
                                              (turned * normal).cwiseAbs().dot(b.half)));
    }
    if (b.node.is_flat && squared < squared_limit_) {
      const Vector3d normal_A = X_AB_.linear() * b.node.normal;
      squared = std::max(squared, squared_gap(b.node, normal_A.dot(a.center - X_AB_.translation()),
                                              normal_A.cwiseAbs().dot(a.half)));
    }
    return squared;
  }
  /// A lower bound of the squared distance of a node's slab from a box whose center is at this
  /// height, and which reaches so far up and down from there.
  double squared_gap(const BoxTree::Node& slab, double height, double reach) const {
    const double away = std::max(height - slab.high, slab.low - height);
    const double gap = std::max(away - reach - noise_, 0.0);
    return gap * gap;
  }

  /// Whether two nodes need not be looked at, as they are apart along the direction.
  bool is_left_out_along(const BoxOfA& a, const BoxOfB& b) {
    if (!direction_) return false;
    const Vector3d& of_A = direction_->of_A;
    double lowest_a = of_A.dot(a.center) - direction_->per_half_A.dot(a.half);
    double highest_b = of_A.dot(b.center_A) + direction_->per_half_B.dot(b.half);
    if (is_left_out_along(lowest_a - highest_b)) return true;
    if (!a.node.is_flat && !b.node.is_flat) return false;
    if (a.node.is_flat) lowest_a = std::max(lowest_a, lowest_in(a.node, of_A));
    if (b.node.is_flat) {
      highest_b = std::min(highest_b, direction_->origin_B - lowest_in(b.node, -direction_->of_B));
    }
    return is_left_out_along(lowest_a - highest_b);
  }
  /// A lower bound of d · p for points p in a node's box and slab: of the part of d that is along
  /// the slab's normal by the slab, of the rest by the box.
  static double lowest_in(const BoxTree::Node& node, const Vector3d& d) {
    const double along = d.dot(node.normal);
    const Vector3d rest = d - along * node.normal;
    return std::min(along * node.low, along * node.high) + rest.dot(center(node)) -
           rest.cwiseAbs().dot(half(node));
  }
  bool is_left_out_along(double gap) {
    if (!(gap > limit_along_)) return false;
    squared_left_out_ = std::min(squared_left_out_, gap * gap);
    return true;
  }

  /// Whether nodes or triangles that are so far apart at least need not be looked at.
  bool is_left_out(double squared_gap) {
    if (squared_gap < squared_limit_) return false;
    squared_left_out_ = std::min(squared_left_out_, squared_gap);
    return true;
  }

  void push(std::vector<Pair>& open, std::int32_t i, const BoxOfA& a, std::int32_t j,
            const BoxOfB& b) {
    if (is_left_out_along(a, b)) return;
    const double gap = squared_gap(a, b);
    if (!is_left_out(gap)) open.push_back({gap, i, j});
  }

  void visit(const Pair& pair, std::vector<Pair>& open) {
    const BoxTree::Node& node_a = tree_a_.nodes[pair.node_a];
    const BoxTree::Node& node_b = tree_b_.nodes[pair.node_b];
    if (node_a.count > 0 && node_b.count > 0) {
      compare(node_a, node_b);
      return;
    }
    const bool splits_a =
        node_a.count == 0 && (node_b.count > 0 || (node_a.upper - node_a.lower).squaredNorm() >=
                                                      (node_b.upper - node_b.lower).squaredNorm());
    const std::size_t size = open.size();
    if (splits_a) {
      const BoxOfB b = box_of_b(pair.node_b);
      for (const std::int32_t i : {pair.node_a + 1, node_a.first}) {
        push(open, i, box_of_a(i), pair.node_b, b);
      }
    } else {
      const BoxOfA a = box_of_a(pair.node_a);
      for (const std::int32_t j : {pair.node_b + 1, node_b.first}) {
        push(open, pair.node_a, a, j, box_of_b(j));
      }
    }
    // The last pair of the list is visited first.
    if (open.size() == size + 2 && open[size].squared_gap < open[size + 1].squared_gap) {
      std::swap(open[size], open[size + 1]);
    }
  }

  void compare(const BoxTree::Node& node_a, const BoxTree::Node& node_b) {
    using Box = Eigen::AlignedBox3d;
    const auto squared_apart = [](const Box& a, const Box& b) {
      return (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0.0).squaredNorm();
    };
    const BoxOfA leaf_a = box_of_a(node_a);
    for (std::int32_t t = node_b.first; t < node_b.first + node_b.count; ++t) {
      const internal::IndexedTriangle& of_b = tree_b_.triangles[t];
      // Whatever is found meanwhile, this direction stays one.
      const std::optional<Direction> direction = direction_;
      const double highest_b = direction ? direction->highest_B(of_b.corners) : 0.0;
      if (direction && is_left_out_along(direction->of_A.dot(leaf_a.center) -
                                         direction->per_half_A.dot(leaf_a.half) - highest_b)) {
        continue;
      }
      const Corners corners_b = mapped(of_b.corners);
      const Box box_b = internal::box_of(corners_b);
      if (is_left_out(squared_apart(Box(node_a.lower, node_a.upper), box_b))) continue;
      for (std::int32_t s = node_a.first; s < node_a.first + node_a.count; ++s) {
        const internal::IndexedTriangle& of_a = tree_a_.triangles[s];
        if (direction && is_left_out_along(direction->lowest_A(of_a.corners) - highest_b)) continue;
        if (is_left_out(squared_apart(internal::box_of(of_a.corners), box_b))) continue;
        improve(of_a.corners, of_a.face, corners_b, of_b.face);
      }
    }
  }

  void offer(const Vector3d& on_a, const Vector3d& on_b, std::int32_t face_a, std::int32_t face_b) {
    const double squared = (on_a - on_b).squaredNorm();
    if (!(squared < squared_best_)) return;
    squared_best_ = squared;
    best_ = {std::sqrt(squared), on_a, on_b, face_a, face_b};
    set_limit(std::min(squared_enough_, squared_share_ * squared));
    if (squared > 0.0) direction_.emplace(on_a - on_b, X_AB_);
  }

  void set_limit(double squared_limit) {
    squared_limit_ = squared_limit;
    // Not a share of the best: bounds are the better for what is left out so.
    limit_along_ = std::sqrt(std::min(squared_enough_, squared_best_)) * (1.0 + kMargin) + noise_;
  }

  /// Offers the nearest points of two triangles. If the triangles do not cross, these points are on
  /// a corner and a triangle, or on two edges. Corners and edges are skipped if they are farther
  /// from the other triangle's plane than the best distance.
  void improve(const Corners& a, std::int32_t face_a, const Corners& b, std::int32_t face_b) {
    const Heights of_b(a, b);
    if (of_b.are_beyond(squared_best_)) return;
    const Heights of_a(b, a);
    if (of_a.are_beyond(squared_best_)) return;
    if (of_a.beyond == 0.0 && of_b.beyond == 0.0) {
      for (const auto& [first, second] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
        if (const std::optional<Vector3d> point = internal::piercing(*first, *second)) {
          offer(*point, *point, face_a, face_b);
          return;
        }
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (of_a.is_corner_near(i, squared_best_)) {
        offer(a[i], internal::closest_on_triangle(a[i], b), face_a, face_b);
      }
      if (of_b.is_corner_near(i, squared_best_)) {
        offer(internal::closest_on_triangle(b[i], a), b[i], face_a, face_b);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!of_a.is_edge_near(i, squared_best_)) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        if (!of_b.is_edge_near(j, squared_best_)) continue;
        const auto [on_a, on_b] =
            internal::closest_on_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
        offer(on_a, on_b, face_a, face_b);
      }
    }
  }

  const internal::IndexedMesh& a_;
  const internal::IndexedMesh& b_;
  const BoxTree& tree_a_;
  const BoxTree& tree_b_;
  const RigidTransform& X_AB_;
  const Eigen::Matrix3d turn_;
  const bool is_rotation_;  ///< Whether lengths along the axes of B are lengths in A, too.
  const double squared_enough_;
  const double squared_share_;
  const double squared_near_enough_;
  const double noise_;  ///< [m]
  double squared_best_;
  double squared_limit_;  ///< Nodes and triangles as far apart as this are left out.
  double limit_along_ = std::numeric_limits<double>::infinity();  ///< The same along the direction.
  std::optional<Direction> direction_;
  double squared_left_out_ = std::numeric_limits<double>::infinity();
  std::optional<SurfaceProximity> best_;
};

void require_seed(const std::optional<ProximitySeed>& seed, const MeshQuery& a, const MeshQuery& b,
                  const char* who) {
  if (!seed) return;
  const auto require_face = [&](std::int32_t face, const MeshQuery& query, const char* name) {
    base::require(face >= 0 && face < std::ssize(query.mesh().faces), who, name, face,
                  "a face of the mesh");
  };
  require_face(seed->face_a, a, "seed.face_a");
  require_face(seed->face_b, b, "seed.face_b");
}

}  // namespace

std::optional<SurfaceProximity> nearest_points(const MeshQuery& a, const MeshQuery& b,
                                               const RigidTransform& X_AB, double enough,
                                               const std::optional<ProximitySeed>& seed,
                                               double near_enough) {
  internal::require_finite(X_AB, "nearest_points");
  require_seed(seed, a, b, "nearest_points");
  base::require(!std::isnan(near_enough), "nearest_points", "near_enough", near_enough, "a number");
  base::require(!std::isnan(enough), "nearest_points", "enough", enough, "a number");
  Search search(a, b, X_AB, enough, 1.0, near_enough);
  search.run(seed);
  return search.best();
}

SurfaceClearance surface_clearance(const MeshQuery& a, const MeshQuery& b,
                                   const RigidTransform& X_AB, double enough, double share,
                                   const std::optional<ProximitySeed>& seed) {
  internal::require_finite(X_AB, "surface_clearance");
  require_seed(seed, a, b, "surface_clearance");
  base::require(!std::isnan(enough), "surface_clearance", "enough", enough, "a number");
  base::require(share > 0.0 && share <= 1.0, "surface_clearance", "share", share, "in (0, 1]");
  Search search(a, b, X_AB, enough, share, 0.0);
  search.run(seed);
  SurfaceClearance result{search.at_least(), seed};
  if (search.best()) result.nearest = ProximitySeed{search.best()->face_a, search.best()->face_b};
  return result;
}

}  // namespace graspfit::geometry
