#pragma once

#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/grasp/contact.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// Parameters of contact estimation (paper section 10).
struct ContactEstimationOptions {
  double clip_thickness = 0.0;  ///< Of clip volumes whose pad states none [m], > 0. The planner's
                                ///< rule: max(0.5 voxel, 1 mm) (A33).
  geometry::PatchAveraging averaging = geometry::PatchAveraging::AreaWeighted;  ///< A34.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Contact of one pad: the object's triangles clipped by the pad's clip volume. Point and normal
/// are the mean over the pieces, the point projected to the nearest point of the surface; size is
/// the pieces' total area. Empty if no piece has area, or the mean normal vanishes (shorter than
/// 0.1).
///
/// `is_target` and `weak` are left at their defaults. Which triangles are cut is decided exactly on
/// the clip volume's half-spaces as rounded to frame O.
std::optional<Contact> estimate_contact(const hands::HandModel& hand, int pad,
                                        const geometry::RigidTransform& X_OC,
                                        const geometry::MeshQuery& object,
                                        const ContactEstimationOptions& options);

/// Contacts of all pads of the hand, in pad order (contacts without a target count: A35).
std::vector<Contact> estimate_contacts(const hands::HandModel& hand,
                                       const std::vector<geometry::RigidTransform>& X_OL,
                                       const geometry::MeshQuery& object,
                                       const ContactEstimationOptions& options);

}  // namespace graspfit::grasp
