#include "output/grasp_text.hpp"

#include <algorithm>
#include <functional>
#include <iterator>

#include "graspfit/base/number_text.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {

std::string epsilon_text(const grasp::Grasp& grasp, int decimals) {
  return grasp.is_closed() ? fixed_decimal(grasp.epsilon(), decimals) : "open";
}

std::string closed_text(const grasp::GraspFile& file) {
  const auto num_closed =
      std::count_if(file.grasps.begin(), file.grasps.end(),
                    [](const grasp::Grasp& grasp) { return grasp.is_closed(); });
  if (num_closed == std::ssize(file.grasps)) return "all closed";
  return (num_closed == 0 ? "none" : std::to_string(num_closed)) + " closed";
}

std::string grip_text(const grasp::GraspFile& file) {
  if (file.options.style != grasp::GraspStyle::Auto) return "";
  const auto num_with = [&](bool (grasp::Grasp::*has)() const) {
    return std::to_string(std::count_if(file.grasps.begin(), file.grasps.end(), std::mem_fn(has)));
  };
  std::string text = num_with(&grasp::Grasp::has_palm_target) + " of " +
                     std::to_string(file.grasps.size()) + " grasps press on the palm, " +
                     num_with(&grasp::Grasp::has_target_behind_tip) +
                     " with other pads than fingertips'";
  const auto num_fingers = [](const grasp::Grasp& grasp) {
    const auto& targets = grasp.targets.contacts;
    return std::count_if(targets.begin(), targets.end(),
                         [](const grasp::TargetContact& target) { return !target.is_palm; });
  };
  const auto& named = file.options.fingers;
  const std::ptrdiff_t num_asked = named.empty() ? file.options.num_contacts : std::ssize(named);
  const auto num_fewer =
      std::count_if(file.grasps.begin(), file.grasps.end(),
                    [&](const grasp::Grasp& grasp) { return num_fingers(grasp) < num_asked; });
  if (num_fewer > 0) text += ", " + std::to_string(num_fewer) + " with fewer fingers than asked";
  const auto& found = file.statistics.guidance;
  const auto narrowest = found.find(std::string(grasp::kNarrowestPinch));
  const auto widest = found.find(std::string(grasp::kWidestPinch));
  const std::string at = " at friction " + base::plain_decimal(file.options.friction);
  if (narrowest == found.end() || widest == found.end()) {
    return text + "; two fingertips of " + file.hand.name + " pinch nothing squarely" + at;
  }
  return text + "; two fingertips of " + file.hand.name + " pinch squarely" + at + " what is " +
         std::to_string(narrowest->second) + " to " + std::to_string(widest->second) +
         " mm wide (graspfit hand reach shows it)";
}

}  // namespace graspfit::app
