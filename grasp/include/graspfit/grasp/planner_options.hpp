#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/contact/squeeze.hpp"
#include "graspfit/grasp/approach_sampling.hpp"
#include "graspfit/grasp/contact_refinement.hpp"
#include "graspfit/grasp/distinct_grasps.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/medial_symmetry.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// Which grasps the planner collects.
enum class Acceptance {
  Valid,   ///< Usable, free of penetration on the true meshes, every requested contact there.
  Usable,  ///< M > 0: the paper's meaning.
};

/// Which usable grasps are rejected, so that the next attempt draws new targets: the validation of
/// the paper's section 6.5, which does not state the limits.
enum class Rejection {
  None,
  /// Grasps in which a requested contact is missing, or farther from its target as drawn than
  /// `PlannerOptions::largest_deviation`. Methods without targets reject none.
  Deviation,
  Quality,  ///< M < min(0.5 · ideal M, 0.6): below "high quality"; of methods without targets
            ///< M < 0.6. Selects by M itself.
};

/// When the planner stops searching.
enum class SearchRule {
  Best,    ///< Use all attempts and return the best accepted grasps by `RankRule`: the paper's
           ///< generate, evaluate, select.
  First,   ///< Stop at the first accepted grasps: unselected sets, as for averages over usable
           ///< grasps.
  Closed,  ///< Stop at the first accepted grasps that close (`Grasp::is_closed`). Others fill up
           ///< where the attempts end before, best first.
};

/// What is best among a run's grasps: their order, and which of alike ones and of more than were
/// asked for are left.
enum class RankRule {
  M,  ///< The paper's measure.
  /// How hard the grasp is to break: strength as in `KeptCandidate::Strongest` [R], then M.
  Epsilon,
  /// The smallest force under which a physics test fails, for who has one (`graspfit plan --hold`);
  /// in planning the same as `Epsilon`.
  Margin,
};

/// What becomes of a hand that has closed while a requested part does not touch.
enum class MissingContact {
  Fails,  ///< The attempt has failed: a formed grasp needs them all [P: its stop condition].
  /// The contacts that the hand has are measured, and M > 0 makes the grasp usable. This is
  /// possible without refinement only, since refined grasps have all their contacts; it is for
  /// tables over all attempts with M > 0.
  Measured,
};

/// Which of an attempt's candidates are tried first, and by that which of the target sets drawn is
/// fitted [R]. A candidate is a target set and a side from which the hand is fitted to it. Where
/// `target_draws` is 1, the random search has the order that is stated there, whichever is set.
enum class CandidateOrder {
  Pads,  ///< Candidates on whose targets the fingertip pads would lie flattest.
  /// Candidates whose targets balance one another (within the squeeze's largest residual) at
  /// `squeeze_friction`, then those whose targets do so at `friction`; ties are ordered as by
  /// `Pads`. All sides of a set balance alike, so this has an effect only where the method
  /// "fitting" draws several sets at random per attempt. With `TargetSearch::Ranked`, whose sets
  /// are taken by their rank, and with all other methods it is the same as `Pads`.
  Balance,
};

/// Which of an attempt's candidates is kept [R]. `First` and `Balanced` choose among the candidates
/// of one target set.
enum class KeptCandidate {
  First,     ///< The first whose grasp is accepted.
  Balanced,  ///< The first whose grasp is accepted and whose squeeze balances; else the accepted
             ///< grasp of least residual.
  /// All candidates, up to `max_placements`, are tried, and the strongest accepted grasp with a
  /// balanced squeeze is kept, else the strongest accepted one. Strength is ε, signed, of the
  /// contacts that touch (with refinement: within its largest gap), with friction cones of
  /// `squeeze_friction` and torques over the object's largest radius. Candidates are the sides of
  /// all sets drawn, or of the next set of a ranked search, or the strongest postures of a search
  /// by the hand's reach.
  Strongest,
  /// As `Strongest`, but by firmness alone: the lesser of ε and 0.3 of the largest force that the
  /// contacts bear in each of 14 directions (`contact::least_force`), with friction halfway between
  /// `friction` and `squeeze_friction`. Of a search by reach, whose candidates promise a firmness,
  /// the next one is not tried once there is an accepted grasp that is as firm as that.
  Firmest,
};

