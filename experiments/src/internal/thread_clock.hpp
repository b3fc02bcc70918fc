#pragma once

#include <time.h>

namespace graspfit::experiments::internal {

/// Processor time that the calling thread has used [s].
inline double thread_cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  constexpr double kSecondsPerNanosecond = 1e-9;
  return static_cast<double>(now.tv_sec) + kSecondsPerNanosecond * static_cast<double>(now.tv_nsec);
}

}  // namespace graspfit::experiments::internal
