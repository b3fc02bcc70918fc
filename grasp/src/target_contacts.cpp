#include "graspfit/grasp/target_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/grasp/contact_quality.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;
using geometry::InvalidInput;
using geometry::shortest_decimal;

constexpr double kPi = 3.14159265358979323846;

void require(bool holds, const std::string& field, const std::string& value,
             const std::string& range) {
  if (!holds) throw InvalidInput("TargetOptions: " + field + " = " + value + ", must be " + range);
}

/// The search of one target set: all state of the paper's section 6.
class Selection {
 public:
  Selection(const ObjectModel& object, const hands::TipDistances& distances,
            const std::vector<int>& fingers, const TargetOptions& options, geometry::Random& random)
      : object_(object),
        distances_(distances),
        fingers_(fingers),
        options_(options),
        random_(random) {
    for (std::size_t p = 0; p < object.patches.size(); ++p) {
      if (object.patches[p].has_normal && object.scores.scores[p] > options.score_threshold) {
        pool_.push_back(static_cast<std::int32_t>(p));
      }
    }
  }

  TargetSelection run() {
    TargetSelection result;
    if (pool_.empty()) return result;
    result.failure = TargetFailure::NoSecond;
    for (int tried = 0; tried < options_.max_seeds; ++tried) {
      relaxation_ = tried >= options_.relax_after_seeds ? 1.5 : 1.0;
      result.seeds_tried = tried + 1;
      chosen_.assign(1, pool_[random_.index(pool_.size())]);
      while (chosen_.size() < fingers_.size()) {
        const std::optional<std::int32_t> next = draw_next();
        if (!next) break;
        chosen_.push_back(*next);
      }
      if (chosen_.size() == fingers_.size()) {
        result.targets = as_targets(result.seeds_tried);
        return result;
      }
      if (chosen_.size() > 1) result.failure = TargetFailure::NoFurther;
    }
    return result;
  }

 private:
  struct Candidate {
    double rank;
    std::int32_t patch;
  };

  const Vector3d& point(std::int32_t patch) const { return object_.patches[patch].centroid; }
  Vector3d inward(std::int32_t patch) const { return -object_.patches[patch].outward_normal; }

  /// Whether some pair of fingers, not yet ruled out, reaches `distance` between target `earlier`
  /// and the next one. The seed's finger is known; the others are assigned later.
  bool in_reach(double distance, std::size_t earlier) const {
    const std::size_t first_a = earlier == 0 ? 0 : 1;
    const std::size_t last_a = earlier == 0 ? 1 : fingers_.size();
    for (std::size_t a = first_a; a < last_a; ++a) {
      for (std::size_t b = 1; b < fingers_.size(); ++b) {
        if (a == b) continue;
        const hands::DistanceRange& range = distances_[fingers_[a]][fingers_[b]];
        if (distance >= range.smallest && distance <= range.largest) return true;
      }
    }
    return false;
  }

  bool is_stable_with(std::int32_t patch, std::int32_t other) const {
    return stable_pair_angle(point(other), inward(other), point(patch), inward(patch),
                             options_.theta_max)
        .has_value();
  }

