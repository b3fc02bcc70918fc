#include "internal/urdf.hpp"

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"

namespace graspfit::hands::internal {

namespace {

using geometry::InvalidInput;
using geometry::IoError;
using tinyxml2::XMLElement;

/// Reads one file: every complaint names the file, the line and the item.
class Parser {
 public:
  Parser(std::string file, Findings& findings) : file_(std::move(file)), findings_(findings) {}

  RobotDescription parse(const std::string& text) {
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
      throw IoError(file_ + ": empty file");
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      throw IoError(file_ + ": line " + std::to_string(document.ErrorLineNum()) + ": not XML (" +
                    std::string(document.ErrorName()) + ")");
    }
    const XMLElement* root = document.RootElement();
    if (root == nullptr || std::string_view(root->Name()) != "robot") {
      throw IoError(file_ + ": not a URDF: its root element is <" +
                    (root ? std::string(root->Name()) : std::string()) + ">, not <robot>");
    }
    RobotDescription urdf;
    urdf.name = text_of(*root, "name", "robot");
    for (const XMLElement* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      if (tag.substr(0, 6) == "xacro:") {
        fail(*e, "<" + std::string(tag) + ">: this is a xacro file; expand it to a URDF first");
      }
      findings_.attempt([&] {
        if (tag == "link") urdf.links.push_back(link(*e));
        if (tag == "joint") urdf.joints.push_back(joint(*e));
      });
    }
    return urdf;
  }

 private:
  [[noreturn]] void fail(const XMLElement& at, const std::string& what) const {
    throw InvalidInput(file_ + ": line " + std::to_string(at.GetLineNum()) + ": " + what);
  }

  /// A required attribute that is not empty.
  std::string text_of(const XMLElement& e, const char* attribute, const std::string& item) const {
    const char* value = e.Attribute(attribute);
    if (value == nullptr || *value == '\0') {
      fail(e, item + ": <" + e.Name() + "> has no " + attribute);
    }
    return value;
  }

  /// `count` numbers separated by blanks.
  std::vector<double> parse_numbers(const XMLElement& e, std::string_view text, std::size_t count,
                                    const std::string& item) const {
    std::vector<double> values;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    const auto complain = [&](const std::string& why) {
      fail(e, item + ": <" + e.Name() + "> \"" + std::string(text) + "\" " + why);
    };
    while (true) {
      while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
      if (at == end) break;
      if (*at == '+') ++at;
      double value = 0.0;
      const auto [rest, error] = std::from_chars(at, end, value);
      const bool ends_here =
          rest == end || *rest == ' ' || *rest == '\t' || *rest == '\n' || *rest == '\r';
      if (error != std::errc() || !ends_here) complain("is not a number");
      if (!std::isfinite(value)) complain("is not finite");
      values.push_back(value);
      at = rest;
    }
    if (values.size() != count) {
      complain("has " + std::to_string(values.size()) + " of " + std::to_string(count) +
               " numbers");
    }
    return values;
  }

  double number(const XMLElement& e, const char* attribute, const std::string& item) const {
    return parse_numbers(e, text_of(e, attribute, item), 1, item)[0];
  }

  double number_or(const XMLElement& e, const char* attribute, double otherwise,
                   const std::string& item) const {
    return e.Attribute(attribute) ? number(e, attribute, item) : otherwise;
  }

  double positive(const XMLElement& e, const char* attribute, const std::string& item) const {
    const double value = number(e, attribute, item);
    if (value <= 0.0)
      fail(e, item + ": <" + e.Name() + "> has a " + attribute + " that is not positive");
    return value;
  }

  Eigen::Vector3d vector_or(const XMLElement& e, const char* attribute,
                            const Eigen::Vector3d& otherwise, const std::string& item) const {
    if (!e.Attribute(attribute)) return otherwise;
    const std::vector<double> v = parse_numbers(e, e.Attribute(attribute), 3, item);
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
      const std::vector<double> size = parse_numbers(*kind, text_of(*kind, "size", item), 3, item);
      if (!(size[0] > 0.0 && size[1] > 0.0 && size[2] > 0.0)) {
        fail(*kind, item + ": <box> has a size that is not positive");
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
      if ((mesh.scale.array() == 0.0).any()) fail(*kind, item + ": <mesh> has a scale of zero");
      result.shape = mesh;
    } else {
      fail(*kind,
           item + ": geometry <" + std::string(tag) + "> is none of box, cylinder, sphere, mesh");
    }
    return result;
  }

