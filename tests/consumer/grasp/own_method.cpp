// A planning method of one's own: the hand comes along one of the axes of the object's frame and
// closes on it.
#include <cstdio>
#include <memory>

#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/palm_pose.hpp"

using namespace graspfit;

class AxisGuidance : public grasp::GraspGuidance {
 public:
  explicit AxisGuidance(const grasp::GuidanceScene& scene) : scene_(scene) {}

  grasp::GuidedStarts starts(std::int64_t number) const override {
    if (number >= 3) return {.is_exhausted = true};
    const hands::HandModel& hand = scene_.hand.model();
    const Eigen::Vector3d direction = -Eigen::Vector3d::Unit(number);
    hands::HandConfiguration start = hands::open_configuration(hand);
    start.X_OH =
        hands::palm_pose(hand, hands::closing_axis_H(hand), hands::grasp_center_H(hand), direction,
                         hands::any_normal(direction), scene_.object.mass.center_of_mass);
    // close_hand backs the open hand off until it is clear and closes it under the shared guard.
    return {.starts = {{.close = [this, start] {
              return grasp::close_hand(scene_, scene_.options.style, scene_.parts, start, {},
                                       scene_.options.fitting);
            }}}};
  }
  grasp::GuidanceModel model() const override { return {.columns = {"x_m", "y_m", "z_m"}}; }

 private:
  const grasp::GuidanceScene scene_;
};

int main() {
  grasp::PlanningMethods methods = grasp::planning_methods();
  methods.add({.name = "axis", .title = "along the axes", .make = [](const auto& scene) {
                 return std::make_unique<AxisGuidance>(scene);
               }});

  const hands::HandModel hand = hands::find_hand("barrett");
  const grasp::PlannerOptions options{.planner = "axis", .count = 3, .max_attempts = 10};
  const grasp::ObjectModel object = grasp::prepare_object(geometry::ball(0.06), hand, options);
  const grasp::PlannerResult result =
      grasp::plan_grasps(object, hand, options, {}, {.methods = methods});
  for (const grasp::Grasp& grasp : result.grasps) {
    const Eigen::Vector3d palm = grasp.configuration.X_OH.linear() * hand.palm.direction_H;
    Eigen::Index axis = 0;
    palm.cwiseAbs().maxCoeff(&axis);
    std::printf("palm along -%c: M = %.3f\n", "xyz"[axis], grasp.quality.m);
  }
  return result.statistics.attempts == 3 && result.grasps.size() == 3 ? 0 : 1;
}
