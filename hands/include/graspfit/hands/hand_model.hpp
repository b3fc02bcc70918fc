#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/hands/contact_pad.hpp"

namespace graspfit::hands {

/// Kind of a joint.
enum class JointType { Revolute, Prismatic };

/// A joint follows another: q = ratio · q[leader] + offset.
struct Coupling {
  int leader = -1;      ///< Index of the leading joint.
  double ratio = 1.0;   ///< [rad/rad], [m/m] or mixed.
  double offset = 0.0;  ///< [rad] or [m].
  /// True where a clutch frees the leader when its link is blocked, and this joint goes on closing
  /// alone up to its own limit (Barrett's TorqueSwitch).
  bool breakaway = false;
};

/// A movable joint between two links.
struct Joint {
  std::string name;
  JointType type = JointType::Revolute;
  int parent_link = -1;
  int child_link = -1;
  RigidTransform X_PJ = RigidTransform::Identity();   ///< Joint frame in the parent link's frame;
                                                      ///< the child link's frame at q = 0.
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitZ();  ///< Unit axis in the joint frame.
  double lower = 0.0;                                 ///< [rad] or [m]
  double upper = 0.0;                                 ///< [rad] or [m], ≥ lower.
  /// +1 if growing q closes the hand, −1 if it opens it, 0 if it does neither (spread, abduction).
  int closing_sign = 0;
  std::optional<Coupling> coupling;  ///< Empty for an independent joint (an intrinsic DOF).

  /// The limits at which the joint opens and closes the hand; meaningless if closing_sign is 0.
  double open_limit() const { return closing_sign > 0 ? lower : upper; }
  double closed_limit() const { return closing_sign > 0 ? upper : lower; }
};

/// Mass, center of mass and inertia of a link, as its description says.
struct LinkInertia {
  double mass = 0.0;                                    ///< [kg], ≥ 0.
  Eigen::Vector3d center_L = Eigen::Vector3d::Zero();   ///< Center of mass [m].
  Eigen::Matrix3d inertia_L = Eigen::Matrix3d::Zero();  ///< About center_L, along L's axes [kg m²].
};

/// A rigid link. Links joined by fixed joints in the file are links of their own here.
struct Link {
  std::string name;
  std::optional<int> parent_link;   ///< Empty for the root.
  std::optional<int> parent_joint;  ///< Movable joint to the parent; empty for the root or a fixed
                                    ///< connection.
  /// Pose in the parent link when fixed to it.
  RigidTransform X_PL_fixed = RigidTransform::Identity();
  TriangleMesh mesh_L;  ///< Closed surface in the link's frame [m]; may have no faces.
  std::optional<LinkInertia> inertia;  ///< Empty where the description gives none.
  /// The mesh files that mesh_L came from, in the order of the description and relative to the
  /// folder of the description itself (symbolic links resolved); none for primitives.
  std::vector<std::string> mesh_files;
};

/// An ordered chain of links that closes on the object.
struct Finger {
  std::string name;
  std::vector<int> links;  ///< Proximal to distal.
  /// Movable joints of the chain, proximal to distal, coupled ones included.
  std::vector<int> joints;
  std::optional<int> tip_pad;  ///< The pad that precision grasps use; empty: no pad.
  bool is_thumb = false;
  std::optional<int> swing_joint;  ///< Turns the finger around the palm (spread, abduction).
};

/// The palm and the hand base frame H.
struct Palm {
  int link = -1;                                       ///< The root link; its frame is H.
  Eigen::Vector3d center_H = Eigen::Vector3d::Zero();  ///< Palm center [m].
  /// Unit n_palm: leaves the palm toward the object.
  Eigen::Vector3d direction_H = Eigen::Vector3d::UnitZ();
  std::optional<int> pad;  ///< Its contact pad; empty: none.
};

/// Two links whose collision does not count (neighbors, or always overlapping).
struct CollisionExclusion {
  int link_a = -1;
  int link_b = -1;
};

/// An articulated hand: kinematic tree, fingers, pads. Never changes while planning; everything
/// that varies is in HandConfiguration. Links and joints are ordered parents first.
struct HandModel {
  std::string name;
  std::string description_file;  ///< URDF path as given.
  std::string description_sha256;
  std::string sidecar_file;
  std::string sidecar_sha256;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Finger> fingers;
  std::vector<ContactPad> pads;
  Palm palm;
  std::vector<CollisionExclusion> exclusions;

  /// Number of independent joints.
  int num_intrinsic_dof() const;
  /// Index by name. @throws InvalidInput that lists the existing names, if there is no such name.
  int finger_index(const std::string& finger_name) const;
  int joint_index(const std::string& joint_name) const;
  int link_index(const std::string& link_name) const;
  int pad_index(const std::string& pad_name) const;
  /// Name of a finger; "palm" for none, which no finger is called. Precondition, not checked: there
  /// is such a finger.
  std::string part_name(std::optional<int> finger) const;
  /// Index of the pad at a finger's tip, and of the palm's. @throws InvalidInput if there is no
  /// such finger, or it has none.
  int tip_pad_of(int finger) const;
  int palm_pad() const;
  /// Index of the thumb; the first finger if none is marked.
  int thumb() const;
  /// True if contacts between the two links are to be ignored (also true for a link and itself).
  bool is_excluded(int link_a, int link_b) const;
};

/// Throws InvalidInput in one line (hand, item, value) if an index, limit, outline, direction or
/// coupling of the model makes no sense. The reader calls it.
void validate(const HandModel& model);

/// Upper bound of the distance of any point of the hand from the palm center over all
/// configurations [m]: the sum of chain lengths. It bounds the distance from which a hand may have
/// to approach.
double largest_reach(const HandModel& model);

}  // namespace graspfit::hands
