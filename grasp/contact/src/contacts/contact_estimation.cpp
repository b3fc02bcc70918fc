#include "graspfit/contact/contact_estimation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "contacts/clipped_surface.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/hands/pad_surface.hpp"

namespace graspfit::contact {
namespace {

using Eigen::Vector3d;
using geometry::ClippedPiece;
using geometry::RigidTransform;
using internal::CutFace;
using internal::FacesInVolume;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kSmallestMeanNormal = 0.1;  // A shorter mean says that the normals cancel.
constexpr double kLooksAway = 0.5;  // least cosine between outward normal and pressing direction

/// What the estimation needs besides a pad and the pieces of surface in its clip volume.
struct Scene {
  const hands::HandModel& hand;
  const geometry::MeshQuery& object;
  const ContactEstimationOptions& options;
  const geometry::WeakRegions* weak_regions;

  bool knows_weak() const {
    return weak_regions && weak_regions->outcome != geometry::WeakOutcome::TooCoarse;
  }
};

/// Sums over pieces of surface.
struct SurfaceMean {
  double area = 0.0;
  double weak_area = 0.0;
  double weight = 0.0;
  Vector3d weighted_centroid_O = Vector3d::Zero();
  Vector3d weighted_normal_O = Vector3d::Zero();

  Vector3d centroid_O() const { return weighted_centroid_O / weight; }
  Vector3d outward_normal_O() const { return weighted_normal_O / weight; }
  bool is_contact() const { return area > 0.0 && outward_normal_O().norm() >= kSmallestMeanNormal; }
};

using Group = std::vector<std::size_t>;

SurfaceMean mean_over(const std::vector<ClippedPiece>& pieces, const Group& group,
                      const Scene& scene) {
  SurfaceMean mean;
  for (const std::size_t i : group) {
    const ClippedPiece& piece = pieces[i];
    const double weight =
        scene.options.averaging == geometry::PatchAveraging::AreaWeighted ? piece.area : 1.0;
    mean.area += piece.area;
    if (scene.knows_weak() && scene.weak_regions->is_weak[piece.face]) mean.weak_area += piece.area;
    mean.weight += weight;
    mean.weighted_centroid_O += weight * piece.centroid;
    mean.weighted_normal_O += weight * geometry::face_normal(scene.object.mesh(), piece.face);
  }
  return mean;
}

/// Faces that may have area in the pad's clip volume and that count.
FacesInVolume counted_faces(const hands::ContactPad& pad, const RigidTransform& X_OC,
                            const geometry::MeshQuery& object,
                            const ContactEstimationOptions& options) {
  FacesInVolume faces = internal::faces_in_clip_volume(pad, options.clip_thickness, X_OC, object);
  if (options.faces == ContactFaces::All) return faces;
  const Vector3d pressing_O = X_OC.linear().col(2);
  const auto looks_away = [&](std::int32_t face) {
    return geometry::face_normal(object.mesh(), face).dot(pressing_O) > kLooksAway;
  };
  std::erase_if(faces.inside, looks_away);
  std::erase_if(faces.cut, [&](const CutFace& cut) { return looks_away(cut.face); });
  return faces;
}

/// Pieces that make one contact together.
std::vector<Group> contact_groups(const std::vector<ClippedPiece>& pieces,
                                  const hands::ContactPad& pad, const Scene& scene) {
  if (pieces.empty()) return {};
  if (scene.options.pieces == ContactPieces::Separate) {
    return internal::groups_of(pieces, scene.object.mesh(), hands::largest_boundary_distance(pad));
  }
  Group all(pieces.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return {all};
}

/// The point of the pieces that is nearest to `point_O`.
Vector3d nearest_on(const std::vector<ClippedPiece>& pieces, const Group& group,
                    const Vector3d& point_O) {
  Vector3d nearest = geometry::closest_point(pieces[group.front()], point_O);
  for (const std::size_t i : group) {
    const Vector3d candidate = geometry::closest_point(pieces[i], point_O);
    if ((candidate - point_O).squaredNorm() < (nearest - point_O).squaredNorm()) {
      nearest = candidate;
    }
  }
  return nearest;
}

/// The faces of a group's pieces, as a mesh of their own.
geometry::TriangleMesh faces_of(const std::vector<ClippedPiece>& pieces, const Group& group,
                                const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh result;
  for (const std::size_t i : group) {
    const auto first = base::as_index<std::int32_t>(result.vertices.size());
    const std::array<Vector3d, 3> corners = geometry::corners(mesh, pieces[i].face);
    result.vertices.insert(result.vertices.end(), corners.begin(), corners.end());
    result.faces.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// All contacts of a pad.
std::vector<Contact> contacts_of(int pad_index, const RigidTransform& X_OC, const Scene& scene) {
  const hands::ContactPad& pad = scene.hand.pads[pad_index];
  const geometry::TriangleMesh& mesh = scene.object.mesh();
  const std::vector<ClippedPiece> pieces =
      internal::clipped_surface(counted_faces(pad, X_OC, scene.object, scene.options), mesh);
  const std::vector<Group> groups = contact_groups(pieces, pad, scene);
  const RigidTransform X_CO = geometry::inverted(X_OC);
  std::vector<Contact> contacts;
  for (const Group& group : groups) {
    const SurfaceMean mean = mean_over(pieces, group, scene);
    if (!mean.is_contact()) continue;
    const auto gap_to = [&](const geometry::MeshQuery& surface) {
      return pad_gap(geometry::MeshQuery(hands::pad_surface_L(scene.hand, pad_index)),
                     X_OC * geometry::inverted(pad.X_LC), surface, kNoLimit)
          .value_or(kNoLimit);
    };
    Contact contact;
    contact.point_O = nearest_on(pieces, group, mean.centroid_O());
    contact.inward_normal_O = -mean.outward_normal_O().normalized();
    contact.area = mean.area;
    contact.pad_boundary_distance =
        hands::boundary_distance(pad, (X_CO * contact.point_O).head<2>());
    contact.gap = groups.size() == 1 ? gap_to(scene.object)
                                     : gap_to(geometry::MeshQuery(faces_of(pieces, group, mesh)));
    contact.link = pad.link;
    contact.pad = pad_index;
    contact.finger = pad.finger;
    if (scene.knows_weak()) contact.weak = 2.0 * mean.weak_area >= mean.area;
    contacts.push_back(contact);
  }
  return contacts;
}

/// Whether the normals of all faces are so alike that no mean of them is too short for a contact.
bool are_normals_alike(const FacesInVolume& faces, const geometry::TriangleMesh& mesh) {
  constexpr double kAlike = 2.0 * kSmallestMeanNormal;  // least cosine to the first normal
  if (faces.has_thin) return false;
  const Vector3d first =
      geometry::face_normal(mesh, faces.inside.empty() ? faces.cut[0].face : faces.inside[0]);
  const auto is_alike = [&](std::int32_t face) {
    return geometry::face_normal(mesh, face).dot(first) >= kAlike;
  };
  return std::all_of(faces.inside.begin(), faces.inside.end(), is_alike) &&
         std::all_of(faces.cut.begin(), faces.cut.end(),
                     [&](const CutFace& cut) { return is_alike(cut.face); });
}

void require_pad(const hands::HandModel& hand, int pad) {
  base::require(pad >= 0 && pad < std::ssize(hand.pads), "estimate_contact", "pad", pad,
                "an index into the pads of hand " + hand.name);
}

void require_weak_regions_of(const geometry::TriangleMesh& mesh,
                             const geometry::WeakRegions* weak_regions) {
  if (weak_regions && weak_regions->is_weak.size() != mesh.faces.size()) {
    throw base::InvalidInput("estimate_contact: weak regions of " +
                             std::to_string(weak_regions->is_weak.size()) +
                             " faces for a mesh of " + std::to_string(mesh.faces.size()));
  }
}

}  // namespace

std::optional<double> pad_gap(const geometry::MeshQuery& pad_surface_L, const RigidTransform& X_OL,
                              const geometry::MeshQuery& object, double enough) {
  const auto nearest = geometry::nearest_points(object, pad_surface_L, X_OL, enough);
  return nearest ? std::optional<double>(nearest->distance) : std::nullopt;
}

void ContactEstimationOptions::validate() const {
  base::require(clip_thickness > 0.0 && std::isfinite(clip_thickness), "ContactEstimationOptions",
                "clip_thickness", clip_thickness, "finite and above 0");
}

std::optional<Contact> estimate_contact(const hands::HandModel& hand, int pad,
                                        const RigidTransform& X_OC,
                                        const geometry::MeshQuery& object,
                                        const ContactEstimationOptions& options,
                                        const geometry::WeakRegions* weak_regions) {
  options.validate();
  require_pad(hand, pad);
  require_weak_regions_of(object.mesh(), weak_regions);
  ContactEstimationOptions joined = options;
  joined.pieces = ContactPieces::Joined;
  const std::vector<Contact> contacts =
      contacts_of(pad, X_OC, {hand, object, joined, weak_regions});
  return contacts.empty() ? std::nullopt : std::optional(contacts.front());
}

bool is_counted(const hands::HandModel& hand, int pad, const ContactEstimationOptions& options) {
  if (options.pads == CountedPads::All) return true;
  const std::optional<int>& finger = hand.pads[pad].finger;
  return !finger || hand.fingers[*finger].tip_pad == pad;
}

bool has_contact(const hands::HandModel& hand, int pad, const RigidTransform& X_OC,
                 const geometry::MeshQuery& object, const ContactEstimationOptions& options) {
  options.validate();
  require_pad(hand, pad);
  const geometry::TriangleMesh& mesh = object.mesh();
  const hands::ContactPad& description = hand.pads[pad];
  const FacesInVolume faces = counted_faces(description, X_OC, object, options);
  if (faces.inside.empty() && faces.cut.empty()) return false;
  if (!are_normals_alike(faces, mesh)) {
    const Scene scene{hand, object, options, nullptr};
    const std::vector<ClippedPiece> pieces = internal::clipped_surface(faces, mesh);
    const std::vector<Group> groups = contact_groups(pieces, description, scene);
    return std::any_of(groups.begin(), groups.end(), [&](const Group& group) {
      return mean_over(pieces, group, scene).is_contact();
    });
  }
  return !faces.inside.empty() ||
         std::any_of(faces.cut.begin(), faces.cut.end(), [&](const CutFace& cut) {
           const auto piece = geometry::clip(geometry::corners(mesh, cut.face), cut.cutting);
           return piece && piece->area > 0.0;
         });
}

std::vector<Contact> estimate_contacts(const hands::HandModel& hand,
                                       const std::vector<RigidTransform>& X_OL,
                                       const geometry::MeshQuery& object,
                                       const ContactEstimationOptions& options,
                                       const geometry::WeakRegions* weak_regions) {
  options.validate();
  require_weak_regions_of(object.mesh(), weak_regions);
  if (X_OL.size() != hand.links.size()) {
    throw base::InvalidInput("estimate_contacts: " + std::to_string(X_OL.size()) +
                             " link poses for the " + std::to_string(hand.links.size()) +
                             " links of hand " + hand.name);
  }
  const Scene scene{hand, object, options, weak_regions};
  std::vector<Contact> contacts;
  for (int pad = 0; pad < std::ssize(hand.pads); ++pad) {
    if (!is_counted(hand, pad, options)) continue;
    const std::vector<Contact> of_pad = contacts_of(pad, hands::pad_pose(hand, pad, X_OL), scene);
    contacts.insert(contacts.end(), of_pad.begin(), of_pad.end());
  }
  return contacts;
}

std::vector<Contact> touching_contacts(std::span<const Contact> contacts,
                                       const std::optional<double>& largest_gap) {
  std::vector<Contact> touching;
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(touching),
               [&](const Contact& contact) { return !largest_gap || contact.gap <= *largest_gap; });
  return touching;
}

}  // namespace graspfit::contact
