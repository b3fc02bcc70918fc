#include "graspfit/geometry/likely_rest_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/used_vertices.hpp"
#include "hull/support_margin.hpp"
#include "mesh/input_check.hpp"

namespace graspfit::geometry {

using Eigen::Vector3d;

namespace {

constexpr double kSameHeight = 1e-12;  // of heights: facets of one plane are one rest

/// A triangle of the hull that may lie on the plane.
struct Facet {
  std::array<std::size_t, 3> corners{};     ///< Counter-clockwise from outside.
  std::array<std::int32_t, 3> neighbors{};  ///< Beyond the edge from corner k to the next.
  /// Per edge, how far the center's projection to the facet is beyond it; negative inside.
  std::array<double, 3> beyond{};
  Vector3d outward = Vector3d::Zero();
  double height = 0.0;       ///< Of the center above the facet.
  double solid_angle = 0.0;  ///< Under which the center sees it.
};

/// Two facets that rests roll to, and how high the center is on the lowest way between them found.
struct Pass {
  double height = 0.0;
  std::int32_t a = 0;
  std::int32_t b = 0;
};

/// Van Oosterom and Strackee, IEEE Trans. Biomedical Engineering 30(2), 1983.
double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double na = a.norm(), nb = b.norm(), nc = c.norm();
  const double denominator = na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), denominator);
}

class Rolling {
 public:
  Rolling(const std::vector<Vector3d>& points, const ConvexHull3& hull, const Vector3d& center);

  /// Per facet, the one on which a solid that met the plane there comes to rest.
  std::vector<std::int32_t> rests() const;
  /// The edges between facets that roll to different rests, the lowest pass first.
  std::vector<Pass> passes(const std::vector<std::int32_t>& rests) const;
  const std::vector<Facet>& facets() const { return facets_; }

 private:
  void find_neighbors();

  const std::vector<Vector3d>& points_;
  const Vector3d center_;
  std::vector<Facet> facets_;
};

Rolling::Rolling(const std::vector<Vector3d>& points, const ConvexHull3& hull,
                 const Vector3d& center)
    : points_(points), center_(center) {
  for (const HullFacet& corners : hull.facets) {
    facets_.push_back({.corners = {corners[0], corners[1], corners[2]}});
  }
  find_neighbors();
  for (Facet& facet : facets_) {
    const std::array<Vector3d, 3> p = {points[facet.corners[0]] - center,
                                       points[facet.corners[1]] - center,
                                       points[facet.corners[2]] - center};
    const Vector3d across = (p[1] - p[0]).cross(p[2] - p[0]);
    facet.outward = across.stableNormalized();
    facet.height = facet.outward.dot(p[0]);
    if (!(facet.height > 0.0)) {
      throw base::InvalidInput(
          "likely_rest_poses: the center of mass is not inside the convex hull");
    }
    facet.solid_angle = solid_angle(p[0], p[1], p[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d along = (p[(k + 1) % 3] - p[k]).stableNormalized();
      facet.beyond[k] = along.cross(p[k]).dot(facet.outward);
    }
  }
}

void Rolling::find_neighbors() {
  std::map<std::pair<std::size_t, std::size_t>, std::int32_t> facet_at;
  for (std::int32_t f = 0; f < std::ssize(facets_); ++f) {
    const auto& corners = facets_[f].corners;
    for (std::size_t k = 0; k < 3; ++k) facet_at[{corners[k], corners[(k + 1) % 3]}] = f;
  }
  for (Facet& facet : facets_) {
    for (std::size_t k = 0; k < 3; ++k) {
      facet.neighbors[k] = facet_at.at({facet.corners[(k + 1) % 3], facet.corners[k]});
    }
  }
}

std::vector<std::int32_t> Rolling::rests() const {
  std::vector<std::int32_t> rests(facets_.size(), -1);
  std::vector<std::int32_t> way;
  for (std::int32_t start = 0; start < std::ssize(facets_); ++start) {
    way.clear();
    std::int32_t at = start;
    // Between facets of one plane rounding might lead around in a circle, which ends there.
    while (rests[at] < 0 && std::find(way.begin(), way.end(), at) == way.end()) {
      way.push_back(at);
      const Facet& facet = facets_[at];
      const auto farthest = std::max_element(facet.beyond.begin(), facet.beyond.end());
      if (*farthest > 0.0) at = facet.neighbors[farthest - facet.beyond.begin()];
    }
    const std::int32_t rest = rests[at] < 0 ? at : rests[at];
    for (const std::int32_t facet : way) rests[facet] = rest;
  }
  return rests;
}

std::vector<Pass> Rolling::passes(const std::vector<std::int32_t>& rests) const {
  std::vector<Pass> passes;
  for (std::int32_t a = 0; a < std::ssize(facets_); ++a) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t b = facets_[a].neighbors[k];
      if (b < a || rests[a] == rests[b]) continue;
      const auto& back = facets_[b].neighbors;
      const std::size_t edge_of_b = std::find(back.begin(), back.end(), a) - back.begin();
      double height = std::max(facets_[a].height, facets_[b].height);
      if (facets_[a].beyond[k] <= 0.0 && facets_[b].beyond[edge_of_b] <= 0.0) {
        // Tipping over the edge, the center comes vertically above it.
        const Vector3d start = points_[facets_[a].corners[k]] - center_;
        const Vector3d end = points_[facets_[a].corners[(k + 1) % 3]] - center_;
        height = std::max(height, (end - start).stableNormalized().cross(start).norm());
      }
      passes.push_back({height, rests[a], rests[b]});
    }
  }
  std::stable_sort(passes.begin(), passes.end(),
                   [](const Pass& x, const Pass& y) { return x.height < y.height; });
  return passes;
}

