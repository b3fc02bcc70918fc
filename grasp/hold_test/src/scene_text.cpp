#include "scene_text.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mass_properties.hpp"

namespace graspfit::hold_test::internal {

namespace {

using geometry::RigidTransform;
using hands::JointType;

/// Volume below which the engine refuses a mesh [m³].
constexpr double kLeastPieceVolume = 1e-13;

/// Least mass and inertia of a body [kg, kg m²]: the engine would refuse a link that states zero.
constexpr double kLeastMass = 1e-4;
constexpr double kLeastInertia = 1e-8;

/// Range of joints that cannot move, as the engine asks for an interval [rad or m].
constexpr double kLeastRange = 1e-9;

/// Drive of the slide that lifts the hand: so stiff that 10 N move it by 0.1 mm, so inert that
/// fingers do not shake it.
constexpr double kLiftStiffness = 1e5;  // [N/m]
constexpr double kLiftDamping = 2e3;    // [N s/m]: critical.
constexpr double kLiftArmature = 10.0;  // [kg]

std::string number(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

template <class Values>
std::string numbers(const Values& values) {
  return base::list_text(values, number, " ");
}

std::string attribute(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + value + "\"";
}

std::string position(const Eigen::Vector3d& p) { return attribute("pos", numbers(p)); }

std::string pose(const RigidTransform& X) {
  const Eigen::Quaterniond q(X.linear());
  return position(X.translation()) +
         attribute("quat", numbers(std::array{q.w(), q.x(), q.y(), q.z()}));
}

std::string inertial(double mass, const Eigen::Vector3d& center, const Eigen::Matrix3d& inertia) {
  const std::array full = {inertia(0, 0), inertia(1, 1), inertia(2, 2),
                           inertia(0, 1), inertia(0, 2), inertia(1, 2)};
  return "<inertial" + position(center) + attribute("mass", number(mass)) +
         attribute("fullinertia", numbers(full)) + "/>\n";
}

bool is_positive_definite(const Eigen::Matrix3d& inertia) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues().minCoeff() > 0.0;
}

class Scene {
 public:
  Scene(const HoldHand& hand, const HoldObject& object, const HoldProtocol& protocol)
      : hand_(hand), object_(object), protocol_(protocol) {}

  std::string text() {
    add_hand();
    add_object();
    add_pairs();
    add_drives();
    return "<mujoco model=\"hold test\">\n" + settings() + "<asset>\n" + meshes_ +
           "</asset>\n<worldbody>\n" + bodies_ + "</worldbody>\n<contact>\n" + exclusions_ +
           "</contact>\n<equality>\n" + equalities_ + "</equality>\n<actuator>\n" + actuators_ +
           "</actuator>\n</mujoco>\n";
  }

 private:
  const hands::HandModel& model() const { return hand_.model; }

  double stiffness(const hands::Joint& joint) const {
    return joint.type == JointType::Prismatic ? protocol_.slide_stiffness : protocol_.stiffness;
  }

  std::string settings() const {
    return "<compiler angle=\"radian\" balanceinertia=\"true\"" +
           attribute("boundmass", number(kLeastMass)) +
           attribute("boundinertia", number(kLeastInertia)) + "/>\n<size" +
           attribute("nconmax", "400") + attribute("njmax", "1600") + "/>\n<option" +
           attribute("timestep", number(protocol_.step)) +
           attribute("impratio", number(protocol_.impratio)) +
           attribute("noslip_iterations", std::to_string(protocol_.noslip_iterations)) +
           attribute("integrator", "implicit") + attribute("cone", "elliptic") +
           attribute("gravity", "0 0 0") + ">\n<flag" +
           attribute("multiccd", protocol_.multi_point_contacts ? "enable" : "disable") +
           "/>\n</option>\n<default>\n<geom condim=\"4\" type=\"mesh\"" +
           attribute("friction", numbers(std::array{protocol_.sliding_friction,
                                                    protocol_.torsional_friction, 1e-4})) +
           "/>\n<default class=\"hand\"><geom contype=\"2\" conaffinity=\"7\"" +
           attribute("solimp", numbers(protocol_.hand_solimp)) +
           attribute("solref", numbers(protocol_.hand_solref)) +
           "/></default>\n<default class=\"object\"><geom contype=\"1\" conaffinity=\"6\"" +
           attribute("solimp", numbers(protocol_.object_solimp)) +
           attribute("solref", numbers(protocol_.object_solref)) + "/></default>\n</default>\n";
  }

