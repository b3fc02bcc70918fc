#include <cmath>
#include <numeric>

#include "cells/prediction_statistics.hpp"
#include "graspfit/base/random.hpp"
#include "support/catch.hpp"

namespace test_prediction_statistics {

using namespace graspfit::experiments::internal;
using graspfit::base::Random;

namespace {

/// Ten grasps with ties; the expected values below are those of SciPy 1.10.
const ScoredOutcomes kTied = {{0.3, 0.1, 0.3, 0.9, 0.5, 0.5, 0.5, 0.2, 0.7, 0.4},
                              {1, 0, 0, 1, 1, 0, 1, 0, 0, 1}};

double auc_by_pairs(const ScoredOutcomes& sample) {
  double wins = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 0; i < sample.scores.size(); ++i) {
    for (std::size_t j = 0; j < sample.scores.size(); ++j) {
      if (sample.outcomes[i] == 0.0 || sample.outcomes[j] != 0.0) continue;
      pairs += 1.0;
      if (sample.scores[i] > sample.scores[j]) wins += 1.0;
      if (sample.scores[i] == sample.scores[j]) wins += 0.5;
    }
  }
  return wins / pairs;
}

}  // namespace

TEST_CASE("Equal values share the mean of their ranks", "[experiments][prediction_statistics]") {
  CHECK(midranks(kTied.scores) ==
        // These are the ranks of scipy.stats.rankdata.
        std::vector<double>{3.5, 1, 3.5, 10, 7, 7, 7, 2, 9, 5});
  CHECK(midranks({}).empty());
}

TEST_CASE("Quantiles are linear between order statistics", "[experiments][prediction_statistics]") {
  const std::vector<double> values = {3, 1, 1, 9, 4, 4, 2, 2, 8, 3};
  for (const auto& [share, expected] : std::vector<std::pair<double, double>>{
           {0, 1}, {0.025, 1}, {0.25, 2}, {0.5, 3}, {0.75, 4}, {1, 9}}) {
    CHECK(quantile(values, share) == expected);  // These are the values of numpy.quantile.
  }
  CHECK(*quantile({1, 2, 4}, 0.4) == Approx(1.8));
  CHECK(quantile({7}, 0.9) == 7.0);
  CHECK_FALSE(quantile({}, 0.5));
}

TEST_CASE("The area under the ROC curve is the share of pairs in order, ties half",
          "[experiments][prediction_statistics]") {
  CHECK(auc({{1, 2, 3, 4}, {0, 0, 1, 1}}) == 1.0);
  CHECK(auc({{4, 3, 2, 1}, {0, 0, 1, 1}}) == 0.0);
  CHECK(auc({{1, 2, 1, 2}, {0, 0, 1, 1}}) == 0.5);
  // The value is that of scipy.stats.mannwhitneyu over the number of pairs.
  CHECK(*auc(kTied) == Approx(0.7));
  Random random(1);
  for (int sample = 0; sample < 20; ++sample) {
    ScoredOutcomes drawn;
    for (int i = 0; i < 30; ++i) {
      drawn.scores.push_back(static_cast<double>(random.index(8)));
      drawn.outcomes.push_back(static_cast<double>(random.index(2)));
    }
    CHECK(*auc(drawn) == Approx(auc_by_pairs(drawn)));
  }
}

TEST_CASE("Rank correlation is Spearman's", "[experiments][prediction_statistics]") {
  CHECK(*spearman({{1, 2, 3, 4}, {1, 8, 27, 64}}) == Approx(1.0));
  CHECK(*spearman({{1, 2, 3, 4}, {4, 3, 2, -9}}) == Approx(-1.0));
  // Without ties it is 1 - 6 sum d^2 / (n (n^2 - 1)); here d = 1, 1, 2, 1, 1.
  CHECK(*spearman({{1, 2, 3, 4, 5}, {2, 1, 5, 3, 4}}) == Approx(1.0 - 6.0 * 8.0 / 120.0));
  CHECK(*spearman({kTied.scores, {3, 1, 1, 9, 4, 4, 2, 2, 8, 3}}) ==
        Approx(0.8535866965031759));  // The value is that of scipy.stats.spearmanr.
}