/// Whether sides of all sets that an attempt draws are compared.
constexpr bool compares_all_sets(KeptCandidate kept) {
  return kept == KeptCandidate::Strongest || kept == KeptCandidate::Firmest;
}

/// What fingers do that a refined grasp does not need [R].
enum class IdleFingers {
  Stay,   ///< They are where the search left them.
  Close,  ///< Each closes onto the object, where its fingertip's pad meets it.
};

/// Everything that decides what the planner does. Same options, object, hand and seed: same grasps,
/// on one build and processor.
struct PlannerOptions {
  /// The method that guides hands to the object, by its name in `planning_methods`; "fitting" is
  /// the paper's own. All else is the same for every method.
  std::string planner = "fitting";
  GraspStyle style = GraspStyle::Precision;
  /// Names from the hand, thumb anywhere; empty: `num_contacts` of them.
  std::vector<std::string> fingers;
  /// Used where `fingers` is empty: the thumb and the fingers after it, ≥ 2, with the palm ≥ 1.
  int num_contacts = 3;
  /// Whether the palm must touch too, which adds one target; empty: in power grasps only [P: "if
  /// the palm may touch"].
  std::optional<bool> palm;
  int count = 1;  ///< Grasps to collect (K), ≥ 1.
  std::uint64_t seed = 1;
  SearchRule search = SearchRule::Best;
  RankRule rank = RankRule::M;
  int max_attempts = 50;  ///< Target sets fitted, ≥ 1; a budget of work, not of time.
  /// Steps of fitting and refinement of all attempts together, ≥ 1: the attempt with which their
  /// sum, taken in the order of attempts, reaches it is the last; empty: no such budget.
  std::optional<std::int64_t> max_iterations;
  Acceptance acceptance = Acceptance::Valid;
  MissingContact missing_contact = MissingContact::Fails;
  Rejection rejection = Rejection::None;    ///< [R]: the measures say which grasps are good.
  std::optional<double> largest_deviation;  ///< Of a contact from its target [m], > 0; empty: the
                                            ///< width of a fingertip pad.
  /// Wanted palm direction in O, nonzero; the sides of target sets and all accepted grasps are
  /// within `approach_angle` of it.
  std::optional<Eigen::Vector3d> approach_O;
  /// Largest angle between the palm direction and `approach_O` [rad], in (0, π].
  double approach_angle = std::numbers::pi / 2;
  /// Opt-in; makes results depend on the machine, and is recorded.
  std::optional<double> wall_clock_limit_s;
  int resolution = 30;                   ///< Voxels along the object's longest extent [P].
  std::optional<double> clip_thickness;  ///< [m]; empty: max(0.5 voxel, 1 mm).
  geometry::PatchAveraging averaging = geometry::PatchAveraging::AreaWeighted;  ///< [R]
  /// Pads whose contacts count; empty: in power grasps all [P: proximal links are encouraged to
  /// touch], and with `GraspStyle::Auto`, else those of fingertips and palm [R].
  std::optional<contact::CountedPads> counted_pads;
  contact::ContactPieces contact_pieces = contact::ContactPieces::Joined;
  /// With `Facing`, `TargetSearch::Reach` also takes the two sides of a wall that is thinner than a
  /// voxel as two places [R].
  contact::ContactFaces contact_faces = contact::ContactFaces::All;
  ScoreOptions score;
  /// Fragile features (S of M1; never targets by `targets.exclude_weak`); empty: none are looked
  /// for and S = 1 everywhere.
  std::optional<geometry::WeakRegionOptions> weak = geometry::WeakRegionOptions{};
  TargetOptions targets;  ///< min_separation > 0, or empty: the planner sets one pad width.
  /// Target sets drawn per attempt, ≥ 1; the one on which the fingertip pads would lie flattest is
  /// fitted: contacts "the hand can plausibly reach" (paper section 1) read through the hand's
  /// kinematics [R]. 1: the paper's random set, first from the side on which the object protrudes
  /// less.
  int target_draws = 32;
  CandidateOrder candidate_order = CandidateOrder::Pads;
  KeptCandidate kept = KeptCandidate::First;
  /// Largest number of sides from which an attempt fits the hand, ≥ 1: sides of one target set,
  /// those with the flattest pads first [R] (three and more targets have two sides, two targets
  /// sixteen); with `KeptCandidate::Strongest` and `Firmest`, sides of all sets drawn.
  int max_placements = 4;
  /// How often an attempt may draw targets anew, ≥ 0, while what it has is not good enough [R]:
  /// while no grasp is accepted; with `KeptCandidate::Balanced` and `Strongest`, while no accepted
  /// one has a squeeze that balances; with `Firmest`, while none is as firm as 0.04. What is kept
  /// is chosen among the candidates of all draws. Only the search by the hand's reach draws anew.
  int max_redraws = 0;
  FittingOptions fitting;
  ApproachSamplingOptions sampling;       ///< Of the method gs.
  MedialSymmetryOptions medial_symmetry;  ///< Of the methods ma and ma-full-retreat.
  /// Whether requested contacts are made real by exact queries after fitting [R], for which hands
  /// close to the first graze only, whatever `fitting.contact_state` is; without: the paper's
  /// voxel-level grasp.
  bool refine = true;
  RefinementOptions refinement;
  IdleFingers idle_fingers = IdleFingers::Stay;
  /// Without refinement: overlap of links of different fingers that a formed grasp may have before
  /// it is rejected as a self-collision [m], ≥ 0 [R].
  double self_overlap = 0.001;
  /// Every contact's score must exceed it, in [0, 1), whether the pad had a target or not; empty:
  /// only the scores of targets count, as the paper states it [R].
  std::optional<double> contact_score_threshold;
  /// Whether a grasp needs a pre-grasp with a collision-free path to it [R].
  bool pre_grasps = true;
  PreGraspOptions pre_grasp;
  contact::SqueezeOptions squeeze;
  DistinctOptions distinct;
  double friction = 0.4;  ///< Coulomb's μ of ε, ≥ 0 [R]; GraspIt!'s usual.
  /// Friction coefficient of the narrower cones to which the forces of the squeeze are limited, ≥ 0
  /// [R]; the friction beyond it is left for loads.
  double squeeze_friction = 0.2;
  contact::QualityOptions quality;  ///< merge_distance > 0, or empty: `merge_distance` below.
  void validate() const;            ///< Throws InvalidInput naming the field and its value.
};

