#include "graspfit/hands/hand_export.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "description/sidecar.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::hands {

namespace {

namespace fs = std::filesystem;
using base::InvalidInput;
using base::shortest_decimal;

/// Limits of effort and velocity, which a URDF must state and a hand model does not know: they are
/// large enough not to stop a simulated joint.
constexpr const char* kEffort = "10";   // [N or N m]
constexpr const char* kVelocity = "1";  // [m/s or rad/s]

void require_file_name(const HandModel& model, const std::string& name, const std::string& item) {
  bool is_fit = !name.empty() && name.front() != '.';
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    is_fit = is_fit && code >= 0x20 && code != 0x7f && c != '/' && c != '\\';
  }
  if (is_fit) return;
  throw InvalidInput("export_hand: hand " + model.name + ": " + item + " \"" + name +
                     "\" cannot be a file's name");
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string three(const Eigen::Vector3d& v) {
  return shortest_decimal(v.x()) + ' ' + shortest_decimal(v.y()) + ' ' + shortest_decimal(v.z());
}

/// Roll, pitch and yaw with R = Rz(yaw) Ry(pitch) Rx(roll). Pitch and roll are taken from what is
/// left of R after the yaw, so that all three fit together to rounding also where the pitch is near
/// 90 degrees and yaw and roll are no longer told apart.
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& R) {
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const double pitch = std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0));
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, pitch, yaw};
}

std::string origin(const RigidTransform& X) {
  return "<origin xyz=\"" + three(X.translation()) + "\" rpy=\"" +
         three(roll_pitch_yaw(X.linear())) + "\"/>";
}

std::string inertial(const LinkInertia& inertia) {
  const Eigen::Matrix3d& I = inertia.inertia_L;
  const auto entry = [&](const char* name, int i, int j) {
    return std::string(" ") + name + "=\"" + shortest_decimal(I(i, j)) + '"';
  };
  return "    <inertial>\n      <origin xyz=\"" + three(inertia.center_L) +
         "\" rpy=\"0 0 0\"/>\n      <mass value=\"" + shortest_decimal(inertia.mass) +
         "\"/>\n      <inertia" + entry("ixx", 0, 0) + entry("ixy", 0, 1) + entry("ixz", 0, 2) +
         entry("iyy", 1, 1) + entry("iyz", 1, 2) + entry("izz", 2, 2) + "/>\n    </inertial>\n";
}

/// The beginning of a <joint>: its name and type, parent and child, and the child's pose.
std::string joint_head(const std::string& name, const char* type, const std::string& parent,
                       const std::string& child, const RigidTransform& X_PJ) {
  return "  <joint name=\"" + escaped(name) + "\" type=\"" + type + "\">\n    <parent link=\"" +
         escaped(parent) + "\"/>\n    <child link=\"" + escaped(child) + "\"/>\n    " +
         origin(X_PJ) + '\n';
}

std::string joint_text(const HandModel& model, const Joint& joint) {
  std::string text = joint_head(
      joint.name, joint.type == JointType::Prismatic ? "prismatic" : "revolute",
      model.links[joint.parent_link].name, model.links[joint.child_link].name, joint.X_PJ);
  text += "    <axis xyz=\"" + three(joint.axis_J) + "\"/>\n    <limit lower=\"" +
          shortest_decimal(joint.lower) + "\" upper=\"" + shortest_decimal(joint.upper) +
          "\" effort=\"" + kEffort + "\" velocity=\"" + kVelocity + "\"/>\n";
  if (joint.coupling) {
    const Joint& leader = model.joints[joint.coupling->leader];
    text += "    <mimic joint=\"" + escaped(leader.name) + "\" multiplier=\"" +
            shortest_decimal(joint.coupling->ratio) + "\" offset=\"" +
            shortest_decimal(joint.coupling->offset) + "\"/>\n";
  }
  return text + "  </joint>\n";
}

std::string mesh_name(const Link& link) { return link.name + ".obj"; }

