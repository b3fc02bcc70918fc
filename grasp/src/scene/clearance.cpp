#include "scene/clearance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using geometry::SurfaceProximity;
using hands::RigidTransform;

namespace {

/// The distance of bodies that are not near is bounded from below, up to so much more than asked
/// for [m] and to half of the distance: until the bodies have moved by the bound, they need not be
/// measured again.
constexpr double kAhead = 0.04;
constexpr double kAheadShare = 0.5;
constexpr double kRounding = 1e-9;  // of a distance and of the coordinates [m]

/// Bound of how far any point of a ball in L moves from one pose to another.
double motion_bound(const RigidTransform& from, const RigidTransform& to, const Vector3d& center,
                    double radius) {
  // The spectral norm of the difference of two rotations is at most its Frobenius norm.
  return (to * center - from * center).norm() + radius * (to.linear() - from.linear()).norm();
}

}  // namespace

Clearance::Clearance(const FittingHand& hand, const ObjectModel& object,
                     const SurroundingsCollision& surroundings)
    : hand_(hand), object_(object), surroundings_(surroundings) {
  const hands::HandModel& model = hand.model();
  const auto num_links = base::as_index<int>(model.links.size());
  for (int a = 0; a < num_links; ++a) {
    pieces_.emplace_back(hand.pieces(a).size());
    const Eigen::AlignedBox3d box = hand.collision().link_solid(a)
                                        ? hand.collision().link_solid(a)->box()
                                        : Eigen::AlignedBox3d(Vector3d::Zero());
    centers_L_.push_back(box.center());
    radii_.push_back(0.5 * box.diagonal().norm());
    for (int b = a + 1; b < num_links; ++b) {
      const bool both = hand.collision().link_solid(a) && hand.collision().link_solid(b);
      if (both && !model.is_excluded(a, b)) pairs_.emplace_back(a, b);
    }
  }
  pair_known_.resize(pairs_.size());
}

bool Clearance::surely_beyond(const Known& known, const RigidTransform& X, const Vector3d& center,
                              double radius, double enough) {
  return known.is_known && known.at_least - motion_bound(known.X, X, center, radius) > enough;
}

std::optional<SurfaceProximity> Clearance::nearest(Known& known, const geometry::MeshQuery& a,
                                                   const geometry::MeshQuery& b,
                                                   const RigidTransform& X, double enough) {
  if (!known.is_near) {
    const auto found =
        geometry::surface_clearance(a, b, X, enough + kAhead, kAheadShare, known.seed);
    known = {found.at_least, X, found.nearest, true, false};
    if (found.at_least > enough) return std::nullopt;
  }
  const auto result = geometry::nearest_points(a, b, X, enough, known.seed);
  if (!result) {
    known = {enough, X, known.seed, true, false};
  } else {
    known = {result->distance, X, geometry::ProximitySeed{result->face_a, result->face_b}, true,
             true};
  }
  return result;
}

/// A lower bound of the distance of the object from a ball in O, which need not be the distance.
double Clearance::object_bound(const Vector3d& center_O, double radius, double enough) const {
  // The point and the nearest surface are within half a diagonal of their voxels' centers.
  const double voxel_size = object_.grid.lattice.voxel_size;
  const double by_map = std::abs(object_.distance.at(center_O)) * voxel_size - radius;
  const double rounding = std::numbers::sqrt3 * voxel_size;
  // The bound is enough, or none is.
  if (by_map - rounding > enough || by_map + rounding <= enough) return by_map - rounding;
  const double distance = std::sqrt(object_.query.closest_point(center_O).squared_distance);
  return distance - kRounding * (1.0 + distance) - radius;
}

