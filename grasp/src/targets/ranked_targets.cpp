#include "graspfit/grasp/ranked_targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "targets/target_feasibility.hpp"

namespace graspfit::grasp {

using internal::FingerOrder;
using internal::PointIndices;
using internal::TargetRules;

namespace {

// The stable pairs of more points could take a gigabyte.
constexpr std::size_t kMostPoints = 1 << 14;
// Sets kept per round.
constexpr std::size_t kMostKept = 1 << 12;
// By how much the first round's limit on the rank is above the best possible; rounds that find
// nothing or little double it, rounds that overflow halve it.
constexpr double kFirstStep = 0.02;

/// A complete set with its rank, by which sets are ordered.
struct RankedSet {
  double rank = -1.0;  ///< Before all sets.
  std::array<std::int32_t, kMostParts> points{};
  auto operator<=>(const RankedSet&) const = default;
};

}  // namespace

struct RankedTargets::Impl {
  Impl(const ObjectModel& object, const PartDistances& distances, const RequestedParts& parts,
       const TargetOptions& options)
      : rules(object, distances, parts, options), num_fingers(rules.num_fingers()) {
    if (rules.pool().size() > kMostPoints) {
      throw base::InvalidInput("RankedTargets: " + std::to_string(rules.pool().size()) +
                               " points, at most " + std::to_string(kMostPoints) +
                               " can be searched; set pool_spacing");
    }
    const auto n = static_cast<double>(num_fingers);
    num_rank_edges = std::max(1.0, n * (n - 1.0) / 2.0 - 1.0);
    find_partners();
  }

  std::optional<TargetContacts> next() {
    while (queue.empty() && !is_finished) search_round();
    if (queue.empty()) return std::nullopt;
    const RankedSet set = queue.back();
    queue.pop_back();
    const std::size_t size = num_fingers + (rules.has_palm() ? 1 : 0);
    const PointIndices points(set.points.data(), size);
    return rules.as_targets(points, misfit_of(points), 0);
  }

  /// Finds the stable pairs within reach: for each point its partners, by ascending distance.
  void find_partners() {
    const auto num_points = base::as_index<std::int32_t>(rules.pool().size());
    if (num_points > 0) failure = TargetFailure::NoSecond;
    partners.resize(num_points);
    for (std::int32_t a = 0; a < num_points; ++a) {
      for (std::int32_t b = a + 1; b < num_points; ++b) {
        if (!rules.is_stable_pair(a, b)) continue;
        const double distance = rules.distance(a, b);
        if (rules.is_too_near(distance) || !rules.is_in_seed_reach(distance)) continue;
        partners[a].push_back(b);
        partners[b].push_back(a);
        if (num_fingers > 2) failure = TargetFailure::NoFurther;
      }
    }
    for (std::int32_t a = 0; a < num_points; ++a) {
      std::sort(partners[a].begin(), partners[a].end(), [&](std::int32_t b, std::int32_t c) {
        const double to_b = rules.distance(a, b);
        const double to_c = rules.distance(a, c);
        return to_b != to_c ? to_b < to_c : b < c;
      });
    }
  }

  /// Finds the sets after `last` up to a limit on the rank, at most kMostKept of the best.
  void search_round() {
    const double first_limit = std::max(last.rank, 0.0) + step;
    limit = first_limit;
    is_cut = false;
    has_overflown = false;
    for (std::int32_t seed = 0; seed < std::ssize(rules.pool()); ++seed) {
      chosen[0] = seed;
      search_seconds(seed);
    }
    std::sort(queue.begin(), queue.end(), std::greater<>());
    if (has_overflown) {
      last = queue.front();
      step /= 2.0;
    } else {
      last.rank = first_limit;
      last.points.fill(std::numeric_limits<std::int32_t>::max());
      is_finished = !is_cut;
      if (queue.size() < kMostKept / 8) step *= 2.0;
    }
  }

  bool is_over_limit(double least_rank) {
    if (least_rank <= limit) return false;
    is_cut = true;
    return true;
  }

  void search_seconds(std::int32_t seed) {
    for (const std::int32_t second : partners[seed]) {
      chosen[1] = second;
      const double distance = rules.distance(seed, second);
      const double angles = pair_rank(1);
      if (is_over_limit(angles)) continue;
      const std::vector<FingerOrder> orders =
          rules.extended(TargetRules::seed_orders(), {&distance, 1});
      if (orders.empty()) continue;
      if (num_fingers == 2) {
        complete(orders);
      } else {
        search_thirds(orders, distance, angles);
      }
    }
  }

