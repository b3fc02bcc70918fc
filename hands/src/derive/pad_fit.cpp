#include "derive/pad_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "derive/ray_grid.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "model/pad_outline.hpp"

namespace graspfit::hands::internal {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::MeshQuery;

constexpr double kFlatLean = 0.2;  // [rad]: chamfers and fillets are no part of a plane
constexpr double kFlatShare = 0.5;
constexpr double kFrontShare = 0.2;  // of a plane that touches first; a facet of a round has less
constexpr double kFrontLean = 0.05;  // [rad]
constexpr double kMaxBridge = 5e-3;  // [m]: a pad over a deeper hollow is made smaller
constexpr double kFillShare = 0.93;
constexpr std::size_t kMaxCorners = 12;
constexpr std::size_t kMaxPlanes = 40;
constexpr double kDomeTolerance = 1e-4;  // [m]

/// Rotation whose z is `direction` and whose x follows `along`.
Eigen::Matrix3d axes(const Vector3d& direction, const Vector3d& along) {
  Eigen::Matrix3d R;
  R.col(2) = direction.normalized();
  Vector3d x = along - along.dot(R.col(2)) * R.col(2);
  if (x.norm() < 1e-6 * along.norm() || x.norm() == 0.0) x = R.col(2).unitOrthogonal();
  R.col(0) = x.normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

std::size_t num_set(const std::vector<bool>& cells) {
  return std::count(cells.begin(), cells.end(), true);
}

/// Convex hull of points of the plane, counter-clockwise from its leftmost corner; corners that
/// stand out by less than 1e-9 of the hull's size are left out, so that rounding makes no corners.
std::vector<Vector2d> hull_of(const std::vector<Vector2d>& points) {
  std::vector<Vector3d> flat;
  for (const Vector2d& p : points) flat.emplace_back(p.x(), p.y(), 0.0);
  const geometry::ConvexHull3 hull = geometry::convex_hull(flat);
  if (hull.rank < 2) return {};
  std::vector<Vector2d> outline;
  for (const std::size_t i : hull.vertices) outline.push_back(points[i]);
  if (area_of(outline) < 0.0) std::reverse(outline.begin(), outline.end());
  const auto is_left = [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  const auto [leftmost, rightmost] = std::minmax_element(outline.begin(), outline.end(), is_left);
  const double least = 1e-9 * (*rightmost - *leftmost).squaredNorm();
  std::rotate(outline.begin(), leftmost, outline.end());
  for (std::size_t i = 0; i < outline.size() && outline.size() >= 3;) {
    const Vector2d& before = outline[(i + outline.size() - 1) % outline.size()];
    const Vector2d& after = outline[(i + 1) % outline.size()];
    if (cross(outline[i] - before, after - outline[i]) <= least) {
      outline.erase(outline.begin() + i);
      i = i > 0 ? i - 1 : 0;  // the corner before may stand out no longer
    } else {
      ++i;
    }
  }
  return outline.size() < 3 ? std::vector<Vector2d>{} : outline;
}

/// The outline without the corners whose removal costs least area, one after the other, until
/// `count` are left.
std::vector<Vector2d> simplified(std::vector<Vector2d> outline, std::size_t count) {
  while (outline.size() > count) {
    std::size_t least = 0;
    double least_area = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vector2d& before = outline[(i + outline.size() - 1) % outline.size()];
      const Vector2d& after = outline[(i + 1) % outline.size()];
      const double area = 0.5 * cross(outline[i] - before, after - before);
      if (area < least_area) {
        least_area = area;
        least = i;
      }
    }
    outline.erase(outline.begin() + least);
  }
  return outline;
}

bool is_inside(const std::vector<Vector2d>& outline, const Vector2d& point) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
    if (cross(edge, point - outline[i]) < 0.0) return false;
  }
  return !outline.empty();
}

/// Share of the cells inside an outline that are set in `cells`.
double fill_share(const RayGrid& grid, const std::vector<bool>& cells,
                  const std::vector<Vector2d>& outline) {
  std::size_t inside = 0;
  std::size_t set = 0;
  for (int y = 0; y < grid.ny; ++y) {
    for (int x = 0; x < grid.nx; ++x) {
      if (!is_inside(outline, grid.center(x, y))) continue;
      ++inside;
      set += cells[grid.index(x, y)] ? 1U : 0U;
    }
  }
  return inside == 0 ? 0.0 : static_cast<double>(set) / static_cast<double>(inside);
}

