#include "import/graspit.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "description/xml_source.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/units.hpp"
#include "import/mesh_borrowing.hpp"

namespace graspfit::hands::internal {

namespace {

namespace fs = std::filesystem;
using base::kMetersPerMillimeter;
using base::kRadiansPerDegree;
using base::shortest_decimal;
using geometry::RigidTransform;
using tinyxml2::XMLElement;

/// Largest norm of R R^T - I of a matrix that is taken for a rotation; entries of three decimals
/// give 3e-3.
constexpr double kRotationSlack = 1e-2;

RigidTransform turn(double angle, const Eigen::Vector3d& axis) {
  return RigidTransform(Eigen::AngleAxisd(angle, axis));
}
RigidTransform shift(const Eigen::Vector3d& by) { return RigidTransform(Eigen::Translation3d(by)); }

/// An expression dK * ratio + offset, with ratio and offset as the file writes them.
struct Expression {
  int dof = -1;
  double ratio = 1.0;
  double offset = 0.0;
};

/// A joint of a chain, in meters and radians.
struct ChainJoint {
  DescribedJoint described;
  Expression value;
  /// Joint frame in GraspIt!'s frame of the link before it.
  RigidTransform before = RigidTransform::Identity();
  /// GraspIt!'s frame of the link in our frame of the link.
  RigidTransform after = RigidTransform::Identity();
};

struct ChainLink {
  std::string body;  ///< File name as written.
  int num_joints = 1;
};

/// Reads one file.
class Reader : private XmlSource {
 public:
  Reader(const fs::path& file, Findings& findings)
      : XmlSource(file.string()), path_(file), findings_(findings) {}

  RobotDescription parse(const std::string& text) {
    tinyxml2::XMLDocument document;
    const XMLElement& root = XmlSource::parse(text, "robot", "GraspIt! robot XML", document);
    description_.meters_per_unit = kMetersPerMillimeter;
    description_.name =
        root.Attribute("DBName") ? text_of(root, "DBName", "robot") : path_.stem().string();
    dofs(root);
    name_links(root);
    const XMLElement* palm = root.FirstChildElement("palm");
    if (palm == nullptr) fail(root, "no <palm>");
    DescribedLink base;
    base.name = palm_name_;
    body_geometry(content(*palm, "palm"), RigidTransform::Identity(), base);
    description_.links.push_back(std::move(base));
    int index = 0;
    for (const XMLElement* e = root.FirstChildElement("chain"); e;
         e = e->NextSiblingElement("chain"), ++index) {
      findings_.attempt([&] { chain(*e, index); }, "chain " + std::to_string(index));
    }
    if (index == 0) fail(root, "no <chain>");
    // Limits of joints with faults say nothing.
    if (!findings_.has_faults()) findings_.attempt([&] { share_dofs(root); });
    if (lacks_meshes_ && !findings_.has_faults()) {
      description_ = with_borrowed_meshes(path_, description_, findings_);
    }
    return std::move(description_);
  }

 private:
  struct Dof {
    bool breakaway = false;
    std::vector<std::size_t> joints;  ///< Indices into `description_.joints`, in file order.
    std::vector<double> ratios;
  };

  std::string content(const XMLElement& e, const std::string& item) const {
    const std::string_view text = e.GetText() ? e.GetText() : "";
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) fail(e, item + ": <" + e.Name() + "> is empty");
    return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
  }

  const XMLElement& child(const XMLElement& e, const char* tag, const std::string& item) const {
    const XMLElement* found = e.FirstChildElement(tag);
    if (found == nullptr) fail(e, item + ": no <" + tag + ">");
    return *found;
  }

  double value(const XMLElement& e, const char* tag, const std::string& item) const {
    const XMLElement& at = child(e, tag, item);
    return numbers(at, content(at, item), 1, item)[0];
  }

  void dofs(const XMLElement& root) {
    for (const XMLElement* e = root.FirstChildElement("dof"); e; e = e->NextSiblingElement("dof")) {
      const char* type = e->Attribute("type");
      dofs_.push_back({.breakaway = (type && std::string_view(type) == "b") ||
                                    e->FirstChildElement("breakAwayTorque") != nullptr,
                       .joints = {},
                       .ratios = {}});
    }
    if (dofs_.empty()) fail(root, "no <dof>");
  }

