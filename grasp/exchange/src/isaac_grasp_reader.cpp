#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "yaml_node.hpp"

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
    Eigen::VectorXd q = Eigen::VectorXd::Constant(std::ssize(hand_.joints),
                                                  std::numeric_limits<double>::quiet_NaN());
    for (const auto& [name, value] : node.members()) {
      const std::size_t joint = index_of(name, value);
      q[joint] = within_limits(hand_.joints[joint], value);
    }
    for (std::size_t j = 0; j < hand_.joints.size(); ++j) {
      if (std::isnan(q[j]) && !hand_.joints[j].coupling) {
        node.fail("joint " + hand_.joints[j].name + " of hand " + hand_.name + " is missing");
      }
    }
    follow_couplings(node, q);
    return q;
  }

  std::size_t index_of(const std::string& name, const YamlNode& value) const {
    const auto found =
        std::find_if(hand_.joints.begin(), hand_.joints.end(),
                     [&name = name](const hands::Joint& joint) { return joint.name == name; });
    if (found != hand_.joints.end()) {
      return static_cast<std::size_t>(found - hand_.joints.begin());
    }
    value.fail("hand " + hand_.name + " has no such joint; it has " +
               base::list_text(hand_.joints, &hands::Joint::name));
  }

  double within_limits(const hands::Joint& joint, const YamlNode& node) const {
    const double value = node.number();
    const double excess = std::max(joint.lower - value, value - joint.upper);
    if (excess > options_.largest_limit_excess) {
      node.fail("is " + shortest_decimal(value) + ", outside the joint's " +
                shortest_decimal(joint.lower) + " to " + shortest_decimal(joint.upper));
    }
    return std::clamp(value, joint.lower, joint.upper);
  }

  /// Puts followers that are not stated where their leaders put them, and checks those that are.
  void follow_couplings(const YamlNode& node, Eigen::VectorXd& q) const {
    const Eigen::VectorXd stated = q;
    for (std::size_t j = 0; j < hand_.joints.size(); ++j) {
      // Any position will do for a follower: the couplings correct all but those that a clutch lets
      // go on closing.
      if (std::isnan(q[j])) {
        q[j] = hand_.joints[j].open_limit();
      }
    }
    hands::apply_couplings(hand_, q);
    for (std::size_t j = 0; j < hand_.joints.size(); ++j) {
      const double value = stated[j];
      const double follows = q[j];
      if (std::isnan(value) || std::abs(value - follows) <= options_.largest_coupling_error) {
        continue;
      }
      const hands::Joint& leader = hand_.joints[hand_.joints[j].coupling->leader];
      node.fail("joint " + hand_.joints[j].name + " is " + shortest_decimal(value) +
                ", but its leader " + leader.name + " puts it at " + shortest_decimal(follows));
    }
  }

  const hands::HandModel& hand_;
  const IsaacReadOptions& options_;
};

}  // namespace

void IsaacReadOptions::validate() const {
  const auto require = [](std::string_view field, double value) {
    base::require(value >= 0.0 && std::isfinite(value), "IsaacReadOptions", field, value,
                  "finite and >= 0");
  };
  require("largest_norm_error", largest_norm_error);
  require("largest_limit_excess", largest_limit_excess);
  require("largest_coupling_error", largest_coupling_error);
}

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
