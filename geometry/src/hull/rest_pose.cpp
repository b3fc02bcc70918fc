#include "graspfit/geometry/rest_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/angle.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/used_vertices.hpp"
#include "hull/support_margin.hpp"
#include "mesh/input_check.hpp"

namespace graspfit::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

template <class Vector>
void require_finite(const char* what, const Vector& vector) {
  if (vector.allFinite()) return;
  std::string text;
  for (const double x : vector) text += (text.empty() ? "(" : ", ") + base::shortest_decimal(x);
  throw base::InvalidInput(std::string(what) + " = " + text + "), must be finite");
}

/// Whether the line through `center` along the normal of a counter-clockwise triangle meets the
/// triangle, border included.
bool is_plumb_over(const std::array<Vector3d, 3>& triangle, const Vector3d& normal,
                   const Vector3d& center) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& a = triangle[k];
    const Vector3d& b = triangle[(k + 1) % 3];
    constexpr double kRounding = 1e-12;  // over squared lengths: the border belongs to both sides
    if ((b - a).cross(center - a).dot(normal) < -kRounding * (b - a).squaredNorm()) return false;
  }
  return true;
}

}  // namespace

void RestPoseOptions::validate() const {
  const auto require = [](const char* field, double value) {
    base::require(value >= 0.0 && std::isfinite(value), "RestPoseOptions", field, value,
                  "finite and >= 0");
  };
  require("flatness", flatness);
  require("same_up", same_up);
  require("least_margin", least_margin);
}

std::vector<RestPose> rest_poses(const TriangleMesh& mesh, const Vector3d& center_of_mass,
                                 const RestPoseOptions& options) {
  options.validate();
  if (mesh.faces.empty()) throw base::InvalidInput("rest_poses: the mesh has no faces");
  internal::require_usable(mesh, "rest_poses");
  require_finite("rest_poses: center_of_mass", center_of_mass);
  const std::vector<Vector3d> surface = used_vertices(mesh);
  const ConvexHull3 hull = convex_hull(surface);
  if (hull.rank != 3) throw base::DegenerateGeometry("rest_poses: the mesh spans no volume");
  std::vector<Vector3d> corners;
  for (const std::size_t i : hull.vertices) corners.push_back(surface[i]);

  std::vector<RestPose> poses;
  for (const HullFacet& facet : hull.facets) {
    const std::array<Vector3d, 3> triangle = {surface[facet[0]], surface[facet[1]],
                                              surface[facet[2]]};
    const Vector3d across = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (!(across.norm() > 0.0)) continue;  // thinner than rounding: a neighbor will do
    const Vector3d normal = across.normalized();
    if (!is_plumb_over(triangle, normal, center_of_mass)) continue;
    const double offset = normal.dot(triangle[0]);
    std::vector<Vector3d> support;
    for (const Vector3d& corner : corners) {
      if (offset - normal.dot(corner) <= options.flatness) support.push_back(corner);
    }
    const RestPose pose{-normal, offset - normal.dot(center_of_mass),
                        std::max(0.0, internal::support_margin(support, -normal, center_of_mass))};
    if (pose.margin >= options.least_margin) poses.push_back(pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const RestPose& a, const RestPose& b) { return a.height < b.height; });
  std::vector<RestPose> distinct;
  for (const RestPose& pose : poses) {
    const bool is_known = std::any_of(distinct.begin(), distinct.end(), [&](const RestPose& other) {
      return angle_between(pose.up_O, other.up_O) < options.same_up;
    });
    if (!is_known) distinct.push_back(pose);
  }
  return distinct;
}

const RestPose& nearest_rest_pose(const std::vector<RestPose>& poses, const Vector3d& wanted_up_O) {
  if (!(wanted_up_O.norm() > 0.0) || !wanted_up_O.allFinite()) {
    throw base::InvalidInput("nearest_rest_pose: the wanted up has no length");
  }
  if (poses.empty()) throw base::InvalidInput("nearest_rest_pose: there is no rest pose");
  return *std::min_element(poses.begin(), poses.end(), [&](const RestPose& a, const RestPose& b) {
    return angle_between(a.up_O, wanted_up_O) < angle_between(b.up_O, wanted_up_O);
  });
}

RigidTransform standing_pose(const TriangleMesh& mesh, const Vector3d& up_O, double turn,
                             const Vector3d& center_O, const Vector2d& place_W) {
  if (mesh.faces.empty()) throw base::InvalidInput("standing_pose: the mesh has no faces");
  internal::require_usable(mesh, "standing_pose");
  require_finite("standing_pose: up_O", up_O);
  if (!(up_O.norm() > 0.0)) throw base::InvalidInput("standing_pose: up_O has no length");
  require_finite("standing_pose: turn", Eigen::Matrix<double, 1, 1>(turn));
  require_finite("standing_pose: center_O", center_O);
  require_finite("standing_pose: place_W", place_W);
  const Vector3d axis = up_O.cross(Vector3d::UnitZ());
  const double angle = angle_between(up_O, Vector3d::UnitZ());
  const Vector3d unit_axis = axis.norm() > 0.0 ? Vector3d(axis.normalized()) : Vector3d::UnitX();
  RigidTransform X_WO = RigidTransform::Identity();
  X_WO.linear() = (Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * Eigen::AngleAxisd(angle, unit_axis))
                      .toRotationMatrix();
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : used_vertices(mesh)) {
    lowest = std::min(lowest, X_WO.linear().row(2).dot(vertex));
  }
  const Vector3d center = X_WO.linear() * center_O;
  X_WO.translation() << place_W.x() - center.x(), place_W.y() - center.y(), -lowest;
  return X_WO;
}

}  // namespace graspfit::geometry