/// The largest rectangle of set cells, with its corners at cell centers: the surface extends half a
/// cell beyond it.
std::vector<Vector2d> largest_rectangle(const RayGrid& grid, const std::vector<bool>& cells) {
  int best = 0;
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  std::vector<int> height(grid.nx, 0);
  for (int y = 0; y < grid.ny; ++y) {
    for (int x = 0; x < grid.nx; ++x) {
      int& h = height[x];
      h = cells[grid.index(x, y)] ? h + 1 : 0;
    }
    for (int from = 0; from < grid.nx; ++from) {
      int lowest = std::numeric_limits<int>::max();
      for (int to = from; to < grid.nx; ++to) {
        lowest = std::min(lowest, height[to]);
        if (lowest == 0) break;
        const int area = (to - from) * (lowest - 1);
        if (area > best) {
          best = area;
          x0 = from, x1 = to, y0 = y - lowest + 1, y1 = y;
        }
      }
    }
  }
  if (best == 0) return {};
  return {grid.center(x0, y0), grid.center(x1, y0), grid.center(x1, y1), grid.center(x0, y1)};
}

/// A plane n · p = offset of the search frame.
struct Plane {
  Vector3d normal = Vector3d::UnitZ();
  double offset = 0.0;
};

bool lies_on(const Sample& sample, const Plane& plane) {
  return std::abs(plane.normal.dot(sample.point) - plane.offset) <= kFlatTolerance &&
         plane.normal.dot(sample.normal) >= std::cos(kFlatLean);
}

/// The plane through one of the samples that holds most of the part.
std::pair<Plane, std::vector<bool>> best_plane(const RayGrid& grid,
                                               const std::vector<bool>& cells) {
  constexpr std::size_t kNumTrials = 100;
  const std::size_t stride = std::max<std::size_t>(1, num_set(cells) / kNumTrials);
  Plane best;
  std::size_t most = 0;
  std::size_t number = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i] || number++ % stride != 0) continue;
    const Plane plane{grid.samples[i].normal, grid.samples[i].normal.dot(grid.samples[i].point)};
    std::size_t held = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      held += cells[k] && lies_on(grid.samples[k], plane) ? 1U : 0U;
    }
    if (held > most) {
      most = held;
      best = plane;
    }
  }
  std::vector<bool> on(cells.size(), false);
  for (std::size_t k = 0; k < cells.size(); ++k) on[k] = cells[k] && lies_on(grid.samples[k], best);
  return {best, on};
}

/// Corners of the mesh faces that lie in a plane, in the search frame.
std::vector<Vector2d> corners_in(const MeshQuery& link, const Eigen::Matrix3d& R_LS,
                                 const Plane& plane, const Eigen::AlignedBox3d& box_S) {
  std::vector<Vector2d> points;
  for (std::size_t f = 0; f < link.mesh().faces.size(); ++f) {
    const Vector3d normal = R_LS.transpose() * geometry::face_normal(link.mesh(), f);
    if (plane.normal.dot(normal) < std::cos(kFlatLean)) continue;
    std::array<Vector3d, 3> corners = geometry::corners(link.mesh(), f);
    bool is_in = true;
    for (Vector3d& corner : corners) {
      corner = R_LS.transpose() * corner;
      is_in = is_in && std::abs(plane.normal.dot(corner) - plane.offset) <= kFlatTolerance;
    }
    if (!is_in) continue;
    for (const Vector3d& corner : corners) {
      points.emplace_back(std::clamp(corner.x(), box_S.min().x(), box_S.max().x()),
                          std::clamp(corner.y(), box_S.min().y(), box_S.max().y()));
    }
  }
  return points;
}

Vector2d centroid_of(const std::vector<Vector2d>& outline) {
  Vector2d sum = Vector2d::Zero();
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const double part = cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    sum += part * (outline[0] + outline[i] + outline[i + 1]) / 3.0;
    twice += part;
  }
  return sum / twice;
}

/// Largest |height of the mesh over the pad| over cells inside the outline.
double deviation_of(const FittedPad& fitted, const RayGrid& grid, const std::vector<bool>& cells,
                    const Eigen::Matrix3d& R_LS) {
  ContactPad pad;
  pad.outline = fitted.outline;
  pad.surface = fitted.surface;
  pad.planes = surface_planes(pad);
  const RigidTransform X_CL = geometry::inverted(fitted.X_LC);
  double deviation = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i]) continue;
    const Vector3d point_C = X_CL * (R_LS * grid.samples[i].point);
    if (!is_inside(pad.outline, point_C.head<2>())) continue;
    deviation = std::max(deviation, std::abs(height_over_pad(pad, point_C)));
  }
  return deviation;
}

