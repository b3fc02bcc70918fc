#include "grasp/grasp_measure.hpp"

#include <algorithm>
#include <utility>

#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/grasp/grasp_measure.hpp"

namespace graspfit::grasp {
namespace {

/// Marks the contacts of `pad` as targets; returns whether one of them is near enough.
bool mark_requested(std::vector<contact::Contact>& contacts, int pad,
                    const std::optional<double>& largest_gap) {
  bool is_any_near = false;
  for (contact::Contact& contact : contacts) {
    if (contact.pad != pad) continue;
    contact.is_target = true;
    is_any_near = is_any_near || !largest_gap || contact.gap <= *largest_gap;
  }
  return is_any_near;
}

}  // namespace

internal::PosedGrasp internal::with_contacts(const MeasuringScene& scene,
                                             const hands::HandConfiguration& configuration,
                                             const RequestedParts& requested) {
  const hands::HandModel& hand = scene.hand;
  hands::validate(hand, configuration);
  PosedGrasp measured{.grasp = {}, .X_OL = hands::forward_kinematics(hand, configuration)};
  Grasp& grasp = measured.grasp;
  grasp.configuration = configuration;
  grasp.contacts = contact::estimate_contacts(hand, measured.X_OL, scene.object,
                                              scene.contact_options, scene.weak);
  grasp.has_all_contacts = true;
  for (const int pad : requested_pads(hand, requested)) {
    const bool has_contact = mark_requested(grasp.contacts, pad, scene.largest_gap);
    grasp.has_all_contacts = grasp.has_all_contacts && has_contact;
  }
  grasp.quality =
      contact::contact_quality(grasp.contacts, scene.quality_context, scene.quality_options);
  return measured;
}

internal::PosedGrasp internal::with_self_penetration(const MeasuringScene& scene,
                                                     PosedGrasp measured) {
  const hands::HandCollision::Result with_self = scene.collision.against_self(measured.X_OL);
  GraspPenetration& penetration = measured.grasp.penetration;
  penetration.self_intersects = with_self.intersects;
  penetration.self_depth = with_self.depth;
  penetration.self_link_a = with_self.link_a;
  penetration.self_link_b = with_self.link_b;
  return measured;
}

internal::PosedGrasp internal::with_penetration(const MeasuringScene& scene, PosedGrasp measured) {
  auto& [grasp, X_OL] = measured;
  const hands::HandCollision::Result with_object =
      scene.collision.against_object(scene.object, X_OL);
  GraspPenetration& penetration = grasp.penetration;
  penetration.object_intersects = with_object.intersects;
  penetration.object_depth = with_object.depth;
  penetration.object_depth_bound = with_object.depth_bound;
  penetration.object_link = with_object.link_a;
  for (int link = 0; link < std::ssize(X_OL); ++link) {
    penetration.surroundings_touched =
        penetration.surroundings_touched ||
        scene.surroundings.touches(scene.collision, link, X_OL[link]);
  }
  return measured;
}

Grasp internal::with_wrench_quality(const MeasuringScene& scene, Grasp grasp) {
  const std::vector<contact::Contact> touching =
      contact::touching_contacts(grasp.contacts, scene.bearing_gap);
  if (!touching.empty()) {
    grasp.wrench = contact::wrench_quality(contact::grasp_wrench_space(
        touching, contact::wrench_convention(contact::WrenchTool::GraspIt, scene.wrench_object,
                                             touching, scene.friction)));
  }
  return grasp;
}

Grasp measure_grasp(const MeasuringScene& scene, const hands::HandConfiguration& configuration,
                    const RequestedParts& requested) {
  internal::PosedGrasp measured = internal::with_contacts(scene, configuration, requested);
  measured = internal::with_self_penetration(scene, std::move(measured));
  measured = internal::with_penetration(scene, std::move(measured));
  return internal::with_wrench_quality(scene, std::move(measured.grasp));
}

double grasp_strength(const Grasp& grasp, const contact::WrenchObject& object, double friction,
                      const std::optional<double>& bearing_gap) {
  return contact::signed_epsilon(contact::touching_contacts(grasp.contacts, bearing_gap), object,
                                 friction);
}

}  // namespace graspfit::grasp
