#include "graspfit/hold_test/hold_batch.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "graspfit/base/errors.hpp"

namespace graspfit::hold_test {
namespace {

using base::InvalidInput;

std::vector<std::size_t> wanted_indices(const HoldBatchOptions& options, std::size_t num_grasps) {
  std::vector<std::size_t> indices = options.indices;
  if (indices.empty()) {
    indices.resize(num_grasps);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
  }
  for (const std::size_t index : indices) {
    if (index < num_grasps) continue;
    throw InvalidInput("test_grasps: there is no grasp with index " + std::to_string(index) +
                       " of " + std::to_string(num_grasps));
  }
  return indices;
}

std::size_t num_workers(int num_threads, std::size_t num_grasps) {
  if (num_threads < 0) {
    throw InvalidInput("test_grasps: num_threads is " + std::to_string(num_threads) +
                       ", must be at least 0");
  }
  const unsigned threads = num_threads > 0 ? static_cast<unsigned>(num_threads)
                                           : std::max(1U, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(num_grasps, 1, threads);
}

}  // namespace

std::vector<TestedGrasp> test_grasps(const HoldHand& hand, const HoldObject& object,
                                     const HoldProtocol& protocol,
                                     std::span<const grasp::Grasp> grasps,
                                     const HoldBatchOptions& options,
                                     const HoldProgress& progress) {
  const std::vector<std::size_t> indices = wanted_indices(options, grasps.size());
  std::vector<TestedGrasp> tested(indices.size());
  // Chance decides which worker tests which grasp, but not what the tests find, since a verdict
  // depends on the grasp alone. Of several errors the first grasp's is thrown.
  std::vector<std::exception_ptr> errors(indices.size());
  std::atomic<std::size_t> next = 0;
  std::size_t done = 0;
  std::mutex reporting;
  const auto work = [&](HoldTest& test) {
    for (std::size_t i = next++; i < indices.size(); i = next++) {
      try {
        const grasp::Grasp& grasp = grasps[indices[i]];
        tested[i].index = indices[i];
        tested[i].verdict = test.test(grasp);
        if (options.near_limit) {
          tested[i].is_near_limit = test.is_near_limit(grasp, tested[i].verdict);
        }
        if (options.margin) tested[i].margin = test.margin(grasp, options.largest_margin);
      } catch (...) {
        errors[i] = std::current_exception();
        next = indices.size();
      }
      const std::lock_guard lock(reporting);
      if (progress) progress(++done, indices.size());
    }
  };
  std::vector<HoldTest> tests;
  for (std::size_t t = num_workers(options.num_threads, indices.size()); t > 0; --t) {
    tests.emplace_back(hand, object, protocol);
  }
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < tests.size(); ++t) threads.emplace_back(work, std::ref(tests[t]));
  work(tests[0]);
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return tested;
}

const char* name_of(HoldStage stage) {
  switch (stage) {
    case HoldStage::Rejected:
      return "rejected";
    case HoldStage::Approach:
      return "approach";
    case HoldStage::Load:
      return "load";
    case HoldStage::Held:
      break;
  }
  return "held";
}

std::map<HoldStage, std::size_t> count_stages(std::span<const TestedGrasp> tested) {
  std::map<HoldStage, std::size_t> counts = {{HoldStage::Rejected, 0},
                                             {HoldStage::Approach, 0},
                                             {HoldStage::Load, 0},
                                             {HoldStage::Held, 0}};
  for (const TestedGrasp& grasp : tested) ++counts[grasp.verdict.stage];
  return counts;
}

std::vector<std::size_t> held_best_first(std::span<const TestedGrasp> tested) {
  std::vector<std::size_t> held;  // indices into `tested`
  for (std::size_t i = 0; i < tested.size(); ++i) {
    if (tested[i].verdict.held()) held.push_back(i);
  }
  const auto margin = [&](std::size_t i) {
    return tested[i].margin ? tested[i].margin->force : 0.0;
  };
  std::stable_sort(held.begin(), held.end(),
                   [&](std::size_t a, std::size_t b) { return margin(a) > margin(b); });
  for (std::size_t& i : held) i = tested[i].index;
  return held;
}

}  // namespace graspfit::hold_test
