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
/// Derives, from a hand's tree and meshes, what its sidecar does not say: fingers
/// (deriver_fingers.cpp), closing signs of the joints (deriver_closing.cpp), center and direction
/// of the palm (deriver_palm.cpp), and pads (deriver_pads.cpp).

namespace graspfit::hands::internal {

using base::InvalidInput;
using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::MeshQuery;

/// A finger: its bodies from the palm to the tip, and the joints that move them.
struct Chain {
  std::vector<int> bodies;
  std::vector<int> joints;            ///< The joint above each body.
  Vector3d tip_B = Vector3d::Zero();  ///< Fingertip in the frame of the last body's first link.
  std::vector<int> leaders;  ///< Independent joints that move the finger, proximal to distal.
};

/// What an independent joint does to the hand.
enum class Role { None, Bend, Other };

/// What a body of a finger faces when the finger closes.
struct Facing {
  Vector3d direction_H;  ///< Unit.
  Vector3d along_H;      ///< Unit, toward the tip.
  Vector3d point_H;      ///< Middle of the body.
};

/// Derives a sidecar in steps, each of which uses the results of those before it.
class Deriver {
 public:
  Deriver(const HandModel& tree, const Sidecar& given, Findings& findings)
      : tree_(tree), given_(given), findings_(findings), bodies_(bodies_of(tree)) {}

  Sidecar derive();

 private:
  [[noreturn]] void fail(const std::string& what) const;

  // Kinematics
  /// The configuration with positions `q`, and followers where their leaders put them (breakaway is
  /// ignored).
  HandConfiguration followed(const VectorXd& q) const;
  std::vector<RigidTransform> poses(const VectorXd& q) const;
  /// Positions of all joints at the value nearest zero.
  VectorXd rest() const;
  /// Positions of closing joints at `share` of their range from open to closed, and of the others
  /// at rest.
  VectorXd closed_by(double share) const;
  const RigidTransform& pose_of_body(const std::vector<RigidTransform>& X_HL, int body) const;
  Vector3d tip(const Chain& chain, const std::vector<RigidTransform>& X_HL) const;
  Vector3d axis_H(int joint, const std::vector<RigidTransform>& X_HL) const;

  // Fingers
  /// Center of the part of a body that is farthest from its joint; of a body on a prismatic joint,
  /// the center of the whole body.
  Vector3d tip_of(const Body& body) const;
  double reach_of(const Chain& chain) const;
  void chains();
  void given_chains();
  Chain chain_of(std::vector<int> bodies) const;
  /// Drops bars of linkages. A chain all of whose joints follow is no finger of its own if another
  /// chain has the same leaders, reaches farther, and touches it beyond their common part in all
  /// sampled configurations.
  void drop_linkage_members();
  double reach_from_palm(const Chain& chain) const;
  bool always_touch(const Chain& a, const Chain& b,
                    const std::vector<std::vector<RigidTransform>>& samples) const;
  /// Where a branch forks, the part before the fork belongs to the finger that reaches farthest.
  void share_out_trunks();
  std::string name_of_body(int body) const;

  // Closing
  VectorXd sampled(std::size_t sample) const;
  /// How far apart the fingertips are: the sum of every fingertip's distance from the palm and its
  /// mean distance from the other tips.
  double spread(const std::vector<RigidTransform>& X_HL) const;
  /// Finds which joints bend fingers, and in which direction they close them.
  void signs();
  /// +1 if the finger turns in the same sense when `leader` grows as when the finger's last joint
  /// grows, −1 if in the opposite sense.
  double side_of(const Chain& chain, int leader, const std::vector<RigidTransform>& X_HL) const;
  std::map<std::string, int> closing() const;
  /// Sets the closing signs of `tree_` as the reader will resolve them.
  void take_signs(const std::map<std::string, int>& signs);
  void note_closing(const std::map<std::string, int>& signs);

  // Palm
  /// What a body of a finger faces in a configuration, if closing joints of the finger move it.
  std::optional<Facing> facing(const Chain& chain, std::size_t number, const VectorXd& q) const;
  /// The point that the half-closed fingers face: the one nearest to all lines along which their
  /// bodies face. A small weight pulls it toward the middles of the bodies, so that it also exists
  /// for parallel lines.
  Vector3d facing_center() const;
  void palm_direction();
  /// The direction that more than half of the fingers face at rest, if they agree within 45°.
  std::optional<Vector3d> resting_direction() const;
  /// Sets the palm direction to the normal of the side of the palm that fills most of the view from
  /// the point that the half-closed fingers face.
  void find_palm_direction_by_view();
  /// Finds closing signs of joints that bend no finger but move its half-closed tip in front of the
  /// palm (a thumb's opposition). The joint of a finger that does so most comes first, then the
  /// next one, while the first is half closed.
  void fore_joints();
  /// How far a joint moves the half-closed finger's tip along the palm's direction from its lower
  /// limit to its upper one; 0 if that is less than kForwardShare of the length of the tip's path.
  double forward_of(const Chain& chain, int leader) const;

  // Names and thumb
  /// The finger whose tip moves against the others' when the hand closes; empty if no finger does
  /// so clearly, or if there are only two.
  std::optional<int> thumb() const;
  /// Names of the fingers: for each finger the common prefix of its links' names, up to a
  /// separator. They are finger_1, … where the prefixes do not tell the fingers apart.
  std::vector<std::string> names() const;
  std::vector<SidecarFinger> fingers();

  // Pads
  std::vector<SidecarPad> pads(const std::vector<SidecarFinger>& fingers);
  /// How far the palm extends from its center: as far as the fingers' first joints and half-closed
  /// tips, seen along the palm's direction. This leaves out a wrist.
  double palm_reach() const;
  /// Whether a pad faces its own finger, the palm or a bar of a linkage close by, both while the
  /// hand is open and while it is half closed: no object can get between them.
  bool is_shut_in(const FittedPad& pad, int link, const Chain& chain) const;
  /// The axis of the root link that is most nearly normal to the palm's direction.
  Vector3d palm_axis() const;
  void add_pad(std::vector<SidecarPad>& list, const std::optional<FittedPad>& found,
               const std::string& link, const std::string& finger);
  SidecarPalm palm(const std::vector<SidecarPad>& found,
                   const std::optional<std::vector<SidecarPad>>& given);

  HandModel tree_;  ///< A copy, whose closing signs are set by the steps.
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
