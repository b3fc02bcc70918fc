#pragma once

#include <cstdint>

namespace graspfit::base {

/// Seeded random numbers with the same values on every platform (`std::` distributions differ
/// between standard libraries).
///
/// Generator: SplitMix64 [Steele, Lea & Flood 2014]; one 64-bit state, period 2^64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// An independent stream for item `index` of the run with seed `seed`: the same whatever was
  /// drawn before, so that work can be split in any way.
  static Random stream(std::uint64_t seed, std::uint64_t index);

  /// The next 64 random bits.
  std::uint64_t next();

  /// Uniform in [0, 1), 53 bits.
  double uniform();

  /// Uniform in [lower, upper).
  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

  /// Uniform in {0, …, count − 1}, without modulo bias. Precondition: count ≥ 1.
  std::uint64_t index(std::uint64_t count);

 private:
  std::uint64_t state_;
};

}  // namespace graspfit::base