  /// Sets the names of palm and links: stems of body files, made unique by the chain and the index
  /// in it.
  void name_links(const XMLElement& root) {
    const auto stem = [&](const XMLElement& e) {
      return plain(e, fs::path(content(e, "link")).stem().string(), "link");
    };
    std::map<std::string, int> count;
    if (const XMLElement* palm = root.FirstChildElement("palm")) {
      palm_name_ = stem(*palm);
      ++count[palm_name_];
    }
    std::vector<std::vector<std::string>> stems;
    for (const XMLElement* c = root.FirstChildElement("chain"); c;
         c = c->NextSiblingElement("chain")) {
      stems.emplace_back();
      for (const XMLElement* l = c->FirstChildElement("link"); l;
           l = l->NextSiblingElement("link")) {
        stems.back().push_back(stem(*l));
        ++count[stems.back().back()];
      }
    }
    for (std::size_t c = 0; c < stems.size(); ++c) {
      link_names_.emplace_back();
      for (std::size_t l = 0; l < stems[c].size(); ++l) {
        std::string name = stems[c][l];
        if (count[name] > 1) name = "chain" + std::to_string(c) + "_" + name;
        const auto repeated = std::count(stems[c].begin(), stems[c].end(), stems[c][l]);
        if (repeated > 1) name += "_" + std::to_string(l);
        link_names_.back().push_back(name);
      }
    }
  }

  /// Reads a <transform>: each part is a transform in the frame that the parts before it end in.
  RigidTransform transform(const XMLElement& e, const std::string& item) const {
    RigidTransform X = RigidTransform::Identity();
    for (const XMLElement* part = e.FirstChildElement(); part; part = part->NextSiblingElement()) {
      const std::string_view tag = part->Name();
      const std::string text = content(*part, item);
      if (tag == "translation") {
        const std::vector<double> v = numbers(*part, text, 3, item);
        X = X * shift(kMetersPerMillimeter * Eigen::Vector3d(v[0], v[1], v[2]));
      } else if (tag == "rotation") {
        X = X * rotation(*part, text, item);
      } else if (tag == "rotationMatrix") {
        X = X * rotation_matrix(*part, text, item);
      } else if (tag == "fullTransform") {
        X = X * full_transform(*part, text, item);
      } else {
        fail(*part, item + ": <" + std::string(tag) +
                        "> is none of translation, rotation, rotationMatrix, fullTransform");
      }
    }
    return X;
  }

  /// Reads a rotation such as "-90 y": degrees about an axis.
  RigidTransform rotation(const XMLElement& e, const std::string& text,
                          const std::string& item) const {
    const char axis = text.back();
    if (axis < 'x' || axis > 'z') {
      fail(e, item + ": <rotation> \"" + text + "\" does not end in x, y or z");
    }
    const double angle = numbers(e, text.substr(0, text.size() - 1), 1, item)[0];
    return turn(angle * kRadiansPerDegree, Eigen::Vector3d::Unit(axis - 'x'));
  }

