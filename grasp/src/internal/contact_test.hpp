#pragma once

#include "graspfit/grasp/contact_estimation.hpp"

namespace graspfit::grasp {

/// Whether `estimate_contact` finds a contact: the same answer without measuring it, for motions
/// that ask many times.
/// @throws InvalidInput as `estimate_contact`.
bool has_contact(const hands::HandModel& hand, int pad, const geometry::RigidTransform& X_OC,
                 const geometry::MeshQuery& object, const ContactEstimationOptions& options);

}  // namespace graspfit::grasp
