#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "graspfit/hands/tip_reach.hpp"

namespace graspfit::grasp {

/// Fingers and palm that must touch.
struct RequestedParts {
  /// Indices of fingers of the hand; the first one gets the seed (the thumb, where it is among
  /// them).
  std::vector<int> fingers;
  bool palm = false;
  /// Pads with which some of these fingers must touch instead of their fingertips' pads, one of a
  /// finger at most [R].
  std::vector<int> other_pads = {};
  int size() const { return base::as_index<int>(fingers.size()) + (palm ? 1 : 0); }
};

/// How target sets are found.
enum class TargetSearch {
  Random,  ///< The paper's randomized greedy search.
  Ranked,  ///< Best first and complete: every feasible set of the pool, each once [R].
  /// Sets that the hand can meet: where pads lie in postures of the hand on the object, those first
  /// whose contacts withstand most [R]. Targets are points of the pool, and some pair is stable;
  /// equal edges and a near centroid are not asked for, nor `min_separation` but of proposals, of
  /// places that face the same way: where pads lie next to each other, links are kept apart.
  Reach,
};

/// Which of the earlier targets a finger's new target must form a stable pair with.
enum class PairRule {
  Seed,      ///< With the seed (the thumb's target) [R].
  AllPairs,  ///< With every earlier target (the literal reading). With cones of at most 45° no
             ///< five contacts of any object are pairwise stable: their normals would be pairwise
             ///< more than 90° apart.
};

/// Most parts that can be asked for.
inline constexpr int kMostParts = 6;

/// Terms of the ideal M, for a contact in the middle of its pad: its boundary distance as a share
/// of the pad's largest one, and the share of the pad's area that meets the surface [R].
inline constexpr double kIdealBoundaryDistance = 1.0;
inline constexpr double kIdealArea = 0.3;

/// Parameters of target selection (paper section 6).
struct TargetOptions {
  double score_threshold = 0.6;  ///< Every target's score must exceed it, in [0, 1) [P].
  double theta_max =
      std::numbers::pi / 4;             ///< Friction cone half-angle [rad], in (0, π/2); 45° [P].
  PairRule pair_rule = PairRule::Seed;  ///< [R]
  double edge_tolerance_rel = 0.25;     ///< Largest | |V3Vk| − |V1V2| | / |V1V2|, ≥ 0 [R].
  double centroid_limit_rel = 0.6;  ///< Largest distance of the centroid of the fingers' targets
                                    ///< from the center of mass over the normalizing radius [R].
  /// Weight, in the rank, of the angles between the contact normals and the lines that connect
  /// stable pairs, as shares of theta_max, ≥ 0. With 0 angles do not count [R]; with 1 they count
  /// as much as edges and centroid.
  double angle_weight = 0.0;
  double pool_fraction = 0.2;  ///< Share of the ranked candidates drawn from, in (0, 1] [R].
  int pool_minimum = 5;        ///< Least number of candidates drawn from, if there are so many [R].
  /// Seeds tried per set, ≥ 1 [R]; an attempt that has found a set draws no further ones once all
  /// its draws together have tried this many seeds.
  int max_seeds = 200;
  int relax_after_seeds = 50;  ///< Failed seeds after which edge and centroid limits grow by half
                               ///< [R]. The ranked search never relaxes them.
  /// Between targets of different parts [m], ≥ 0; empty: as near as they like, but the planner
  /// sets one pad width.
  std::optional<double> min_separation = {};
  /// Edge of the cubes by which the pool is thinned [m], ≥ 0: of all points in one cube whose
  /// normals have the same largest component, only the one with the best score is kept; 0: all are
  /// kept [P: "sampling by voxels"]. The ranked search needs thinning for four and more targets: a
  /// pad's width.
  double pool_spacing = 0.0;
  TargetSearch search = TargetSearch::Random;
  bool exclude_weak = true;  ///< No targets on weak features, where the object model knows them
                             ///< [R].
  /// How strongly a random set with a large ideal M is preferred, ≥ 0: of up to
  /// `ideal_m_draws` complete sets one is drawn with probability ∝ M^bias. 0: the first set, M is
  /// not used [R].
  double ideal_m_bias = 0.0;
  int ideal_m_draws = 8;  ///< Number of complete sets to draw one from, ≥ 1; their seeds together
                          ///< stay within `max_seeds`.
  /// How far a finger's target may lie from the points that its tip reaches while the palm is on
  /// the palm's target [m], ≥ 0. A distance is allowed because fingers close until they touch,
  /// wherever that is [R].
  double palm_reach_tolerance = 0.015;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// One contact to reach.
struct TargetContact {
  Eigen::Vector3d point_O = Eigen::Vector3d::Zero();           ///< Patch centroid, or sample [m].
  Eigen::Vector3d outward_normal_O = Eigen::Vector3d::Zero();  ///< Its normal, unit.
  /// Index into ObjectModel::patches; empty: the point belongs to no patch.
  std::optional<std::int32_t> patch;
  double score = 0.0;    ///< Score of the patch, or of the voxel that the point is in.
  bool is_palm = false;  ///< The palm's target.
  /// Assigned finger of the hand; empty: none yet, or the palm's target.
  std::optional<int> finger = {};
  /// Pad of that finger that is to touch; empty: its fingertip's. Only targets that come with a
  /// posture have one [R]: `fit_hand` refuses it.
  std::optional<int> pad = {};
};

/// The pad that is to touch at a target that is assigned to a finger or the palm's. @throws
/// InvalidInput if the hand has no such finger or pad.
int pad_for(const hands::HandModel& hand, const TargetContact& target);

/// Whether the contact is of the part, finger or palm, that the target is for.
bool is_for_part_of(const TargetContact& target, const contact::Contact& contact);

/// A set of targets, the seed first, the palm's (if any) last.
struct TargetContacts {
  std::vector<TargetContact> contacts;
  int seeds_tried = 0;  ///< Work spent on this set; 0 for one of the ranked search.
  double rank = 0.0;    ///< As `RankedTargets` defines it, in this order; smaller is better.

