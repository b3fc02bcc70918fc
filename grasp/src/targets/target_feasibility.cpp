#include "targets/target_feasibility.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void check_reach(const PartDistances& distances, const RequestedParts& parts) {
  const auto refuse = [](const std::string& what) {
    throw base::InvalidInput("target contacts: " + what);
  };
  const std::vector<int>& fingers = parts.fingers;
  const int num_fingers = base::as_index<int>(distances.tip_to_tip.size());
  for (const int finger : fingers) {
    if (finger < 0 || finger >= num_fingers) {
      refuse("finger " + std::to_string(finger) + " of a hand with " + std::to_string(num_fingers) +
             " fingers");
    }
  }
  for (const int finger : fingers) {
    const auto has_reach = [&](int other) {
      return distances.tip_to_tip[finger][other].largest > 0.0;
    };
    if (std::none_of(fingers.begin(), fingers.end(), has_reach)) {
      refuse("finger " + std::to_string(finger) +
             " reaches no distance from the others; has it a fingertip pad?");
    }
  }
  if (parts.palm && (!distances.palm || std::ssize(distances.palm_to_tip) != num_fingers)) {
    refuse("a target for the palm of a hand without a palm pad");
  }
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
    : TargetPlaces(object, parts, options, std::move(pool)), distances_(distances) {
  check_reach(distances, parts);
  if (!parts.palm) return;
  palm_space_ = std::vector<std::atomic<PalmSpace>>(this->pool().size());
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

bool TargetRules::reaches(int order_a, int order_b, double distance) const {
  const hands::DistanceRange& range =
      distances_.tip_to_tip[parts().fingers[order_a]][parts().fingers[order_b]];
  return distance >= range.smallest && distance <= range.largest;
}

bool TargetRules::is_in_seed_reach(double distance) const {
  for (int finger = 1; finger < std::ssize(parts().fingers); ++finger) {
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
    for (int finger = 1; finger < std::ssize(parts().fingers); ++finger) {
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
    for (int finger = 1; finger < std::ssize(parts().fingers); ++finger) {
      if (can_take(order, distances.size(), finger, distances)) return true;
    }
  }
  return false;
}

bool TargetRules::has_palm_space(std::int32_t palm) const {
  const PalmSpace known = palm_space_[palm].load(std::memory_order_relaxed);
  if (known != PalmSpace::Unknown) return known == PalmSpace::Free;
  const PoolPoint& point = pool()[palm];
  const double squared_radius = distances_.palm->pad_radius * distances_.palm->pad_radius;
  const bool is_free = std::none_of(
      object().patches.begin(), object().patches.end(), [&](const geometry::SurfacePatch& patch) {
        const Vector3d offset = patch.centroid - point.point_O;
        const double height = -offset.dot(point.inward_normal_O);
        return height > object().grid.lattice.voxel_size &&
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
    pad_normal[t] = R_HO * pool()[fingers[t]].inward_normal_O;
    from_palm[t] = R_HO * (pool()[fingers[t]].point_O - palm.point_O);
    const PointFromPalm point = palm_axes_->place(from_palm[t]);
    for (std::size_t f = 0; f < fingers.size(); ++f) {
      const auto& turns = reachable_turns_[parts().fingers[f]];
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
      return reach.tips[parts().fingers[finger]]->distance(
          reach.center_H + turn * from_palm[target], turn * pad_normal[target]);
    };
    const double of_seed = distance_to_reach(0, 0);
    bool is_reached = of_seed <= options().palm_reach_tolerance;
    std::array<std::array<double, kMostParts>, kMostParts> off{};
    for (std::size_t t = 1; t < fingers.size() && is_reached; ++t) {
      is_reached = false;
      for (int f = 1; f < std::ssize(fingers); ++f) {
        off[t][f] = distance_to_reach(t, f);
        is_reached = is_reached || off[t][f] <= options().palm_reach_tolerance;
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
      if (largest > options().palm_reach_tolerance) continue;
      const double mean = sum / static_cast<double>(fingers.size());
      if (!best || mean < *best) best = mean;
    }
  }
  return best;
}

std::optional<double> TargetRules::palm_misfit(PointIndices fingers,
                                               const std::vector<FingerOrder>& orders,
                                               std::int32_t palm) const {
  const PoolPoint& point = pool()[palm];
  std::array<double, kMostParts> distances{};
  for (std::size_t t = 0; t < fingers.size(); ++t) {
    const Vector3d from_palm = pool()[fingers[t]].point_O - point.point_O;
    if (!(from_palm.dot(point.inward_normal_O) > 0.0)) return std::nullopt;
    distances[t] = from_palm.norm();
    if (is_too_near(distances[t])) return std::nullopt;
  }
  std::vector<FingerOrder> in_reach;
  for (const FingerOrder& order : orders) {
    bool is_in_reach = true;
    for (std::size_t t = 0; t < fingers.size() && is_in_reach; ++t) {
      const hands::DistanceRange& range = distances_.palm_to_tip[parts().fingers[order[t]]];
      is_in_reach = distances[t] >= range.smallest && distances[t] <= range.largest;
    }
    if (is_in_reach) in_reach.push_back(order);
  }
  if (in_reach.empty()) return std::nullopt;
  const std::optional<double> misfit = tip_misfit(fingers, in_reach, point);
  if (!misfit || !has_palm_space(palm)) return std::nullopt;
  return *misfit / normalizing_radius();
}

}  // namespace graspfit::grasp::internal
