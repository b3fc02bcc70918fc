#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fitting/surface_posture.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "methods/hand_grips.hpp"
#include "methods/target_sides.hpp"
#include "scene/clearance.hpp"
#include "targets/target_feasibility.hpp"

/// \file
/// Targets that the hand can meet [R]. Many times a hand is proposed that is about where its pads
/// lie on points that may be targets: by two pads that can face each other as the points do, or by
/// the palm. Of some such proposals the one that fits best is laid onto the surface, and where its
/// pads then lie are the targets: the hand meets them before anything is decided exactly. The
/// strongest such posture is then varied and laid again.

namespace graspfit::grasp::internal {

/// Draws candidates for one object and hand. Const members are safe to call from several threads.
class ReachSides {
 public:
  /// Refers to the scene and the rules.
  ReachSides(const GuidanceScene& scene, const TargetRules& rules);

  /// The strongest candidates of an attempt, the strongest first, each with its posture
  /// (`TargetSide::goal`), from which it is refined. Strength is `contact::epsilon_bound`; of two
  /// contacts, which cannot close, how far their line is within the cones. New candidates and
  /// variations of the strongest one take turns, at random, until one is strong enough or a budget
  /// of work is spent. Empty if none was found.
  std::vector<TargetSide> draw(base::Random& random) const;

 private:
  using Grip = HandGrips::Grip;

  /// A posture in which all parts of a grip lie on the object.
  struct Candidate {
    const Grip* grip = nullptr;
    SurfacePosture posture;
    double strength = 0.0;
  };

  /// A hand at the object, not yet laid onto it.
  struct Proposal {
    hands::HandConfiguration configuration;
    std::vector<bool> is_fixed;  ///< Per joint: a sample set its position.
    /// Per part of the hand; empty: it is not placed.
    std::vector<std::optional<std::int32_t>> patches;
    double largest_cost = 0.0;  ///< Of placing a part where it is [m].
  };

  /// Work done in an attempt.
  struct Work {
    int pairs = 0;
    int proposals_left = 0;
    int postures_left = 0;
    bool is_done() const;
  };

  const Grip& drawn_grip(base::Random& random) const;
  std::vector<Candidate> strongest(const Grip* grip, Work work, base::Random& random) const;
  std::optional<Candidate> drawn(const Grip& grip, base::Random& random, Work& work) const;
  std::optional<Candidate> varied(const Candidate& from, base::Random& random, Work& work) const;
  std::optional<Candidate> laid(const Grip& grip, hands::HandConfiguration start, Work& work) const;
  std::optional<Proposal> pinch(const Grip& grip, base::Random& random) const;
  bool is_from_approach(const hands::HandConfiguration& configuration) const;
  Proposal palm_first(const Grip& grip, base::Random& random) const;
  Proposal proposal_at(const geometry::RigidTransform& X_OH) const;
  void set(std::size_t part, std::int32_t sample, std::int32_t patch, Proposal& proposal) const;
  std::optional<Proposal> proposal(const Grip& grip, base::Random& random, Work& work) const;
  double strength(const std::vector<std::int32_t>& patches) const;
  void complete(std::size_t part, Proposal& proposal) const;
  bool is_good(const SurfacePosture& posture) const;
  bool is_clear_of_surroundings(const SurfacePosture& posture) const;
  bool are_apart(const std::vector<std::int32_t>& patches) const;
  bool has_stable_pair(const std::vector<std::int32_t>& patches) const;
  std::int32_t point_of(std::int32_t patch) const;
  std::vector<contact::Contact> contacts_on(const std::vector<std::int32_t>& patches) const;
  TargetSide side_of(const Candidate& candidate) const;

  const GuidanceScene& scene_;
  const TargetRules& rules_;
  const HandGrips grips_;
  const NearestPatches nearest_;
  const NearestPatches places_;  ///< The pool's.
  const SurfaceSearch search_;
  const Clearance clearance_;
  std::vector<std::int32_t> pool_of_patch_;  ///< −1 where a patch is not in the pool.
  const contact::WrenchObject wrench_object_;
  /// Between that of closure and that within which a squeeze is to balance: what is strong there
  /// still closes where normals turn out a little different.
  const double strength_friction_;
  std::vector<double> shares_;  ///< Per grip: how often it is drawn.
};

}  // namespace graspfit::grasp::internal
