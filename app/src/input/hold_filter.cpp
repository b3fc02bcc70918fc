#include "input/hold_filter.hpp"

#include <algorithm>
#include <utility>

#include "graspfit/hold_test/hold_batch.hpp"

namespace graspfit::app {

HeldGrasps held_grasps(const geometry::TriangleMesh& object_O, const hands::HandModel& hand,
                       const hold_test::HoldProtocol& protocol, int num_threads,
                       std::vector<grasp::Grasp> planned, bool by_margin, ProgressBar& progress) {
  progress.show("convex pieces");
  const hold_test::HoldHand hold_hand = hold_test::prepare_hold_hand(hand);
  const hold_test::HoldObject hold_object = hold_test::prepare_hold_object(object_O);
  hold_test::HoldBatchOptions options;
  options.margin = protocol.has_margins();
  options.num_threads = num_threads;
  const std::vector<hold_test::TestedGrasp> tested = hold_test::test_grasps(
      hold_hand, hold_object, protocol, planned, options, [&](std::size_t done, std::size_t total) {
        progress.show(static_cast<std::int64_t>(done), static_cast<std::int64_t>(total),
                      "tested " + std::to_string(done) + " of " + std::to_string(total));
      });
  HeldGrasps held;
  held.record.protocol = protocol.name;
  for (const auto& [stage, count] : hold_test::count_stages(tested)) {
    held.record.stages[hold_test::name_of(stage)] = static_cast<std::int64_t>(count);
  }
  std::vector<std::size_t> order = hold_test::held_best_first(tested);
  if (!by_margin) std::sort(order.begin(), order.end());
  for (const std::size_t index : order) {
    held.grasps.push_back(std::move(planned[index]));
    if (tested[index].margin) held.record.margins.push_back(tested[index].margin->force);
  }
  return held;
}

std::string hold_text(const grasp::HoldRecord& record) {
  std::int64_t total = 0;
  std::string lost;
  for (const auto& [stage, count] : record.stages) {
    total += count;
    if (stage == hold_test::name_of(hold_test::HoldStage::Held) || count == 0) continue;
    lost += (lost.empty() ? ": " : ", ") + stage + ' ' + std::to_string(count);
  }
  return std::to_string(record.stages.at(hold_test::name_of(hold_test::HoldStage::Held))) + " of " +
         std::to_string(total) + " planned grasps hold under " + record.protocol + lost;
}

}  // namespace graspfit::app
