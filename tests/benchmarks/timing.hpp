#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

namespace graspfit::testing {

/// Returns the wall time of `work` [s].
inline double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Returns the middle one of the values (the upper one of two).
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace graspfit::testing
