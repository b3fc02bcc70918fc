#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace graspfit::base {

/// Calls `body(i)` for every i in [0, count), on `num_threads` threads (0: as many as the machine
/// has). Each call must write only results of its own, so that results do not depend on the number
/// of threads. The first exception that `body` throws is thrown again by this function.
template <typename Body>
void parallel_for(std::size_t count, int num_threads, const Body& body) {
  constexpr std::size_t kChunk = 64;
  std::size_t wanted = num_threads > 0 ? static_cast<std::size_t>(num_threads)
                                       : std::max(1U, std::thread::hardware_concurrency());
  wanted = std::min(wanted, (count + kChunk - 1) / kChunk);
  if (wanted <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_lock;
  const auto work = [&] {
    try {
      for (std::size_t begin = next.fetch_add(kChunk); begin < count;
           begin = next.fetch_add(kChunk)) {
        const std::size_t end = std::min(count, begin + kChunk);
        for (std::size_t i = begin; i < end; ++i) body(i);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_lock);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> threads;
    threads.reserve(wanted - 1);
    for (std::size_t t = 1; t < wanted; ++t) threads.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace graspfit::base
