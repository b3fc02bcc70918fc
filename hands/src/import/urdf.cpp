#include "import/urdf.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>

#include "description/xml_source.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::hands::internal {

namespace {

using tinyxml2::XMLElement;

/// Largest difference from 1 of the length of an axis that is meant as a unit vector: 0.577 0.577
/// 0.577, with three digits, has the length 0.9994.
constexpr double kUnitSlack = 2e-3;
/// Revolute limits beyond a turn [rad], and prismatic limits beyond the reach of any hand [m],
/// suggest degrees and millimeters.
constexpr double kFullTurn = 2.0 * std::numbers::pi + 1e-3;
constexpr double kLongestStroke = 1.0;

/// A number as text for people, with four significant digits.
std::string rounded(double value) {
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 4);
  return {text, end};
}

/// Reads one file. Where faults are collected, an item keeps those of its values that can be read.
class Parser : private XmlSource {
 public:
  Parser(std::string file, Findings& findings) : XmlSource(std::move(file)), findings_(findings) {}

  RobotDescription parse(const std::string& text) {
    tinyxml2::XMLDocument document;
    const XMLElement& root = XmlSource::parse(text, "robot", "a URDF", document);
    RobotDescription urdf;
    findings_.attempt([&] { urdf.name = text_of(root, "name", "robot"); });
    for (const XMLElement* e = root.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      findings_.attempt([&] {
        if (tag.substr(0, 6) == "xacro:") {
          fail(*e, "<" + std::string(tag) + ">: this is a xacro file; expand it to a URDF first");
        }
        if (tag == "link") urdf.links.push_back(link(*e));
        if (tag == "joint") urdf.joints.push_back(joint(*e));
      });
    }
    return urdf;
  }

 private:
  double positive(const XMLElement& e, const char* attribute, const std::string& item) const {
    const double value = number(e, attribute, item);
    if (value <= 0.0)
      fail(e, item + ": <" + e.Name() + "> has a " + attribute +
                  " that is not positive: " + e.Attribute(attribute));
    return value;
  }

  Eigen::Vector3d vector_or(const XMLElement& e, const char* attribute,
                            const Eigen::Vector3d& otherwise, const std::string& item) const {
    if (!e.Attribute(attribute)) return otherwise;
    const std::vector<double> v = numbers(e, e.Attribute(attribute), 3, item);
    return {v[0], v[1], v[2]};
  }

  geometry::RigidTransform origin(const XMLElement& parent, const std::string& item) const {
    geometry::RigidTransform X = geometry::RigidTransform::Identity();
    const XMLElement* e = parent.FirstChildElement("origin");
    if (e == nullptr) return X;
    X.translation() = vector_or(*e, "xyz", Eigen::Vector3d::Zero(), item);
    const Eigen::Vector3d rpy = vector_or(*e, "rpy", Eigen::Vector3d::Zero(), item);
    X.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    return X;
  }

  DescribedGeometry shape(const XMLElement& e, const std::string& item) const {
    DescribedGeometry result;
    result.X_LG = origin(e, item);
    const XMLElement* holder = e.FirstChildElement("geometry");
    const XMLElement* kind = holder ? holder->FirstChildElement() : nullptr;
    if (kind == nullptr) fail(e, item + ": <" + e.Name() + "> without geometry");
    const std::string_view tag = kind->Name();
    if (tag == "box") {
      const std::vector<double> size = numbers(*kind, text_of(*kind, "size", item), 3, item);
      if (!(size[0] > 0.0 && size[1] > 0.0 && size[2] > 0.0)) {
        fail(*kind, item + ": <box> has a size that is not positive: " + kind->Attribute("size"));
      }
      result.shape = BoxShape{{size[0], size[1], size[2]}};
    } else if (tag == "cylinder") {
      result.shape =
          CylinderShape{positive(*kind, "radius", item), positive(*kind, "length", item)};
    } else if (tag == "sphere") {
      result.shape = SphereShape{positive(*kind, "radius", item)};
    } else if (tag == "mesh") {
      MeshFileShape mesh{text_of(*kind, "filename", item),
                         vector_or(*kind, "scale", Eigen::Vector3d::Ones(), item)};
      if ((mesh.scale.array() == 0.0).any())
        fail(*kind, item + ": <mesh> has a scale of zero: " + kind->Attribute("scale"));
      result.shape = mesh;
    } else {
      fail(*kind,
           item + ": geometry <" + std::string(tag) + "> is none of box, cylinder, sphere, mesh");
    }
    return result;
  }

  /// Reads the mass and, where given, the center of mass and the inertia, which is rotated into the
  /// link's axes.
  LinkInertia inertia(const XMLElement& e, const std::string& item) const {
    LinkInertia result;
    const XMLElement* mass = e.FirstChildElement("mass");
    if (mass == nullptr) fail(e, item + ": <inertial> without <mass>");
    result.mass = number(*mass, "value", item);
    if (result.mass < 0.0) fail(*mass, item + ": <mass> is negative: " + mass->Attribute("value"));
    const geometry::RigidTransform X_LI = origin(e, item);
    result.center_L = X_LI.translation();
    if (const XMLElement* tensor = e.FirstChildElement("inertia")) {
      const auto entry = [&](const char* name) { return number_or(*tensor, name, 0.0, item); };
      Eigen::Matrix3d inertia_I;
      // The entries are read before they are assigned: Eigen asserts that a list once begun is
      // completed.
      const double xx = entry("ixx"), xy = entry("ixy"), xz = entry("ixz");
      const double yy = entry("iyy"), yz = entry("iyz"), zz = entry("izz");
      inertia_I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
      result.inertia_L = X_LI.linear() * inertia_I * X_LI.linear().transpose();
    }
    return result;
  }