  /// Rank of `patch` as the next target, smaller is better; empty if it breaks a requirement.
  std::optional<double> rank(std::int32_t patch) const {
    const double first_edge =
        chosen_.size() >= 2 ? (point(chosen_[1]) - point(chosen_[0])).norm() : 0.0;
    double edge_error = 0.0;
    Vector3d sum = point(patch);
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      const double distance = (point(patch) - point(chosen_[k])).norm();
      if (distance < options_.min_separation || !in_reach(distance, k)) return std::nullopt;
      if (chosen_.size() >= 2) {
        const double error = std::abs(distance - first_edge) / first_edge;
        // The hard cut is for the triangle; with more targets not all edges can agree (A19).
        if (chosen_.size() == 2 && error > options_.edge_tolerance_rel * relaxation_) {
          return std::nullopt;
        }
        edge_error += error / static_cast<double>(chosen_.size());
      }
      sum += point(chosen_[k]);
    }
    const std::size_t size = chosen_.size() + 1;
    double centroid_error = 0.0;
    if (size == fingers_.size()) {
      centroid_error = (sum / static_cast<double>(size) - object_.mass.center_of_mass).norm() /
                       object_.normalizing_radius;
      if (centroid_error > options_.centroid_limit_rel * relaxation_) return std::nullopt;
    }
    if (!is_stable_with(patch, chosen_[0])) return std::nullopt;
    if (options_.pair_rule == PairRule::AllPairs) {
      for (std::size_t k = 1; k < chosen_.size(); ++k) {
        if (!is_stable_with(patch, chosen_[k])) return std::nullopt;
      }
    }
    return edge_error + centroid_error;
  }

  /// One of the best-ranked candidates for the next target. The second of three or more has nothing
  /// to be ranked by yet and is drawn from all.
  std::optional<std::int32_t> draw_next() {
    candidates_.clear();
    for (const std::int32_t patch : pool_) {
      if (const std::optional<double> value = rank(patch)) candidates_.push_back({*value, patch});
    }
    if (candidates_.empty()) return std::nullopt;
    const bool is_ranked = chosen_.size() >= 2 || fingers_.size() == 2;
    std::size_t size = candidates_.size();
    if (is_ranked) {
      const auto share =
          static_cast<std::size_t>(std::ceil(options_.pool_fraction * static_cast<double>(size)));
      size = std::min(size, std::max<std::size_t>(share, options_.pool_minimum));
      std::partial_sort(candidates_.begin(),
                        candidates_.begin() + static_cast<std::ptrdiff_t>(size), candidates_.end(),
                        [](const Candidate& a, const Candidate& b) {
                          return a.rank != b.rank ? a.rank < b.rank : a.patch < b.patch;
                        });
    }
    return candidates_[random_.index(size)].patch;
  }

  TargetContacts as_targets(int seeds_tried) const {
    TargetContacts targets;
    targets.seeds_tried = seeds_tried;
    for (const std::int32_t patch : chosen_) {
      targets.contacts.push_back({point(patch), object_.patches[patch].outward_normal, patch,
                                  object_.scores.scores[patch], kUnassigned});
    }
    return targets;
  }

  const ObjectModel& object_;
  const hands::TipDistances& distances_;
  const std::vector<int>& fingers_;
  const TargetOptions& options_;
  geometry::Random& random_;
  std::vector<std::int32_t> pool_;    ///< Patches above the threshold.
  std::vector<std::int32_t> chosen_;  ///< The set so far, seed first.
  std::vector<Candidate> candidates_;
  double relaxation_ = 1.0;
};

}  // namespace

void TargetOptions::validate() const {
  require(score_threshold >= 0.0 && score_threshold < 1.0, "score_threshold",
          shortest_decimal(score_threshold), "in [0, 1)");
  require(theta_max > 0.0 && theta_max < kPi / 2, "theta_max", shortest_decimal(theta_max),
          "in (0, pi/2) rad");
  require(edge_tolerance_rel >= 0.0 && std::isfinite(edge_tolerance_rel), "edge_tolerance_rel",
          shortest_decimal(edge_tolerance_rel), "finite and >= 0");
  require(centroid_limit_rel >= 0.0 && std::isfinite(centroid_limit_rel), "centroid_limit_rel",
          shortest_decimal(centroid_limit_rel), "finite and >= 0");
  require(pool_fraction > 0.0 && pool_fraction <= 1.0, "pool_fraction",
          shortest_decimal(pool_fraction), "in (0, 1]");
  require(pool_minimum >= 1, "pool_minimum", std::to_string(pool_minimum), ">= 1");
  require(max_seeds >= 1, "max_seeds", std::to_string(max_seeds), ">= 1");
  require(relax_after_seeds >= 0, "relax_after_seeds", std::to_string(relax_after_seeds), ">= 0");
  require(min_separation >= 0.0 && std::isfinite(min_separation), "min_separation",
          shortest_decimal(min_separation), "finite and >= 0 m");
}

Vector3d TargetContacts::centroid() const {
  Vector3d sum = Vector3d::Zero();
  for (const TargetContact& contact : contacts) sum += contact.point_O;
  return contacts.empty() ? sum : Vector3d(sum / static_cast<double>(contacts.size()));
}

PartDistances part_distances(const hands::HandModel& hand) {
  return {hands::tip_distances(hand), {}};
}

TargetSelection select_target_contacts(const ObjectModel& object,
                                       const PartDistances& part_distances,
                                       const RequestedParts& parts, const TargetOptions& options,
                                       geometry::Random& random) {
  const hands::TipDistances& distances = part_distances.tip_to_tip;
  const std::vector<int>& fingers = parts.fingers;
  options.validate();
  if (fingers.size() < 2) {
    throw InvalidInput("select_target_contacts: " + std::to_string(fingers.size()) +
                       " fingers, a grasp needs at least two");
  }
  return Selection(object, distances, fingers, options, random).run();
}

}  // namespace graspfit::grasp
