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
  std::size_t index = 0;  ///< Index of the grasp in the list.
  HoldVerdict verdict;
  std::optional<HoldMargin> margin;   ///< Margin of the grasp, if it was asked for.
  std::optional<bool> is_near_limit;  ///< `HoldTest::is_near_limit`, if it was asked for.
};

/// Which grasps of a list are tested, and how.
struct HoldBatchOptions {
  std::vector<std::size_t> indices;  ///< Indices of the grasps to test; if empty, all are tested.
  /// Whether the smallest failing force and torque are searched for, too. For each of the two 10 to
  /// 60 loads are simulated, mostly 20 to 30.
  bool margin = false;
  /// Whether it is looked whether verdicts are near a limit: up to twice as many loads more.
  bool near_limit = false;
  double largest_margin = 100.0;  ///< Largest load tried, as in HoldTest::margin [N], > 0.
  int num_threads = 0;            ///< Number of threads, each with an engine of its own; 0: one per
                                  ///< processor.
};

/// Called now and then from any thread, but never by two at once, with the number of grasps that
/// are done.
using HoldProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Tests grasps. The results are in the order of `indices`, and the same for any number of threads.
/// @throws InvalidInput for an index that the list does not have, a negative number of threads, a
/// bad protocol, and in a build without MuJoCo.
std::vector<TestedGrasp> test_grasps(const HoldHand& hand, const HoldObject& object,
                                     const HoldProtocol& protocol,
                                     std::span<const grasp::Grasp> grasps,
                                     const HoldBatchOptions& options = {},
                                     const HoldProgress& progress = {});

/// "rejected", "approach", "load" or "held".
const char* name_of(HoldStage stage);

/// Counts the grasps whose tests ended at each stage; a stage at which none ended counts 0.
std::map<HoldStage, std::size_t> count_stages(std::span<const TestedGrasp> tested);

/// Indices of the grasps that held, those with the largest margin of force first (without margins,
/// and of equal ones, in the order of the list).
std::vector<std::size_t> held_best_first(std::span<const TestedGrasp> tested);

}  // namespace graspfit::hold_test
