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
  All,          ///< The pads of every link can: fingers may touch with any part.
  TipsAndPalm,  ///< Only fingertips and palm can [P: "a clip volume for each finger/palm"].
};

/// How surface that a clip volume holds in several pieces becomes contacts.
enum class ContactPieces {
  Joined,    ///< All pieces make one contact, their mean [P].
  Separate,  ///< Pieces that are not connected and whose centroids are farther apart than half the
             ///< pad's width make contacts of their own [R]: the mean of two ridges lies on
             ///< neither.
};

/// Which faces in a clip volume are surface that the pad may touch.
enum class ContactFaces {
  All,     ///< All [P: what the volume holds].
  Facing,  ///< Those that do not look away from the pad, by more than 120 degrees from facing it
           ///< [R]: of a thin wall the near side alone.
};

/// Parameters of contact estimation (paper section 10).
struct ContactEstimationOptions {
  double clip_thickness = 0.0;  ///< Thickness of the clip volumes of pads that state none [m], > 0.
                                ///< The planner's rule: max(0.5 voxel, 1 mm).
  geometry::PatchAveraging averaging = geometry::PatchAveraging::AreaWeighted;  ///< [R]
  CountedPads pads = CountedPads::All;
  ContactPieces pieces = ContactPieces::Joined;
  ContactFaces faces = ContactFaces::All;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Estimates the contact of one pad, whether or not `options.pads` counts the pad. The object's
/// triangles are clipped by the pad's clip volume, and all pieces are joined. The normal is the
/// mean over the pieces; the point is the mean over the pieces, projected to the nearest point of
/// these pieces; the area is the total area of the pieces; the boundary distance is that of the
/// point after its projection onto the pad's plane; the gap is `pad_gap`. The result is empty if no
/// piece has area, or if the mean normal vanishes (is shorter than 0.1), as on a plate thinner than
/// the clip volume.
///
/// `weak` says whether at least half of the pieces' area is on weak faces; it stays empty without
/// `weak_regions`, and where the weak regions are unknown (`WeakOutcome::TooCoarse`). `is_target`
/// is left at its default. Surface behind the pad's plane does not count; surface inside the bulge
/// of a curved pad counts, although the link has entered the object there. Walls inside the volume
/// count with their area whichever way they face, or as `options.faces` says. The numbers are
/// rounded, but which triangles are cut is decided exactly on the clip volume's half-spaces as
/// rounded to frame O. The cost is a box query where nothing is near, and otherwise linear in the
/// number of triangles near the pad.
/// @throws InvalidInput for bad options, a pad that the hand does not have, a pose that is not
/// finite, or weak regions of another mesh (another number of faces).
std::optional<Contact> estimate_contact(const hands::HandModel& hand, int pad,
                                        const geometry::RigidTransform& X_OC,
                                        const geometry::MeshQuery& object,
                                        const ContactEstimationOptions& options,
                                        const geometry::WeakRegions* weak_regions = nullptr);

/// Measures the gap of a pad: the smallest distance between the pad's surface on its link's mesh
/// (`hands::pad_surface_L`) and the object's surface [m], zero where these cross. The gap is a
/// distance of meshes in any direction, not the height over the modeled pad. It is rounded, and
/// empty above `enough`.
std::optional<double> pad_gap(const geometry::MeshQuery& pad_surface_L,
                              const geometry::RigidTransform& X_OL,
                              const geometry::MeshQuery& object, double enough);

/// Estimates the contacts of all pads that count (`is_counted`), in pad order. Several contacts of
/// one pad come in the order of their first faces, where faces that lie in the clip volume as a
/// whole precede those that it cuts; the gap of each is that between the pad and the contact's own
/// faces. Contacts of pads without a target are included.
std::vector<Contact> estimate_contacts(const hands::HandModel& hand,
                                       const std::vector<geometry::RigidTransform>& X_OL,
                                       const geometry::MeshQuery& object,
                                       const ContactEstimationOptions& options,
                                       const geometry::WeakRegions* weak_regions = nullptr);

/// Returns the contacts that can bear a force: those with a gap of at most `largest_gap` [m].
/// Without `largest_gap` these are all contacts, as for grasps at the level of voxels, whose pads
/// are nowhere exactly on the surface.
std::vector<Contact> touching_contacts(std::span<const Contact> contacts,
                                       const std::optional<double>& largest_gap);

/// Says whether `estimate_contacts` would find a contact of this pad if the pad counts. The contact
/// itself is not measured, for the sake of motions that ask many times.
/// @throws InvalidInput as `estimate_contact`.
bool has_contact(const hands::HandModel& hand, int pad, const geometry::RigidTransform& X_OC,
                 const geometry::MeshQuery& object, const ContactEstimationOptions& options);

/// Whether contacts of `pad` are among those that `estimate_contacts` looks for.
bool is_counted(const hands::HandModel& hand, int pad, const ContactEstimationOptions& options);

}  // namespace graspfit::contact
