#include "graspfit/base/wilson_interval.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/option_check.hpp"

namespace graspfit::base {

ShareInterval wilson_interval(std::int64_t num_hits, std::int64_t num_trials) {
  require(num_trials >= 0, "wilson_interval", "num_trials", num_trials, ">= 0");
  require(num_hits >= 0 && num_hits <= num_trials, "wilson_interval", "num_hits", num_hits,
          "from 0 to num_trials");
  if (num_trials == 0) return {};
  // With z the normal quantile of 97.5 %: the shares p whose test |share - p| <= z sqrt(p(1-p)/n)
  // does not refuse the sample.
  constexpr double kQuantile = 1.959963984540054;
  const double n = static_cast<double>(num_trials);
  const double share = static_cast<double>(num_hits) / n;
  const double z2 = kQuantile * kQuantile;
  const double center = (share + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half =
      kQuantile * std::sqrt(share * (1.0 - share) / n + z2 / (4.0 * n * n)) / (1.0 + z2 / n);
  // In real arithmetic the share is within; rounding would put 0 or 1 just outside.
  return {std::clamp(center - half, 0.0, share), std::clamp(center + half, share, 1.0)};
}

}  // namespace graspfit::base
