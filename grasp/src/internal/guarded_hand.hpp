#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "graspfit/grasp/hand_fitting.hpp"

namespace graspfit::grasp {

/// A hand in motion among an object and its surroundings: which motions the guard of section 9 lets
/// through, and how long the next one may be.
class GuardedHand {
 public:
  GuardedHand(const FittingHand& hand, const ObjectModel& object,
              const SurroundingsCollision& surroundings, const FittingOptions& options);

  /// Puts the hand somewhere, unchecked.
  void put(const hands::HandConfiguration& configuration);

  /// Whether no link shares a voxel with the object's surface or inside, the true meshes are apart
  /// where the guard is on them, and nothing touches the surroundings.
  bool is_clear() const;

  /// A motion under test.
  bool passes_map(const hands::HandConfiguration& candidate, const std::vector<int>& moved,
                  double length);  ///< Poses the moved links; `length`: of the fastest point [m].
  bool passes_exact(const std::vector<int>& moved);  ///< Meshes, surroundings and, where they
                                                     ///< count, other links, after the map.
  void accept();                                     ///< The motion under test.

  /// Motion of the fastest point of `links` allowed now [m] (section 9, A30).
  double allowed_motion(const std::vector<int>& links) const;

  /// Measures every link anew, so that `smallest_distance` is exact up to a large step.
  void measure_all();

  const hands::HandConfiguration& configuration() const { return configuration_; }
  const std::vector<geometry::RigidTransform>& X_OL() const { return X_OL_; }
  const std::vector<geometry::RigidTransform>& trial_X_OL() const { return trial_X_OL_; }
  const hands::HandModel& model() const { return model_; }
  const std::vector<int>& all_links() const { return all_links_; }
  /// d_min of a link [voxels]: its value or, well away from the object, a lower bound.
  float distance(int link) const { return distance_[link]; }
  float smallest_distance() const;
  /// The link that the last refused motion was refused for; −1 if none.
  int blocking_link() const { return blocking_link_; }
  void forget_blocking() { blocking_link_ = -1; }
  std::int64_t num_queries() const { return num_queries_; }

 private:
  float measured(int link, const geometry::RigidTransform& X_OL);
  /// Never more than `enough`: what is farther comes nearer in later motions.
  double measured_room(int link, double enough) const;
  bool cuts_object(int link, float d_min, const geometry::RigidTransform& X_OL) const;

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
  hands::HandConfiguration configuration_, trial_;
  std::vector<geometry::RigidTransform> X_OL_, trial_X_OL_;
  std::vector<float> distance_, trial_distance_;
  /// Distance to the surroundings, a lower bound [m]; kept current by the motions.
  std::vector<double> room_, trial_room_;
  int blocking_link_ = -1;
  std::int64_t num_queries_ = 0;
};

}  // namespace graspfit::grasp
