#include "targets/sample_targets.hpp"

#include <array>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"

namespace graspfit::grasp::internal {
namespace {

// More draws find sets around seeds that have few, and are made in vain around those that have
// none.
constexpr int kDrawsPerSeed = 100;

std::vector<PoolPoint> points_of(const std::vector<geometry::SurfaceSample>& samples) {
  std::vector<PoolPoint> points;
  for (const geometry::SurfaceSample& sample : samples) {
    points.push_back({sample.point, -sample.normal, std::nullopt});
  }
  return points;
}

/// Whether the fingers can have these points as their targets; `orders` gets the possible
/// assignments.
bool are_in_reach(const TargetRules& rules, PointIndices fingers,
                  std::vector<FingerOrder>& orders) {
  orders = TargetRules::seed_orders();
  std::array<double, kMostParts> distances{};
  for (std::size_t i = 1; i < fingers.size(); ++i) {
    if (!rules.is_stable_pair(fingers[0], fingers[i])) return false;
    for (std::size_t k = 0; k < i; ++k) distances[k] = rules.distance(fingers[k], fingers[i]);
    orders = rules.extended(orders, {distances.data(), i});
    if (orders.empty()) return false;
  }
  return true;
}

}  // namespace

SampleTargets::SampleTargets(const ObjectModel& object, const PartDistances& distances,
                             const RequestedParts& parts, const TargetOptions& options,
                             const std::vector<geometry::SurfaceSample>& samples)
    : rules_(object, distances, parts, options, points_of(samples)) {}

TargetSelection SampleTargets::select(base::Random& random) const {
  TargetSelection result;
  if (rules_.pool().empty()) return result;
  result.failure = TargetFailure::NoFurther;
  std::array<std::int32_t, kMostParts> drawn{};
  const std::size_t num_parts = rules_.num_fingers() + (rules_.has_palm() ? 1 : 0);
  std::vector<FingerOrder> orders;
  for (int seed = 0; seed < rules_.options().max_seeds; ++seed) {
    ++result.seeds_tried;
    for (int draw = 0; draw < kDrawsPerSeed; ++draw) {
      for (std::size_t i = 0; i < num_parts; ++i) {
        drawn[i] = base::as_index<std::int32_t>(random.index(rules_.pool().size()));
      }
      const PointIndices fingers(drawn.data(), rules_.num_fingers());
      if (!are_in_reach(rules_, fingers, orders)) continue;
      std::optional<double> palm_misfit;
      if (rules_.has_palm()) {
        palm_misfit = rules_.palm_misfit(fingers, orders, drawn[num_parts - 1]);
        if (!palm_misfit) continue;
      }
      result.targets =
          rules_.as_targets({drawn.data(), num_parts}, palm_misfit, result.seeds_tried);
      return result;
    }
  }
  return result;
}

}  // namespace graspfit::grasp::internal
