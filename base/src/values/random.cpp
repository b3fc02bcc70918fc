#include "graspfit/base/random.hpp"

#include <cassert>
#include <limits>

namespace graspfit::base {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15;

// The finalizer of SplitMix64: a bijection of the 64-bit numbers.
std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

Random Random::stream(std::uint64_t seed, std::uint64_t index) {
  // Two rounds: neighboring (seed, index) pairs start far apart on the one cycle.
  return Random(mixed(mixed(seed + kGoldenGamma) + kGoldenGamma * (index + 1)));
}

std::uint64_t Random::next() { return mixed(state_ += kGoldenGamma); }

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

std::uint64_t Random::index(std::uint64_t count) {
  assert(count >= 1);
  // Draws at or above the largest multiple of count would favor small results; they are repeated.
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t excess = (most % count + 1) % count;
  std::uint64_t draw = next();
  while (draw > most - excess) draw = next();
  return draw % count;
}

}  // namespace graspfit::base
