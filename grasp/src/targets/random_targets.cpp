#include "graspfit/grasp/random_targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "targets/target_feasibility.hpp"

namespace graspfit::grasp {
namespace {

using internal::FingerOrder;
using internal::TargetRules;

/// The search of one target set: all state of the paper's section 6.
class GreedySearch {
 public:
  GreedySearch(const ObjectModel& object, const TargetRules& rules, const IdealMeasure& ideal,
               base::Random& random)
      : object_(object), rules_(rules), ideal_(ideal), options_(rules.options()), random_(random) {}

  TargetSelection run() {
    TargetSelection result;
    if (rules_.pool().empty()) return result;
    result.failure = TargetFailure::NoSecond;
    const int wanted = options_.ideal_m_bias > 0.0 ? options_.ideal_m_draws : 1;
    std::vector<TargetContacts> complete;
    while (result.seeds_tried < options_.max_seeds && std::ssize(complete) < wanted) {
      // Seeds that led to a set have not failed.
      const int failed = result.seeds_tried - base::as_index<int>(complete.size());
      relaxation_ = failed >= options_.relax_after_seeds ? 1.5 : 1.0;
      ++result.seeds_tried;
      const TargetFailure reached = try_seed();
      result.failure = std::max(result.failure, reached);
      if (!is_complete_) continue;
      complete.push_back(rules_.as_targets(chosen_, palm_misfit_, result.seeds_tried));
    }
    if (!complete.empty()) {
      result.targets = std::move(complete[draw_by_ideal_m(complete)]);
      result.targets->seeds_tried = result.seeds_tried;
    }
    return result;
  }

 private:
  struct Candidate {
    double rank;
    std::int32_t point;
  };

  /// Tries to complete a set from a random seed; returns the stage at which this failed.
  TargetFailure try_seed() {
    is_complete_ = false;
    palm_misfit_.reset();
    chosen_.assign(1, base::as_index<std::int32_t>(random_.index(rules_.pool().size())));
    orders_ = TargetRules::seed_orders();
    find_partners();
    while (chosen_.size() < rules_.num_fingers()) {
      if (!draw_finger()) {
        return chosen_.size() == 1 ? TargetFailure::NoSecond : TargetFailure::NoFurther;
      }
    }
    is_complete_ = !rules_.has_palm() || draw_palm();
    return TargetFailure::NoPalm;
  }

  /// Finds the points that form a stable pair with the seed, as every further target must.
  void find_partners() {
    partners_.clear();
    for (std::int32_t point = 0; point < std::ssize(rules_.pool()); ++point) {
      if (point != chosen_[0] && rules_.is_stable_pair(chosen_[0], point)) {
        partners_.push_back(point);
      }
    }
  }

  /// Distances from the targets chosen to `point`.
  std::span<const double> distances_to(std::int32_t point) {
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      distances_[k] = rules_.distance(chosen_[k], point);
    }
    return {distances_.data(), chosen_.size()};
  }

  /// Rank of `point` as the next finger's target, smaller is better; empty if it breaks a
  /// requirement.
  std::optional<double> rank(std::int32_t point) {
    const std::span<const double> distances = distances_to(point);
    const double first_edge =
        chosen_.size() >= 2 ? rules_.distance(chosen_[0], chosen_[1]) : distances[0];
    double edge_error = 0.0;
    for (const double distance : distances) {
      if (rules_.is_too_near(distance)) return std::nullopt;
      const double error = std::abs(distance - first_edge) / first_edge;
      // The hard cut is for the triangle; with more targets not all edges can agree.
      if (chosen_.size() == 2 && error > options_.edge_tolerance_rel * relaxation_) {
        return std::nullopt;
      }
      edge_error += error / static_cast<double>(distances.size());
    }
    double centroid_error = 0.0;
    if (chosen_.size() + 1 == rules_.num_fingers()) {
      chosen_.push_back(point);
      centroid_error = rules_.centroid_error(chosen_);
      chosen_.pop_back();
      if (centroid_error > options_.centroid_limit_rel * relaxation_) return std::nullopt;
    }
    double angle_sum = 0.0;
    double num_angles = 0.0;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      if (k > 0 && options_.pair_rule == PairRule::Seed) break;
      if (k > 0 && !rules_.is_stable_pair(chosen_[k], point)) return std::nullopt;
      if (options_.angle_weight > 0.0) angle_sum += rules_.angle_share(chosen_[k], point);
      num_angles += 1.0;
    }
    if (!rules_.is_extendable(orders_, distances)) return std::nullopt;
    return edge_error + centroid_error + options_.angle_weight * angle_sum / num_angles;
  }

