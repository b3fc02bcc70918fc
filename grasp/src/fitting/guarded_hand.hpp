#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/grasp/hand_fitting.hpp"

namespace graspfit::grasp::internal {

/// A hand in motion among an object and its surroundings: which motions the guard of the paper's
/// section 9 lets through, and how long the next one may be.
class GuardedHand {
 public:
  /// With the guard on voxels, no motion brings a link of `depth_guarded` deeper into the object
  /// than a voxel's edge; its motions then take several times as long.
  GuardedHand(const GraspScene& scene, const FittingOptions& options,
              const std::vector<int>& depth_guarded);

  /// Puts the hand somewhere, unchecked.
  void put(const hands::HandConfiguration& configuration);

  /// Whether no link shares a voxel with the object's surface or interior, the true meshes satisfy
  /// the guard, and no link touches the surroundings.
  bool is_clear();

  /// Links whose depth is not guarded that may be deeper in the object than a voxel's edge.
  std::vector<int> links_too_deep();

  /// Whether a motion may be made by what else depends on it; takes the links' poses after it.
  using MotionTest = std::function<bool(const std::vector<geometry::RigidTransform>& X_OL)>;

  /// Moves the links `moved` to where `candidate` has them, unless the guard keeps one of them or
  /// `is_wanted` says no: then nothing moves. Cheap tests come first: the distance map,
  /// `is_wanted`, then meshes, surroundings and, where they are guarded, other links. `length` is
  /// the motion of the fastest point [m].
  bool try_move(const hands::HandConfiguration& candidate, const std::vector<int>& moved,
                double length, const MotionTest& is_wanted);

  /// Motion of the fastest point of `links` allowed now [m] (paper section 9) [R].
  double allowed_motion(const std::vector<int>& links) const;

  /// Measures every link anew, so that `smallest_distance` is exact up to a large step.
  void measure_all();

  const hands::HandConfiguration& configuration() const { return configuration_; }
  const std::vector<geometry::RigidTransform>& X_OL() const { return X_OL_; }
  const hands::HandModel& model() const { return model_; }
  const std::vector<int>& all_links() const { return all_links_; }
  /// d_min of a link [voxels]: its value or, well away from the object, a lower bound.
  float distance(int link) const { return distance_[link]; }
  float smallest_distance() const;
  /// The link that the last refused motion was refused for, if there is one.
  std::optional<int> blocking_link() const { return blocking_link_; }
  void forget_blocking() { blocking_link_.reset(); }

 private:
  /// How deep a link was in the object at a pose.
  struct KnownDepth {
    geometry::RigidTransform X_OL;
    geometry::DepthBounds bounds;
  };
  /// The last pose of a link whose depth the guard allowed, and the last one whose depth it
  /// refused.
  struct KnownDepths {
    std::optional<KnownDepth> let, cut;
  };

  /// Poses the moved links of the trial, and tests them against the distance map.
  bool passes_map(const std::vector<int>& moved, double length);
  bool passes_exact(const std::vector<int>& moved);  ///< Tests the trial's meshes.
  void accept();                                     ///< Makes the trial.

  float measured(int link, const geometry::RigidTransform& X_OL);
  /// Distance of a link from the surroundings [m], at most `enough`: farther surroundings are
  /// measured again when motions have brought the link nearer.
  double distance_to_surroundings(int link, double enough) const;
  /// Whether the true meshes overlap by more than the guard lets them.
  bool cuts_object(int link, float d_min, const geometry::RigidTransform& X_OL);
  /// Whether a link may be in the object by more than a voxel's edge: false is right to rounding,
  /// true to the tolerance, or to what the steps that a measurement may take leave open.
  bool is_too_deep(int link, const geometry::RigidTransform& X_OL);
  /// Of any point of a link between two poses, or a little more [m].
  double largest_motion(int link, const geometry::RigidTransform& X_from,
                        const geometry::RigidTransform& X_to) const;

  /// Whether the motion brings links into each other that were apart; then the moved one blocks.
  bool meets_itself(const std::vector<int>& moved);

  const FittingHand& hand_;
  const hands::HandModel& model_;
  const ObjectModel& object_;
  const SurroundingsCollision& surroundings_;
  const FittingOptions& options_;
  const double voxel_size_;
  std::vector<int> all_links_;
  std::vector<std::pair<int, int>> pairs_;  ///< Links that must not meet; empty: not guarded.
  std::vector<bool> guards_depth_;          ///< Per link.
  std::vector<KnownDepths> known_depths_;
  hands::HandConfiguration configuration_, trial_;
  std::vector<geometry::RigidTransform> X_OL_, trial_X_OL_;
  std::vector<float> distance_, trial_distance_;
  /// Per link: lower bound of its distance to the surroundings [m], updated by every motion.
  std::vector<double> surroundings_distance_, trial_surroundings_distance_;
  std::optional<int> blocking_link_;
};

}  // namespace graspfit::grasp::internal
