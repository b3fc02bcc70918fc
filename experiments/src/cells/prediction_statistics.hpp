#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

/// \file
/// How well a score predicts an outcome: ranks only, so that scores need no common scale.

namespace graspfit::experiments::internal {

/// Ranks from 1; equal values share the mean of theirs. Exact (multiples of ½).
std::vector<double> midranks(std::span<const double> values);

/// The value below which a share in [0, 1] of the values lies, linear between order statistics
/// (type 7 of [Hyndman & Fan 1996]). Empty without values.
std::optional<double> quantile(std::vector<double> values, double share);

/// Scores of some grasps and what became of them, in the same order.
struct ScoredOutcomes {
  std::vector<double> scores;
  std::vector<double> outcomes;  ///< For `auc`: above 0 is a success.
};

/// Probability that a success has a larger score than a failure, ties counted half: the area under
/// the receiver operating characteristic [Hanley & McNeil 1982]. Rounded once. Empty where all
/// scores are equal and where there are no successes or no failures: nothing can be told.
std::optional<double> auc(const ScoredOutcomes& sample);

/// The AUC over pairs within one cluster each: the wins of all clusters over the pairs of all
/// clusters.
std::optional<double> auc_within(std::span<const ScoredOutcomes> clusters);

/// Spearman's rank correlation: Pearson's of midranks. Empty where scores or outcomes are all
/// equal.
std::optional<double> spearman(const ScoredOutcomes& sample);

/// Mean of the clusters' correlations, weighted with their numbers of grasps less one; clusters
/// without a correlation are left out.
std::optional<double> spearman_within(std::span<const ScoredOutcomes> clusters);

struct ConfidenceInterval {
  double low = 0.0;
  double high = 0.0;
};

struct BootstrapOptions {
  int replicates = 1000;  ///< ≥ 1.
  double level = 0.95;    ///< In (0, 1).
  std::uint64_t seed = 1;
};

/// The percentile interval of a statistic of clusters drawn with replacement, as many as there are
/// [Efron & Tibshirani 1993]. Whole clusters are drawn because their members (grasps of one object)
/// are alike. `statistic` gets indices of clusters. Empty for fewer than two clusters, and where
/// more than half of the replicates have no value; the others are left out.
std::optional<ConfidenceInterval> bootstrap_interval(
    std::size_t num_clusters,
    const std::function<std::optional<double>(std::span<const std::size_t>)>& statistic,
    const BootstrapOptions& options = {});

enum class RankStatistic { Auc, Spearman };
enum class StatisticScope {
  All,            ///< All grasps together.
  WithinClusters  ///< Only grasps of one cluster are compared.
};

struct Estimate {
  std::optional<double> value;
  std::optional<ConfidenceInterval> interval;
};

/// A statistic of clusters with its bootstrap interval.
Estimate estimate(std::span<const ScoredOutcomes> clusters, RankStatistic statistic,
                  StatisticScope scope, const BootstrapOptions& options = {});

}  // namespace graspfit::experiments::internal
