#include "internal/guidance_list.hpp"
#include "internal/palm_pose.hpp"

namespace graspfit::grasp::internal {
namespace {

class AxisGuidance : public GraspGuidance {
 public:
  explicit AxisGuidance(const GuidanceScene& scene) : scene_(scene) {}

  GuidedStarts starts(std::int64_t number) const override {
    if (number >= 3) return {.is_exhausted = true};
    const hands::HandModel& hand = scene_.hand.model();
    const Eigen::Vector3d direction = -Eigen::Vector3d::Unit(number);
    hands::HandConfiguration start = hands::open_configuration(hand);
    start.X_OH = palm_pose(hand, closing_axis_H(hand), grasp_center_H(hand), direction,
                           any_normal(direction), scene_.object.mass.center_of_mass);
    // close_hand backs the open hand off until it is clear and closes it under the shared guard.
    return {.starts = {{.close = [this, start] {
              return close_hand(scene_.hand, scene_.object, scene_.surroundings,
                                scene_.options.style, scene_.parts, start, {},
                                scene_.contact_options, scene_.options.fitting);
            }}}};
  }
  GuidanceModel model() const override { return {.columns = {"x_m", "y_m", "z_m"}}; }

 private:
  const GuidanceScene scene_;
};

}  // namespace

std::unique_ptr<GraspGuidance> axis_guidance(const GuidanceScene& scene) {
  return std::make_unique<AxisGuidance>(scene);
}

}  // namespace graspfit::grasp::internal
