#include "io/pose_numbers.hpp"

#include <array>
#include <cmath>

namespace graspfit::grasp::internal {

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
  return geometry::rigid_transform(vector3(value.at("translation_m")), wxyz);
}

}  // namespace graspfit::grasp::internal
