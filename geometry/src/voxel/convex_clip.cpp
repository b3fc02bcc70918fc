#include "graspfit/geometry/convex_clip.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "exact/predicates.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "query/indexed_triangle.hpp"
#include "voxel/triangle_clip.hpp"

namespace graspfit::geometry {
namespace {

void require_face(const TriangleMesh& mesh, std::int32_t face) {
  if (face < 0 || face >= std::ssize(mesh.faces)) {
    throw base::InvalidInput("clip: face " + std::to_string(face) + " of " +
                             std::to_string(mesh.faces.size()));
  }
  for (const std::int32_t vertex : mesh.faces[face]) {
    if (vertex >= 0 && vertex < std::ssize(mesh.vertices)) continue;
    throw base::InvalidInput("clip: face " + std::to_string(face) + " has vertex " +
                             std::to_string(vertex) + " of " +
                             std::to_string(mesh.vertices.size()));
  }
}

class Clipper {
 public:
  explicit Clipper(const ConvexVolume& volume) : volume_(volume) {
    for (std::size_t i = 0; i < volume.size(); ++i) {
      if (!volume[i].normal.allFinite() || !std::isfinite(volume[i].offset)) {
        throw base::InvalidInput("clip: half-space " + std::to_string(i) + " is not finite");
      }
    }
  }

  std::optional<ClippedPiece> clip(const std::array<Eigen::Vector3d, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    if (!a.allFinite() || !b.allFinite() || !c.allFinite()) {
      throw base::InvalidInput("clip: a corner of the triangle is not finite");
    }
    polygon_.clear();
    const Eigen::Vector3d vector_area = internal::accurate_vector_area(a, b, c);
    if (vector_area.isZero(0.0)) return std::nullopt;  // The corners are collinear.
    cutter_.reset(triangle);
    cutter_.whole(polygon_);
    for (const auto& [normal, offset] : volume_) {
      const std::uint32_t line = cutter_.add_plane(normal, offset);
      cutter_.split(polygon_, line, internal::TriangleCutter::InPlane::Inside, rest_, nullptr);
      std::swap(polygon_, rest_);
      if (polygon_.empty()) return std::nullopt;
    }
    const internal::CutMeasure measure = cutter_.measure(polygon_);
    ClippedPiece piece;
    piece.area = measure.fraction * vector_area.stableNorm();
    piece.centroid = measure.centroid;
    piece.polygon.reserve(polygon_.size());
    for (const internal::CutEdge& of : polygon_) piece.polygon.push_back(cutter_.corner(of).point);
    return piece;
  }

 private:
  const ConvexVolume& volume_;
  internal::TriangleCutter cutter_;
  internal::CutPolygon polygon_;
  internal::CutPolygon rest_;
};

}  // namespace

std::optional<ClippedPiece> clip(const std::array<Eigen::Vector3d, 3>& triangle,
                                 const ConvexVolume& volume) {
  return Clipper(volume).clip(triangle);
}

std::vector<ClippedPiece> clip(const TriangleMesh& mesh, std::span<const std::int32_t> faces,
                               const ConvexVolume& volume) {
  Clipper clipper(volume);
  std::vector<ClippedPiece> pieces;
  for (const std::int32_t face : faces) {
    require_face(mesh, face);
    if (auto piece = clipper.clip(corners(mesh, face))) {
      piece->face = face;
      pieces.push_back(std::move(*piece));
    }
  }
  return pieces;
}

Eigen::Vector3d closest_point(const ClippedPiece& piece, const Eigen::Vector3d& point) {
  const std::vector<Eigen::Vector3d>& corners = piece.polygon;
  base::require(!corners.empty(), "closest_point", "number of the piece's corners", 0,
                "at least 1");
  if (!point.allFinite()) throw base::InvalidInput("closest_point: the point is not finite");
  Eigen::Vector3d closest = corners.front();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Eigen::Vector3d candidate =
        internal::closest_on_triangle(point, {corners[0], corners[i], corners[i + 1]});
    if ((candidate - point).squaredNorm() < (closest - point).squaredNorm()) closest = candidate;
  }
  return closest;
}

}  // namespace graspfit::geometry
