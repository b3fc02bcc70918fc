#include "fitting/guarded_hand.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

#include "fitting/finger_crossing.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "scene/infinity.hpp"

namespace graspfit::grasp::internal {
namespace {

using geometry::RigidTransform;

// A link whose sample points are at least this far from the surface [voxels] cannot meet it: a
// sample and a point of the surface are each up to √3/2 from the centers of their voxels, and a
// point of the link is up to 1.44 spacings (at most 0.85 voxel) from a sample.
constexpr float kNearVoxels = 3.0F;

// The distance of a link is not measured again while it is surely larger than this [voxels]: a
// larger value measures more often, a smaller one makes bounds less useful, as steps of three
// voxels follow.
constexpr double kFarEnough = 4.0;

// Step between one and two voxels from the surface [voxels]: longer ones are taken back more often,
// shorter ones are more.
constexpr double kStepBeforeSurface = 0.5;

// Depths of links in the object up to `kDepthFloor` are not distinguished, larger ones to
// `kDepthTolerance` [voxels]: smaller values cost more exact tests.
constexpr double kDepthFloor = 0.3;
constexpr double kDepthTolerance = 0.05;

}  // namespace

GuardedHand::GuardedHand(const GraspScene& scene, const FittingOptions& options,
                         const std::vector<int>& depth_guarded)
    : hand_(scene.hand),
      model_(scene.hand.model()),
      object_(scene.object),
      surroundings_(scene.surroundings),
      options_(options),
      voxel_size_(scene.object.grid.lattice.voxel_size),
      all_links_(model_.links.size()),
      guards_depth_(model_.links.size(), false),
      known_depths_(model_.links.size()),
      distance_(model_.links.size()),
      surroundings_distance_(model_.links.size(), kInfinity) {
  std::iota(all_links_.begin(), all_links_.end(), 0);
  for (const int link : depth_guarded) guards_depth_[link] = true;
  if (!options.guard_self) return;
  const auto has_solid = [&](int link) { return hand_.collision().link_solid(link).has_value(); };
  for (const int a : all_links_) {
    for (const int b : all_links_) {
      if (a < b && has_solid(a) && has_solid(b) && !model_.is_excluded(a, b)) {
        pairs_.emplace_back(a, b);
      }
    }
  }
}

float GuardedHand::measured(int link, const RigidTransform& X_OL) {
  if (hand_.samples(link).balls.empty()) return std::numeric_limits<float>::infinity();
  return grasp::smallest_distance(hand_, link, X_OL, object_.distance,
                                  static_cast<float>(options_.large_step_limit + 1.0));
}

double GuardedHand::distance_to_surroundings(int link, double enough) const {
  return std::min(enough,
                  surroundings_.distance(hand_.collision(), link, X_OL_[link], enough).distance);
}

void GuardedHand::put(const hands::HandConfiguration& configuration) {
  configuration_ = configuration;
  X_OL_ = hands::forward_kinematics(model_, configuration_);
  measure_all();
}

void GuardedHand::measure_all() {
  const double enough = (options_.large_step_limit + 1.0) * voxel_size_;
  for (const int link : all_links_) {
    distance_[link] = measured(link, X_OL_[link]);
    if (!surroundings_.surroundings().is_empty())
      surroundings_distance_[link] = distance_to_surroundings(link, enough);
  }
}

bool GuardedHand::is_clear() {
  return std::all_of(all_links_.begin(), all_links_.end(), [&](int link) {
    return distance_[link] > 0.0F && surroundings_distance_[link] > 0.0 &&
           !cuts_object(link, distance_[link], X_OL_[link]);
  });
}

bool GuardedHand::cuts_object(int link, float d_min, const RigidTransform& X_OL) {
  if (!(d_min < kNearVoxels)) return false;
  return options_.guard == PenetrationGuard::Meshes
             ? hand_.collision().link_intersects(object_.query, link, X_OL)
             : guards_depth_[link] && is_too_deep(link, X_OL);
}

std::vector<int> GuardedHand::links_too_deep() {
  std::vector<int> deep;
  std::copy_if(all_links_.begin(), all_links_.end(), std::back_inserter(deep), [&](int link) {
    return !guards_depth_[link] && distance_[link] < kNearVoxels && is_too_deep(link, X_OL_[link]);
  });
  return deep;
}

bool GuardedHand::is_too_deep(int link, const RigidTransform& X_OL) {
  // A depth changes by no more than the link moves: what was found at another pose often decides.
  for (const std::optional<KnownDepth>& known :
       {known_depths_[link].let, known_depths_[link].cut}) {
    if (!known) continue;
    const double motion = largest_motion(link, known->X_OL, X_OL);
    if (known->bounds.at_most + motion <= voxel_size_) return false;
    if (known->bounds.at_least - motion > voxel_size_) return true;
  }
  const geometry::DepthBounds bounds =
      hand_.collision().link_depth_above(object_.query, link, X_OL, kDepthFloor * voxel_size_,
                                         {.tolerance = kDepthTolerance * voxel_size_});
  const bool cuts = bounds.at_most > voxel_size_;
  (cuts ? known_depths_[link].cut : known_depths_[link].let) = {X_OL, bounds};
  return cuts;
}

double GuardedHand::largest_motion(int link, const RigidTransform& X_from,
                                   const RigidTransform& X_to) const {
  // How far a point moves is convex in the point: a corner of the link's box moves farthest.
  const Eigen::AlignedBox3d& box = hand_.collision().link_solid(link)->box();
  double largest = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    largest = std::max(largest, (X_to * corner - X_from * corner).norm());
  }
  return largest;
}

