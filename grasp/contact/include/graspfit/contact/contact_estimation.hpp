#pragma once

#include <optional>
#include <span>
#include <vector>

#include "graspfit/contact/contact.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/weak_regions.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::contact {

/// Which pads can have contacts.
enum class CountedPads {
  All,          ///< Those of every link: fingers may touch with any part.
  TipsAndPalm,  ///< Fingertips and palm [P: "a clip volume for each finger/palm"].
};

/// What becomes of surface that a clip volume holds in several pieces.
enum class ContactPieces {
  Joined,    ///< One contact, the mean of all [P].
  Separate,  ///< Pieces that do not hang together and whose centroids are farther apart than half
             ///< the pad's width are contacts of their own [R]: the mean of two ridges is in
             ///< neither.
};

/// Parameters of contact estimation (paper section 10).
struct ContactEstimationOptions {
  double clip_thickness = 0.0;  ///< Of clip volumes whose pad states none [m], > 0. The planner's
                                ///< rule: max(0.5 voxel, 1 mm).
  geometry::PatchAveraging averaging = geometry::PatchAveraging::AreaWeighted;  ///< [R]
  CountedPads pads = CountedPads::All;
  ContactPieces pieces = ContactPieces::Joined;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Contact of one pad, whether its link counts or not: the object's triangles clipped by the pad's
/// clip volume, all pieces joined. Point and normal are the mean over the pieces, the point
/// projected to the nearest point of these pieces; size is the pieces' total area; boundary
/// distance is that of the point dropped onto the pad's plane; gap is `pad_gap`. Empty if no piece
/// has area, or the mean normal vanishes (shorter than 0.1), as on a plate thinner than the clip
/// volume.
///
/// `weak` says whether at least half of the pieces' area is on weak faces; it stays empty without
/// `weak_regions`, and where those say that nothing is known (`WeakOutcome::TooCoarse`).
/// `is_target` is left at its default. Surface behind the pad's plane is not seen;
/// surface inside the bulge of a curved pad is, and there the link has entered the object. Walls
/// inside the volume count with their area whichever way they face. Rounded; which triangles are
/// cut is decided exactly on the clip volume's half-spaces as rounded to frame O. Cost: a box query
/// where nothing is near, else linear in the triangles near the pad.
/// @throws InvalidInput for bad options, a pad that the hand does not have, or weak regions of
/// another mesh (another number of faces).
std::optional<Contact> estimate_contact(const hands::HandModel& hand, int pad,
                                        const geometry::RigidTransform& X_OC,
                                        const geometry::MeshQuery& object,
                                        const ContactEstimationOptions& options,
                                        const geometry::WeakRegions* weak_regions = nullptr);

/// The gap of a pad: smallest distance between its surface on the link's mesh
/// (`hands::pad_surface_L`) and the object's surface [m]; zero where they cross. Of meshes, and in
/// any direction: not the height over the modeled pad. Empty above `enough`. Rounded.
std::optional<double> pad_gap(const geometry::MeshQuery& pad_surface_L,
                              const geometry::RigidTransform& X_OL,
                              const geometry::MeshQuery& object, double enough);

/// Contacts of all pads of the hand that count, in pad order; those of one pad in the order of
/// their first faces, each with the gap between the pad and its own faces. Contacts without a
/// target count, too.
std::vector<Contact> estimate_contacts(const hands::HandModel& hand,
                                       const std::vector<geometry::RigidTransform>& X_OL,
                                       const geometry::MeshQuery& object,
                                       const ContactEstimationOptions& options,
                                       const geometry::WeakRegions* weak_regions = nullptr);

/// The contacts that can bear a force: those with a gap of at most `largest_gap` [m]; without one
/// all of them, as of grasps at the level of voxels, whose pads are nowhere exactly on the surface.
std::vector<Contact> touching_contacts(std::span<const Contact> contacts,
                                       const std::optional<double>& largest_gap);

/// Whether `estimate_contacts` finds a contact of this pad, if it counts: the same answer without
/// measuring it, for motions that ask many times.
/// @throws InvalidInput as `estimate_contact`.
bool has_contact(const hands::HandModel& hand, int pad, const geometry::RigidTransform& X_OC,
                 const geometry::MeshQuery& object, const ContactEstimationOptions& options);

/// Whether contacts of `pad` are among those that `estimate_contacts` looks for.
bool is_counted(const hands::HandModel& hand, int pad, const ContactEstimationOptions& options);

}  // namespace graspfit::contact