  /// What the pairs of target `k` with the earlier ones add to the rank.
  double pair_rank(std::size_t k) const {
    const TargetOptions& options = rules.options();
    if (!(options.angle_weight > 0.0)) return 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < k; ++i) {
      if (i > 0 && options.pair_rule == PairRule::Seed) break;
      sum += rules.angle_share(chosen[i], chosen[k]);
    }
    return options.angle_weight * sum /
           TargetRules::num_stable_pairs(options.pair_rule, num_fingers);
  }

  /// Searches through the third targets. A third target's distance from the seed must be close to
  /// the first edge and, if it is the last target, such that the centroid can be near the center of
  /// mass: this gives a range of the seed's sorted partners.
  void search_thirds(const std::vector<FingerOrder>& orders, double first_edge, double least_rank) {
    const double tolerance = rules.options().edge_tolerance_rel;
    const double allowed = (limit - least_rank) * num_rank_edges;
    if (allowed < tolerance) is_cut = true;
    const double error = std::min(tolerance, allowed) * first_edge;
    double from = first_edge - error;
    double to = first_edge + error;
    if (num_fingers == 3) {
      double off = rules.options().centroid_limit_rel;
      if (!rules.has_palm() && limit - least_rank < off) {
        is_cut = true;
        off = limit - least_rank;
      }
      const Eigen::Vector3d ideal = 3.0 * rules.center_of_mass_O() - point(0) - point(1);
      const double away = (ideal - point(0)).norm();
      from = std::max(from, away - 3.0 * off * rules.normalizing_radius());
      to = std::min(to, away + 3.0 * off * rules.normalizing_radius());
    }
    // Rounding must not exclude what the tests below would let pass.
    const double slack = 1e-9 * (first_edge + rules.normalizing_radius());
    const std::vector<std::int32_t>& list = partners[chosen[0]];
    auto third = std::lower_bound(list.begin(), list.end(), from - slack,
                                  [&](std::int32_t partner, double distance) {
                                    return rules.distance(chosen[0], partner) < distance;
                                  });
    for (; third != list.end(); ++third) {
      if (rules.distance(chosen[0], *third) > to + slack) break;
      if (*third == chosen[1]) continue;
      chosen[2] = *third;
      if (is_triangle_off(chosen[0], chosen[1], chosen[2])) continue;
      add(2, orders, least_rank);
    }
  }

  /// Whether the third's edges are too different from the first.
  bool is_triangle_off(std::int32_t seed, std::int32_t second, std::int32_t third) const {
    const double first_edge = rules.distance(seed, second);
    for (const std::int32_t other : {seed, second}) {
      const double error = std::abs(rules.distance(other, third) - first_edge) / first_edge;
      if (error > rules.options().edge_tolerance_rel) return true;
    }
    return false;
  }

  /// Continues the search with `chosen[k]`, a partner of the seed, if it is compatible with the
  /// targets before it.
  void add(std::size_t k, const std::vector<FingerOrder>& orders, double least_rank) {
    std::array<double, kMostParts> distances{};
    const double first_edge = rules.distance(chosen[0], chosen[1]);
    double error = 0.0;
    for (std::size_t i = 0; i < k; ++i) {
      distances[i] = rules.distance(chosen[i], chosen[k]);
      if (rules.is_too_near(distances[i])) return;
      error += std::abs(distances[i] - first_edge) / first_edge;
    }
    least_rank += error / num_rank_edges;
    if (is_over_limit(least_rank)) return;
    if (k + 1 == num_fingers && is_centroid_off(least_rank)) return;
    if (rules.options().pair_rule == PairRule::AllPairs) {
      for (std::size_t i = 1; i < k; ++i) {
        if (!rules.is_stable_pair(chosen[i], chosen[k])) return;
      }
    }
    least_rank += pair_rank(k);
    if (is_over_limit(least_rank)) return;
    const std::vector<FingerOrder> more = rules.extended(orders, {distances.data(), k});
    if (more.empty()) return;
    if (k + 1 == num_fingers) {
      complete(more);
      return;
    }
    // Targets after the third are taken in ascending order, so that each set of them comes once.
    for (const std::int32_t partner : partners[chosen[0]]) {
      if (partner == chosen[1] || partner == chosen[2] || (k >= 3 && partner <= chosen[k]))
        continue;
      chosen[k + 1] = partner;
      add(k + 1, more, least_rank);
    }
  }

