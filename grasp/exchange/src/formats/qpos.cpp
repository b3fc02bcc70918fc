#include "formats/qpos.hpp"

#include <algorithm>
#include <limits>

#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::exchange::internal {

void append_qpos(const hands::HandConfiguration* configuration, std::size_t num_joints,
                 std::vector<double>& values) {
  if (configuration == nullptr) {
    values.insert(values.end(), 7 + num_joints, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const Eigen::Vector3d p = configuration->X_OH.translation();
  const auto wxyz = geometry::rotation_wxyz(configuration->X_OH);
  values.insert(values.end(), p.begin(), p.end());
  values.insert(values.end(), wxyz.begin(), wxyz.end());
  values.insert(values.end(), configuration->q.begin(), configuration->q.end());
}

std::array<double, 7> object_pose(const grasp::ObjectRecord& object) {
  std::array<double, 7> pose = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  if (const auto& laid = object.laid) {
    std::copy(laid->translation.begin(), laid->translation.end(), pose.begin());
    std::copy(laid->rotation_wxyz.begin(), laid->rotation_wxyz.end(), pose.begin() + 3);
  }
  return pose;
}

}  // namespace graspfit::exchange::internal