  bool draw_finger() {
    candidates_.clear();
    for (const std::int32_t point : partners_) {
      if (const std::optional<double> value = rank(point)) candidates_.push_back({*value, point});
    }
    if (candidates_.empty()) return false;
    // The second of three or more has nothing but its angle to be ranked by.
    const bool is_ranked =
        chosen_.size() >= 2 || rules_.num_fingers() == 2 || options_.angle_weight > 0.0;
    const std::int32_t point = candidates_[draw_candidate(is_ranked)].point;
    orders_ = rules_.extended(orders_, distances_to(point));
    chosen_.push_back(point);
    return true;
  }

  bool draw_palm() {
    candidates_.clear();
    std::vector<double> misfits;
    std::vector<std::int32_t> with_palm = chosen_;
    with_palm.push_back(0);
    for (std::int32_t point = 0; point < std::ssize(rules_.pool()); ++point) {
      const std::optional<double> misfit = rules_.palm_misfit(chosen_, orders_, point);
      if (!misfit) continue;
      with_palm.back() = point;
      candidates_.push_back({rules_.centroid_error(with_palm) + *misfit, point});
    }
    if (candidates_.empty()) return false;
    const std::int32_t palm = candidates_[draw_candidate(true)].point;
    palm_misfit_ = rules_.palm_misfit(chosen_, orders_, palm);
    chosen_.push_back(palm);
    return true;
  }

  /// Index of a candidate: of one of the best if they are ranked, else of any.
  std::size_t draw_candidate(bool is_ranked) {
    std::size_t size = candidates_.size();
    if (is_ranked) {
      const auto share =
          static_cast<std::size_t>(std::ceil(options_.pool_fraction * static_cast<double>(size)));
      size = std::min(size, std::max<std::size_t>(share, options_.pool_minimum));
      std::partial_sort(candidates_.begin(), candidates_.begin() + size, candidates_.end(),
                        [](const Candidate& a, const Candidate& b) {
                          return a.rank != b.rank ? a.rank < b.rank : a.point < b.point;
                        });
    }
    return random_.index(size);
  }

  /// Index of a complete set, drawn with probability ∝ ideal M^bias; the first where M plays no
  /// part.
  std::size_t draw_by_ideal_m(const std::vector<TargetContacts>& complete) {
    if (!(options_.ideal_m_bias > 0.0)) return 0;
    std::vector<double> weights;
    double largest = 0.0;
    for (const TargetContacts& targets : complete) {
      weights.push_back(ideal_m(object_, targets, ideal_, rules_.fingers()));
      largest = std::max(largest, weights.back());
    }
    if (!(largest > 0.0)) return random_.index(complete.size());
    double sum = 0.0;
    for (double& weight : weights) {
      weight = std::pow(weight / largest, options_.ideal_m_bias);
      sum += weight;
    }
    double left = random_.uniform() * sum;
    std::size_t drawn = 0;
    while (drawn + 1 < weights.size() && left >= weights[drawn]) left -= weights[drawn++];
    return drawn;
  }

  const ObjectModel& object_;
  const TargetRules& rules_;
  const IdealMeasure& ideal_;
  const TargetOptions& options_;
  base::Random& random_;
  std::vector<std::int32_t> chosen_;    ///< The set so far, seed first.
  std::vector<std::int32_t> partners_;  ///< Indices of those that form a stable pair with the seed.
  std::vector<FingerOrder> orders_;     ///< Ways to give the set so far to fingers.
  std::vector<Candidate> candidates_;
  std::array<double, kMostParts> distances_{};
  std::optional<double> palm_misfit_;
  bool is_complete_ = false;
  double relaxation_ = 1.0;
};

}  // namespace

struct TargetSelector::Impl {
  const ObjectModel& object;
  const TargetRules rules;
  const IdealMeasure ideal;
};

TargetSelector::TargetSelector(const ObjectModel& object, const PartDistances& distances,
                               const RequestedParts& parts, const TargetOptions& options,
                               const IdealMeasure& ideal)
    : impl_(new Impl{object, TargetRules(object, distances, parts, options), ideal}) {}
TargetSelector::~TargetSelector() = default;
TargetSelector::TargetSelector(TargetSelector&&) noexcept = default;

TargetSelection TargetSelector::select(base::Random& random) const {
  return GreedySearch(impl_->object, impl_->rules, impl_->ideal, random).run();
}

}  // namespace graspfit::grasp