/// Sets of facets, each with its lowest one.
class Valleys {
 public:
  explicit Valleys(const std::vector<Facet>& facets) : facets_(facets), parents_(facets.size()) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }
  std::int32_t lowest(std::int32_t facet) const {
    while (parents_[facet] != facet) facet = parents_[facet];
    return facet;
  }
  /// Joins the valleys of two lowest facets.
  void join(std::int32_t a, std::int32_t b) {
    const bool is_a_lower = std::pair(facets_[a].height, a) < std::pair(facets_[b].height, b);
    parents_[is_a_lower ? b : a] = is_a_lower ? a : b;
  }

 private:
  const std::vector<Facet>& facets_;
  std::vector<std::int32_t> parents_;
};

/// Per facet, the rest as which it counts: the one that it rolls to, or a lower one that is less
/// than `least_lift` away.
std::vector<std::int32_t> distinct_rests(const Rolling& rolling, double least_lift) {
  const std::vector<Facet>& facets = rolling.facets();
  const std::vector<std::int32_t> rests = rolling.rests();
  Valleys flooded(facets);  // by which passes lead where the solid has not been
  Valleys same(facets);
  for (const Pass& pass : rolling.passes(rests)) {
    const std::int32_t a = flooded.lowest(pass.a);
    const std::int32_t b = flooded.lowest(pass.b);
    if (a == b) continue;
    const std::int32_t higher = facets[a].height > facets[b].height ? a : b;
    if (pass.height - facets[higher].height <= least_lift + kSameHeight * pass.height) {
      const std::int32_t beyond = same.lowest(higher == a ? pass.b : pass.a);
      if (same.lowest(higher) != beyond) same.join(same.lowest(higher), beyond);
    }
    flooded.join(a, b);
  }
  std::vector<std::int32_t> result;
  for (const std::int32_t rest : rests) result.push_back(same.lowest(rest));
  return result;
}

}  // namespace

void LikelyRestPoseOptions::validate() const {
  for (const auto& [field, value] : {std::pair("least_lift", least_lift), {"flatness", flatness}}) {
    base::require(value >= 0.0 && std::isfinite(value), "LikelyRestPoseOptions", field, value,
                  "finite and >= 0");
  }
}

std::vector<LikelyRestPose> likely_rest_poses(const TriangleMesh& mesh,
                                              const Vector3d& center_of_mass,
                                              const LikelyRestPoseOptions& options) {
  options.validate();
  if (mesh.faces.empty()) throw base::InvalidInput("likely_rest_poses: the mesh has no faces");
  internal::require_usable(mesh, "likely_rest_poses");
  if (!center_of_mass.allFinite()) {
    throw base::InvalidInput("likely_rest_poses: the center of mass is not finite");
  }
  const std::vector<Vector3d> points = used_vertices(mesh);
  const ConvexHull3 hull = convex_hull(points);
  if (hull.rank != 3) throw base::DegenerateGeometry("likely_rest_poses: the mesh spans no volume");
  const Rolling rolling(points, hull, center_of_mass);
  const std::vector<Facet>& facets = rolling.facets();
  std::map<std::int32_t, double> angles;  // by the facet at rest
  const std::vector<std::int32_t> rests = distinct_rests(rolling, options.least_lift);
  for (std::size_t f = 0; f < facets.size(); ++f) angles[rests[f]] += facets[f].solid_angle;

  std::vector<LikelyRestPose> poses;
  for (const auto& [rest, angle] : angles) {
    const Vector3d& down = facets[rest].outward;
    std::vector<Vector3d> support;
    for (const std::size_t i : hull.vertices) {
      if (facets[rest].height - down.dot(points[i] - center_of_mass) <= options.flatness) {
        support.push_back(points[i]);
      }
    }
    const double margin = internal::support_margin(support, -down, center_of_mass);
    poses.push_back(
        {{-down, facets[rest].height, std::max(0.0, margin)}, angle / (4.0 * std::numbers::pi)});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return poses;
}

}  // namespace graspfit::geometry