/// Links and joints in the model's order, which is the order in which they are read again.
std::string urdf_text(const HandModel& model) {
  std::set<std::string> joint_names;
  for (const Joint& joint : model.joints) joint_names.insert(joint.name);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<robot name=\"" + escaped(model.name) + "\">\n";
  for (const Link& link : model.links) {
    if (link.parent_joint) {
      text += joint_text(model, model.joints[*link.parent_joint]);
    } else if (link.parent_link) {
      // A model does not keep the names of fixed joints.
      std::string name = link.name + "_fixed";
      while (!joint_names.insert(name).second) name += '_';
      text += joint_head(name, "fixed", model.links[*link.parent_link].name, link.name,
                         link.X_PL_fixed) +
              "  </joint>\n";
    }
    text += "  <link name=\"" + escaped(link.name) + "\">\n";
    if (link.inertia) text += inertial(*link.inertia);
    if (!link.mesh_L.faces.empty()) {
      for (const char* tag : {"visual", "collision"}) {
        text += std::string("    <") + tag + "><geometry><mesh filename=\"" +
                escaped(mesh_name(link)) + "\"/></geometry></" + tag + ">\n";
      }
    }
    text += "  </link>\n";
  }
  return text + "</robot>\n";
}

/// What the model says beyond the URDF, with every member there, so that nothing is derived.
internal::Sidecar sidecar_of(const HandModel& model) {
  const auto link_name = [&](int link) { return model.links[link].name; };
  const auto joint_name = [&](int j) { return model.joints[j].name; };
  const auto pad_name = [&](const std::optional<int>& pad) -> std::optional<std::string> {
    if (!pad) return std::nullopt;
    return model.pads[*pad].name;
  };
  internal::Sidecar sidecar;
  sidecar.fingers.emplace();
  for (const Finger& finger : model.fingers) {
    internal::SidecarFinger out;
    out.name = finger.name;
    out.is_thumb = finger.is_thumb;
    for (const int link : finger.links) out.links.push_back(link_name(link));
    for (const int joint : finger.joints) out.joints.push_back(joint_name(joint));
    if (finger.swing_joint) out.swing_joint = joint_name(*finger.swing_joint);
    out.tip_pad = pad_name(finger.tip_pad);
    sidecar.fingers->push_back(std::move(out));
  }
  sidecar.pads.emplace();
  for (const ContactPad& pad : model.pads) {
    sidecar.pads->push_back({pad.name, link_name(pad.link), model.part_name(pad.finger), pad.X_LC,
                             pad.outline, pad.surface, pad.clip_thickness});
  }
  sidecar.palm = internal::SidecarPalm{link_name(model.palm.link), model.palm.center_H,
                                       model.palm.direction_H, pad_name(model.palm.pad)};
  sidecar.closing.emplace();
  sidecar.couplings.emplace();
  for (const Joint& joint : model.joints) {
    (*sidecar.closing)[joint.name] = joint.closing_sign;
    if (!joint.coupling) continue;
    sidecar.couplings->push_back({joint.name, joint_name(joint.coupling->leader),
                                  joint.coupling->ratio, joint.coupling->offset,
                                  joint.coupling->breakaway});
  }
  sidecar.exclusions.emplace();
  for (const CollisionExclusion& pair : model.exclusions) {
    sidecar.exclusions->emplace_back(link_name(pair.link_a), link_name(pair.link_b));
  }
  return sidecar;
}

}  // namespace

std::vector<fs::path> export_hand(const HandModel& model, const fs::path& folder) {
  validate(model);
  require_file_name(model, model.name, "its name");
  for (const Link& link : model.links) require_file_name(model, link.name, "link");

  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw base::IoError(folder.string() + ": " + error.message());
  std::vector<fs::path> files;
  for (const Link& link : model.links) {
    if (link.mesh_L.faces.empty()) continue;
    files.push_back(folder / mesh_name(link));
    geometry::write_mesh(files.back(), link.mesh_L);
  }
  const fs::path urdf = folder / (model.name + ".urdf");
  files.push_back(sidecar_file_of(urdf));
  base::write_file_atomically(
      files.back(), internal::sidecar_text(sidecar_of(model), model.name,
                                           "Exported by graspfit from hand " + model.name + '.'));
  // The URDF is written last: when it exists, all files that it names do.
  files.push_back(urdf);
  base::write_file_atomically(files.back(), urdf_text(model));
  return files;
}

}  // namespace graspfit::hands