/// The planner's rule for clip volumes.
double clip_thickness(const PlannerOptions& options, double voxel_size);

/// The options by which the planner fits a hand: with refinement, fingers stop at the first graze;
/// where other contacts may do, none is given up for lying far from its target.
FittingOptions fitting_options(const PlannerOptions& options);

/// The planner's rule for deviations from targets [m].
double largest_deviation(const PlannerOptions& options, const hands::HandModel& hand);

/// The planner's rule for contacts that count as one [m]: a tenth of a voxel where `options` leave
/// it open.
double merge_distance(const PlannerOptions& options, double voxel_size);

/// Which contacts of `options` count, and how they are estimated. @param clip_thickness [m]
contact::ContactEstimationOptions contact_estimation(const PlannerOptions& options,
                                                     double clip_thickness);

/// The gap up to which contacts of planned grasps bear forces (ε, closure, min-weight, squeeze)
/// [m]: with refinement, the largest gap that a requested pad may have. Empty without refinement
/// (at the level of voxels), where all contacts bear forces.
std::optional<double> bearing_gap(const PlannerOptions& options);

/// What `options` ask of `hand`, the thumb first where it is among the fingers.
RequestedParts requested_parts(const hands::HandModel& hand, const PlannerOptions& options);

/// The parts by which a grasp with these targets must touch: those that were requested; of style
/// auto, and of style power by reach, those of its targets.
RequestedParts parts_to_touch(const PlannerOptions& options, const RequestedParts& requested,
                              const TargetContacts& targets);

}  // namespace graspfit::grasp
