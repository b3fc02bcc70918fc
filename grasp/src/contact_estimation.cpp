#include "graspfit/grasp/contact_estimation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/hands/pad_surface.hpp"
#include "internal/contact_test.hpp"
#include "internal/option_check.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kThinRel = 1e-9;            // height over length of a triangle
constexpr double kSmallestMeanNormal = 0.1;  // A shorter mean says that the normals cancel (A34).

/// Faces whose boxes meet the prism over the pad's outline that reaches as high as its clip volume,
/// and some more; ascending.
///
/// Asked tile by tile: the box of a whole pad that stands oblique in O is mostly air, and holds
/// several times the faces that are near the pad.
std::vector<std::int32_t> faces_near_pad(const hands::ContactPad& pad, double thickness,
                                         const RigidTransform& X_OC,
                                         const geometry::MeshQuery& object) {
  constexpr int kTilesAlongPad = 6;
  constexpr double kRoundingRel = 1e-12;  // far above the rounding of tiles and half-spaces
  Eigen::AlignedBox2d outline;
  for (const Eigen::Vector2d& corner : pad.outline) outline.extend(corner);
  const double height = hands::pad_height(pad) + thickness;
  const double edge = std::max(height, outline.sizes().maxCoeff() / kTilesAlongPad);
  const Eigen::Array2i counts = (outline.sizes().array() / edge).ceil().cast<int>().max(1);
  const Eigen::Vector2d tile = outline.sizes().array() / counts.cast<double>();
  const Vector3d half_sizes_C(tile.x() / 2, tile.y() / 2, height / 2);
  const Vector3d half_sizes_O = X_OC.linear().cwiseAbs() * half_sizes_C;

  std::vector<std::int32_t> faces;
  for (int x = 0; x < counts.x(); ++x) {
    for (int y = 0; y < counts.y(); ++y) {
      const Eigen::Vector2d corner = outline.min() + tile.cwiseProduct(Eigen::Vector2d(x, y));
      const Vector3d center_O = X_OC * (Vector3d(corner.x(), corner.y(), 0.0) + half_sizes_C);
      const double slack =
          kRoundingRel * (center_O.cwiseAbs().maxCoeff() + X_OC.translation().norm() +
                          outline.sizes().norm() + height);
      const Vector3d half = half_sizes_O.array() + slack;
      const std::vector<std::int32_t> found =
          object.faces_near(Eigen::AlignedBox3d(center_O - half, center_O + half));
      faces.insert(faces.end(), found.begin(), found.end());
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

/// The half-spaces of a convex volume that may cut a triangle, as far as rounded numbers can tell:
/// none where it certainly lies inside. Empty where it certainly lies outside.
///
/// Spares the exact clip most triangles, and the others most of the many half-spaces of a curved
/// pad; those left out do not change a bit of its result.
std::optional<geometry::ConvexVolume> cutting_half_spaces(const std::array<Vector3d, 3>& triangle,
                                                          const geometry::ConvexVolume& volume) {
  geometry::ConvexVolume cutting;
  for (const geometry::HalfSpace& half_space : volume) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    double magnitude = std::abs(half_space.offset);
    for (const Vector3d& corner : triangle) {
      const double height = half_space.normal.dot(corner);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
      magnitude = std::max(magnitude, half_space.normal.cwiseAbs().dot(corner.cwiseAbs()));
    }
    // Six roundings of terms no larger than `magnitude`, doubled.
    const double rounding = 12 * std::numeric_limits<double>::epsilon() * magnitude;
    if (lowest - half_space.offset > rounding) return std::nullopt;
    if (highest - half_space.offset >= -rounding) cutting.push_back(half_space);
  }
  return cutting;
}

/// A triangle that only the exact clip can measure.
struct CutFace {
  std::int32_t face = -1;
  geometry::ConvexVolume cutting;
};

/// The object's triangles that may have area in a clip volume, ascending.
struct FacesInVolume {
  std::vector<std::int32_t> inside;  ///< As a whole, and none of them thin.
  std::vector<CutFace> cut;
  bool has_thin = false;  ///< Among those cut: whether it has area at all is for the clip to say.
};

FacesInVolume faces_in_clip_volume(const hands::ContactPad& pad, const RigidTransform& X_OC,
                                   const geometry::MeshQuery& object,
                                   const ContactEstimationOptions& options) {
  const double thickness = pad.clip_thickness.value_or(options.clip_thickness);
  FacesInVolume result;
  const std::vector<std::int32_t> faces = faces_near_pad(pad, thickness, X_OC, object);
  if (faces.empty()) return result;
  const geometry::ConvexVolume volume_O =
      hands::transformed(hands::clip_volume_C(pad, thickness), X_OC);
  for (const std::int32_t face : faces) {
    const std::array<Vector3d, 3> triangle = geometry::corners(object.mesh(), face);
    std::optional<geometry::ConvexVolume> cutting = cutting_half_spaces(triangle, volume_O);
    if (!cutting) continue;
    const auto& [a, b, c] = triangle;
    const bool is_thin = (b - a).cross(c - a).norm() <=
                         kThinRel * std::max((b - a).squaredNorm(), (c - a).squaredNorm());
    result.has_thin = result.has_thin || is_thin;
    if (cutting->empty() && !is_thin) {
      result.inside.push_back(face);
    } else {
      result.cut.push_back({face, std::move(*cutting)});
    }
  }
  return result;
}

/// Sums over the pieces of surface inside a clip volume.
class SurfaceMean {
 public:
  explicit SurfaceMean(geometry::PatchAveraging averaging) : averaging_(averaging) {}

  void add(double area, const Vector3d& centroid_O, const Vector3d& outward_normal_O,
           bool is_weak) {
    const double weight = averaging_ == geometry::PatchAveraging::AreaWeighted ? area : 1.0;
    area_ += area;
    if (is_weak) weak_area_ += area;
    weight_ += weight;
    centroid_O_ += weight * centroid_O;
    outward_normal_O_ += weight * outward_normal_O;
  }

  double area() const { return area_; }
  double weak_area() const { return weak_area_; }
  Vector3d centroid_O() const { return centroid_O_ / weight_; }
  Vector3d outward_normal_O() const { return outward_normal_O_ / weight_; }

 private:
  geometry::PatchAveraging averaging_;
  double area_ = 0.0;
  double weak_area_ = 0.0;
  double weight_ = 0.0;
  Vector3d centroid_O_ = Vector3d::Zero();
  Vector3d outward_normal_O_ = Vector3d::Zero();
};

SurfaceMean mean_over(const FacesInVolume& faces, const geometry::TriangleMesh& mesh,
                      geometry::PatchAveraging averaging,
                      const std::function<bool(std::int32_t)>& is_weak) {
  SurfaceMean mean(averaging);
  for (const std::int32_t face : faces.inside) {
    const auto [a, b, c] = geometry::corners(mesh, face);
    const Vector3d twice_area = (b - a).cross(c - a);
    mean.add(0.5 * twice_area.norm(), (a + b + c) / 3.0, twice_area.normalized(), is_weak(face));
  }
  for (const CutFace& cut : faces.cut) {
    if (const auto piece = geometry::clip(geometry::corners(mesh, cut.face), cut.cutting)) {
      mean.add(piece->area, piece->centroid, geometry::face_normal(mesh, cut.face),
               is_weak(cut.face));
    }
  }
  return mean;
}

bool is_contact(const SurfaceMean& mean) {
  return mean.area() > 0.0 && mean.outward_normal_O().norm() >= kSmallestMeanNormal;
}

/// Whether the normals of all faces are so alike that no mean of them is too short for a contact.
bool are_normals_alike(const FacesInVolume& faces, const geometry::TriangleMesh& mesh) {
  constexpr double kAlike = 2.0 * kSmallestMeanNormal;  // its component along the first one
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
  internal::require(pad >= 0 && pad < static_cast<int>(hand.pads.size()), "estimate_contact", "pad",
                    pad, "an index into the pads of hand " + hand.name);
}

}  // namespace

std::optional<double> pad_gap(const geometry::MeshQuery& pad_surface_L, const RigidTransform& X_OL,
                              const geometry::MeshQuery& object, double enough) {
  const auto nearest = geometry::nearest_points(object, pad_surface_L, X_OL, enough);
  return nearest ? std::optional<double>(nearest->distance) : std::nullopt;
}

void ContactEstimationOptions::validate() const {
  internal::require(clip_thickness > 0.0 && std::isfinite(clip_thickness),
                    "ContactEstimationOptions", "clip_thickness", clip_thickness,
                    "finite and above 0");
}

std::optional<Contact> estimate_contact(const hands::HandModel& hand, int pad_index,
                                        const RigidTransform& X_OC,
                                        const geometry::MeshQuery& object,
                                        const ContactEstimationOptions& options,
                                        const geometry::WeakRegions* weak_regions) {
  options.validate();
  require_pad(hand, pad_index);
  if (weak_regions && weak_regions->is_weak.size() != object.mesh().faces.size()) {
    throw geometry::InvalidInput(
        "estimate_contact: weak regions of " + std::to_string(weak_regions->is_weak.size()) +
        " faces for a mesh of " + std::to_string(object.mesh().faces.size()));
  }
  const bool knows_weak = weak_regions && weak_regions->outcome != geometry::WeakOutcome::TooCoarse;
  const auto is_weak = [&](std::int32_t face) { return knows_weak && weak_regions->is_weak[face]; };
  const hands::ContactPad& pad = hand.pads[pad_index];
  const FacesInVolume faces = faces_in_clip_volume(pad, X_OC, object, options);
  const SurfaceMean mean = mean_over(faces, object.mesh(), options.averaging, is_weak);
  if (!is_contact(mean)) return std::nullopt;

  const RigidTransform X_CO = X_OC.inverse();
  Contact contact;
  contact.point_O = object.closest_point(mean.centroid_O()).point;
  contact.inward_normal_O = -mean.outward_normal_O().normalized();
  contact.area = mean.area();
  contact.pad_boundary_distance = hands::boundary_distance(pad, (X_CO * contact.point_O).head<2>());
  contact.gap = pad_gap(geometry::MeshQuery(hands::pad_surface_L(hand, pad_index)),
                        X_OC * pad.X_LC.inverse(), object, kNoLimit)
                    .value_or(kNoLimit);
  contact.link = pad.link;
  contact.pad = pad_index;
  contact.finger = pad.finger;
  if (knows_weak) contact.weak = 2.0 * mean.weak_area() >= mean.area();
  return contact;
}

bool has_contact(const hands::HandModel& hand, int pad, const RigidTransform& X_OC,
                 const geometry::MeshQuery& object, const ContactEstimationOptions& options) {
  options.validate();
  require_pad(hand, pad);
  const geometry::TriangleMesh& mesh = object.mesh();
  const FacesInVolume faces =
      faces_in_clip_volume(hand.pads[static_cast<std::size_t>(pad)], X_OC, object, options);
  if (faces.inside.empty() && faces.cut.empty()) return false;
  if (!are_normals_alike(faces, mesh)) {
    return is_contact(
        mean_over(faces, mesh, options.averaging, [](std::int32_t) { return false; }));
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
  if (X_OL.size() != hand.links.size()) {
    throw geometry::InvalidInput("estimate_contacts: " + std::to_string(X_OL.size()) +
                                 " link poses for the " + std::to_string(hand.links.size()) +
                                 " links of hand " + hand.name);
  }
  std::vector<Contact> contacts;
  for (int pad = 0; pad < static_cast<int>(hand.pads.size()); ++pad) {
    if (const auto contact = estimate_contact(hand, pad, hands::pad_pose(hand, pad, X_OL), object,
                                              options, weak_regions)) {
      contacts.push_back(*contact);
    }
  }
  return contacts;
}

}  // namespace graspfit::grasp
