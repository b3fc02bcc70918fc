#include "graspfit/base/number_text.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "yaml/yaml_text.hpp"

namespace graspfit::exchange {
namespace {

using internal::in_quotes;
using internal::yaml_list;
using internal::yaml_number;

/// "cspace_position" or its like: a map of joints.
void append_joints(const std::string& key, const hands::HandModel& hand, const Eigen::VectorXd& q,
                   std::string& text) {
  text += "    " + key + ":\n";
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    text += "      " + in_quotes(hand.joints[i].name) + ": " + yaml_number(q[i]) + '\n';
  }
}

}  // namespace

std::string isaac_grasp_yaml(const grasp::GraspFile& file) {
  const grasp::ObjectRecord& object = file.object;
  std::string text = "# Grasps of " + in_quotes(object.file) + " (SHA-256 " + object.sha256 +
                     "),\n# each coordinate times " +
                     base::shortest_decimal(object.meters_per_file_unit) +
                     " to be in meters, by the hand " + in_quotes(file.hand.name) +
                     ".\n# Confidence is M / (1 + M) of graspfit's measure M, no probability.\n"
                     "format: isaac_grasp\n"
                     "format_version: 1.0\n\n"
                     "object_frame_link: " +
                     in_quotes(internal::object_name(object.file)) +
                     "\ngripper_frame_link: " + in_quotes(file.hand.links[0].name) +
                     (file.grasps.empty() ? "\n\ngrasps: {}\n" : "\n\ngrasps:\n");
  for (std::size_t i = 0; i < file.grasps.size(); ++i) {
    const grasp::Grasp& grasp = file.grasps[i];
    const geometry::RigidTransform X_FH = object.in_file_frame(grasp.configuration.X_OH);
    const auto [w, x, y, z] = geometry::rotation_wxyz(X_FH);
    text += "  " + in_quotes("grasp_" + std::to_string(i)) +
            ":\n    confidence: " + yaml_number(grasp.quality.m / (1.0 + grasp.quality.m)) +
            "\n    position: " + yaml_list(X_FH.translation()) +
            "\n    orientation: {w: " + yaml_number(w) + ", xyz: " + yaml_list({x, y, z}) + "}\n";
    append_joints("cspace_position", file.hand, grasp.configuration.q, text);
    if (grasp.pre_grasp) {
      append_joints("pregrasp_cspace_position", file.hand, grasp.pre_grasp->configuration.q, text);
    }
  }
  return text;
}

}  // namespace graspfit::exchange
