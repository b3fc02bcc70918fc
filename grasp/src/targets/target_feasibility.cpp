#include "targets/target_feasibility.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/contact/contact_quality.hpp"

namespace graspfit::grasp::internal {
namespace {

using base::InvalidInput;
using Eigen::Matrix3d;
using Eigen::Vector3d;

void check_parts(const PartDistances& distances, const RequestedParts& parts,
                 const TargetOptions& options) {
  const auto refuse = [](const std::string& what) {
    throw InvalidInput("target contacts: " + what);
  };
  const std::vector<int>& fingers = parts.fingers;
  const int num_fingers = base::as_index<int>(distances.tip_to_tip.size());
  if (fingers.size() < 2) {
    refuse(std::to_string(fingers.size()) + " fingers, a grasp needs at least two");
  }
  if (parts.size() > kMostParts) {
    refuse(std::to_string(parts.size()) + " parts, at most " + std::to_string(kMostParts) +
           " can have targets");
  }
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    const std::string name = "finger " + std::to_string(fingers[i]);
    if (fingers[i] < 0 || fingers[i] >= num_fingers) {
      refuse(name + " of a hand with " + std::to_string(num_fingers) + " fingers");
    }
    if (std::count(fingers.begin(), fingers.end(), fingers[i]) > 1) refuse(name + " named twice");
  }
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    const std::string name = "finger " + std::to_string(fingers[i]);
    const auto has_reach = [&](int other) {
      return distances.tip_to_tip[fingers[i]][other].largest > 0.0;
    };
    if (std::none_of(fingers.begin(), fingers.end(), has_reach)) {
      refuse(name + " reaches no distance from the others; has it a fingertip pad?");
    }
  }
  if (parts.palm && (!distances.palm || std::ssize(distances.palm_to_tip) != num_fingers)) {
    refuse("a target for the palm of a hand without a palm pad");
  }
  if (options.pair_rule == PairRule::AllPairs && fingers.size() >= 5 &&
      options.theta_max <= std::numbers::pi / 4) {
    refuse(
        std::to_string(fingers.size()) +
        " contacts cannot be pairwise stable with theta_max of 45 degrees or less on any object; "
        "ask for pairs with the seed");
  }
}

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

std::vector<PoolPoint> pool_of(const ObjectModel& object, const TargetOptions& options) {
  std::vector<PoolPoint> pool;
  const bool knows_weak = options.exclude_weak && !object.is_weak_patch.empty();
  for (std::int32_t p = 0; p < std::ssize(object.patches); ++p) {
    const geometry::SurfacePatch& patch = object.patches[p];
    if (!patch.has_normal || !(object.scores.scores[p] > options.score_threshold)) continue;
    if (knows_weak && object.is_weak_patch[p]) continue;
    pool.push_back({patch.centroid, -patch.outward_normal, p});
  }
  if (options.pool_spacing > 0.0) thin(pool, object, options.pool_spacing);
  return pool;
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

/// Turns of the hand at which, for some assignment, every target may be reached by its finger.
Turns turns_of_any(const std::vector<FingerOrder>& orders,
                   const std::array<std::array<Turns, kMostParts>, kMostParts>& reachable,
                   std::size_t num_targets) {
  Turns any;
  for (const FingerOrder& order : orders) {
    Turns all = reachable[0][0];
    for (std::size_t t = 1; t < num_targets; ++t) all &= reachable[t][order[t]];
    any |= all;
  }
  return any;
}

}  // namespace

TargetRules::TargetRules(const ObjectModel& object, const PartDistances& distances,
                         const RequestedParts& parts, const TargetOptions& options)
    : TargetRules(object, distances, parts, options, pool_of(object, options)) {}

TargetRules::TargetRules(const ObjectModel& object, const PartDistances& distances,
                         const RequestedParts& parts, const TargetOptions& options,
                         std::vector<PoolPoint> pool)
    : object_(object),
      distances_(distances),
      parts_(parts),
      options_(options),
      min_separation_(options.min_separation.value_or(0.0)),
      stable_pairs_(options.theta_max),
      pool_(std::move(pool)) {
  options.validate();
  check_parts(distances, parts, options);
  if (!parts.palm) return;
  palm_space_ = std::vector<std::atomic<PalmSpace>>(pool_.size());
  for (auto& known : palm_space_) known = PalmSpace::Unknown;
  palm_axes_.emplace(*distances.palm);
  for (const auto& tip : distances.palm->tips) {
    reachable_turns_.emplace_back();
    if (tip) reachable_turns_.back().emplace(*palm_axes_, *tip, options.palm_reach_tolerance);
  }
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = 2.0 * std::numbers::pi * turn / kTurns;
    turns_H_.push_back(
        Eigen::AngleAxisd(angle, distances.palm->direction_H.normalized()).toRotationMatrix());
  }
}

