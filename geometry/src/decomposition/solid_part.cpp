#include "decomposition/solid_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "graspfit/base/as_index.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

/// Builds one side of a cut from polygons given by corners of the part that is cut.
class PartBuilder {
 public:
  explicit PartBuilder(const SolidPart& from) : from_(from), index_(from.points.size(), -1) {
    part.starts.push_back(0);
  }

  void add_point(std::int32_t old) {
    if (index_[old] < 0) {
      index_[old] = base::as_index<std::int32_t>(part.points.size());
      part.points.push_back(from_.points[old]);
    }
    part.corners.push_back(index_[old]);
  }
  void add_point(const Vector3d& point) {
    part.corners.push_back(base::as_index<std::int32_t>(part.points.size()));
    part.points.push_back(point);
  }
  void end_polygon(std::int32_t face) {
    if (part.corners.size() < static_cast<std::size_t>(part.starts.back()) + 3) {
      part.corners.resize(part.starts.back());
      return;
    }
    part.starts.push_back(base::as_index<std::int32_t>(part.corners.size()));
    part.faces.push_back(face);
  }

  SolidPart part;

 private:
  const SolidPart& from_;
  std::vector<std::int32_t> index_;
};

Vector3d crossing(const Vector3d& a, double height_a, const Vector3d& b, double height_b) {
  return a + height_a / (height_a - height_b) * (b - a);
}

/// The side of a convex polygon where sign · height ≥ 0; its corners on the plane go to `rim`.
std::vector<Vector3d> half_polygon(const std::vector<Vector3d>& polygon, const CutPlane& plane,
                                   double sign, double on_plane, std::vector<Vector3d>& rim) {
  std::vector<Vector3d> half;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double height_a = sign * plane.height(a);
    const double height_b = sign * plane.height(b);
    if (height_a >= -on_plane) half.push_back(a);
    if (std::abs(height_a) <= on_plane) rim.push_back(a);
    if ((height_a > on_plane && height_b < -on_plane) ||
        (height_a < -on_plane && height_b > on_plane)) {
      half.push_back(crossing(a, height_a, b, height_b));
      rim.push_back(half.back());
    }
  }
  return half;
}

/// The side of a cell where sign · height ≥ 0.
ConvexCell half_cell(const ConvexCell& cell, const CutPlane& plane, double sign, double on_plane) {
  ConvexCell half;
  std::vector<Vector3d> rim;
  for (const std::vector<Vector3d>& polygon : cell) {
    std::vector<Vector3d> side = half_polygon(polygon, plane, sign, on_plane, rim);
    const bool is_flat = std::all_of(side.begin(), side.end(), [&](const Vector3d& p) {
      return std::abs(plane.height(p)) <= on_plane;
    });
    if (side.size() >= 3 && !is_flat) half.push_back(std::move(side));
  }
  if (rim.size() < 3) return half;
  Vector3d center = Vector3d::Zero();
  for (const Vector3d& p : rim) center += p / static_cast<double>(rim.size());
  const Vector3d axis = plane.normal.unitOrthogonal();
  const Vector3d other = plane.normal.cross(axis);
  std::vector<std::pair<double, std::size_t>> around;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    around.emplace_back(std::atan2((rim[i] - center).dot(other), (rim[i] - center).dot(axis)), i);
  }
  std::sort(around.begin(), around.end());
  std::vector<Vector3d> cap;
  for (const auto& [angle, i] : around) {
    if (cap.empty() || (rim[i] - cap.back()).norm() > on_plane) cap.push_back(rim[i]);
  }
  if (cap.size() >= 3) half.push_back(std::move(cap));
  return half;
}

/// Corners of a cell that are deeper inside the solid than `on_plane`: where a cut ran along a
/// face, corners lie on that face, and rounding must not count them as inside.
std::vector<Vector3d> corners_inside(const ConvexCell& cell, double on_plane,
                                     const MeshQuery& solid) {
  std::vector<Vector3d> all;
  for (const std::vector<Vector3d>& polygon : cell) {
    all.insert(all.end(), polygon.begin(), polygon.end());
  }
  const auto less = [](const Vector3d& a, const Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(all.begin(), all.end(), less);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::erase_if(all, [&](const Vector3d& p) { return !(solid.signed_distance(p) < -on_plane); });
  return all;
}

}  // namespace