  DescribedLink link(const XMLElement& e) {
    DescribedLink result;
    result.name = text_of(e, "name", "link");
    const std::string item = "link " + result.name;
    if (!link_names_.insert(result.name).second) fail(e, "two links named " + result.name);
    const auto shapes = [&](const char* tag) {
      std::vector<DescribedGeometry> parts;
      for (const XMLElement* at = e.FirstChildElement(tag); at; at = at->NextSiblingElement(tag)) {
        findings_.attempt([&] { parts.push_back(shape(*at, item)); }, item);
      }
      return parts;
    };
    result.visual = shapes("visual");
    result.collision = shapes("collision");
    if (const XMLElement* i = e.FirstChildElement("inertial")) {
      findings_.attempt([&] { result.inertia = inertia(*i, item); }, item);
    }
    return result;
  }

  DescribedJoint::Type type(const XMLElement& e, const std::string& item) const {
    using Type = DescribedJoint::Type;
    const std::string text = text_of(e, "type", item);
    if (text == "fixed") return Type::Fixed;
    if (text == "revolute") return Type::Revolute;
    if (text == "continuous") return Type::Continuous;
    if (text == "prismatic") return Type::Prismatic;
    fail(e, item + ": type " + text + " is none of fixed, revolute, continuous, prismatic");
  }

  void axis(const XMLElement& e, const std::string& item, DescribedJoint& result) {
    const XMLElement* axis = e.FirstChildElement("axis");
    if (axis == nullptr) return;
    const Eigen::Vector3d given = vector_or(*axis, "xyz", Eigen::Vector3d::UnitX(), item);
    const double length = given.norm();
    if (length == 0.0) fail(*axis, item + ": axis 0 0 0");
    result.axis = given / length;
    if (std::abs(length - 1.0) > kUnitSlack) {
      findings_.suspicious(
          item, line(*axis) + "its axis has length " + rounded(length) +
                    ", not 1; a URDF says nothing by that length. If it is the ratio of a "
                    "transmission, add a coupling with ratio " +
                    rounded(length) + " to the sidecar");
    }
  }

  void limits(const XMLElement& e, const std::string& item, DescribedJoint& result) {
    if (result.type == DescribedJoint::Type::Continuous) {
      // The range is one turn: positions beyond it give the same poses.
      result.lower = -std::numbers::pi;
      result.upper = std::numbers::pi;
      return;
    }
    const XMLElement* limit = e.FirstChildElement("limit");
    if (limit == nullptr || (!limit->Attribute("lower") && !limit->Attribute("upper"))) {
      fail(e, item + ": no limits");
    }
    result.lower = number_or(*limit, "lower", 0.0, item);
    result.upper = number_or(*limit, "upper", 0.0, item);
    const std::string range = "limits " + base::shortest_decimal(result.lower) + " to " +
                              base::shortest_decimal(result.upper);
    if (result.lower > result.upper) fail(*limit, item + ": " + range + " are reversed");
    for (const char* end : {"lower", "upper"}) {
      if (!limit->Attribute(end)) {
        findings_.note(item, line(*limit) + "no " + end + " limit; read as 0");
      }
    }
    if (result.lower == result.upper) {
      findings_.suspicious(item, line(*limit) + range + ": it cannot move");
    }
    const bool is_revolute = result.type == DescribedJoint::Type::Revolute;
    const double farthest = std::max(std::abs(result.lower), std::abs(result.upper));
    if (farthest > (is_revolute ? kFullTurn : kLongestStroke)) {
      findings_.suspicious(
          item, line(*limit) + range + " are read as " +
                    (is_revolute ? "radians; are they degrees?" : "meters; are they millimeters?"));
    }
  }

  DescribedJoint joint(const XMLElement& e) {
    DescribedJoint result;
    result.name = text_of(e, "name", "joint");
    const std::string item = "joint " + result.name;
    const auto attempt = [&](const auto& step) { findings_.attempt(step, item); };
    attempt([&] {
      if (!joint_names_.insert(result.name).second) fail(e, "two joints named " + result.name);
    });
    attempt([&] { result.type = type(e, item); });
    const auto end_link = [&](const char* tag) {
      const XMLElement* child = e.FirstChildElement(tag);
      if (child == nullptr) fail(e, item + ": no <" + tag + ">");
      return text_of(*child, "link", item);
    };
    result.parent = end_link("parent");
    result.child = end_link("child");
    attempt([&] { result.X_PJ = origin(e, item); });
    if (result.type == DescribedJoint::Type::Fixed) return result;

    attempt([&] { axis(e, item, result); });
    attempt([&] { limits(e, item, result); });
    attempt([&] {
      const XMLElement* mimic = e.FirstChildElement("mimic");
      if (mimic == nullptr) return;
      result.coupling = DescribedCoupling{text_of(*mimic, "joint", item),
                                          number_or(*mimic, "multiplier", 1.0, item),
                                          number_or(*mimic, "offset", 0.0, item), false};
    });
    return result;
  }

  Findings& findings_;
  std::set<std::string> link_names_;
  std::set<std::string> joint_names_;
};

}  // namespace

RobotDescription parse_urdf(const std::string& text, const std::string& file, Findings& findings) {
  return Parser(file, findings).parse(text);
}

}  // namespace graspfit::hands::internal