double TargetRules::angle_share(std::int32_t a, std::int32_t b) const {
  const PoolPoint& at_a = pool_[a];
  const PoolPoint& at_b = pool_[b];
  return contact::stable_pair_angle(at_a.point_O, at_a.inward_normal_O, at_b.point_O,
                                    at_b.inward_normal_O, options_.theta_max)
             .value_or(options_.theta_max) /
         options_.theta_max;
}

double TargetRules::num_stable_pairs(PairRule rule, std::size_t num_targets) {
  const auto n = static_cast<double>(num_targets);
  return rule == PairRule::Seed ? n - 1.0 : n * (n - 1.0) / 2.0;
}

bool TargetRules::reaches(int order_a, int order_b, double distance) const {
  const hands::DistanceRange& range =
      distances_.tip_to_tip[parts_.fingers[order_a]][parts_.fingers[order_b]];
  return distance >= range.smallest && distance <= range.largest;
}

bool TargetRules::is_in_seed_reach(double distance) const {
  for (int finger = 1; finger < std::ssize(parts_.fingers); ++finger) {
    if (reaches(0, finger, distance)) return true;
  }
  return false;
}

bool TargetRules::can_take(const FingerOrder& order, std::size_t size, int finger,
                           std::span<const double> distances) const {
  for (std::size_t k = 0; k < size; ++k) {
    if (order[k] == finger || !reaches(order[k], finger, distances[k])) return false;
  }
  return true;
}

std::vector<FingerOrder> TargetRules::extended(const std::vector<FingerOrder>& orders,
                                               std::span<const double> distances) const {
  const std::size_t size = distances.size();
  std::vector<FingerOrder> result;
  for (const FingerOrder& order : orders) {
    for (int finger = 1; finger < std::ssize(parts_.fingers); ++finger) {
      if (!can_take(order, size, finger, distances)) continue;
      result.push_back(order);
      result.back()[size] = static_cast<std::int8_t>(finger);
    }
  }
  return result;
}

bool TargetRules::is_extendable(const std::vector<FingerOrder>& orders,
                                std::span<const double> distances) const {
  for (const FingerOrder& order : orders) {
    for (int finger = 1; finger < std::ssize(parts_.fingers); ++finger) {
      if (can_take(order, distances.size(), finger, distances)) return true;
    }
  }
  return false;
}

double TargetRules::centroid_error(PointIndices points) const {
  const auto sorted = ascending(points);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) sum += pool_[sorted[k]].point_O;
  return (sum / static_cast<double>(points.size()) - center_of_mass_O()).norm() /
         normalizing_radius();
}

