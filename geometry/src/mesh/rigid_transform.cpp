#include "graspfit/geometry/rigid_transform.hpp"

#include <algorithm>

namespace graspfit::geometry {

std::array<double, 4> rotation_wxyz(const RigidTransform& X_AB) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(X_AB.linear()).normalized();
  std::array<double, 4> wxyz = {q.w(), q.x(), q.y(), q.z()};
  double sign = 1.0;
  for (double component : wxyz) {
    if (component == 0.0) continue;
    sign = component < 0.0 ? -1.0 : 1.0;
    break;
  }
  for (double& component : wxyz) {
    // No negative zero, and no component that rounding brought above one.
    component = component == 0.0 ? 0.0 : std::clamp(sign * component, -1.0, 1.0);
  }
  return wxyz;
}

RigidTransform rigid_transform(const Eigen::Vector3d& translation,
                               const std::array<double, 4>& rotation_wxyz) {
  const auto& [w, x, y, z] = rotation_wxyz;
  RigidTransform X_AB = RigidTransform::Identity();
  X_AB.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  X_AB.translation() = translation;
  return X_AB;
}

}  // namespace graspfit::geometry
