#include "graspfit/exchange/grasp_arrays.hpp"

#include <array>
#include <limits>

#include "archive/npz.hpp"
#include "formats/qpos.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::exchange {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> joint_names(const hands::HandModel& hand) {
  std::vector<std::string> names;
  for (const hands::Joint& joint : hand.joints) names.push_back(joint.name);
  return names;
}

}  // namespace

void GraspArrays::add(const std::string& name, const std::string& license,
                      const grasp::GraspFile& file, const std::vector<HoldFinding>& findings) {
  if (findings.size() != file.grasps.size()) {
    throw base::InvalidInput("grasp arrays: " + name + " has " +
                             std::to_string(file.grasps.size()) + " grasps and " +
                             std::to_string(findings.size()) + " findings");
  }
  if (names_.empty()) {
    hand_ = file.hand.name;
    joints_ = joint_names(file.hand);
  } else if (hand_ != file.hand.name || joints_ != joint_names(file.hand)) {
    throw base::InvalidInput("grasp arrays: " + name + " has grasps of hand " + file.hand.name +
                             ", those before it are of " + hand_);
  }
  names_.push_back(name);
  paths_.push_back(file.object.file);
  hashes_.push_back(file.object.sha256);
  licenses_.push_back(license);
  scales_.push_back(file.object.meters_per_file_unit);
  const std::array<double, 7> pose = internal::object_pose(file.object);
  poses_.insert(poses_.end(), pose.begin(), pose.end());
  for (std::size_t i = 0; i < file.grasps.size(); ++i) {
    object_index_.push_back(base::as_index<std::int64_t>(names_.size()) - 1);
    ranks_.push_back(base::as_index<std::int64_t>(i) + 1);
    add_grasp(file, file.grasps[i], findings[i]);
  }
}

void GraspArrays::add_grasp(const grasp::GraspFile& file, const grasp::Grasp& grasp,
                            const HoldFinding& finding) {
  const std::size_t num_joints = joints_.size();
  internal::append_qpos(grasp.pre_grasp ? &grasp.pre_grasp->configuration : nullptr, num_joints,
                        before_);
  internal::append_qpos(&grasp.configuration, num_joints, at_);
  internal::append_qpos(grasp.squeeze ? &grasp.squeeze->configuration : nullptr, num_joints,
                        beyond_);
  m_.push_back(grasp.quality.m);
  epsilon_.push_back(grasp.wrench ? grasp.epsilon() : kUnknown);
  gaps_.push_back(grasp::largest_requested_gap(grasp));
  held_.push_back(finding.is_held ? (*finding.is_held ? 1 : 0) : -1);
  forces_.push_back(finding.margin_force.value_or(kUnknown));
  torques_.push_back(finding.margin_torque.value_or(kUnknown));
  for (const contact::Contact& contact : grasp.contacts) {
    points_.insert(points_.end(), contact.point_O.begin(), contact.point_O.end());
    normals_.insert(normals_.end(), contact.inward_normal_O.begin(), contact.inward_normal_O.end());
    contact_gaps_.push_back(contact.gap);
    areas_.push_back(contact.area);
    links_.push_back(file.hand.links[contact.link].name);
  }
  contact_start_.push_back(base::as_index<std::int64_t>(links_.size()));
}

std::string GraspArrays::npz() const {
  const std::array<std::string, 1> hand = {hand_};
  const std::size_t objects = num_objects();
  const std::size_t grasps = num_grasps();
  const std::size_t contacts = links_.size();
  const std::vector<std::size_t> qpos = {grasps, 7 + joints_.size()};
  internal::NpzWriter npz;
  npz.add("hand", {}, hand);
  npz.add("joint_names", {joints_.size()}, joints_);
  npz.add("object_name", {objects}, names_);
  npz.add("object_path", {objects}, paths_);
  npz.add("object_sha256", {objects}, hashes_);
  npz.add("object_license", {objects}, licenses_);
  npz.add("object_scale", {objects}, scales_);
  npz.add("object_pose", {objects, 7}, poses_);
  npz.add("object_index", {grasps}, object_index_);
  npz.add("rank", {grasps}, ranks_);
  npz.add("pregrasp_qpos", qpos, before_);
  npz.add("grasp_qpos", qpos, at_);
  npz.add("squeeze_qpos", qpos, beyond_);
  npz.add("m", {grasps}, m_);
  npz.add("epsilon", {grasps}, epsilon_);
  npz.add("largest_gap", {grasps}, gaps_);
  npz.add("held", {grasps}, held_);
  npz.add("margin_force", {grasps}, forces_);
  npz.add("margin_torque", {grasps}, torques_);
  npz.add("contact_start", {grasps + 1}, contact_start_);
  npz.add("contact_point", {contacts, 3}, points_);
  npz.add("contact_normal", {contacts, 3}, normals_);
  npz.add("contact_gap", {contacts}, contact_gaps_);
  npz.add("contact_area", {contacts}, areas_);
  npz.add("contact_link", {contacts}, links_);
  return npz.bytes();
}

}  // namespace graspfit::exchange