  bool is_centroid_off(double least_rank) {
    const double off = rules.centroid_error(fingers());
    if (off > rules.options().centroid_limit_rel) return true;
    return !rules.has_palm() && is_over_limit(least_rank + off);
  }

  /// Whether no order of the same targets with the same seed comes before this one; orders are
  /// compared by rank, then by their points.
  bool is_best_order() const {
    if (num_fingers == 2) return true;
    const double error = rules.edge_error(fingers());
    std::array<std::int32_t, kMostParts> other = chosen;
    for (std::size_t second = 1; second < num_fingers; ++second) {
      for (std::size_t third = 1; third < num_fingers; ++third) {
        if (second == third) continue;
        if (is_triangle_off(chosen[0], chosen[second], chosen[third])) continue;
        other[1] = chosen[second];
        other[2] = chosen[third];
        std::size_t k = 3;
        for (std::size_t rest = 1; rest < num_fingers; ++rest) {
          if (rest != second && rest != third) other[k++] = chosen[rest];
        }
        const double other_error = rules.edge_error(PointIndices(other.data(), num_fingers));
        if (other_error < error) return false;
        if (other_error == error &&
            std::make_pair(other[1], other[2]) < std::make_pair(chosen[1], chosen[2])) {
          return false;
        }
      }
    }
    return true;
  }

  /// All fingers have targets.
  void complete(const std::vector<FingerOrder>& orders) {
    if (num_fingers == 2 && is_centroid_off(pair_rank(1))) return;
    if (!is_best_order()) return;
    if (!rules.has_palm()) {
      keep(fingers(), std::nullopt);
      return;
    }
    failure = TargetFailure::NoPalm;
    for (std::int32_t palm = 0; palm < std::ssize(rules.pool()); ++palm) {
      const std::optional<double> misfit = rules.palm_misfit(fingers(), orders, palm);
      if (!misfit) continue;
      chosen[num_fingers] = palm;
      keep(PointIndices(chosen.data(), num_fingers + 1), misfit);
    }
  }

  void keep(PointIndices points, std::optional<double> misfit) {
    RankedSet set;
    set.rank = rules.rank(points, misfit);
    if (is_over_limit(set.rank)) return;
    std::copy(points.begin(), points.end(), set.points.begin());
    if (set <= last) return;
    queue.push_back(set);
    std::push_heap(queue.begin(), queue.end());
    if (queue.size() <= kMostKept) return;
    std::pop_heap(queue.begin(), queue.end());
    queue.pop_back();
    has_overflown = true;
    limit = queue.front().rank;
  }

  /// Misfit of a set's palm, found again.
  std::optional<double> misfit_of(PointIndices points) {
    if (!rules.has_palm()) return std::nullopt;
    std::vector<FingerOrder> orders = TargetRules::seed_orders();
    std::array<double, kMostParts> distances{};
    for (std::size_t k = 1; k < num_fingers; ++k) {
      for (std::size_t i = 0; i < k; ++i) distances[i] = rules.distance(points[i], points[k]);
      orders = rules.extended(orders, {distances.data(), k});
    }
    return rules.palm_misfit(points.first(num_fingers), orders, points[num_fingers]);
  }

  const Eigen::Vector3d& point(std::size_t k) const { return rules.pool()[chosen[k]].point_O; }
  PointIndices fingers() const { return {chosen.data(), num_fingers}; }

  TargetRules rules;
  const std::size_t num_fingers;
  double num_rank_edges = 1.0;  ///< Edges that the rank is a mean over.
  std::vector<std::vector<std::int32_t>> partners;
  TargetFailure failure = TargetFailure::NoSeed;

  double step = kFirstStep;
  double limit = 0.0;  ///< Ranks beyond it are left for later rounds.
  RankedSet last;      ///< All sets up to this one have been found.
  bool is_cut = false;
  bool has_overflown = false;
  bool is_finished = false;
  std::array<std::int32_t, kMostParts> chosen{};
  /// Found and not yet given; the best last, a heap while searching.
  std::vector<RankedSet> queue;
};

RankedTargets::RankedTargets(const ObjectModel& object, const PartDistances& distances,
                             const RequestedParts& parts, const TargetOptions& options)
    : impl_(std::make_unique<Impl>(object, distances, parts, options)) {}
RankedTargets::~RankedTargets() = default;
RankedTargets::RankedTargets(RankedTargets&&) noexcept = default;

std::optional<TargetContacts> RankedTargets::next() { return impl_->next(); }

TargetFailure RankedTargets::failure() const { return impl_->failure; }

}  // namespace graspfit::grasp