bool GuardedHand::try_move(const hands::HandConfiguration& candidate, const std::vector<int>& moved,
                           double length, const MotionTest& is_wanted) {
  trial_ = candidate;
  if (!passes_map(moved, length) || !is_wanted(trial_X_OL_) || !passes_exact(moved)) return false;
  accept();
  return true;
}

bool GuardedHand::passes_map(const std::vector<int>& moved, double length) {
  trial_X_OL_ = X_OL_;
  trial_distance_ = distance_;
  trial_surroundings_distance_ = surroundings_distance_;
  // A value changes by no more than √2 per voxel between centers, and a point is within √3/2 of its
  // own center, before and after.
  const double change = std::numbers::sqrt2 * (length / voxel_size_ + std::numbers::sqrt3);
  for (const int link : moved) {
    trial_X_OL_[link] = hands::link_pose(model_, link, trial_X_OL_, trial_);
    trial_surroundings_distance_[link] -= length;
    const double bound = distance_[link] - change;
    if (bound > kFarEnough) {
      trial_distance_[link] = static_cast<float>(bound);
      continue;
    }
    trial_distance_[link] = measured(link, trial_X_OL_[link]);
    if (trial_distance_[link] < 0.0F) {
      blocking_link_ = link;
      return false;
    }
  }
  blocking_link_.reset();
  return true;
}

bool GuardedHand::passes_exact(const std::vector<int>& moved) {
  for (const int link : moved) {
    if (trial_surroundings_distance_[link] <= 0.0 &&
        surroundings_.touches(hand_.collision(), link, trial_X_OL_[link])) {
      blocking_link_ = link;
      return false;
    }
    if (cuts_object(link, trial_distance_[link], trial_X_OL_[link])) {
      blocking_link_ = link;
      return false;
    }
  }
  return !meets_itself(moved);
}

bool GuardedHand::meets_itself(const std::vector<int>& moved) {
  constexpr double kRounding = 1e-12;  // of poses that a rigid motion has composed anew
  const auto is_moved = [&](int link) {
    return std::find(moved.begin(), moved.end(), link) != moved.end();
  };
  for (const auto& [a, b] : pairs_) {
    const bool is_b_moved = is_moved(b);
    if (!is_b_moved && !is_moved(a)) continue;
    const RigidTransform X_AB = geometry::relative_pose(trial_X_OL_[a], trial_X_OL_[b]);
    const RigidTransform before = geometry::relative_pose(X_OL_[a], X_OL_[b]);
    if ((X_AB.matrix() - before.matrix()).cwiseAbs().maxCoeff() < kRounding) continue;
    if (!do_links_meet(hand_, a, b, X_AB) || do_links_meet(hand_, a, b, before)) continue;
    blocking_link_ = is_b_moved ? b : a;
    return true;
  }
  return false;
}

void GuardedHand::accept() {
  configuration_ = trial_;
  X_OL_.swap(trial_X_OL_);
  distance_.swap(trial_distance_);
  surroundings_distance_.swap(trial_surroundings_distance_);
  const double near = options_.large_step_at * voxel_size_;
  const double enough = (options_.large_step_limit + 1.0) * voxel_size_;
  for (const int link : all_links_) {
    if (surroundings_distance_[link] <= near)
      surroundings_distance_[link] = distance_to_surroundings(link, enough);
  }
}

double GuardedHand::allowed_motion(const std::vector<int>& links) const {
  float d_min = std::numeric_limits<float>::infinity();
  double to_surroundings = kInfinity;
  for (const int link : links) {
    d_min = std::min(d_min, distance_[link]);
    to_surroundings = std::min(to_surroundings, surroundings_distance_[link]);
  }
  double voxels = options_.small_step;
  if (d_min >= options_.large_step_at) {
    voxels = std::clamp(d_min - 1.0, options_.small_step,
                        std::max(options_.small_step, options_.large_step_limit));
  } else if (d_min >= 1.0F) {
    // Not yet at the surface: half a voxel cannot pass the layer of partial ones.
    voxels = std::max(options_.small_step, kStepBeforeSurface);
  }
  // A motion shorter than the distance to the surroundings cannot meet them; close to them, small
  // steps are allowed and then tested.
  return std::min(voxels * voxel_size_,
                  std::max(to_surroundings, options_.small_step * voxel_size_));
}

float GuardedHand::smallest_distance() const {
  return *std::min_element(distance_.begin(), distance_.end());
}

}  // namespace graspfit::grasp::internal
