#include "graspfit/exchange/graspit_world.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "formats/graspit_robot_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::exchange {
namespace {

using base::shortest_decimal;
using internal::GraspItDof;
using tinyxml2::XMLElement;

constexpr double kMillimetersPerMeter = 1000.0;

/// A joint further than this from the value of its degree of freedom has broken away [rad or mm].
constexpr double kSameValue = 1e-9;

double in_graspit_units(const hands::Joint& joint, double position) {
  return joint.type == hands::JointType::Prismatic ? kMillimetersPerMeter * position : position;
}

std::string full_transform(const geometry::RigidTransform& X) {
  const auto [w, x, y, z] = geometry::rotation_wxyz(X);
  const Eigen::Vector3d p = kMillimetersPerMeter * X.translation();
  return '(' + shortest_decimal(w) + ' ' + shortest_decimal(x) + ' ' + shortest_decimal(y) + ' ' +
         shortest_decimal(z) + ")[" + shortest_decimal(p.x()) + ' ' + shortest_decimal(p.y()) +
         ' ' + shortest_decimal(p.z()) + ']';
}

/// Returns the value of a degree of freedom and, where it breaks away, a flag per joint: 0, or 1
/// and the value at which the joint stopped. The value of the degree of freedom is that of the
/// joint that has closed furthest.
std::string dof_text(const hands::HandModel& hand, const GraspItDof& dof,
                     const Eigen::VectorXd& q) {
  const auto value_of = [&](const GraspItDof::Follower& follower) {
    return in_graspit_units(hand.joints[follower.joint], q[follower.joint]) / follower.ratio;
  };
  if (dof.joints.empty()) return "0";
  double value = value_of(dof.joints[0]);
  for (const GraspItDof::Follower& follower : dof.joints) {
    const double sign = hand.joints[follower.joint].closing_sign * follower.ratio;
    if (sign * (value_of(follower) - value) > 0.0) value = value_of(follower);
  }
  std::string text = shortest_decimal(value);
  if (!dof.breaks_away) return text;
  for (const GraspItDof::Follower& follower : dof.joints) {
    const double own = value_of(follower);
    text += std::abs(own - value) <= kSameValue ? " 0" : " 1 " + shortest_decimal(own);
  }
  return text;
}

std::string dof_values(const hands::HandModel& hand, const Eigen::VectorXd& q) {
  std::string text;
  if (const auto dofs = internal::graspit_dofs(hand)) {
    for (const GraspItDof& dof : *dofs) text += (text.empty() ? "" : " ") + dof_text(hand, dof, q);
    return text;
  }
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    if (hand.joints[i].coupling) continue;
    text += (text.empty() ? "" : " ") + shortest_decimal(in_graspit_units(hand.joints[i], q[i]));
  }
  return text;
}

XMLElement& add(XMLElement& parent, const char* name, const std::string& text = "") {
  XMLElement* const element = parent.InsertNewChildElement(name);
  if (!text.empty()) element->SetText(text.c_str());
  return *element;
}

void add_transform(XMLElement& element, const geometry::RigidTransform& X) {
  add(add(element, "transform"), "fullTransform", full_transform(X));
}

/// GraspIt!'s name for the format of a body's geometry, by its extension.
std::string geometry_type(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (extension == ".iv" || extension == ".wrl") return "Inventor";
  return extension.empty() ? "off" : extension.substr(1);
}

}  // namespace

bool is_graspit_hand(const hands::HandModel& hand) {
  return internal::graspit_dofs(hand).has_value();
}

std::string graspit_world_xml(const grasp::GraspFile& file, std::size_t index,
                              const GraspItWorldOptions& options) {
  if (index >= file.grasps.size()) {
    throw base::InvalidInput("graspit_world_xml: grasp " + std::to_string(index + 1) + " of " +
                             std::to_string(file.grasps.size()));
  }
  const hands::HandConfiguration& configuration = file.grasps[index].configuration;
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration("xml version=\"1.0\""));
  XMLElement* const world = document.NewElement("world");
  document.InsertEndChild(world);

  XMLElement& body = add(*world, "graspableBody");
  if (options.body_file.empty()) {
    XMLElement& inline_body = add(body, "body");
    add(inline_body, "geometryFile", file.object.file)
        .SetAttribute("type", geometry_type(file.object.file).c_str());
    add(inline_body, "geometryScaling",
        shortest_decimal(kMillimetersPerMeter * file.object.meters_per_file_unit));
  } else {
    add(body, "filename", options.body_file);
  }
  add_transform(body,
                file.object.laid ? file.object.laid->X_OF() : geometry::RigidTransform::Identity());

  XMLElement& robot = add(*world, "robot");
  add(robot, "filename",
      options.robot_file.empty() ? file.hand.description_file : options.robot_file);
  add(robot, "dofValues", dof_values(file.hand, configuration.q));
  add_transform(robot, configuration.X_OH);

  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace graspfit::exchange