TEST_CASE("What cannot be told has no value", "[experiments][prediction_statistics]") {
  CHECK_FALSE(auc({{1, 2}, {1, 1}}));
  CHECK_FALSE(auc({{1, 2}, {0, 0}}));
  CHECK_FALSE(auc({{2, 2}, {0, 1}}));
  CHECK_FALSE(auc({}));
  CHECK_FALSE(spearman({{1, 1}, {0, 1}}));
  CHECK_FALSE(spearman({{1, 2}, {3, 3}}));
  CHECK_FALSE(spearman({{1}, {1}}));
  CHECK_FALSE(spearman({}));
  const std::vector<ScoredOutcomes> constant = {
      {{1, 1}, {0, 1}}, {{2, 2}, {1, 0}}, {{3, 4}, {1, 1}}};
  CHECK_FALSE(auc_within(constant));
  CHECK_FALSE(spearman_within(constant));
  const Estimate none = estimate(constant, RankStatistic::Auc, StatisticScope::WithinClusters);
  CHECK_FALSE(none.value);
  CHECK_FALSE(none.interval);
}

TEST_CASE("Within clusters, a score that only tells clusters apart counts nothing",
          "[experiments][prediction_statistics]") {
  // Successes are 11, 1, 2, and failures 10, 0. In order are 3 of 3 pairs within clusters, 4 of 6
  // altogether.
  const std::vector<ScoredOutcomes> clusters = {{{10, 11}, {0, 1}}, {{0, 1, 2}, {0, 1, 1}}};
  const auto value = [&](RankStatistic statistic, StatisticScope scope) {
    return estimate(clusters, statistic, scope).value;
  };
  CHECK(auc_within(clusters) == 1.0);
  CHECK(value(RankStatistic::Auc, StatisticScope::WithinClusters) == 1.0);
  CHECK(*value(RankStatistic::Auc, StatisticScope::All) == Approx(4.0 / 6.0));
  // The correlations are 1 of two grasps and -1 of three, so that the mean is (1 * 1 - 2 * 1) / 3.
  const std::vector<ScoredOutcomes> opposed = {{{1, 2}, {1, 2}}, {{1, 2, 3}, {3, 2, 1}}};
  CHECK(*spearman_within(opposed) == Approx(-1.0 / 3.0));
}

TEST_CASE("Bootstrap intervals are those of the normal theory where it holds",
          "[experiments][prediction_statistics]") {
  constexpr std::size_t kClusters = 400;
  const auto mean = [](std::span<const std::size_t> drawn) -> std::optional<double> {
    const auto odd = std::count_if(drawn.begin(), drawn.end(), [](auto c) { return c % 2 == 1; });
    return static_cast<double>(odd) / static_cast<double>(drawn.size());
  };
  const auto interval = bootstrap_interval(kClusters, mean, {.seed = 7});
  REQUIRE(interval);
  const double half_width = 1.96 * 0.5 / std::sqrt(static_cast<double>(kClusters));
  // The percentiles of 1000 draws have a standard error of 4 % of this half width.
  CHECK(interval->low == Approx(0.5 - half_width).margin(0.2 * half_width));
  CHECK(interval->high == Approx(0.5 + half_width).margin(0.2 * half_width));

  const auto again = bootstrap_interval(kClusters, mean, {.seed = 7});
  CHECK(again->low == interval->low);
  CHECK(again->high == interval->high);
  const auto narrow = bootstrap_interval(kClusters, mean, {.level = 0.5, .seed = 7});
  CHECK(narrow->low > interval->low);
  CHECK(narrow->high < interval->high);
}

TEST_CASE("An interval needs two clusters and draws that have a value",
          "[experiments][prediction_statistics]") {
  const auto one = [](std::span<const std::size_t>) { return std::optional<double>(1.0); };
  CHECK_FALSE(bootstrap_interval(1, one));
  CHECK(bootstrap_interval(2, one)->high == 1.0);
  // Both of two clusters are in half of the draws, all of four in 4!/4^4 = 9 % of them.
  const auto with_all = [](std::size_t count) {
    return [count](std::span<const std::size_t> drawn) -> std::optional<double> {
      for (std::size_t c = 0; c < count; ++c) {
        if (std::find(drawn.begin(), drawn.end(), c) == drawn.end()) return std::nullopt;
      }
      return 1.0;
    };
  };
  CHECK_FALSE(bootstrap_interval(4, with_all(4)));
  // One cluster has a success, one a failure, and a value needs both.
  const std::vector<ScoredOutcomes> clusters = {{{1}, {0}}, {{2}, {1}}};
  CHECK(estimate(clusters, RankStatistic::Auc, StatisticScope::All).value == 1.0);
}

}  // namespace test_prediction_statistics