  /// Mass, and where given center of mass and inertia; the latter turned into the link's axes.
  LinkInertia inertia(const XMLElement& e, const std::string& item) const {
    LinkInertia result;
    const XMLElement* mass = e.FirstChildElement("mass");
    if (mass == nullptr) fail(e, item + ": <inertial> without <mass>");
    result.mass = number(*mass, "value", item);
    if (result.mass < 0.0) fail(*mass, item + ": <mass> is negative");
    const geometry::RigidTransform X_LI = origin(e, item);
    result.center_L = X_LI.translation();
    if (const XMLElement* tensor = e.FirstChildElement("inertia")) {
      const auto entry = [&](const char* name) { return number_or(*tensor, name, 0.0, item); };
      Eigen::Matrix3d inertia_I;
      inertia_I << entry("ixx"), entry("ixy"), entry("ixz"), entry("ixy"), entry("iyy"),
          entry("iyz"), entry("ixz"), entry("iyz"), entry("izz");
      result.inertia_L = X_LI.linear() * inertia_I * X_LI.linear().transpose();
    }
    return result;
  }

  DescribedLink link(const XMLElement& e) {
    DescribedLink result;
    result.name = text_of(e, "name", "link");
    const std::string item = "link " + result.name;
    if (!link_names_.insert(result.name).second) fail(e, "two links named " + result.name);
    for (const XMLElement* v = e.FirstChildElement("visual"); v;
         v = v->NextSiblingElement("visual")) {
      result.visual.push_back(shape(*v, item));
    }
    for (const XMLElement* c = e.FirstChildElement("collision"); c;
         c = c->NextSiblingElement("collision")) {
      result.collision.push_back(shape(*c, item));
    }
    if (const XMLElement* i = e.FirstChildElement("inertial")) result.inertia = inertia(*i, item);
    return result;
  }

  DescribedJoint joint(const XMLElement& e) {
    DescribedJoint result;
    result.name = text_of(e, "name", "joint");
    const std::string item = "joint " + result.name;
    if (!joint_names_.insert(result.name).second) fail(e, "two joints named " + result.name);
    const std::string type = text_of(e, "type", item);
    using Type = DescribedJoint::Type;
    if (type == "fixed") {
      result.type = Type::Fixed;
    } else if (type == "revolute") {
      result.type = Type::Revolute;
    } else if (type == "continuous") {
      result.type = Type::Continuous;
    } else if (type == "prismatic") {
      result.type = Type::Prismatic;
    } else {
      fail(e, item + ": type " + type + " is none of fixed, revolute, continuous, prismatic");
    }
    const auto end_link = [&](const char* tag) {
      const XMLElement* child = e.FirstChildElement(tag);
      if (child == nullptr) fail(e, item + ": no <" + tag + ">");
      return text_of(*child, "link", item);
    };
    result.parent = end_link("parent");
    result.child = end_link("child");
    result.X_PJ = origin(e, item);
    if (result.type == Type::Fixed) return result;

    if (const XMLElement* axis = e.FirstChildElement("axis")) {
      result.axis = vector_or(*axis, "xyz", Eigen::Vector3d::UnitX(), item);
      if (result.axis.norm() == 0.0) fail(*axis, item + ": axis 0 0 0");
      result.axis.normalize();
    }
    const XMLElement* limit = e.FirstChildElement("limit");
    if (result.type == Type::Continuous) {
      // One turn: what lies beyond is the same pose.
      result.lower = -std::numbers::pi;
      result.upper = std::numbers::pi;
    } else {
      if (limit == nullptr || (!limit->Attribute("lower") && !limit->Attribute("upper"))) {
        fail(e, item + ": no limits");
      }
      result.lower = number_or(*limit, "lower", 0.0, item);
      result.upper = number_or(*limit, "upper", 0.0, item);
      if (result.lower > result.upper) {
        fail(*limit, item + ": limits " + geometry::shortest_decimal(result.lower) + " to " +
                         geometry::shortest_decimal(result.upper) + " are reversed");
      }
    }
    if (const XMLElement* mimic = e.FirstChildElement("mimic")) {
      result.coupling = DescribedCoupling{text_of(*mimic, "joint", item),
                                          number_or(*mimic, "multiplier", 1.0, item),
                                          number_or(*mimic, "offset", 0.0, item), false};
    }
    return result;
  }

  std::string file_;
  Findings& findings_;
  std::set<std::string> link_names_;
  std::set<std::string> joint_names_;
};

}  // namespace

RobotDescription parse_urdf(const std::string& text, const std::string& file, Findings& findings) {
  return Parser(file, findings).parse(text);
}

}  // namespace graspfit::hands::internal