std::vector<Vector3d> SolidPart::hull_points() const {
  std::vector<Vector3d> all = points;
  all.insert(all.end(), inner_corners.begin(), inner_corners.end());
  return all;
}

SolidPart whole_solid(const MeshQuery& solid) {
  constexpr double kMarginRel = 0.01;  // of the box's diagonal, so that no corner is on the surface
  const TriangleMesh& mesh = solid.mesh();
  SolidPart part;
  part.points = mesh.vertices;
  part.starts.push_back(0);
  for (std::int32_t f = 0; f < std::ssize(mesh.faces); ++f) {
    part.corners.insert(part.corners.end(), mesh.faces[f].begin(), mesh.faces[f].end());
    part.starts.push_back(base::as_index<std::int32_t>(part.corners.size()));
    part.faces.push_back(f);
  }
  Eigen::AlignedBox3d box = solid.box();
  const Vector3d margin = Vector3d::Constant(kMarginRel * box.diagonal().norm());
  box = {box.min() - margin, box.max() + margin};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double end : {box.min()[axis], box.max()[axis]}) {
      std::vector<Vector3d> side;
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (const auto& [at_u, at_v] :
           {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}}) {
        Vector3d p;
        p[axis] = end;
        p[u] = at_u != 0 ? box.max()[u] : box.min()[u];
        p[v] = at_v != 0 ? box.max()[v] : box.min()[v];
        side.push_back(p);
      }
      part.cell.push_back(std::move(side));
    }
  }
  return part;
}

std::pair<SolidPart, SolidPart> cut(const SolidPart& part, const CutPlane& plane, double on_plane,
                                    const MeshQuery& solid) {
  std::vector<double> heights(part.points.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = plane.height(part.points[i]);
    if (std::abs(heights[i]) <= on_plane) heights[i] = 0.0;
  }
  PartBuilder below(part);
  PartBuilder above(part);
  for (std::size_t k = 0; k < part.num_polygons(); ++k) {
    const std::int32_t first = part.starts[k];
    const std::int32_t last = part.starts[k + 1];
    double lowest = heights[part.corners[first]];
    double highest = lowest;
    for (std::int32_t c = first; c < last; ++c) {
      lowest = std::min(lowest, heights[part.corners[c]]);
      highest = std::max(highest, heights[part.corners[c]]);
    }
    const std::int32_t face = part.faces[k];
    if (lowest >= 0.0 || highest <= 0.0) {
      const bool is_in_plane = lowest == 0.0 && highest == 0.0;
      const bool is_below =
          is_in_plane ? vector_area(solid.mesh(), face).dot(plane.normal) > 0.0 : highest <= 0.0;
      PartBuilder& side = is_below ? below : above;
      for (std::int32_t c = first; c < last; ++c) side.add_point(part.corners[c]);
      side.end_polygon(face);
      continue;
    }
    for (std::int32_t c = first; c < last; ++c) {
      const std::int32_t a = part.corners[c];
      const std::int32_t b = part.corners[c + 1 < last ? c + 1 : first];
      if (heights[a] <= 0.0) below.add_point(a);
      if (heights[a] >= 0.0) above.add_point(a);
      if (heights[a] * heights[b] < 0.0) {
        const Vector3d p = crossing(part.points[a], heights[a], part.points[b], heights[b]);
        below.add_point(p);
        above.add_point(p);
      }
    }
    below.end_polygon(face);
    above.end_polygon(face);
  }
  below.part.cell = half_cell(part.cell, plane, -1.0, on_plane);
  above.part.cell = half_cell(part.cell, plane, 1.0, on_plane);
  below.part.inner_corners = corners_inside(below.part.cell, on_plane, solid);
  above.part.inner_corners = corners_inside(above.part.cell, on_plane, solid);
  return {std::move(below.part), std::move(above.part)};
}

}  // namespace graspfit::geometry::internal
