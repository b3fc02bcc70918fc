#pragma once

#include <string>

#include "graspfit/grasp/grasp_io.hpp"

/// \file
/// Messages moveit_msgs/Grasp as YAML, of ROS 1 and 2 alike [moveit/moveit_msgs, msg/Grasp.msg and
/// msg/GripperTranslation.msg]: `seq` and stamps, which differ between them, are left out, as
/// readers fill in what is missing.

namespace graspfit::exchange {

/// A YAML list of messages, best grasp first. SI units; quaternions by the keys x, y, z, w.
///
/// - `grasp_pose`: the pose of the hand's root link in the frame named as the object's file, which
///   is O. (MoveIt! means the link that the end effector is attached to: append the fixed transform
///   from the root link to that link.)
/// - postures: the independent joints; their followers, which mimic them, are left to the robot
///   model.
/// - `grasp_quality`: M. `pre_grasp_approach`: along the palm's direction in the frame of the root
///   link; the desired and the least distance are the pre-grasp's retreat, or 0 without a
///   pre-grasp.
/// - `post_grasp_retreat`, `post_place_retreat`: not planned, distance 0. `max_contact_force` 0: no
///   limit. `allowed_touch_objects`: the object.
std::string moveit_grasps_yaml(const grasp::GraspFile& file);

}  // namespace graspfit::exchange
