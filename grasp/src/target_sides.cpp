#include "internal/target_sides.hpp"

#include <tuple>
#include <utility>

#include "internal/finger_crossing.hpp"
#include "internal/target_posture.hpp"

namespace graspfit::grasp::internal {
namespace {

std::tuple<int, bool, double> misfit_of(const TargetSide& side) {
  return {side.imbalance, side.do_fingers_cross, side.misfit};
}

bool crosses(const TargetSide& side, const GuidanceScene& scene) {
  const hands::HandConfiguration goal =
      posture_for(scene.hand.model(), side.targets, side.placement).configuration;
  return do_fingers_cross(scene.hand, with_fingers_apart(scene.hand, side.targets, goal));
}

}  // namespace

bool by_misfit(const TargetSide& a, const TargetSide& b) { return misfit_of(a) < misfit_of(b); }

std::vector<TargetSide> sides_of(const TargetContacts& targets, const GuidanceScene& scene,
                                 bool are_judged) {
  const hands::HandModel& hand = scene.hand.model();
  std::vector<TargetSide> sides;
  for (const PalmPlacement& placement : palm_placements(
           scene.object, targets, scene.options.approach_O, scene.options.approach_angle)) {
    TargetSide side{assign_fingers(hand, targets, scene.parts, placement), placement};
    if (are_judged) {
      side.misfit = reach_misfit(hand, side.targets, placement);
      side.do_fingers_cross = scene.options.fitting.guard_self && crosses(side, scene);
    }
    sides.push_back(std::move(side));
  }
  return sides;
}

std::vector<GuidedStart> starts_from(std::vector<TargetSide> sides, const GuidanceScene& scene) {
  const auto most = static_cast<std::size_t>(scene.options.max_placements);
  if (sides.size() > most) sides.erase(sides.begin() + scene.options.max_placements, sides.end());
  std::vector<GuidedStart> starts;
  for (TargetSide& side : sides) {
    GuidedStart start;
    start.close = [&scene, targets = side.targets, placement = side.placement] {
      return fit_hand(scene.hand, scene.object, scene.surroundings, scene.options.style, targets,
                      placement, scene.contact_options, scene.options.fitting);
    };
    start.targets = std::move(side.targets);
    starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace graspfit::grasp::internal