  /// Returns the geoms of the pieces, whose meshes are translated by `shift`.
  std::string pieces(const geometry::ConvexDecomposition& shape, const std::string& kind,
                     const Eigen::Vector3d& shift) {
    std::string geoms;
    for (const geometry::TriangleMesh& piece : shape.pieces) {
      if (geometry::signed_volume(piece) < kLeastPieceVolume) continue;
      geoms += hull(piece.vertices, attribute("class", kind), shift);
    }
    return geoms;
  }

  /// Returns the geom of the points' convex hull, translated by `shift`.
  std::string hull(const std::vector<Eigen::Vector3d>& points, const std::string& attributes,
                   const Eigen::Vector3d& shift) {
    const std::string name = "piece_" + std::to_string(num_pieces_++);
    std::string vertices;
    for (const Eigen::Vector3d& point : points) {
      vertices += (vertices.empty() ? "" : " ") + numbers(Eigen::Vector3d(point + shift));
    }
    meshes_ += "<mesh" + attribute("name", name) + attribute("vertex", vertices) + "/>\n";
    return "<geom" + attributes + attribute("mesh", name) + "/>\n";
  }

  /// Returns the link's inertia as described. What the description leaves out or states as zero is
  /// computed from the link's solid, with the described mass or else the protocol's density.
  std::string link_inertial(const hands::Link& link) const {
    const bool has_mass = link.inertia && link.inertia->mass > 0.0;
    if (has_mass && is_positive_definite(link.inertia->inertia_L)) {
      return inertial(link.inertia->mass, link.inertia->center_L, link.inertia->inertia_L);
    }
    if (link.mesh_L.faces.empty()) {
      return inertial(has_mass ? link.inertia->mass : kLeastMass,
                      has_mass ? link.inertia->center_L : Eigen::Vector3d(Eigen::Vector3d::Zero()),
                      kLeastInertia * Eigen::Matrix3d::Identity());
    }
    const geometry::MassProperties solid = geometry::mass_properties(link.mesh_L);
    const double mass = has_mass ? link.inertia->mass : protocol_.link_density * solid.volume;
    return inertial(mass, has_mass ? link.inertia->center_L : solid.center_of_mass,
                    mass / solid.volume * solid.inertia);
  }

  std::string joint_element(int index) const {
    const hands::Joint& joint = model().joints[index];
    const bool is_slide = joint.type == JointType::Prismatic;
    return "<joint" + attribute("name", joint_name(index)) +
           attribute("type", is_slide ? "slide" : "hinge") +
           attribute("axis", numbers(joint.axis_J)) + attribute("limited", "true") +
           attribute("range", numbers(std::array{
                                  joint.lower, std::max(joint.upper, joint.lower + kLeastRange)})) +
           attribute("damping", number(stiffness(joint) * protocol_.damping_time)) +
           attribute("armature", number(is_slide ? protocol_.slide_armature : protocol_.armature)) +
           "/>\n";
  }

  void add_link(int index) {
    const hands::Link& link = model().links[index];
    RigidTransform X_PL = RigidTransform::Identity();
    std::string joint;
    if (link.parent_joint) {
      X_PL = model().joints[*link.parent_joint].X_PJ;
      joint = joint_element(*link.parent_joint);
    } else if (link.parent_link) {
      X_PL = link.X_PL_fixed;
    }
    bodies_ += "<body" + attribute("name", link_name(index)) + pose(X_PL) + ">\n" + joint +
               link_inertial(link) + pieces(hand_.links[index], "hand", Eigen::Vector3d::Zero());
    for (int child = 0; child < std::ssize(model().links); ++child) {
      if (model().links[child].parent_link == index) add_link(child);
    }
    bodies_ += "</body>\n";
  }

