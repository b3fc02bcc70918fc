#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

/// The parts of a URDF that a hand needs, as the file says them: names not yet resolved, tree not
/// yet checked.
struct UrdfBox {
  Eigen::Vector3d size;
};
struct UrdfCylinder {
  double radius = 0.0;
  double length = 0.0;
};
struct UrdfSphere {
  double radius = 0.0;
};
struct UrdfMesh {
  std::string filename;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

struct UrdfGeometry {
  geometry::RigidTransform X_LG = geometry::RigidTransform::Identity();
  std::variant<UrdfBox, UrdfCylinder, UrdfSphere, UrdfMesh> shape;
};

struct UrdfLink {
  std::string name;
  std::vector<UrdfGeometry> visual;
  std::vector<UrdfGeometry> collision;
  std::optional<LinkInertia> inertia;
};

struct UrdfMimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
};

struct UrdfJoint {
  enum class Type { Fixed, Revolute, Continuous, Prismatic };
  std::string name;
  Type type = Type::Fixed;
  std::string parent;
  std::string child;
  geometry::RigidTransform X_PJ = geometry::RigidTransform::Identity();
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();  ///< Unit; as the format says where none is given.
  double lower = 0.0;
  double upper = 0.0;
  std::optional<UrdfMimic> mimic;
};

struct Urdf {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
};

/// Parses the text of a URDF. Numbers are read in the C locale whatever the program's locale is.
/// @throws IoError or InvalidInput, prefixed by `file` and the line where that helps.
Urdf parse_urdf(const std::string& text, const std::string& file);

}  // namespace graspfit::hands::internal
