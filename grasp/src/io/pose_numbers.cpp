#include "io/pose_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace graspfit::grasp::internal {

std::array<double, 4> rotation_wxyz(const geometry::RigidTransform& X_AB) {
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

geometry::RigidTransform pose(const Eigen::Vector3d& translation,
                              const std::array<double, 4>& rotation_wxyz) {
  const auto& [w, x, y, z] = rotation_wxyz;
  geometry::RigidTransform X_AB = geometry::RigidTransform::Identity();
  X_AB.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  X_AB.translation() = translation;
  return X_AB;
}

Eigen::Vector3d vector3(const base::JsonValue& value) {
  return Eigen::Vector3d(value.numbers<3>().data());
}

geometry::RigidTransform pose(const base::JsonValue& value) {
  const base::JsonValue rotation = value.at("rotation_wxyz");
  const std::array<double, 4> wxyz = rotation.numbers<4>();
  double squared_norm = 0.0;
  for (double component : wxyz) squared_norm += component * component;
  // Written quaternions are unit to rounding; six digits by hand pass, a wrong convention does not.
  if (!(std::abs(squared_norm - 1.0) < 1e-5)) rotation.fail("is not a unit quaternion");
  return pose(vector3(value.at("translation_m")), wxyz);
}

}  // namespace graspfit::grasp::internal
