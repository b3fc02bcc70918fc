#include "methods/target_sides.hpp"

#include <tuple>
#include <utility>

#include "fitting/finger_crossing.hpp"
#include "fitting/target_posture.hpp"
#include "graspfit/grasp/finger_assignment.hpp"

namespace graspfit::grasp::internal {
namespace {

std::tuple<int, bool, double> misfit_of(const TargetSide& side) {
  return {side.imbalance, side.do_fingers_cross, side.misfit};
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
      const TargetPosture posture = posture_for(hand, side.targets, placement);
      side.misfit = reach_misfit(hand, side.targets, posture);
      side.goal = fitting_goal(scene.hand, side.targets, posture, scene.options.fitting);
      side.do_fingers_cross =
          scene.options.fitting.guard_self && do_fingers_cross(scene.hand, *side.goal);
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
    start.close = [&scene, targets = side.targets, placement = side.placement, goal = side.goal,
                   is_at_goal = side.is_at_goal] {
      if (is_at_goal && scene.options.refine) {
        FittingResult result;
        result.initial = result.configuration = *goal;
        result.stop = FittingStop::Contact;
        return result;
      }
      return fit_hand(scene, scene.options.style, targets, placement, scene.options.fitting, goal);
    };
    start.targets = std::move(side.targets);
    start.draws_to_targets = !side.is_at_goal;
    start.promised_firmness = side.promised_firmness;
    start.posture = std::move(side.goal);
    starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace graspfit::grasp::internal