  /// Centroid of the target polygon, the palm's target left out: midpoint, triangle centroid, or
  /// vertex mean for more [m].
  Eigen::Vector3d centroid() const;
};

/// Hand and options by which the ideal M of targets is computed; the same as for M of the grasps.
struct IdealMeasure {
  const hands::HandModel* hand = nullptr;  ///< Null: in normalized units only.
  contact::QualityOptions options = {};
};

/// Why no set was found: the furthest stage that was reached.
enum class TargetFailure {
  NoSeed,     ///< The pool is empty: no voxel exceeds the score threshold.
  NoSecond,   ///< No seed had a stable partner in reach.
  NoFurther,  ///< Pairs were found, but never all the further contacts.
  NoPalm,     ///< Fingers' targets were found, but never one for the palm.
};

/// Outcome of one selection.
struct TargetSelection {
  std::optional<TargetContacts> targets;
  TargetFailure failure = TargetFailure::NoSeed;  ///< Of the furthest stage reached, if no targets.
  int seeds_tried = 0;
};

/// The properties of a hand that decide which targets are suitable for its palm.
struct PalmReach {
  /// Palm center, which is placed over the palm's target [m].
  Eigen::Vector3d center_H = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_H = Eigen::Vector3d::UnitZ();  ///< Unit n_palm.
  /// Of the palm's pad, from its frame's origin to the farthest corner [m].
  double pad_radius = 0.0;
  /// Per finger, the points that its tip reaches; no entries: any point in front of the palm.
  std::vector<std::optional<hands::TipReach>> tips;
};

/// How far apart parts of a hand can be, computed once per hand.
struct PartDistances {
  hands::TipDistances tip_to_tip;                      ///< `[a][b]`, as `hands::HandWorkspace`.
  std::vector<hands::DistanceRange> palm_to_tip = {};  ///< Per finger, as `hands::HandWorkspace`.
  std::optional<PalmReach> palm = {};                  ///< Empty for a hand without a palm pad.
};
PartDistances part_distances(const hands::HandModel& hand);
/// As above, but without distances and reach of the palm where `parts` do not request it.
PartDistances part_distances(const hands::HandModel& hand, const RequestedParts& parts);

/// Contacts at the points of the targets, each of the finger that its target is assigned to.
/// Targets that are not assigned get `fingers` in order; those beyond the end of `fingers` get no
/// finger, as the palm's target.
std::vector<contact::Contact> contacts_at(const TargetContacts& targets,
                                          const std::vector<int>& fingers = {});

/// M of the targets themselves: every contact in the middle of its pad. `fingers` as of
/// `contacts_at`. @throws InvalidInput as `contact::ideal_quality`.
double ideal_m(const ObjectModel& object, const TargetContacts& targets,
               const IdealMeasure& measure, const std::vector<int>& fingers = {});

/// The parts that assigned targets are for, in their order.
RequestedParts parts_of(const TargetContacts& targets);

/// The pads that must touch: of each finger its tip's or the other one, then the palm's. @throws
/// InvalidInput if the hand has no such finger or pad, or another pad is of no requested finger.
std::vector<int> requested_pads(const hands::HandModel& hand, const RequestedParts& requested);

}  // namespace graspfit::grasp
