#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "scene/straight_way.hpp"

namespace graspfit::grasp::internal {

/// The search for one grasp's pre-grasp.
class PreGraspSearch {
 public:
  /// Refers to all of its arguments, and to what the grasp refers to. They are valid: options
  /// within their ranges, a grasp within the hand's limits.
  PreGraspSearch(const PreGraspScene& scene, const hands::PosedConfiguration& grasp,
                 const PreGraspOptions& options);

  /// What `find_pre_grasp` returns.
  std::optional<PreGrasp> find();

  /// What `checked_pre_grasp` returns.
  std::optional<PreGrasp> checked(const hands::HandConfiguration& start);

 private:
  using LinkPoses = std::vector<hands::RigidTransform>;
  enum class Joints {
    Closing,
    Leaving,  ///< None that moves a link onto the object; neutral ones if they may open.
    All,
  };

  /// A lower bound of a distance, and how far was searched for it: beyond, the bound says no more.
  struct SearchedBound {
    double at_least = 0.0;  ///< [m]
    double searched = 0.0;  ///< [m]
  };

  /// What is known of two bodies that must stay apart.
  struct Bodies {
    std::optional<geometry::ProximitySeed> seed;  ///< Faces near each other when last measured.
    SearchedBound in_grasp = {};
    std::optional<double> met_at;  ///< Share at which they met on the last way on which they did.
  };

  struct LinkPair {
    int a;
    int b;
    Bodies bodies;
  };

  /// A link, to be kept from object and surroundings.
  struct GuardedLink {
    int link;
    Bodies of_object;
  };

  /// The first pre-grasp among all openings of these joints and retreats, in their order.
  std::optional<PreGrasp> least_opening(Joints joints);

  const geometry::MeshQuery& solid(int link) const { return *scene_.collision.link_solid(link); }
  /// Per joint: whether its opening moves no point that nearly touches the object towards it.
  std::vector<bool> leaving_joints() const;
  /// Neutral joints may only by option.
  bool may_open(std::size_t joint) const;
  Eigen::VectorXd opened(double opening, Joints joints) const;
  /// The largest share, over the closing joints, of the motion to the joint's position in the open
  /// hand, in [0, 1].
  double opening_of(const Eigen::VectorXd& q) const;
  hands::RigidTransform retreated(double retreat) const;

  double surroundings_distance(int link, const hands::RigidTransform& X_OL, double enough) const;
  /// Whether every link keeps the wanted clearance.
  bool is_clear(const LinkPoses& X_OL);
  /// Distance of the nearest link, where none is in the object.
  double nearest_distance(const LinkPoses& X_OL) const;
  /// Whether bodies that met on an earlier way surely meet on this one, as those that stopped the
  /// ways before mostly do. That is seen far sooner than that bodies stay apart, and leaves what
  /// `is_free` says as it is.
  bool meet_again(const hands::HandConfiguration& start, const StraightWay& way) const;
  /// Whether the straight path to the grasp is free. Surfaces that stay apart suffice, since no
  /// body is inside another to begin with: at the start no link is in the object, and in the grasp
  /// neither link of a pair is in the other.
  bool is_free(const hands::HandConfiguration& start, const LinkPoses& X_OL_start);

  const PreGraspScene& scene_;
  const hands::HandConfiguration& grasp_;
  const PreGraspOptions& options_;
  const Eigen::VectorXd open_q_;
  const LinkPoses& X_OL_grasp_;
  std::vector<GuardedLink> links_;  ///< Those with a solid; one that failed last comes first.
  std::vector<LinkPair> pairs_;  ///< Pairs that must stay apart; one that failed last comes first.
  std::vector<bool> leaves_;     ///< Per joint, once it is asked for.
  int num_in_vain_ = 0;          ///< Distances of bodies not proven to stay apart, of this search.
};

}  // namespace graspfit::grasp::internal