std::optional<FittedPad> flat_pad(const MeshQuery& link, const RayGrid& grid,
                                  const std::vector<bool>& part, const Eigen::Matrix3d& R_LS,
                                  const SearchBox& box, const Vector3d& along) {
  const auto [plane, on] = best_plane(grid, part);
  const auto size = static_cast<double>(num_set(part));
  std::size_t num_parallel = 0;
  bool is_in_front = true;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!part[i]) continue;
    const Sample& sample = grid.samples[i];
    is_in_front = is_in_front && plane.normal.dot(sample.point) - plane.offset <= kFlatTolerance;
    if (on[i] && plane.normal.dot(sample.normal) >= std::cos(kFrontLean)) ++num_parallel;
  }
  const bool is_most = static_cast<double>(num_set(on)) >= kFlatShare * size;
  const bool touches_first = is_in_front && static_cast<double>(num_parallel) >= kFrontShare * size;
  if (!is_most && !touches_first) return std::nullopt;
  std::vector<Vector2d> outline_S = hull_of(corners_in(link, R_LS, plane, box.box_S));
  if (outline_S.size() < 3 || fill_share(grid, on, outline_S) < kFillShare) {
    outline_S = largest_rectangle(grid, on);
  }
  // A rectangle that holds only little of a jagged plane is no pad.
  const double part_area = size * grid.step * grid.step;
  const double least_area = is_most ? 0.0 : 0.5 * kFrontShare * part_area;
  if (outline_S.size() < 3 || !(area_of(outline_S) > least_area)) return std::nullopt;
  outline_S = simplified(std::move(outline_S), kMaxCorners);
  // From the search frame's x and y onto the plane, then into the pad's own axes.
  const auto lifted_L = [&R_LS, &front = plane](const Vector2d& p) -> Vector3d {
    const double z = (front.offset - front.normal.head<2>().dot(p)) / front.normal.z();
    return R_LS * Vector3d(p.x(), p.y(), z);
  };
  FittedPad pad;
  pad.X_LC.linear() = axes(R_LS * plane.normal, along);
  pad.X_LC.translation() = lifted_L(centroid_of(outline_S));
  const RigidTransform X_CL = geometry::inverted(pad.X_LC);
  for (const Vector2d& corner : outline_S) {
    pad.outline.push_back((X_CL * lifted_L(corner)).head<2>());
  }
  pad.area = area_of(pad.outline);
  pad.deviation = deviation_of(pad, grid, on, R_LS);
  return pad;
}

/// The dome over an outline: mesh points, added one after the other where the mesh stands out most.
/// `points_C` in the pad's frame; the first are those over the outline's corners.
std::vector<Vector3d> dome(const std::vector<Vector2d>& outline,
                           const std::vector<Vector3d>& points_C) {
  ContactPad pad;
  pad.outline = outline;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (points_C[i].z() > 0.0) pad.surface.push_back(points_C[i]);
  }
  // A step that would make too many planes is undone.
  std::vector<Vector3d> accepted = pad.surface;
  while (true) {
    pad.planes = surface_planes(pad);
    if (pad.planes.size() > kMaxPlanes) break;
    accepted = pad.surface;
    double highest = kDomeTolerance;
    const Vector3d* next = nullptr;
    for (const Vector3d& point : points_C) {
      const double height = height_over_pad(pad, point);
      if (height <= highest) continue;
      highest = height;
      next = &point;
    }
    if (next == nullptr) break;
    pad.surface.push_back(*next);
    // Points that are inside the hull with the new point are no corners any more.
    pad.planes = surface_planes(pad);
    constexpr double kCovered = 1e-9;  // [m]; rounding of the planes
    std::erase_if(pad.surface,
                  [&](const Vector3d& p) { return height_over_pad(pad, p) < -kCovered; });
  }
  return accepted;
}

std::optional<FittedPad> bulging_pad(const MeshQuery& link, const std::vector<MeshQuery>& others,
                                     const RayGrid& grid, const std::vector<bool>& part,
                                     const Eigen::Matrix3d& R_LS, const SearchBox& box) {
  std::vector<Vector2d> hits_S;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i]) hits_S.push_back(grid.samples[i].point.head<2>());
  }
  std::vector<Vector2d> outline_S = hull_of(hits_S);
  if (outline_S.size() >= 3) outline_S = simplified(std::move(outline_S), kMaxCorners);
  if (outline_S.size() < 3 || fill_share(grid, part, outline_S) < kFillShare) {
    outline_S = largest_rectangle(grid, part);
  }
  if (outline_S.size() < 3 || !(area_of(outline_S) > 0.0)) return std::nullopt;

  const Vector2d middle = centroid_of(outline_S);
  std::vector<Vector3d> points_S;
  for (const Vector2d& corner : outline_S) {
    const Sample sample = probe(link, others, R_LS, corner, box.top);
    points_S.emplace_back(
        corner.x(), corner.y(),
        sample.is_hit ? sample.point.z() : -std::numeric_limits<double>::infinity());
  }
  double base = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!part[i] || !is_inside(outline_S, grid.samples[i].point.head<2>())) continue;
    points_S.push_back(grid.samples[i].point);
    base = std::min(base, grid.samples[i].point.z());
  }
  if (!std::isfinite(base)) return std::nullopt;
  FittedPad pad;
  pad.X_LC.linear() = R_LS;
  pad.X_LC.translation() = R_LS * Vector3d(middle.x(), middle.y(), base);
  for (const Vector2d& corner : outline_S) pad.outline.push_back(corner - middle);
  std::vector<Vector3d> points_C;
  for (const Vector3d& p : points_S) {
    points_C.emplace_back(p.x() - middle.x(), p.y() - middle.y(), std::max(0.0, p.z() - base));
  }
  pad.surface = dome(pad.outline, points_C);
  double height = 0.0;
  for (const Vector3d& p : pad.surface) height = std::max(height, p.z());
  if (height < kFlatTolerance) {
    pad.X_LC.translation() += height * R_LS.col(2);
    pad.surface.clear();
  }
  pad.area = area_of(pad.outline);
  pad.deviation = deviation_of(pad, grid, part, R_LS);
  return pad;
}

