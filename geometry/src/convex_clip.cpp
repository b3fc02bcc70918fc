#include "graspfit/geometry/convex_clip.hpp"

#include <cmath>
#include <utility>

#include "graspfit/geometry/errors.hpp"
#include "internal/predicates.hpp"
#include "internal/triangle_clip.hpp"

namespace graspfit::geometry {
namespace {

class Clipper {
 public:
  explicit Clipper(const ConvexVolume& volume) : volume_(volume) {
    for (std::size_t i = 0; i < volume.size(); ++i) {
      if (!volume[i].normal.allFinite() || !std::isfinite(volume[i].offset)) {
        throw InvalidInput("clip: half-space " + std::to_string(i) + " is not finite");
      }
    }
  }

  std::optional<ClippedPiece> clip(const std::array<Eigen::Vector3d, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    if (internal::are_collinear(a, b, c)) return std::nullopt;
    cutter_.reset(triangle);
    cutter_.whole(polygon_);
    for (const HalfSpace& half_space : volume_) {
      const std::uint32_t line = cutter_.add_plane(half_space.normal, half_space.offset);
      cutter_.split(polygon_, line, internal::TriangleCutter::InPlane::Inside, rest_, nullptr);
      std::swap(polygon_, rest_);
      if (polygon_.empty()) return std::nullopt;
    }
    const internal::CutMeasure measure = cutter_.measure(polygon_);
    ClippedPiece piece;
    piece.area = measure.fraction * internal::accurate_vector_area(a, b, c).stableNorm();
    piece.centroid = measure.centroid;
    for (const internal::CutCorner& corner : polygon_) piece.polygon.push_back(corner.point);
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
    if (auto piece = clipper.clip(corners(mesh, static_cast<std::size_t>(face)))) {
      piece->face = face;
      pieces.push_back(std::move(*piece));
    }
  }
  return pieces;
}

}  // namespace graspfit::geometry
