#include "graspfit/exchange/moveit_grasp.hpp"

#include "graspfit/geometry/rigid_transform.hpp"
#include "yaml/yaml_text.hpp"

namespace graspfit::exchange {
namespace {

using internal::in_quotes;
using internal::yaml_number;

std::string header(const std::string& frame) {
  return "header: {frame_id: " + in_quotes(frame) + '}';
}

std::string xyz(const Eigen::Vector3d& v) {
  return "x: " + yaml_number(v.x()) + ", y: " + yaml_number(v.y()) + ", z: " + yaml_number(v.z());
}

/// trajectory_msgs/JointTrajectory of a single point; of none without joint positions.
std::string posture(const char* key, const hands::HandModel& hand, const std::string& frame,
                    const Eigen::VectorXd* q) {
  std::string names;
  std::string positions;
  for (std::size_t i = 0; i < hand.joints.size() && q != nullptr; ++i) {
    if (hand.joints[i].coupling) continue;
    names += (names.empty() ? "" : ", ") + in_quotes(hand.joints[i].name);
    positions += (positions.empty() ? "" : ", ") + yaml_number((*q)[i]);
  }
  const std::string point = "{positions: [" + positions + "]}";
  return std::string("  ") + key + ":\n    " + header(frame) + "\n    joint_names: [" + names +
         "]\n    points: [" + (q == nullptr ? "" : point) + "]\n";
}

/// moveit_msgs/GripperTranslation.
std::string translation(const char* key, const std::string& frame, const Eigen::Vector3d& direction,
                        double distance) {
  return std::string("  ") + key + ":\n    direction: {" + header(frame) + ", vector: {" +
         xyz(direction) + "}}\n    desired_distance: " + yaml_number(distance) +
         "\n    min_distance: " + yaml_number(distance) + '\n';
}

std::string message(const grasp::GraspFile& file, std::size_t index) {
  const grasp::Grasp& grasp = file.grasps[index];
  const hands::HandModel& hand = file.hand;
  const std::string object = internal::object_name(file.object.file);
  const std::string& base = hand.links[0].name;
  const hands::HandConfiguration* before =
      grasp.pre_grasp ? &grasp.pre_grasp->configuration : nullptr;
  const geometry::RigidTransform X_FH = file.object.in_file_frame(grasp.configuration.X_OH);
  const Eigen::Vector3d position = X_FH.translation();
  const auto [w, x, y, z] = geometry::rotation_wxyz(X_FH);
  return "- id: " + in_quotes("grasp_" + std::to_string(index)) + '\n' +
         posture("pre_grasp_posture", hand, base, before ? &before->q : nullptr) +
         posture("grasp_posture", hand, base, &grasp.configuration.q) + "  grasp_pose:\n    " +
         header(object) + "\n    pose:\n      position: {" + xyz(position) +
         "}\n      orientation: {" + xyz({x, y, z}) + ", w: " + yaml_number(w) + "}\n" +
         "  grasp_quality: " + yaml_number(grasp.quality.m) + '\n' +
         translation("pre_grasp_approach", base, hand.palm.direction_H,
                     grasp.pre_grasp ? grasp.pre_grasp->retreat : 0.0) +
         translation("post_grasp_retreat", base, -hand.palm.direction_H, 0.0) +
         translation("post_place_retreat", base, -hand.palm.direction_H, 0.0) +
         "  max_contact_force: 0.0\n  allowed_touch_objects: [" + in_quotes(object) + "]\n";
}

}  // namespace

std::string moveit_grasps_yaml(const grasp::GraspFile& file) {
  if (file.grasps.empty()) return "[]\n";
  std::string text;
  for (std::size_t i = 0; i < file.grasps.size(); ++i) text += message(file, i);
  return text;
}

}  // namespace graspfit::exchange
