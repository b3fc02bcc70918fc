#include "cells/prediction_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "graspfit/base/random.hpp"

namespace graspfit::experiments::internal {
namespace {

/// Pairs of a success and a failure, and in how many of them the success has the larger score.
struct Concordance {
  double wins = 0.0;  ///< A multiple of ½: ties count half.
  double pairs = 0.0;
  bool has_different_scores = false;
};

bool are_different(std::span<const double> values) {
  return std::any_of(values.begin(), values.end(), [&](double v) { return v != values.front(); });
}

/// Counts the pairs by the rank sum of the successes [Mann & Whitney 1947].
Concordance concordance(const ScoredOutcomes& sample) {
  const std::vector<double> ranks = midranks(sample.scores);
  double successes = 0.0;
  double rank_sum = 0.0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (!(sample.outcomes[i] > 0.0)) continue;
    successes += 1.0;
    rank_sum += ranks[i];
  }
  const double failures = static_cast<double>(ranks.size()) - successes;
  return {rank_sum - successes * (successes + 1.0) / 2.0, successes * failures,
          are_different(sample.scores)};
}

std::optional<double> auc_of(std::span<const Concordance> parts) {
  Concordance sum;
  for (const Concordance& part : parts) {
    if (part.pairs == 0.0) continue;
    sum.wins += part.wins;
    sum.pairs += part.pairs;
    sum.has_different_scores = sum.has_different_scores || part.has_different_scores;
  }
  if (sum.pairs == 0.0 || !sum.has_different_scores) return std::nullopt;
  return sum.wins / sum.pairs;
}

/// A cluster's correlation and its weight, 0 where it has none.
struct WeightedCorrelation {
  double correlation = 0.0;
  double weight = 0.0;
};

WeightedCorrelation weighted_correlation(const ScoredOutcomes& cluster) {
  const std::optional<double> correlation = spearman(cluster);
  if (!correlation) return {};
  return {*correlation, static_cast<double>(cluster.scores.size()) - 1.0};
}

std::optional<double> mean_of(std::span<const WeightedCorrelation> parts) {
  double sum = 0.0;
  double weight = 0.0;
  for (const WeightedCorrelation& part : parts) {
    sum += part.weight * part.correlation;
    weight += part.weight;
  }
  if (weight == 0.0) return std::nullopt;
  return sum / weight;
}

/// `part` of every cluster, in order.
template <class Part>
auto parts_of(std::span<const ScoredOutcomes> clusters, const Part& part) {
  std::vector<decltype(part(clusters.front()))> parts;
  for (const ScoredOutcomes& cluster : clusters) parts.push_back(part(cluster));
  return parts;
}

ScoredOutcomes together(std::span<const ScoredOutcomes> clusters,
                        std::span<const std::size_t> drawn) {
  ScoredOutcomes all;
  for (const std::size_t c : drawn) {
    const ScoredOutcomes& cluster = clusters[c];
    all.scores.insert(all.scores.end(), cluster.scores.begin(), cluster.scores.end());
    all.outcomes.insert(all.outcomes.end(), cluster.outcomes.begin(), cluster.outcomes.end());
  }
  return all;
}

/// Computes a statistic of the clusters as they are, and its interval from draws of them.
template <class Statistic>
Estimate estimate_by(std::size_t num_clusters, const Statistic& statistic,
                     const BootstrapOptions& options) {
  std::vector<std::size_t> each(num_clusters);
  std::iota(each.begin(), each.end(), std::size_t{0});
  const std::optional<double> value = statistic(std::span<const std::size_t>(each));
  if (!value) return {};
  return {value, bootstrap_interval(num_clusters, statistic, options)};
}

/// As `estimate_by`, where a cluster's part of the statistic does not depend on the others.
template <class Part, class Combine>
Estimate estimate_by_parts(const std::vector<Part>& parts, const Combine& combine,
                           const BootstrapOptions& options) {
  std::vector<Part> chosen(parts.size());
  const auto statistic = [&](std::span<const std::size_t> drawn) {
    for (std::size_t i = 0; i < drawn.size(); ++i) chosen[i] = parts[drawn[i]];
    return combine(std::span<const Part>(chosen));
  };
  return estimate_by(parts.size(), statistic, options);
}

}  // namespace

std::vector<double> midranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double rank = static_cast<double>(begin + 1 + end) / 2.0;
    for (; begin < end; ++begin) ranks[order[begin]] = rank;
  }
  return ranks;
}

std::optional<double> quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], position - static_cast<double>(below));
}

std::optional<double> auc(const ScoredOutcomes& sample) {
  const Concordance all = concordance(sample);
  return auc_of({&all, 1});
}

std::optional<double> auc_within(std::span<const ScoredOutcomes> clusters) {
  return auc_of(parts_of(clusters, concordance));
}

std::optional<double> spearman(const ScoredOutcomes& sample) {
  if (!are_different(sample.scores) || !are_different(sample.outcomes)) return std::nullopt;
  const std::vector<double> x = midranks(sample.scores);
  const std::vector<double> y = midranks(sample.outcomes);
  const double mean = (static_cast<double>(x.size()) + 1.0) / 2.0;
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
    xy += (x[i] - mean) * (y[i] - mean);
  }
  return xy / std::sqrt(xx * yy);
}

std::optional<double> spearman_within(std::span<const ScoredOutcomes> clusters) {
  return mean_of(parts_of(clusters, weighted_correlation));
}

std::optional<ConfidenceInterval> bootstrap_interval(
    std::size_t num_clusters,
    const std::function<std::optional<double>(std::span<const std::size_t>)>& statistic,
    const BootstrapOptions& options) {
  if (num_clusters < 2) return std::nullopt;
  std::vector<double> values;
  std::vector<std::size_t> drawn(num_clusters);
  for (int replicate = 0; replicate < options.replicates; ++replicate) {
    base::Random random = base::Random::stream(options.seed, static_cast<std::uint64_t>(replicate));
    for (std::size_t& cluster : drawn) cluster = random.index(num_clusters);
    if (const std::optional<double> value = statistic(drawn)) values.push_back(*value);
  }
  if (2 * values.size() < static_cast<std::size_t>(options.replicates)) return std::nullopt;
  const double tail = (1.0 - options.level) / 2.0;
  return ConfidenceInterval{*quantile(values, tail), *quantile(values, 1.0 - tail)};
}

Estimate estimate(std::span<const ScoredOutcomes> clusters, RankStatistic statistic,
                  StatisticScope scope, const BootstrapOptions& options) {
  if (scope == StatisticScope::WithinClusters) {
    return statistic == RankStatistic::Auc
               ? estimate_by_parts(parts_of(clusters, concordance), auc_of, options)
               : estimate_by_parts(parts_of(clusters, weighted_correlation), mean_of, options);
  }
  const auto of_all = [&](std::span<const std::size_t> drawn) {
    const ScoredOutcomes all = together(clusters, drawn);
    return statistic == RankStatistic::Auc ? auc(all) : spearman(all);
  };
  return estimate_by(clusters.size(), of_all, options);
}

}  // namespace graspfit::experiments::internal
