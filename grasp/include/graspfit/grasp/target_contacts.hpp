#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/random.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/hands/hand_workspace.hpp"

namespace graspfit::grasp {

/// Fingers and palm that must touch.
struct RequestedParts {
  std::vector<int> fingers;  ///< Of the hand, the seed's first (the thumb where it is among them,
                             ///< A22).
  bool palm = false;
  int size() const { return static_cast<int>(fingers.size()) + (palm ? 1 : 0); }
};

/// How target sets are found.
enum class TargetSearch {
  Random,  ///< The paper's randomized greedy search.
  Ranked,  ///< Best first and complete: every feasible set of the pool, each once [R].
};

/// Which earlier targets a new one must form a stable pair with (notes A17).
enum class PairRule {
  Seed,      ///< With the seed (the thumb's target) [R].
  AllPairs,  ///< With every earlier target; feasible for at most four (the literal reading).
};

/// Parameters of target selection (paper section 6; notes A17–A20).
struct TargetOptions {
  double score_threshold = 0.6;  ///< Every target's score must exceed it, in [0, 1) [P].
  double theta_max =
      0.78539816339744831;              ///< Friction cone half-angle [rad], in (0, π/2); 45° [P].
  PairRule pair_rule = PairRule::Seed;  ///< A17.
  double edge_tolerance_rel = 0.25;  ///< Largest | |V3Vk| − |V1V2| | / |V1V2|, ≥ 0 (A19) [R].
  double centroid_limit_rel =
      0.6;  ///< Largest centroid-to-CoM distance over the normalizing radius (A19) [R].
  double pool_fraction =
      0.2;               ///< Share of the ranked candidates drawn from, in (0, 1] (A19, A20) [R].
  int pool_minimum = 5;  ///< Candidates drawn from at least, if there are so many (A20) [R].
  int max_seeds = 200;   ///< Seeds tried per set, ≥ 1 (A20) [R].
  int relax_after_seeds =
      50;  ///< Failed seeds after which edge and centroid limits grow by half (A19) [R].
  double min_separation =
      0.0;  ///< Between targets of different fingers [m], ≥ 0; the planner sets one pad width.
  TargetSearch search = TargetSearch::Random;
  bool exclude_weak = true;  ///< No targets on weak features, where the object model knows them
                             ///< (notes 19.3) [R].
  /// How strongly a random set with a large ideal M is preferred (A48): a complete set is accepted
  /// with the probability (M / largest ideal M so far)^bias. 0: M is not used [R].
  double ideal_m_bias = 0.0;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// What a target is assigned to before it is assigned.
inline constexpr int kUnassigned = -2;

/// One contact to reach.
struct TargetContact {
  Eigen::Vector3d point_O = Eigen::Vector3d::Zero();           ///< Patch centroid [m].
  Eigen::Vector3d outward_normal_O = Eigen::Vector3d::Zero();  ///< Patch normal, unit.
  std::int32_t patch = -1;                                     ///< Index into ObjectModel::patches.
  double score = 0.0;                                          ///< Of that patch.
  int finger = kUnassigned;  ///< Assigned finger of the hand, kPalm, or kUnassigned.
};

/// A set of targets, the seed first.
struct TargetContacts {
  std::vector<TargetContact> contacts;
  int seeds_tried = 0;  ///< Work spent on this set.

  /// Centroid of the target polygon: midpoint, triangle centroid, or vertex mean for more [m].
  Eigen::Vector3d centroid() const;
};

/// Why no set was found.
enum class TargetFailure {
  NoSeed,     ///< No voxel exceeds the score threshold.
  NoSecond,   ///< No seed tried had a stable partner in reach.
  NoFurther,  ///< Pairs were found, but never all the further contacts.
  NoPalm,     ///< Fingers' targets were found, but never one for the palm.
};

/// Outcome of one selection.
struct TargetSelection {
  std::optional<TargetContacts> targets;
  TargetFailure failure = TargetFailure::NoSeed;  ///< Of the furthest stage reached, if no targets.
  int seeds_tried = 0;
};

/// How far apart parts of a hand can be, computed once per hand (A18).
struct PartDistances {
  hands::TipDistances tip_to_tip;                 ///< `[a][b]`, as `hands::HandWorkspace`.
  std::vector<hands::DistanceRange> palm_to_tip;  ///< Per finger, as `hands::HandWorkspace`.
};
PartDistances part_distances(const hands::HandModel& hand);

/// Picks targets by the paper's randomized greedy search (section 6): a random seed above the
/// threshold; a second contact in tip distance and in both cones; further contacts with edges close
/// to the first and a centroid close to the center of mass; each drawn at random from the
/// best-ranked feasible candidates; a new seed where one has none.
///
/// Fingers' targets come first, the seed's first of all; one for the palm, if `parts` has it, comes
/// last and is the only one assigned here (finger kPalm). The selection uses, for each further
/// contact, the union of the ranges of the fingers not yet served; assignment follows in
/// `assign_fingers`. @throws InvalidInput for fewer than two fingers.
TargetSelection select_target_contacts(const ObjectModel& object, const PartDistances& distances,
                                       const RequestedParts& parts, const TargetOptions& options,
                                       geometry::Random& random);

/// All feasible target sets, best first (`TargetSearch::Ranked`) [R]: complete, so that an end
/// without any set proves that the pool has none, and `failure` says at which stage.
class RankedTargets {
 public:
  /// @throws as `select_target_contacts`.
  RankedTargets(const ObjectModel& object, const PartDistances& distances,
                const RequestedParts& parts, const TargetOptions& options);
  ~RankedTargets();
  RankedTargets(RankedTargets&&) noexcept;

  /// The next best set; empty when there are no more.
  std::optional<TargetContacts> next();

  /// Why there was none, after `next` gave none the first time.
  TargetFailure failure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace graspfit::grasp