  void add_hand() {
    const bool is_lifted = protocol_.load == HoldLoad::Lift;
    if (is_lifted) {
      bodies_ += "<body name=\"lift\">\n<joint name=\"lift\" type=\"slide\" axis=\"0 0 1\"" +
                 attribute("damping", number(kLiftDamping)) +
                 attribute("armature", number(kLiftArmature)) + "/>\n" +
                 inertial(kLeastMass, Eigen::Vector3d::Zero(),
                          kLeastInertia * Eigen::Matrix3d::Identity());
      actuators_ += "<position name=\"lift\" joint=\"lift\"" +
                    attribute("kp", number(kLiftStiffness)) + "/>\n";
    }
    add_link(model().palm.link);
    if (is_lifted) bodies_ += "</body>\n";
  }

  void add_object() {
    const Eigen::Vector3d& center = object_.center_of_mass_O;
    const bool is_on_table = protocol_.load == HoldLoad::Lift;
    bodies_ += "<body name=\"object\"" + position(center) + ">\n<freejoint name=\"object\"/>\n" +
               inertial(protocol_.object_mass, Eigen::Vector3d::Zero(),
                        protocol_.object_mass * object_.inertia_per_mass_O) +
               pieces(object_.shape, "object", -center);
    if (is_on_table && geometry::convex_hull(object_.foot_O).measure > kLeastPieceVolume) {
      // The table alone meets it.
      bodies_ += hull(object_.foot_O,
                      attribute("class", "object") + " contype=\"0\" conaffinity=\"4\"", -center);
    }
    bodies_ += "</body>\n";
    if (!is_on_table) return;
    bodies_ +=
        "<geom class=\"object\" type=\"plane\" size=\"0 0 1\" contype=\"4\" "
        "conaffinity=\"0\"" +
        position({0.0, 0.0, table_z_O(object_)}) + "/>\n";
  }

  void add_pairs() {
    const int num_links = base::as_index<int>(model().links.size());
    for (int a = 0; a < num_links; ++a) {
      for (int b = a + 1; b < num_links; ++b) {
        if (!model().is_excluded(a, b)) continue;
        exclusions_ += "<exclude" + attribute("body1", link_name(a)) +
                       attribute("body2", link_name(b)) + "/>\n";
      }
    }
  }

  void add_drives() {
    for (int j = 0; j < std::ssize(model().joints); ++j) {
      const hands::Joint& joint = model().joints[j];
      if (!joint.coupling || joint.coupling->breakaway) {
        actuators_ += "<position" + attribute("name", joint_name(j)) +
                      attribute("joint", joint_name(j)) +
                      attribute("kp", number(stiffness(joint))) + "/>\n";
      }
      if (!joint.coupling) continue;
      equalities_ +=
          "<joint" + attribute("name", joint_name(j)) + attribute("joint1", joint_name(j)) +
          attribute("joint2", joint_name(joint.coupling->leader)) +
          attribute("polycoef", numbers(std::array{joint.coupling->offset, joint.coupling->ratio,
                                                   0.0, 0.0, 0.0})) +
          attribute("solimp", numbers(protocol_.hand_solimp)) +
          attribute("solref", numbers(protocol_.hand_solref)) + "/>\n";
    }
  }

  const HoldHand& hand_;
  const HoldObject& object_;
  const HoldProtocol& protocol_;
  int num_pieces_ = 0;
  std::string meshes_;
  std::string bodies_;
  std::string exclusions_;
  std::string equalities_;
  std::string actuators_;
};

}  // namespace

std::string link_name(int link) { return "link_" + std::to_string(link); }
std::string joint_name(int joint) { return "joint_" + std::to_string(joint); }

std::string scene_text(const HoldHand& hand, const HoldObject& object,
                       const HoldProtocol& protocol) {
  return Scene(hand, object, protocol).text();
}

}  // namespace graspfit::hold_test::internal
