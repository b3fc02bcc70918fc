#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::grasp {
namespace {

using base::shortest_decimal;
using geometry::RigidTransform;

/// A name with a separator or a quote in it is quoted as RFC 4180 says.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string joint_columns(const hands::HandModel& hand, const std::string& prefix) {
  std::string columns;
  for (const hands::Joint& joint : hand.joints) {
    const char* unit = joint.type == hands::JointType::Revolute ? "_rad" : "_m";
    columns += ',' + quoted(prefix + joint.name + unit);
  }
  return columns;
}

std::string pose_columns(const std::string& prefix) {
  std::string columns;
  for (const char* name : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"}) {
    columns += ',' + prefix + "palm_" + name;
  }
  return columns;
}

std::string joint_cells(const Eigen::VectorXd& q) {
  std::string cells;
  for (double value : q) cells += ',' + shortest_decimal(value);
  return cells;
}

std::string pose_cells(const RigidTransform& X_OH) {
  std::string cells;
  for (int axis = 0; axis < 3; ++axis) cells += ',' + shortest_decimal(X_OH.translation()[axis]);
  for (double value : geometry::rotation_wxyz(X_OH)) cells += ',' + shortest_decimal(value);
  return cells;
}

const char* flag_cell(bool value) { return value ? ",true" : ",false"; }

std::string row(const GraspFile& file, const Grasp& grasp, std::size_t rank) {
  const contact::ContactQuality& quality = grasp.quality;
  const std::size_t num_joints = file.hand.joints.size();
  bool is_palm_touching = false;
  for (const contact::Contact& contact : grasp.contacts) is_palm_touching |= !contact.finger;

  std::string cells = std::to_string(rank);
  for (double value : {quality.m, quality.m1, quality.m2, quality.m3, quality.regularity,
                       quality.centroid_distance, grasp.epsilon()}) {
    cells += ',' + shortest_decimal(value);
  }
  cells += flag_cell(grasp.is_force_closure());
  cells += ',' + std::to_string(grasp.contacts.size());
  cells += ',' + std::to_string(quality.stable_pairs.size());
  for (double value :
       {largest_contact_gap(grasp), largest_requested_gap(grasp), largest_penetration(grasp)}) {
    cells += ',' + shortest_decimal(value);
  }
  cells += flag_cell(is_palm_touching);
  cells += flag_cell(grasp.is_usable());
  cells += flag_cell(grasp.is_valid());
  cells += ',' + std::to_string(grasp.attempt);
  cells += pose_cells(grasp.configuration.X_OH) + joint_cells(grasp.configuration.q);
  if (grasp.pre_grasp) {
    const PreGrasp& start = *grasp.pre_grasp;
    for (double value : {start.clearance, start.opening, start.retreat}) {
      cells += ',' + shortest_decimal(value);
    }
    cells += pose_cells(start.configuration.X_OH) + joint_cells(start.configuration.q);
  } else {
    cells += std::string(3 + 7 + num_joints, ',');
  }
  if (grasp.squeeze) {
    cells += ',' + shortest_decimal(grasp.squeeze->residual);
    cells += joint_cells(grasp.squeeze->configuration.q);
  } else {
    cells += std::string(1 + num_joints, ',');
  }
  return cells;
}

}  // namespace

std::string to_csv(const GraspFile& file) {
  std::string csv =
      "rank,m,m1,m2,m3,regularity,centroid_distance_m,epsilon,force_closure,num_contacts,"
      "num_stable_pairs,largest_contact_gap_m,largest_requested_gap_m,largest_penetration_m,"
      "palm_touches,usable,valid,attempt";
  csv += pose_columns("") + joint_columns(file.hand, "");
  csv += ",pre_grasp_clearance_m,pre_grasp_opening,pre_grasp_retreat_m";
  csv += pose_columns("pre_grasp_") + joint_columns(file.hand, "pre_grasp_");
  csv += ",squeeze_residual" + joint_columns(file.hand, "squeeze_") + '\n';
  for (std::size_t i = 0; i < file.grasps.size(); ++i)
    csv += row(file, file.grasps[i], i + 1) + '\n';
  return csv;
}

}  // namespace graspfit::grasp
