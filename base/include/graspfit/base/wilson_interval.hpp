#pragma once

#include <cstdint>

namespace graspfit::base {

/// An interval of shares, each from 0 to 1.
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};

/// The two-sided 95 % interval of the share of which `num_hits` among `num_trials` independent
/// trials are a sample [Wilson 1927, the score interval]. It is never outside [0, 1] and holds the
/// sample's own share; without trials it is [0, 1]. Rounded.
/// @throws InvalidInput unless 0 <= `num_hits` <= `num_trials`.
ShareInterval wilson_interval(std::int64_t num_hits, std::int64_t num_trials);

}  // namespace graspfit::base
