#include "graspfit/exchange/dexgraspbench.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "archive/npz.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::exchange {
namespace {

/// Appends position, quaternion and joints; NaN where there is no configuration.
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

}  // namespace

std::string dexgraspbench_npz(const grasp::GraspFile& file) {
  const std::size_t num_joints = file.hand.joints.size();
  std::vector<double> before;
  std::vector<double> at;
  std::vector<double> beyond;
  for (const grasp::Grasp& grasp : file.grasps) {
    append_qpos(grasp.pre_grasp ? &grasp.pre_grasp->configuration : nullptr, num_joints, before);
    append_qpos(&grasp.configuration, num_joints, at);
    append_qpos(grasp.squeeze ? &grasp.squeeze->configuration : nullptr, num_joints, beyond);
  }
  std::vector<std::string> names;
  for (const hands::Joint& joint : file.hand.joints) names.push_back(joint.name);

  const std::array<std::string, 1> object = {file.object.file};
  const std::array<double, 1> scale = {file.object.meters_per_file_unit};
  std::array<double, 7> object_pose = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  if (const auto& laid = file.object.laid) {
    std::copy(laid->translation.begin(), laid->translation.end(), object_pose.begin());
    std::copy(laid->rotation_wxyz.begin(), laid->rotation_wxyz.end(), object_pose.begin() + 3);
  }
  const std::vector<std::size_t> shape = {file.grasps.size(), 7 + num_joints};
  internal::NpzWriter npz;
  npz.add("obj_path", {}, object);
  npz.add("obj_scale", {}, scale);
  npz.add("obj_pose", {7}, object_pose);
  npz.add("pregrasp_qpos", shape, before);
  npz.add("grasp_qpos", shape, at);
  npz.add("squeeze_qpos", shape, beyond);
  npz.add("joint_names", {num_joints}, names);
  return npz.bytes();
}

}  // namespace graspfit::exchange
