#include "geometry/traced_clip.hpp"

#include <algorithm>
#include <utility>

#include "exact/predicates.hpp"

namespace graspfit::testing {

using geometry::internal::CutCorner;
using geometry::internal::CutEdge;
using geometry::internal::CutPolygon;
using geometry::internal::TriangleCutter;

TracedPolygon ClipTracer::clip(const Triangle& triangle, const geometry::ConvexVolume& volume) {
  if (!begin(triangle)) return {};
  CutPolygon polygon;
  cutter_.whole(polygon);
  for (const auto& [normal, offset] : volume) {
    planes_.push_back({-1, static_cast<int>(planes_.size())});
    const std::uint32_t line = cutter_.add_plane(normal, offset);
    CutPolygon inside;
    cutter_.split(polygon, line, TriangleCutter::InPlane::Inside, inside, nullptr);
    if (inside.empty()) return {};
    polygon = std::move(inside);
  }
  return traced(polygon);
}

std::map<std::int64_t, TracedPolygon> ClipTracer::clip_by_voxels(
    const Triangle& triangle, const geometry::VoxelLattice& lattice) {
  pieces_.clear();
  if (!begin(triangle)) return {};
  lattice_ = &lattice;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    first_[axis] = 0;
    while (lattice.plane(axis, first_[axis] + 1) <= low) ++first_[axis];
    last_[axis] = first_[axis];
    first_line_[axis] = static_cast<std::uint32_t>(3 + planes_.size());
    for (; lattice.plane(axis, last_[axis] + 1) < high; ++last_[axis]) {
      cutter_.add_axis_plane(axis, lattice.plane(axis, last_[axis] + 1));
      planes_.push_back({axis, last_[axis] + 1});
    }
  }
  CutPolygon whole;
  cutter_.whole(whole);
  cut_along(2, whole);
  return std::move(pieces_);
}

// Returns false if the corners are collinear.
bool ClipTracer::begin(const Triangle& triangle) {
  planes_.clear();
  const auto& [a, b, c] = triangle;
  if (geometry::internal::accurate_vector_area(a, b, c).isZero(0.0)) return false;
  cutter_.reset(triangle);
  return true;
}

// Cuts slab by slab, without the product's short cuts past planes that a polygon cannot reach.
void ClipTracer::cut_along(int axis, CutPolygon rest) {
  for (int i = first_[axis]; i <= last_[axis] && !rest.empty(); ++i) {
    CutPolygon piece;
    CutPolygon beyond;
    if (i == last_[axis]) {
      piece = rest;
    } else {
      const std::uint32_t line = first_line_[axis] + static_cast<std::uint32_t>(i - first_[axis]);
      cutter_.split(rest, line, TriangleCutter::InPlane::Outside, piece, &beyond);
    }
    rest = beyond;
    if (piece.empty()) continue;
    voxel_[axis] = i;
    if (axis > 0) {
      cut_along(axis - 1, piece);
    } else {
      pieces_[lattice_->index(voxel_)] = traced(piece);
    }
  }
}

TracedPolygon ClipTracer::traced(const CutPolygon& polygon) {
  TracedPolygon result;
  for (const CutEdge& of : polygon) {
    result.corners.push_back(cutter_.corner(of).point);
    result.origins.push_back(origin(of));
  }
  result.measure = cutter_.measure(polygon);
  return result;
}

CornerOrigin ClipTracer::origin(const CutEdge& of) const {
  CornerOrigin result;
  if (of.corner < 3) {
    result.kind = CornerOrigin::Kind::Vertex;
    result.vertex = static_cast<int>(of.corner);
    return result;
  }
  const CutCorner& corner = cutter_.corner(of);
  const auto [first, second] = std::minmax(corner.line_a, corner.line_b);
  if (first < 3) {
    // The line of a vertex is the edge that does not touch it.
    result.kind = CornerOrigin::Kind::EdgeAndPlane;
    result.edge = static_cast<int>((first + 1) % 3);
    result.planes[0] = planes_.at(second - 3);
  } else {
    result.kind = CornerOrigin::Kind::TwoPlanes;
    result.planes = {planes_.at(first - 3), planes_.at(second - 3)};
  }
  return result;
}

}  // namespace graspfit::testing