double TargetRules::edge_error(PointIndices fingers) const {
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

double TargetRules::rank(PointIndices points, std::optional<double> palm_misfit) const {
  const PointIndices fingers = points.first(num_fingers());
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

bool TargetRules::has_palm_space(std::int32_t palm) const {
  const PalmSpace known = palm_space_[palm].load(std::memory_order_relaxed);
  if (known != PalmSpace::Unknown) return known == PalmSpace::Free;
  const PoolPoint& point = pool_[palm];
  const double squared_radius = distances_.palm->pad_radius * distances_.palm->pad_radius;
  const bool is_free = std::none_of(
      object_.patches.begin(), object_.patches.end(), [&](const geometry::SurfacePatch& patch) {
        const Vector3d offset = patch.centroid - point.point_O;
        const double height = -offset.dot(point.inward_normal_O);
        return height > object_.grid.lattice.voxel_size &&
               offset.squaredNorm() - height * height < squared_radius;
      });
  // Whichever thread finds it finds the same.
  palm_space_[palm].store(is_free ? PalmSpace::Free : PalmSpace::Taken, std::memory_order_relaxed);
  return is_free;
}

std::optional<double> TargetRules::tip_misfit(PointIndices fingers,
                                              const std::vector<FingerOrder>& orders,
                                              const PoolPoint& palm) const {
  const PalmReach& reach = *distances_.palm;
  if (reach.tips.empty()) return 0.0;
  // From the palm to the targets, in H but for the turn about the palm's direction.
  const Matrix3d R_HO = Eigen::Quaterniond::FromTwoVectors(palm.inward_normal_O, reach.direction_H)
                            .toRotationMatrix();
  std::array<Vector3d, kMostParts> from_palm, pad_normal;
  std::array<std::array<Turns, kMostParts>, kMostParts> reachable;  // [target][finger]
  for (std::size_t t = 0; t < fingers.size(); ++t) {
    pad_normal[t] = R_HO * pool_[fingers[t]].inward_normal_O;
    from_palm[t] = R_HO * (pool_[fingers[t]].point_O - palm.point_O);
    const PointFromPalm point = palm_axes_->place(from_palm[t]);
    for (std::size_t f = 0; f < fingers.size(); ++f) {
      const auto& turns = reachable_turns_[parts_.fingers[f]];
      if (turns) reachable[t][f] = turns->at(point);
    }
  }
  const Turns worth_trying = turns_of_any(orders, reachable, fingers.size());
  std::optional<double> best;
  for (int k = 0; k < kTurns && worth_trying.any(); ++k) {
    if (!worth_trying[k]) continue;
    const Matrix3d& turn = turns_H_[k];
    const auto distance_to_reach = [&](std::size_t target, int finger) {
      if (!reachable[target][finger][k]) return std::numeric_limits<double>::infinity();
      return reach.tips[parts_.fingers[finger]]->distance(reach.center_H + turn * from_palm[target],
                                                          turn * pad_normal[target]);
    };
    const double of_seed = distance_to_reach(0, 0);
    bool is_reached = of_seed <= options_.palm_reach_tolerance;
    std::array<std::array<double, kMostParts>, kMostParts> off{};
    for (std::size_t t = 1; t < fingers.size() && is_reached; ++t) {
      is_reached = false;
      for (int f = 1; f < std::ssize(fingers); ++f) {
        off[t][f] = distance_to_reach(t, f);
        is_reached = is_reached || off[t][f] <= options_.palm_reach_tolerance;
      }
    }
    if (!is_reached) continue;
    for (const FingerOrder& order : orders) {
      double sum = of_seed;
      double largest = of_seed;
      for (std::size_t t = 1; t < fingers.size(); ++t) {
        sum += off[t][order[t]];
        largest = std::max(largest, off[t][order[t]]);
      }
      if (largest > options_.palm_reach_tolerance) continue;
      const double mean = sum / static_cast<double>(fingers.size());
      if (!best || mean < *best) best = mean;
    }
  }
  return best;
}

std::optional<double> TargetRules::palm_misfit(PointIndices fingers,
                                               const std::vector<FingerOrder>& orders,
                                               std::int32_t palm) const {
  const PoolPoint& point = pool_[palm];
  std::array<double, kMostParts> distances{};
  for (std::size_t t = 0; t < fingers.size(); ++t) {
    const Vector3d from_palm = pool_[fingers[t]].point_O - point.point_O;
    if (!(from_palm.dot(point.inward_normal_O) > 0.0)) return std::nullopt;
    distances[t] = from_palm.norm();
    if (is_too_near(distances[t])) return std::nullopt;
  }
  std::vector<FingerOrder> in_reach;
  for (const FingerOrder& order : orders) {
    bool is_in_reach = true;
    for (std::size_t t = 0; t < fingers.size() && is_in_reach; ++t) {
      const hands::DistanceRange& range = distances_.palm_to_tip[parts_.fingers[order[t]]];
      is_in_reach = distances[t] >= range.smallest && distances[t] <= range.largest;
    }
    if (is_in_reach) in_reach.push_back(order);
  }
  if (in_reach.empty()) return std::nullopt;
  const std::optional<double> misfit = tip_misfit(fingers, in_reach, point);
  if (!misfit || !has_palm_space(palm)) return std::nullopt;
  return *misfit / normalizing_radius();
}

TargetContacts TargetRules::as_targets(PointIndices points, std::optional<double> palm_misfit,
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