/// The bulging pad of a part, or of less and less of the part around its center, until the pad
/// stands off the mesh by at most kMaxBridge; the last pad tried if none does.
std::optional<FittedPad> bulging_pad_without_hollow(const MeshQuery& link,
                                                    const std::vector<MeshQuery>& others,
                                                    const RayGrid& grid, std::vector<bool> part,
                                                    const Eigen::Matrix3d& R_LS,
                                                    const SearchBox& box,
                                                    const std::optional<Vector2d>& given_center) {
  constexpr int kNumTrials = 5;
  constexpr double kShrink = 0.8;
  Vector2d center = Vector2d::Zero();
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i]) center += grid.samples[i].point.head<2>() / static_cast<double>(num_set(part));
  }
  if (given_center) center = *given_center;
  double radius = 0.0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i]) radius = std::max(radius, (grid.samples[i].point.head<2>() - center).norm());
  }
  auto pad = bulging_pad(link, others, grid, part, R_LS, box);
  for (int trial = 0; trial < kNumTrials && pad && pad->deviation > kMaxBridge; ++trial) {
    radius *= kShrink;
    for (std::size_t i = 0; i < part.size(); ++i) {
      part[i] = part[i] && (grid.samples[i].point.head<2>() - center).norm() <= radius;
    }
    const auto smaller = bulging_pad(link, others, grid, part, R_LS, box);
    if (!smaller) break;
    pad = smaller;
  }
  return pad;
}

/// The pad with coordinates in whole micrometers, as a person would write them. Corners and points
/// that rounding puts on a straight line or outside the outline are removed.
FittedPad tidied(FittedPad pad) {
  constexpr double kPerMeter = 1e6;
  const auto rounded = [&](auto v) {
    for (auto& x : v) x = std::round(x * kPerMeter) / kPerMeter + 0.0;  // no negative zero
    return v;
  };
  pad.X_LC.translation() = rounded(Vector3d(pad.X_LC.translation()));
  for (Vector2d& corner : pad.outline) corner = rounded(corner);
  pad.outline = hull_of(pad.outline);
  for (Vector3d& point : pad.surface) point = rounded(point);
  std::erase_if(pad.surface, [&](const Vector3d& point) {
    return point.z() <= 0.0 || !is_inside(pad.outline, point.head<2>());
  });
  return pad;
}

}  // namespace

std::optional<FittedPad> fit_pad(const MeshQuery& link, const std::vector<MeshQuery>& others,
                                 const PadSearch& search) {
  Eigen::Matrix3d R_LS = axes(search.direction, search.along);
  // The second search is along the mean normal of what the first one found.
  for (const bool is_last : {false, true}) {
    const SearchBox box = search_box(link, others, R_LS, search);
    const RayGrid grid = cast(link, others, R_LS, box);
    std::optional<Vector2d> center;
    if (search.center) center = (R_LS.transpose() * *search.center).head<2>();
    const std::vector<bool> part = facing_part(grid, center);
    if (num_set(part) < 4) return std::nullopt;
    if (const auto flat = flat_pad(link, grid, part, R_LS, box, search.along)) return tidied(*flat);
    if (is_last) {
      const auto bulging = bulging_pad_without_hollow(link, others, grid, part, R_LS, box, center);
      return bulging ? std::optional(tidied(*bulging)) : std::nullopt;
    }
    Vector3d mean = Vector3d::Zero();
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (part[i]) mean += grid.samples[i].normal;
    }
    R_LS = axes(R_LS * mean, search.along);
  }
  return std::nullopt;
}

}  // namespace graspfit::hands::internal
