#include <array>
#include <cmath>

#include "formats/stated_joints.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "yaml/yaml_node.hpp"

namespace graspfit::exchange {
namespace {

using base::shortest_decimal;
using internal::YamlNode;

void check_format(const YamlNode& root) {
  const YamlNode format = root.at("format");
  if (format.text() != "isaac_grasp") {
    format.fail("is \"" + format.text() + "\", not isaac_grasp");
  }
  const YamlNode version = root.at("format_version");
  if (version.number() != 1.0) version.fail("is " + version.text() + "; version 1.0 is read");
}

/// Reads grasps of one hand.
class Reader {
 public:
  Reader(const hands::HandModel& hand, const IsaacReadOptions& options)
      : hand_(hand), options_(options) {}

  ImportedGrasp read(const std::string& name, const YamlNode& node) const {
    ImportedGrasp grasp;
    grasp.name = name;
    if (const auto confidence = node.find("confidence")) confidence->number();
    const YamlNode orientation = node.at("orientation");
    const Eigen::Vector3d xyz = orientation.at("xyz").vector3();
    const std::array<double, 4> wxyz = {orientation.at("w").number(), xyz.x(), xyz.y(), xyz.z()};
    const double norm = std::hypot(wxyz[0], xyz.norm());
    if (!(std::abs(norm - 1.0) <= options_.largest_norm_error)) {
      orientation.fail("is no unit quaternion, its norm is " + shortest_decimal(norm));
    }
    grasp.configuration.X_OH = geometry::rigid_transform(node.at("position").vector3(), wxyz);
    grasp.configuration.q = joints(node.at("cspace_position"));
    if (const auto before = node.find("pregrasp_cspace_position")) {
      grasp.pre_grasp_q = joints(*before);
    }
    return grasp;
  }

 private:
  Eigen::VectorXd joints(const YamlNode& node) const {
    internal::StatedJoints joints(hand_);
    for (const auto& [name, value] : node.members()) {
      const auto joint = joints.index_of(name);
      if (!joint) value.fail(joints.unknown_text());
      if (const auto fault = joints.state(*joint, value.number(), options_)) value.fail(*fault);
    }
    if (const auto fault = joints.complete(options_)) node.fail(*fault);
    return joints.q();
  }

  const hands::HandModel& hand_;
  const IsaacReadOptions& options_;
};

}  // namespace

std::vector<ImportedGrasp> read_isaac_grasps(const std::filesystem::path& path,
                                             const hands::HandModel& hand,
                                             const IsaacReadOptions& options) {
  options.validate();
  const YamlNode root = YamlNode::parse(path.string(), base::read_file(path));
  check_format(root);
  const Reader reader(hand, options);
  const YamlNode grasps = root.at("grasps");
  std::vector<ImportedGrasp> read;
  for (const auto& [name, node] : grasps.members()) read.push_back(reader.read(name, node));
  if (read.empty()) grasps.fail("holds no grasp");
  return read;
}

}  // namespace graspfit::exchange