std::vector<NearPoints> Clearance::find(const LinkPoses& X_OL, double enough) {
  std::vector<NearPoints> near;
  for (int link = 0; link < std::ssize(pieces_); ++link) {
    const auto& pieces = hand_.pieces(link);
    const RigidTransform& X = X_OL[link];
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      Known& known = pieces_[link][i];
      const FittingHand::Piece& piece = pieces[i];
      if (surely_beyond(known, X, piece.center_L, piece.radius, enough)) continue;
      if (!known.is_near) {
        const double bound = object_bound(X * piece.center_L, piece.radius, enough);
        if (bound > enough) {
          known = {bound, X, known.seed, true, false};
          continue;
        }
      }
      const auto found = nearest(known, object_.query, piece.surface_L, X, enough);
      if (!found) continue;
      near.push_back({found->distance, link, std::nullopt, found->point_on_b_A, found->point_on_a_A,
                      (found->point_on_b_A - found->point_on_a_A).normalized()});
    }
  }
  if (!surroundings_.surroundings().is_empty()) {
    for (int link = 0; link < std::ssize(X_OL); ++link) {
      if (!hand_.collision().link_solid(link)) continue;
      const SurroundingsDistance found =
          surroundings_.distance(hand_.collision(), link, X_OL[link], enough);
      if (found.distance > enough) continue;
      near.push_back({found.distance, link, std::nullopt, found.point_on_link_O,
                      found.point_on_link_O - found.distance * found.normal_O, found.normal_O});
    }
  }
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const auto [a, b] = pairs_[p];
    const RigidTransform X_AB = geometry::relative_pose(X_OL[a], X_OL[b]);
    Known& known = pair_known_[p];
    if ((centers_L_[a] - X_AB * centers_L_[b]).norm() > radii_[a] + radii_[b] + enough) {
      continue;
    }
    if (surely_beyond(known, X_AB, centers_L_[b], radii_[b], enough)) continue;
    const auto found = nearest(known, *hand_.collision().link_solid(a),
                               *hand_.collision().link_solid(b), X_AB, enough);
    if (!found) continue;
    const Vector3d on_a = X_OL[a] * found->point_on_a_A;
    const Vector3d on_b = X_OL[a] * found->point_on_b_A;
    near.push_back({found->distance, b, a, on_b, on_a, (on_b - on_a).normalized()});
  }
  return near;
}

bool Clearance::is_apart(const LinkPoses& X_OL, double least) const {
  const auto is_near = [&](const Known& known, const geometry::MeshQuery& a,
                           const geometry::MeshQuery& b, const RigidTransform& X,
                           const Vector3d& center, double radius) {
    return !surely_beyond(known, X, center, radius, least) &&
           geometry::nearest_points(a, b, X, least, known.seed, least);
  };
  for (int link = 0; link < std::ssize(pieces_); ++link) {
    const auto& pieces = hand_.pieces(link);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (is_near(pieces_[link][i], object_.query, pieces[i].surface_L, X_OL[link],
                  pieces[i].center_L, pieces[i].radius)) {
        return false;
      }
    }
  }
  for (int link = 0; link < std::ssize(X_OL); ++link) {
    if (surroundings_.surroundings().is_empty()) break;
    if (!hand_.collision().link_solid(link)) continue;
    if (surroundings_.distance(hand_.collision(), link, X_OL[link], least).distance <= least) {
      return false;
    }
  }
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const auto [a, b] = pairs_[p];
    if (is_near(pair_known_[p], *hand_.collision().link_solid(a), *hand_.collision().link_solid(b),
                geometry::relative_pose(X_OL[a], X_OL[b]), centers_L_[b], radii_[b])) {
      return false;
    }
  }
  return true;
}

Clearance::Blocked Clearance::blocked(const LinkPoses& X_OL, double least) const {
  Blocked result;
  for (int link = 0; link < std::ssize(X_OL); ++link) {
    const auto& solid = hand_.collision().link_solid(link);
    if (!solid) continue;
    const RigidTransform& X = X_OL[link];
    if (geometry::nearest_points(object_.query, *solid, X, least, {}, least) ||
        surroundings_.touches(hand_.collision(), link, X)) {
      result.links.push_back(link);
    }
  }
  for (const auto& [a, b] : pairs_) {
    const RigidTransform X_AB = geometry::relative_pose(X_OL[a], X_OL[b]);
    if (!geometry::nearest_points(*hand_.collision().link_solid(a),
                                  *hand_.collision().link_solid(b), X_AB, least, {}, least)) {
      continue;
    }
    result.by_own_hand.push_back(a);
    result.by_own_hand.push_back(b);
  }
  return result;
}

bool Clearance::is_clear_of_world(const LinkPoses& X_OL) const {
  for (int link = 0; link < std::ssize(X_OL); ++link) {
    const RigidTransform& X = X_OL[link];
    if (hand_.collision().link_intersects(object_.query, link, X)) return false;
    if (surroundings_.touches(hand_.collision(), link, X)) return false;
  }
  return true;
}

bool Clearance::is_clear_of_itself(const LinkPoses& X_OL) const {
  return std::none_of(pairs_.begin(), pairs_.end(), [&](const std::pair<int, int>& pair) {
    const RigidTransform X_AB = geometry::relative_pose(X_OL[pair.first], X_OL[pair.second]);
    return geometry::do_intersect(*hand_.collision().link_solid(pair.first),
                                  *hand_.collision().link_solid(pair.second), X_AB);
  });
}

}  // namespace graspfit::grasp::internal
