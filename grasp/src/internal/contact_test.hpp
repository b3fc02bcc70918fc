#pragma once

#include "graspfit/grasp/contact_estimation.hpp"

namespace graspfit::grasp {

/// Whether `estimate_contacts` finds a contact of this pad, if it counts: the same answer without
/// measuring it, for motions that ask many times.
/// @throws InvalidInput as `estimate_contact`.
bool has_contact(const hands::HandModel& hand, int pad, const geometry::RigidTransform& X_OC,
                 const geometry::MeshQuery& object, const ContactEstimationOptions& options);

/// Whether contacts of `pad` are among those that `estimate_contacts` looks for.
bool is_counted(const hands::HandModel& hand, int pad, const ContactEstimationOptions& options);

}  // namespace graspfit::grasp