  /// Reads nine numbers, column by column, and returns the nearest rotation.
  RigidTransform rotation_matrix(const XMLElement& e, const std::string& text,
                                 const std::string& item) const {
    const std::vector<double> v = numbers(e, text, 9, item);
    const Eigen::Matrix3d given = Eigen::Map<const Eigen::Matrix3d>(v.data());  // column-major
    const double error = (given * given.transpose() - Eigen::Matrix3d::Identity()).norm();
    if (!(error < kRotationSlack) || given.determinant() < 0.0) {
      fail(e, item + ": <rotationMatrix> is no rotation: R R^T differs from 1 by " +
                  shortest_decimal(error) + ", determinant " +
                  shortest_decimal(given.determinant()));
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(given, Eigen::ComputeFullU | Eigen::ComputeFullV);
    RigidTransform X = RigidTransform::Identity();
    X.linear() = svd.matrixU() * svd.matrixV().transpose();
    return X;
  }

  /// Reads "(w x y z)[x y z]": a unit quaternion and a translation in millimeters.
  RigidTransform full_transform(const XMLElement& e, std::string text,
                                const std::string& item) const {
    for (char& c : text) {
      if (c == '(' || c == ')' || c == '[' || c == ']') c = ' ';
    }
    const std::vector<double> v = numbers(e, text, 7, item);
    const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
    if (std::abs(q.norm() - 1.0) > kRotationSlack) {
      fail(e, item + ": <fullTransform> has a quaternion of length " + shortest_decimal(q.norm()));
    }
    return shift(kMetersPerMillimeter * Eigen::Vector3d(v[4], v[5], v[6])) *
           RigidTransform(q.normalized());
  }

  /// Reads an expression such as d1, d1*0.33, d1+40 or d1*-1+-2.46; blanks do not count.
  Expression expression(const XMLElement& e, const std::string& item) const {
    const std::string text = content(e, item);
    std::string packed;
    for (const char c : text) {
      if (c != ' ' && c != '\t') packed += c;
    }
    const auto complain = [&](const std::string& why) {
      fail(e, item + ": <" + e.Name() + "> \"" + text + "\" " + why);
    };
    const char* at = packed.data();
    const char* const end = at + packed.size();
    Expression result;
    if (at == end || *at++ != 'd') complain("names no degree of freedom (d0, d1*0.33+40)");
    const auto dof = std::from_chars(at, end, result.dof);
    if (dof.ec != std::errc() || result.dof < 0) complain("names no degree of freedom");
    at = dof.ptr;
    const auto number = [&](double& into) {
      if (at != end && *at == '+') ++at;
      const auto [rest, error] = std::from_chars(at, end, into);
      if (error != std::errc() || !std::isfinite(into)) complain("is not d#*ratio+offset");
      at = rest;
    };
    if (at != end && *at == '*') {
      ++at;
      number(result.ratio);
    }
    if (at != end && (*at == '+' || *at == '-')) {
      if (*at == '+') ++at;
      number(result.offset);
    }
    if (at != end) complain("is not d#*ratio+offset");
    if (result.dof >= std::ssize(dofs_)) {
      complain("uses degree of freedom " + std::to_string(result.dof) + " of " +
               std::to_string(dofs_.size()));
    }
    if (result.ratio == 0.0) complain("has a ratio of 0: the joint never moves");
    return result;
  }

  ChainJoint joint(const XMLElement& e, int chain, int index) {
    ChainJoint result;
    const std::string where = "chain" + std::to_string(chain) + "_joint" + std::to_string(index);
    const std::string type = text_of(e, "type", where);
    const bool is_revolute = type == "Revolute";
    if (!is_revolute && type != "Prismatic") {
      fail(e, where + ": type " + type + " is neither Revolute nor Prismatic");
    }
    result.value = expression(child(e, is_revolute ? "theta" : "d", where), where);
    DescribedJoint& described = result.described;
    described.name = "d" + std::to_string(result.value.dof) + "_" + where;
    const std::string item = "joint " + described.name;
    described.type = is_revolute ? DescribedJoint::Type::Revolute : DescribedJoint::Type::Prismatic;
    described.axis = Eigen::Vector3d::UnitZ();
    const double unit = is_revolute ? kRadiansPerDegree : kMetersPerMillimeter;
    const RigidTransform offset =
        is_revolute ? turn(result.value.offset * kRadiansPerDegree, Eigen::Vector3d::UnitZ())
                    : shift({0, 0, result.value.offset * kMetersPerMillimeter});
    const RigidTransform fixed =
        is_revolute ? shift({0, 0, value(e, "d", item) * kMetersPerMillimeter})
                    : turn(value(e, "theta", item) * kRadiansPerDegree, Eigen::Vector3d::UnitZ());
    const RigidTransform link =
        shift({value(e, "a", item) * kMetersPerMillimeter, 0, 0}) *
        turn(value(e, "alpha", item) * kRadiansPerDegree, Eigen::Vector3d::UnitX());
    result.before = is_revolute ? offset : fixed * offset;
    result.after = is_revolute ? fixed * link : link;
    findings_.attempt(
        [&] {
          if (!e.FirstChildElement("minValue") || !e.FirstChildElement("maxValue")) {
            fail(e, item + ": no limits");
          }
          const double lower = value(e, "minValue", item);
          const double upper = value(e, "maxValue", item);
          described.lower = lower * unit;
          described.upper = upper * unit;
          const std::string range = "limits " + shortest_decimal(lower) + " to " +
                                    shortest_decimal(upper) + (is_revolute ? " degrees" : " mm");
          if (described.lower > described.upper) fail(e, item + ": " + range + " are reversed");
          if (described.lower == described.upper) {
            findings_.suspicious(item, line(e) + range + ": it cannot move");
          }
        },
        item);
    return result;
  }

  ChainLink link(const XMLElement& e, const std::string& item) const {
    const std::string type = text_of(e, "dynamicJointType", item);
    const std::map<std::string, int> num_joints = {
        {"Fixed", 0}, {"Revolute", 1}, {"Prismatic", 1}, {"Universal", 2}, {"Ball", 3}};
    const auto found = num_joints.find(type);
    if (found == num_joints.end()) {
      fail(e, item + ": dynamicJointType " + type +
                  " is none of Fixed, Revolute, Prismatic, Universal, Ball");
    }
    return {content(e, item), found->second};
  }

  void chain(const XMLElement& e, int index) {
    const std::string item = "chain " + std::to_string(index);
    const XMLElement* base = e.FirstChildElement("transform");
    std::vector<ChainJoint> joints;
    for (const XMLElement* at = e.FirstChildElement("joint"); at;
         at = at->NextSiblingElement("joint")) {
      joints.push_back(joint(*at, index, base::as_index<int>(joints.size())));
    }
    std::vector<ChainLink> links;
    int num_used = 0;
    for (const XMLElement* at = e.FirstChildElement("link"); at;
         at = at->NextSiblingElement("link")) {
      links.push_back(link(*at, item));
      num_used += links.back().num_joints;
    }
    if (links.empty()) fail(e, item + ": no links");
    if (num_used != std::ssize(joints)) {
      fail(e, item + ": its links hang on " + std::to_string(num_used) + " joints, but it has " +
                  std::to_string(joints.size()));
    }
    // Transform from our frame of the last link (at its own joint) to GraspIt!'s, where the next
    // joint starts.
    RigidTransform X_PG = base ? transform(*base, item) : RigidTransform::Identity();
    std::string parent = palm_name_;
    auto next = joints.begin();
    for (std::size_t l = 0; l < links.size(); ++l) {
      const std::string& name = link_names_[index][l];
      for (int j = 0; j < links[l].num_joints; ++j, ++next) {
        DescribedJoint described = next->described;
        described.X_PJ = X_PG * next->before;
        described.parent = parent;
        described.child = j + 1 == links[l].num_joints ? name : described.name + "_link";
        parent = described.child;
        X_PG = next->after;
        Dof& dof = dofs_[next->value.dof];
        dof.joints.push_back(description_.joints.size());
        dof.ratios.push_back(next->value.ratio);
        description_.joints.push_back(std::move(described));
        if (j + 1 < links[l].num_joints) {
          description_.links.emplace_back();
          description_.links.back().name = parent;
        }
      }
      if (links[l].num_joints == 0) {
        DescribedJoint mount;
        mount.name = name + "_mount";
        mount.parent = parent;
        mount.child = name;
        mount.X_PJ = X_PG;
        X_PG = RigidTransform::Identity();
        parent = name;
        description_.joints.push_back(std::move(mount));
      }
      DescribedLink described;
      described.name = name;
      findings_.attempt([&] { body_geometry(links[l].body, X_PG, described); }, "link " + name);
      description_.links.push_back(std::move(described));
    }
  }

  /// Sets couplings and limits of joints that share a degree of freedom.
  void share_dofs(const XMLElement& root) {
    for (std::size_t d = 0; d < dofs_.size(); ++d) {
      const Dof& dof = dofs_[d];
      const std::string item = "degree of freedom d" + std::to_string(d);
      if (dof.joints.empty()) {
        findings_.suspicious("", item + " moves no joint");
        continue;
      }
      // The range of dK that all of its joints allow.
      double lower = -std::numeric_limits<double>::infinity();
      double upper = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < dof.joints.size(); ++k) {
        const DescribedJoint& joint = description_.joints[dof.joints[k]];
        const double a = joint.lower / dof.ratios[k];
        const double b = joint.upper / dof.ratios[k];
        lower = std::max(lower, std::min(a, b));
        upper = std::min(upper, std::max(a, b));
      }
      if (lower > upper) fail(root, item + ": the limits of its joints exclude each other");
      DescribedJoint& leader = description_.joints[dof.joints[0]];
      const double a = dof.ratios[0] * lower;
      const double b = dof.ratios[0] * upper;
      if (dof.joints.size() > 1) {
        const double range[] = {std::min(a, b), std::max(a, b)};
        constexpr double kRounding = 1e-9;  // of a ratio and back [rad] or [m]
        if (range[0] - leader.lower > kRounding || leader.upper - range[1] > kRounding) {
          findings_.note("joint " + leader.name,
                         "limits narrowed to " + shortest_decimal(range[0]) + " to " +
                             shortest_decimal(range[1]) + " by joints on the same " + item);
          leader.lower = range[0];
          leader.upper = range[1];
        }
      }
      for (std::size_t k = 1; k < dof.joints.size(); ++k) {
        description_.joints[dof.joints[k]].coupling =
            DescribedCoupling{leader.name, dof.ratios[k] / dof.ratios[0], 0.0, dof.breakaway};
      }
    }
  }

