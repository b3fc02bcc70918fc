#include "cells/hold_preparation.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "cells/hold_cell.hpp"
#include "settings/last_used.hpp"

namespace graspfit::experiments::internal {
namespace {

using hold_test::HoldStage;

constexpr std::array<std::pair<HoldStage, const char*>, 4> kStages = {
    {{HoldStage::Rejected, "rejected"},
     {HoldStage::Approach, "approach"},
     {HoldStage::Load, "load"},
     {HoldStage::Held, kHeldStage}}};

}  // namespace

std::shared_ptr<const hold_test::HoldHand> hold_hand(const Planned& planned) {
  static LastUsed<hold_test::HoldHand> prepared;
  return prepared.value(planned.settings.hand,
                        [&] { return hold_test::prepare_hold_hand(*planned.hand); });
}

std::shared_ptr<const hold_test::HoldObject> hold_object(const Planned& planned) {
  static LastUsed<hold_test::HoldObject> prepared;
  return prepared.value(planned.settings.object.key(),
                        [&] { return hold_test::prepare_hold_object(planned.object_file->mesh); });
}

const char* stage_name(HoldStage stage) {
  return std::find_if(kStages.begin(), kStages.end(),
                      [&](const auto& entry) { return entry.first == stage; })
      ->second;
}

}  // namespace graspfit::experiments::internal
