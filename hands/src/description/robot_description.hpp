#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

/// What a robot description (URDF, MJCF, GraspIt! XML) says of a hand, whatever its format: names
/// not yet resolved, tree not yet checked. Meters, radians, kilograms.
struct BoxShape {
  Eigen::Vector3d size;  ///< Full lengths.
};
/// A cylinder about the z axis, centered at the origin.
struct CylinderShape {
  double radius = 0.0;
  double length = 0.0;
};
/// A capsule about the z axis, centered at the origin; `length` is between the centers of its two
/// hemispheres.
struct CapsuleShape {
  double radius = 0.0;
  double length = 0.0;
};
struct EllipsoidShape {
  Eigen::Vector3d radii;
};
struct SphereShape {
  double radius = 0.0;
};
/// A mesh file as the description names it: a path relative to the description, `package://` or
/// `file://`.
struct MeshFileShape {
  std::string filename;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};
/// A mesh that the format's reader has loaded itself, and the path, relative to the description's
/// folder, of the file that it came from, if any.
struct LoadedMeshShape {
  TriangleMesh mesh;
  std::string filename;
};

struct DescribedGeometry {
  geometry::RigidTransform X_LG = geometry::RigidTransform::Identity();
  std::variant<BoxShape, CylinderShape, CapsuleShape, EllipsoidShape, SphereShape, MeshFileShape,
               LoadedMeshShape>
      shape;
};

struct DescribedLink {
  std::string name;
  std::vector<DescribedGeometry> visual;
  std::vector<DescribedGeometry> collision;
  std::optional<LinkInertia> inertia;
};

/// q = multiplier · q[joint] + offset.
struct DescribedCoupling {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
  bool breakaway = false;  ///< As `Coupling::breakaway`; GraspIt! XML and MJCF's tendons say so.
};

struct DescribedJoint {
  enum class Type { Fixed, Revolute, Continuous, Prismatic };
  std::string name;
  Type type = Type::Fixed;
  std::string parent;
  std::string child;
  geometry::RigidTransform X_PJ = geometry::RigidTransform::Identity();
  /// Unit vector; the format's default where none is given.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double lower = 0.0;
  double upper = 0.0;
  std::optional<DescribedCoupling> coupling;
};

struct RobotDescription {
  std::string name;
  std::vector<DescribedLink> links;
  std::vector<DescribedJoint> joints;
  double meters_per_unit = 1.0;  ///< Unit of the file's lengths; here all are in meters.
  /// Pairs of links that the description itself takes out of collision.
  std::vector<std::pair<std::string, std::string>> exclusions;
};

}  // namespace graspfit::hands::internal
