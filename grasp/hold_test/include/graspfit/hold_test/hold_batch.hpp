#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test {

/// What a test found of one grasp of a list.
struct TestedGrasp {
  std::size_t index = 0;  ///< In that list.
  HoldVerdict verdict;
  std::optional<HoldMargin> margin;  ///< Where it was asked for.
};

/// Which grasps of a list are tested, and how.
struct HoldBatchOptions {
  std::vector<std::size_t> indices;  ///< Of the grasps to test; empty: all.
  bool margin = false;               ///< Also the smallest failing loads: a score of tests each.
  double largest_margin = 100.0;     ///< As of HoldTest::margin [N], > 0.
  int num_threads = 0;               ///< Each with an engine of its own; 0: one per processor.
};

/// Called now and then from any thread, one at a time, with how many grasps are done.
using HoldProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Tests grasps; the same results in the order of `indices` for any number of threads.
/// @throws InvalidInput for an index that the list does not have, a negative number of threads, a
/// bad protocol, and in a build without MuJoCo.
std::vector<TestedGrasp> test_grasps(const HoldHand& hand, const HoldObject& object,
                                     const HoldProtocol& protocol,
                                     std::span<const grasp::Grasp> grasps,
                                     const HoldBatchOptions& options = {},
                                     const HoldProgress& progress = {});

/// "rejected", "approach", "load" or "held".
const char* name_of(HoldStage stage);

/// How many grasps came how far; a stage that none came to counts 0.
std::map<HoldStage, std::size_t> count_stages(std::span<const TestedGrasp> tested);

/// Indices of the grasps that held, those with the largest margin of force first (without margins,
/// and of equal ones, in the order of the list).
std::vector<std::size_t> held_best_first(std::span<const TestedGrasp> tested);

}  // namespace graspfit::hold_test
