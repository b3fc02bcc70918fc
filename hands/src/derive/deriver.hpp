#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "derive/derivation.hpp"
#include "derive/pad_fit.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/kinematic_chain.hpp"
#include "model/hand_bodies.hpp"

/// \file
/// How what a hand's sidecar does not say is derived from its tree and meshes: fingers
/// (deriver_fingers.cpp), which way joints close them (deriver_closing.cpp), where the palm is and
/// looks (deriver_palm.cpp), and pads (deriver_pads.cpp).

namespace graspfit::hands::internal {

using base::InvalidInput;
using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::MeshQuery;

inline std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// A finger: bodies from the one on the palm to the tip, and what moves them.
struct Chain {
  std::vector<int> bodies;
  std::vector<int> joints;            ///< Above each of the bodies.
  Vector3d tip_B = Vector3d::Zero();  ///< In the frame of the last body's first link.
  std::vector<int> leaders;           ///< Independent joints that move it, proximal to distal.
};

/// What an independent joint does to the hand.
enum class Role { None, Bend, Other };

/// Where a body of a finger goes when it closes.
struct Facing {
  Vector3d direction_H;  ///< Unit.
  Vector3d along_H;      ///< Unit, toward the tip.
  Vector3d point_H;      ///< Middle of the body.
};

/// What is found out on the way; each step uses those before it.
class Deriver {
 public:
  Deriver(const HandModel& tree, const Sidecar& given, Findings& findings)
      : tree_(tree), given_(given), findings_(findings), bodies_(bodies_of(tree)) {}

  Sidecar derive();

 private:
  [[noreturn]] void fail(const std::string& what) const;

  // Kinematics
  /// With followers where their leaders put them (breakaway is not counted).
  HandConfiguration followed(const VectorXd& q) const;
  std::vector<RigidTransform> poses(const VectorXd& q) const;
  /// Every joint at the value nearest zero.
  VectorXd rest() const;
  /// Closing joints this far from open to closed, the others at rest.
  VectorXd closed_by(double share) const;
  const RigidTransform& pose_of_body(const std::vector<RigidTransform>& X_HL, int body) const;
  Vector3d tip(const Chain& chain, const std::vector<RigidTransform>& X_HL) const;
  Vector3d axis_H(int joint, const std::vector<RigidTransform>& X_HL) const;

  // Fingers
  /// Middle of the part of a body that is farthest from its joint: of a slide, of all of it.
  Vector3d tip_of(const Body& body) const;
  double reach_of(const Chain& chain) const;
  void chains();
  void given_chains();
  void complete(Chain& chain) const;
  /// Bars of a linkage: a chain that only follows, on joints that another chain follows too, and
  /// that touches that chain beyond their common part in all sampled configurations, is no finger
  /// of its own if the other reaches farther.
  void drop_linkage_members();
  double reach_from_palm(const Chain& chain) const;
  bool always_touch(const Chain& a, const Chain& b,
                    const std::vector<std::vector<RigidTransform>>& samples) const;
  /// Where a branch forks, the part before the fork belongs to the finger that reaches farthest.
  void share_out_trunks();
  std::string name_of_body(int body) const;

  // Closing
  VectorXd sampled(std::size_t sample) const;
  /// How far apart the hand is: of every fingertip its distance from the palm and the mean one from
  /// the other tips.
  double spread(const std::vector<RigidTransform>& X_HL) const;
  /// Which joints bend fingers, and which way closes.
  void signs();
  /// +1 if a growing leader turns the finger as its last joint does when growing, −1 if against.
  double side_of(const Chain& chain, int leader, const std::vector<RigidTransform>& X_HL) const;
  std::map<std::string, int> closing() const;
  /// The model's own signs, as the reader will resolve them.
  void take_signs(const std::map<std::string, int>& signs);
  void note_closing(const std::map<std::string, int>& signs);

  // Palm
  /// How a body of a finger faces in a configuration, if its closing joints move it.
  std::optional<Facing> facing(const Chain& chain, std::size_t number, const VectorXd& q) const;
  /// Where the half-closed fingers face: the point nearest to all lines along which their bodies
  /// face, drawn a little to the middle of the bodies, so that parallel lines have one too.
  Vector3d facing_center() const;
  void palm_direction();
  /// The way in which more than half of the fingers face at rest, if they agree within 45°.
  std::optional<Vector3d> resting_direction() const;
  /// The side of the palm that is seen from the fingers' center: the direction that most of the
  /// field of view faces.
  void find_palm_direction_by_view();
  /// Joints that bend no finger but bring its half-closed tip before the palm (a thumb's
  /// opposition) close it that way: of every finger first the one that does so most, then, with
  /// that one half closed, the next.
  void fore_joints();
  /// How far a joint moves the half-closed finger's tip along the palm's direction, lower limit to
  /// upper; 0 if that is less than kForwardShare of the tip's way.
  double forward_of(const Chain& chain, int leader) const;

  // Names and thumb
  /// The finger whose tip, when closing, goes against the others'; none if no one does so clearly,
  /// or if there are only two.
  std::optional<int> thumb() const;
  /// What the names of a finger's links begin with, up to a separator; finger_1, … where that does
  /// not tell the fingers apart.
  std::vector<std::string> names() const;
  std::vector<SidecarFinger> fingers();

  // Pads
  std::vector<SidecarPad> pads(const std::vector<SidecarFinger>& fingers);
  /// How far the palm goes from its center: as far as the fingers' first joints and half-closed
  /// tips, seen along its direction. Leaves out a wrist.
  double palm_reach() const;
  /// Whether a pad looks at its own finger, the palm or a bar of a linkage close by, the hand being
  /// open and half closed: then nothing can get between.
  bool is_shut_in(const FittedPad& pad, int link, const Chain& chain) const;
  /// A direction in the palm's plane: of the root link's axes the one most across its direction.
  Vector3d palm_axis() const;
  void add_pad(std::vector<SidecarPad>& list, const std::optional<FittedPad>& found,
               const std::string& link, const std::string& finger);
  SidecarPalm palm(const std::vector<SidecarPad>& found,
                   const std::optional<std::vector<SidecarPad>>& given);

  HandModel tree_;  ///< A copy: closing signs are set on the way.
  const Sidecar& given_;
  Findings& findings_;
  std::vector<Body> bodies_;
  std::vector<Chain> chains_;
  std::vector<Role> role_;  ///< Per joint; None for joints that follow.
  std::vector<int> sign_;
  Vector3d palm_middle_ = Vector3d::Zero();
  Vector3d facing_center_ = Vector3d::Zero();
  Vector3d palm_center_ = Vector3d::Zero();
  Vector3d palm_direction_ = Vector3d::UnitZ();
};

}  // namespace graspfit::hands::internal
