#pragma once

#include <optional>
#include <vector>

#include "fitting/guarded_hand.hpp"
#include "fitting/target_posture.hpp"
#include "graspfit/grasp/hand_fitting.hpp"

namespace graspfit::grasp::internal {

/// One run of the adjustment loop (sections 7 to 9).
class FittingLoop {
 public:
  struct Outcome {
    FittingResult result;
    /// With the guard on voxels, links whose depth was not guarded and that may be deeper in the
    /// object than a voxel's edge; none if the hand was not clear at the start.
    std::vector<int> links_too_deep;
  };

  /// `depth_guarded` as in `GuardedHand`.
  FittingLoop(const GraspScene& scene, GraspStyle style, const RequestedParts& requested,
              const FittingOptions& options, const std::vector<int>& depth_guarded);

  /// Fits the hand to targets that are assigned to the requested parts.
  Outcome fit(const TargetContacts& targets, const PalmPlacement& placement,
              const std::optional<hands::HandConfiguration>& goal);
  /// Closes the hand from `start`, without targets.
  Outcome close(const hands::HandConfiguration& start, const RetreatRule& retreat);

 private:
  /// A finger that closes, while the loop runs.
  struct Part {
    enum class State { Free, Touching, Blocked, AtLimit };
    int finger = 0;
    std::optional<int> pad;  ///< Empty: a finger of a power grasp that has no tip pad.
    int tip_link = 0;
    bool has_target = false;
    /// Joints that close it alone, proximal to distal; the last may be one that a clutch frees
    /// (breakaway). `stage` is the one that closes now.
    std::vector<int> closing;
    std::size_t stage = 0;
    bool is_shared = false;       ///< Others close by the same joint: a gripper's jaws.
    bool is_toward_goal = false;  ///< Still on the way to the posture at the targets.
    std::optional<Eigen::Vector3d> target_O;
    State state = State::Free;
  };

  /// A configuration in which the fingers have closed, and how far their contacts are from their
  /// targets.
  struct Formed {
    hands::HandConfiguration configuration;
    std::vector<Part> parts;
    int num_missing = 0;  ///< Targets whose fingertip has no contact.
    double miss = 0.0;    ///< Sum of the distances of the other targets from their contacts [m].
    Eigen::Vector3d to_center;  ///< From the mean of contacts to the mean of targets [m].
  };

  void add_part(int finger, bool has_target);
  bool place();
  bool retreat(hands::HandConfiguration start, double step, int most_steps);
  Outcome failed_start() const;
  void approach();
  void seat_palm(double distance);
  void bring_palm(double distance);
  Outcome run();
  void advance(double distance, double tolerance);
  void close_part(Part& part);
  bool close_toward_goal(Part& part);
  bool try_closing(const Part& part, double step);
  bool next_stage(Part& part);
  void move_palm_to_goal();
  bool close_free_parts();
  void recenter();
  Formed formed();
  static bool is_nearer(const Formed& a, const Formed& b);
  bool try_shift(const Eigen::Vector3d& shift, double opening);
  void close_on(Part& part);
  void press_palm();
  FittingResult finished();

  bool try_move(const hands::HandConfiguration& candidate, const std::vector<int>& moved,
                double length);
  hands::HandConfiguration with_joint(int joint, double position) const;
  bool is_at_closing_limit(int joint) const;
  double lever(int joint, int link) const;
  double lever(int joint) const;
  double allowed_step(int joint) const;
  const Part* stopped_part_sharing(int joint) const;
  bool any_touching() const;
  int num_free() const;
  bool is_hopeless(const Part& part) const;
  bool touches(const Part& part);
  bool palm_touches();
  bool has_contact_at(int pad, const std::vector<geometry::RigidTransform>& X_OL);
  Eigen::Vector3d palm_direction() const;

  const FittingHand& hand_;
  const hands::HandModel& model_;
  const ObjectModel& object_;
  const contact::ContactEstimationOptions& contact_options_;
  const FittingOptions& options_;
  const double voxel_size_;
  GuardedHand state_;
  std::vector<std::vector<int>> moved_links_;  ///< Per joint.
  std::vector<Part> parts_;                    ///< Those with targets first, the seed's before all.
  const GraspStyle style_;
  const bool has_palm_target_;
  hands::HandConfiguration initial_;
  /// The posture at the targets; without targets, the hand's start.
  hands::HandConfiguration goal_;
  bool is_clear_at_start_ = false;
  bool is_palm_done_ = false;  ///< The palm is where it is wanted, or cannot get there.
  bool stops_at_palm_;         ///< Once the palm touches, `advance` ends.
  bool is_palm_held_ = false;  ///< The palm touches and must not lose its contact.
  int iterations_ = 0;
  double contact_tests_s_ = 0.0;
};

}  // namespace graspfit::grasp::internal