  /// Adds the geometry that a body file names, if both files exist and the geometry is a mesh that
  /// can be read.
  void body_geometry(const std::string& body, const RigidTransform& X_LG, DescribedLink& link) {
    const fs::path folder = fs::absolute(path_).parent_path();
    std::error_code error;
    for (fs::path mesh : {folder / "iv" / body, folder / body}) {
      if (!fs::is_regular_file(mesh, error)) continue;
      if (mesh.extension() == ".xml") mesh = geometry_file(mesh);
      const std::string name = mesh.lexically_relative(folder).generic_string();
      const std::set<std::string> readable = {".off", ".obj", ".ply", ".stl", ".gltf", ".glb"};
      if (!readable.contains(mesh.extension().string())) {
        findings_.note("link " + link.name, name + " is no mesh format that is read");
      } else if (!fs::is_regular_file(mesh, error)) {
        findings_.note("link " + link.name, name + " is not there");
      } else {
        DescribedGeometry& added = link.collision.emplace_back();
        added.X_LG = X_LG;
        added.shape = MeshFileShape{name, Eigen::Vector3d::Constant(kMetersPerMillimeter)};
        return;
      }
      break;
    }
    lacks_meshes_ = true;
  }

  /// The mesh that a body file names, relative to itself.
  static fs::path geometry_file(const fs::path& body) {
    const XmlSource source(body.string());
    tinyxml2::XMLDocument document;
    const XMLElement& root =
        source.parse(base::read_file(body), "root", "a GraspIt! body", document);
    const XMLElement* file = root.FirstChildElement("geometryFile");
    if (file == nullptr || file->GetText() == nullptr) source.fail(root, "no <geometryFile>");
    const std::string_view text = file->GetText();
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) source.fail(*file, "<geometryFile> is empty");
    return body.parent_path() / text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
  }

  fs::path path_;
  Findings& findings_;
  RobotDescription description_;
  std::vector<Dof> dofs_;
  std::string palm_name_;
  std::vector<std::vector<std::string>> link_names_;  ///< Per chain.
  bool lacks_meshes_ = false;
};

}  // namespace

RobotDescription parse_graspit(const std::string& text, const std::filesystem::path& file,
                               Findings& findings) {
  return Reader(file, findings).parse(text);
}

}  // namespace graspfit::hands::internal
