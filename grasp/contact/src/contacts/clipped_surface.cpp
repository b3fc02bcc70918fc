#include "contacts/clipped_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::contact::internal {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kThinRel = 1e-9;  // height over length of a triangle

/// Returns, ascending, the faces whose boxes meet the prism over the pad's outline that is as high
/// as the pad's clip volume, and some more.
///
/// The query is made tile by tile: the bounding box of a whole pad that stands oblique in O is
/// mostly empty, and holds several times as many faces as are near the pad.
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

/// Returns the half-spaces of a convex volume that may cut a triangle, as far as rounded numbers
/// can tell: an empty list where the triangle certainly lies inside, no value where it certainly
/// lies outside.
///
/// Most triangles need no exact clip then, and the others are clipped without most of the many
/// half-spaces of a curved pad; the half-spaces left out do not change a bit of the result.
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

}  // namespace

FacesInVolume faces_in_clip_volume(const hands::ContactPad& pad, double thickness,
                                   const RigidTransform& X_OC, const geometry::MeshQuery& object) {
  if (!X_OC.matrix().allFinite()) {
    throw base::InvalidInput("estimate_contact: the pose of the pad is not finite");
  }
  thickness = pad.clip_thickness.value_or(thickness);
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

std::vector<geometry::ClippedPiece> clipped_surface(const FacesInVolume& faces,
                                                    const geometry::TriangleMesh& mesh) {
  std::vector<geometry::ClippedPiece> pieces;
  for (const std::int32_t face : faces.inside) {
    const auto [a, b, c] = geometry::corners(mesh, face);
    pieces.push_back({.polygon = {a, b, c},
                      .area = 0.5 * (b - a).cross(c - a).norm(),
                      .centroid = (a + b + c) / 3.0,
                      .face = face});
  }
  for (const CutFace& cut : faces.cut) {
    if (auto piece = geometry::clip(geometry::corners(mesh, cut.face), cut.cutting)) {
      piece->face = cut.face;
      pieces.push_back(std::move(*piece));
    }
  }
  return pieces;
}

std::vector<std::vector<std::size_t>> groups_of(const std::vector<geometry::ClippedPiece>& pieces,
                                                const geometry::TriangleMesh& mesh,
                                                double distance) {
  base::DisjointSets sets(pieces.size());
  const auto unite = [&sets](std::size_t i, std::size_t j) {
    sets.unite(base::as_index<std::int32_t>(i), base::as_index<std::int32_t>(j));
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> piece_at;  // by edge
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& face = mesh.faces[pieces[i].face];
    for (int corner = 0; corner < 3; ++corner) {
      const std::pair edge = std::minmax({face[corner], face[(corner + 1) % 3]});
      const auto [found, is_new] = piece_at.emplace(edge, i);
      if (!is_new) unite(i, found->second);
    }
  }
  const auto groups = [&] {
    const std::vector<std::int32_t> set_of = sets.numbered();
    std::vector<std::vector<std::size_t>> result;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::int32_t set = set_of[i];
      if (set == std::ssize(result)) result.emplace_back();
      result[set].push_back(i);
    }
    return result;
  };
  const std::vector<std::vector<std::size_t>> joined = groups();
  std::vector<Vector3d> centroids;
  for (const std::vector<std::size_t>& group : joined) {
    Vector3d sum = Vector3d::Zero();
    double area = 0.0;
    for (const std::size_t i : group) {
      sum += pieces[i].area * pieces[i].centroid;
      area += pieces[i].area;
    }
    centroids.push_back(sum / area);
  }
  for (std::size_t a = 0; a < joined.size(); ++a) {
    for (std::size_t b = a + 1; b < joined.size(); ++b) {
      if ((centroids[a] - centroids[b]).norm() <= distance) {
        unite(joined[a].front(), joined[b].front());
      }
    }
  }
  return groups();
}

}  // namespace graspfit::contact::internal
