#include "targets/target_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "graspfit/base/errors.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;

/// Keeps the point with the best score per cell and main direction of the normal; the order of the
/// points stays.
void thin(std::vector<PoolPoint>& pool, const ObjectModel& object, double spacing) {
  using Cell = std::tuple<double, double, double, int>;  // whole numbers, of any size
  std::map<Cell, std::size_t> best;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    const Eigen::Vector3d cell =
        ((pool[i].point_O - object.grid.lattice.origin) / spacing).array().floor();
    Eigen::Index axis = 0;
    pool[i].inward_normal_O.cwiseAbs().maxCoeff(&axis);
    const int side = 2 * static_cast<int>(axis) + (pool[i].inward_normal_O[axis] > 0.0 ? 1 : 0);
    const auto [entry, is_new] = best.try_emplace({cell[0], cell[1], cell[2], side}, i);
    const auto score = [&](std::size_t index) { return object.scores.scores[*pool[index].patch]; };
    if (!is_new && score(i) > score(entry->second)) entry->second = i;
  }
  std::vector<std::size_t> kept;
  for (const auto& [cell, index] : best) kept.push_back(index);
  std::sort(kept.begin(), kept.end());
  std::vector<PoolPoint> thinned;
  for (const std::size_t index : kept) thinned.push_back(pool[index]);
  pool = std::move(thinned);
}

[[noreturn]] void refuse(const std::string& what) {
  throw base::InvalidInput("target contacts: " + what);
}

void check_parts(const RequestedParts& parts, const TargetOptions& options) {
  const std::vector<int>& fingers = parts.fingers;
  if (fingers.size() < 2) {
    refuse(std::to_string(fingers.size()) + " fingers, a grasp needs at least two");
  }
  if (parts.size() > kMostParts) {
    refuse(std::to_string(parts.size()) + " parts, at most " + std::to_string(kMostParts) +
           " can have targets");
  }
  for (const int finger : fingers) {
    if (std::count(fingers.begin(), fingers.end(), finger) > 1) {
      refuse("finger " + std::to_string(finger) + " named twice");
    }
  }
  if (options.pair_rule == PairRule::AllPairs && fingers.size() >= 5 &&
      options.theta_max <= std::numbers::pi / 4) {
    refuse(
        std::to_string(fingers.size()) +
        " contacts cannot be pairwise stable with theta_max of 45 degrees or less on any object; "
        "ask for pairs with the seed");
  }
}

/// Indices in ascending order, so that sums over a set do not depend, to the bit, on its order.
std::array<std::int32_t, kMostParts> ascending(PointIndices points) {
  std::array<std::int32_t, kMostParts> sorted{};
  for (std::size_t size = 0; size < points.size(); ++size) {
    std::size_t at = size;
    for (; at > 0 && sorted[at - 1] > points[size]; --at) sorted[at] = sorted[at - 1];
    sorted[at] = points[size];
  }
  return sorted;
}

}  // namespace

std::vector<PoolPoint> pool_of(const ObjectModel& object, const TargetOptions& options) {
  return pool_of(object, surface_places(object, false), options);
}

std::vector<PoolPoint> pool_of(const ObjectModel& object, const std::vector<SurfacePlace>& places,
                               const TargetOptions& options) {
  std::vector<PoolPoint> pool;
  const bool knows_weak = options.exclude_weak && !object.is_weak_patch.empty();
  for (std::int32_t p = 0; p < std::ssize(places); ++p) {
    const SurfacePlace& place = places[p];
    const bool is_side = place.other_side >= 0;
    const bool is_high = is_side || object.scores.scores[place.patch] > options.score_threshold;
    if (!place.has_normal || !is_high) continue;
    if (knows_weak && object.is_weak_patch[place.patch]) continue;
    pool.push_back({place.point_O, -place.outward_normal_O, place.patch, p});
  }
  if (options.pool_spacing > 0.0) thin(pool, object, options.pool_spacing);
  return pool;
}

TargetPlaces::TargetPlaces(const ObjectModel& object, const RequestedParts& parts,
                           const TargetOptions& options, std::vector<PoolPoint> pool)
    : object_(object),
      parts_(parts),
      options_(options),
      min_separation_(options.min_separation.value_or(0.0)),
      stable_pairs_(options.theta_max),
      pool_(std::move(pool)) {
  options.validate();
  check_parts(parts, options);
}

double TargetPlaces::angle_share(std::int32_t a, std::int32_t b) const {
  const PoolPoint& at_a = pool_[a];
  const PoolPoint& at_b = pool_[b];
  return contact::stable_pair_angle(at_a.point_O, at_a.inward_normal_O, at_b.point_O,
                                    at_b.inward_normal_O, options_.theta_max)
             .value_or(options_.theta_max) /
         options_.theta_max;
}

double TargetPlaces::num_stable_pairs(PairRule rule, std::size_t num_targets) {
  const auto n = static_cast<double>(num_targets);
  return rule == PairRule::Seed ? n - 1.0 : n * (n - 1.0) / 2.0;
}

double TargetPlaces::centroid_error(PointIndices points) const {
  const auto sorted = ascending(points);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) sum += pool_[sorted[k]].point_O;
  return (sum / static_cast<double>(points.size()) - center_of_mass_O()).norm() /
         normalizing_radius();
}

double TargetPlaces::edge_error(PointIndices fingers) const {
  const std::size_t size = fingers.size();
  if (size < 3) return 0.0;
  const double first = distance(fingers[0], fingers[1]);
  const auto sorted = ascending(fingers);
  double sum = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = i + 1; j < size; ++j) {  // the first edge itself adds 0
      sum += std::abs(distance(sorted[i], sorted[j]) - first) / first;
    }
  }
  const auto n = static_cast<double>(size);
  return sum / (n * (n - 1.0) / 2.0 - 1.0);
}

double TargetPlaces::rank(PointIndices points, std::optional<double> palm_misfit) const {
  const PointIndices fingers = points.first(std::min(points.size(), num_fingers()));
  double rank = edge_error(fingers) + centroid_error(points) + palm_misfit.value_or(0.0);
  if (options_.angle_weight > 0.0) {
    double sum = 0.0;
    for (std::size_t i = 0; i < fingers.size(); ++i) {
      if (i > 0 && options_.pair_rule == PairRule::Seed) break;
      for (std::size_t j = i + 1; j < fingers.size(); ++j) {
        sum += angle_share(fingers[i], fingers[j]);
      }
    }
    rank += options_.angle_weight * sum / num_stable_pairs(options_.pair_rule, fingers.size());
  }
  return rank;
}

TargetContacts TargetPlaces::as_targets(PointIndices points, std::optional<double> palm_misfit,
                                        int seeds_tried) const {
  TargetContacts targets;
  targets.seeds_tried = seeds_tried;
  targets.rank = rank(points, palm_misfit);
  for (const std::int32_t index : points) {
    const PoolPoint& point = pool_[index];
    const double score = point.patch ? object_.scores.scores[*point.patch]
                                     : contact_score_at(object_, point.point_O).value_or(0.0);
    targets.contacts.push_back({point.point_O, -point.inward_normal_O, point.patch, score});
  }
  if (has_palm()) targets.contacts.back().is_palm = true;
  return targets;
}

}  // namespace graspfit::grasp::internal
