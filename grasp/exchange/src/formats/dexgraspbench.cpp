#include "graspfit/exchange/dexgraspbench.hpp"

#include <array>
#include <vector>

#include "archive/npz.hpp"
#include "formats/qpos.hpp"

namespace graspfit::exchange {

std::string dexgraspbench_npz(const grasp::GraspFile& file) {
  const std::size_t num_joints = file.hand.joints.size();
  std::vector<double> before;
  std::vector<double> at;
  std::vector<double> beyond;
  for (const grasp::Grasp& grasp : file.grasps) {
    internal::append_qpos(grasp.pre_grasp ? &grasp.pre_grasp->configuration : nullptr, num_joints,
                          before);
    internal::append_qpos(&grasp.configuration, num_joints, at);
    internal::append_qpos(grasp.squeeze ? &grasp.squeeze->configuration : nullptr, num_joints,
                          beyond);
  }
  std::vector<std::string> names;
  for (const hands::Joint& joint : file.hand.joints) names.push_back(joint.name);

  const std::array<std::string, 1> object = {file.object.file};
  const std::array<double, 1> scale = {file.object.meters_per_file_unit};
  const std::array<double, 7> object_pose = internal::object_pose(file.object);
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
