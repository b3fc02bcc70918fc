#pragma once

#include <type_traits>

#include "graspfit/grasp/option_row.hpp"

/// \file
/// Every option of the planner, once: its row. Of these rows come the checks of ranges, the options
/// of grasp files with their schema, the flags of the program with their help, and the settings of
/// experiments with theirs.
///
/// Each function names the fields of one struct, in the order of grasp files, to a visitor:
/// `at(field, row)` for a field, `at.group(key, struct, rows)` for a struct within, and
/// `at.optional_group` for one that may be empty.

namespace graspfit::grasp::internal {

using base::above;
using base::at_least;
using base::between;
using base::NumberRange;
using namespace option_group;

inline constexpr NumberRange kAny = {};
inline constexpr NumberRange kShare = {.least = 0, .most = 1, .has_least = false};
inline constexpr NumberRange kBelowOne = {.least = 0, .most = 1, .has_most = false};
inline constexpr NumberRange kAcute = {
    .least = 0, .most = 90, .has_least = false, .has_most = false};

constexpr auto score_rows = [](auto& at, auto& score) {
  at(score.neighborhood, {"neighborhood", between(3, 63), "neighborhood", "1", kScores,
                          "edge of the window of a score, in voxels, odd", "P"});
  at(score.gamma_deg, {"gamma_deg", above(0)});
  at(score.length_voxels, {"length_voxels", above(0), "score-length-voxels", "1", kScores,
                           "L, the normalizer of the mean plane distance, in voxels", "R", "A3"});
  at(score.normalization, {"normalization", kAny, "score-normalization", "", kScores,
                           "how raw scores become comparable with the threshold", "R", "A1"});
  at(score.plane_distance, {"plane_distance", kAny, "plane-distance", "", kScores,
                            "distances of neighbors to the voxel's plane", "R", "A2"});
  at(score.mean_filter_radius,
     {"mean_filter_radius", between(0, 31), "mean-filter-radius", "1", kScores,
      "radius of the smoothing of scores, in voxels", "R", "A5"});
  at(score.mean_filter_passes, {"mean_filter_passes", between(0, 1000), "mean-filter-passes", "1",
                                kScores, "passes of the smoothing of scores", "R", "A5"});
  at(score.floor, {"floor", above(0)});
  at(score.median_factor, {"median_factor", above(0)});
};

// The structs of geometry and contact (weak features with their rays, squeeze, measure) check
// themselves, without the planner: what rows say of their ranges is for flags, settings and
// schemas.

constexpr auto shape_diameter_rows = [](auto& at, auto& rays) {
  at(rays.num_rays, {"num_rays", between(1, 10000)});
  at(rays.cone_angle_deg, {"cone_angle_deg", between(0, 179)});
  at(rays.trim_deviations, {.key = "trim_deviations", .range = above(0), .may_be_infinite = true});
};

constexpr auto weak_rows = [](auto& at, auto& weak) {
  at(weak.weak_thickness, {"weak_thickness_m", above(0), "weak-thickness-mm", "mm", kTargets,
                           "slender features thinner than this are fragile: S = 0 in M1",
                           "P; what is fragile: R", "A37"});
  at(weak.min_length_ratio, {"min_length_ratio", at_least(0)});
  at(weak.voxels_per_thickness, {"voxels_per_thickness", between(4, 32)});
  at(weak.max_resolution, {"max_resolution", between(16, 512)});
  at.group("shape_diameter", weak.shape_diameter, shape_diameter_rows);
};

constexpr auto target_rows = [](auto& at, auto& targets) {
  at(targets.score_threshold, {"score_threshold", kBelowOne, "score-threshold", "1", kScores,
                               "every target's score must exceed it", "P"});
  at(targets.theta_max, {"theta_max_rad", kAcute, "", "deg"});
  at(targets.pair_rule,
     {"pair_rule", kAny, "pair-rule", "", kTargets,
      "with which earlier targets a new one must form a stable pair", "R", "A17"});
  at(targets.edge_tolerance_rel,
     {"edge_tolerance_rel", at_least(0), "edge-tolerance", "1", kTargets,
      "largest difference of target distances over the first one", "R", "A19"});
  at(targets.centroid_limit_rel,
     {"centroid_limit_rel", at_least(0), "centroid-limit", "1", kTargets,
      "largest distance of the targets' centroid from the center of mass, over half the bounding "
      "box's diagonal",
      "R", "A19"});
  at(targets.angle_weight, {"angle_weight", at_least(0), "angle-weight", "1", kTargets,
                            "weight of the angles between lines and normals of stable pairs in the "
                            "rank of target sets; 0: not ranked by angles",
                            "R", "A19"});
  at(targets.pool_fraction, {"pool_fraction", kShare, "pool-fraction", "1", kTargets,
                             "share of the ranked candidates that is drawn from", "R", "A20"});
  at(targets.pool_minimum, {"pool_minimum", at_least(1)});
  at(targets.max_seeds, {"max_seeds", at_least(1), "max-seeds", "1", kTargets,
                         "seeds tried per target set", "R", "A20"});
  at(targets.relax_after_seeds, {"relax_after_seeds", at_least(0)});
  at(targets.min_separation,
     {.key = "min_separation_m",
      .range = at_least(0),
      .meaning =
          "of targets of different fingers; 0: the width of the widest requested fingertip pad",
      .is_zero_if_empty = true});
  at(targets.pool_spacing, {"pool_spacing_m", at_least(0), "pool-spacing-mm", "mm", kTargets,
                            "of all candidates in a cube of this size the best one stays; 0: all; "
                            "a pad's width makes ranked searches for four and more targets short",
                            "P: sampling"});
  at(targets.search,
     {"search", kAny, "target-search", "", kTargets,
      "sets of targets at random; ranked: best first until all are tried, which may end with the "
      "proof that there is none; reach: sets on which the hand's pads lie before it is fitted "
      "exactly, those that withstand most first",
      "random: P; ranked, reach: R"});
  at(targets.exclude_weak, {"exclude_weak", kAny, "exclude-weak", "", kTargets,
                            "no targets on fragile features", "R", "A37"});
  at(targets.ideal_m_bias,
     {"ideal_m_bias", at_least(0), "ideal-m-bias", "1", kTargets,
      "random sets: how strongly those with a large M of their own are preferred; 0: not", "R",
      "A48"});
  at(targets.ideal_m_draws, {"ideal_m_draws", at_least(1), "ideal-m-draws", "1", kTargets,
                             "with ideal-m-bias: complete sets to draw one from", "R", "A48"});
  at(targets.palm_reach_tolerance,
     {"palm_reach_tolerance_m", at_least(0), "palm-reach-tolerance-mm", "mm", kTargets,
      "with the palm: how far a target may lie from where its fingertip gets", "R"});
};

constexpr auto fitting_rows = [](auto& at, auto& fitting) {
  at(fitting.clearance, {"clearance_m", between(0, 10000), "clearance-mm", "mm", kTargets,
                         "between the object and the palm at the start", "R", "A24"});
  at(fitting.large_step_at, {"large_step_at_voxels", at_least(1)});
  at(fitting.large_step_limit, {"large_step_limit_voxels", above(0)});
  at(fitting.small_step, {"small_step_voxels", kShare});
  at(fitting.max_halvings, {"max_halvings", between(0, 30)});
  at(fitting.max_iterations, {"max_iterations", at_least(1)});
  at(fitting.sample_spacing, {"sample_spacing_voxels", between(0.05, 0.85)});
  at(fitting.guard,
     {"guard", kAny, "guard", "", kTargets,
      "what a motion must not enter: full voxels, or also, near the surface, the true meshes",
      "voxels: P; meshes: R"});
  at(fitting.contact_state,
     {"contact_state", kAny, "contact-state", "", kTargets,
      "when, without refinement, a closing finger or palm has touched: when its next motion would "
      "enter the object, or when its clip volume holds a first sliver of surface, for comparison; "
      "with refinement always the latter, whatever is set",
      "closed: P; first-graze: R", "A32"});
  at(fitting.closing_tolerance, {"closing_tolerance_m", above(0)});
  at(fitting.palm_after_contact,
     {"palm_after_contact", kAny, "palm-after-contact", "", kTargets,
      "once a finger touches the palm stays, or goes on when all have closed, as long as contacts "
      "come nearer to their targets, fingers giving way and closing again",
      "R", "A29"});
  at(fitting.guard_self,
     {"guard_self", kAny, "guard-self", "", kTargets,
      "fingers stop at each other, too, while they close, those without a target swing out of the "
      "way, and sets for which none cross go first; no: fingers close through each other, and "
      "refinement parts them or gives up",
      "R"});
  at(fitting.give_up_distance, {"give_up_distance_m", at_least(0)});
};

constexpr auto sampling_rows = [](auto& at, auto& sampling) {
  at(sampling.source,
     {"source", kAny, "gs-sampling", "", kSearch,
      "with planner gs: points drawn on the surface, or hit by rays from a box around it", "R"});
  at(sampling.count, {"count", between(1, 1000000), "gs-samples", "1", kSearch,
                      "with planner gs: points drawn on the surface", "R"});
  at(sampling.box_margin, {"box_margin_m", above(0)});
  at(sampling.box_spacing, {"box_spacing_m", above(0)});
  at(sampling.largest_standoff, {"largest_standoff_m", at_least(0)});
};

constexpr auto medial_symmetry_rows = [](auto& at, auto& medial) {
  at(medial.samples, {"samples", between(1, 1000000), "ma-samples", "1", kSearch,
                      "with planner ma: points of the surface at which balls are looked for", "R"});
  at(medial.min_object_angle_deg, {"min_object_angle_deg", between(0, 180)});
  at(medial.axis_ratio, {"axis_ratio", between(0, 1)});
  at(medial.rim_ratio, {"rim_ratio", between(0, 1)});
  at(medial.search_radius, {"search_radius_m", above(0)});
  at(medial.search_radius_rel, {"search_radius_rel", at_least(0)});
  at(medial.least_spread_rel, {"least_spread_rel", at_least(0)});
};

constexpr auto refinement_rows = [](auto& at, auto& refinement) {
  constexpr int kMostSteps = std::remove_reference_t<decltype(refinement)>::kMostSteps;
  at(refinement.wanted_gap, {"wanted_gap_m", above(0), "wanted-gap-mm", "mm", kContacts,
                             "to which pads that must touch are brought, below largest-gap-mm"});
  at(refinement.largest_gap, {"largest_gap_m", above(0), "largest-gap-mm", "mm", kContacts,
                              "a pad that must touch has contact within this of the object"});
  at(refinement.least_distance, {"least_distance_m", above(0), "least-distance-mm", "mm", kContacts,
                                 "kept between all that must not touch"});
  at(refinement.max_iterations, {"max_iterations", between(1, kMostSteps), "refine-iterations", "1",
                                 kContacts, "iterations of contact refinement, at most"});
  at(refinement.slide_steps, {"slide_steps", between(0, kMostSteps), "slide-steps", "1", kContacts,
                              "in which pads that touch are slid toward their targets: larger M, "
                              "more work; 8 is a good number, 0: not"});
  at(refinement.near_pad_steps,
     {"near_pad_steps", between(0, kMostSteps), "near-pad-steps", "1", kContacts,
      "at most, in which each further pad that nearly touches is brought to touch where all others "
      "keep touching; 0: it stays"});
  at(refinement.reach, {"reach_m", above(0)});
  at(refinement.largest_shift, {"largest_shift_m", at_least(0), "largest-shift-mm", "mm", kContacts,
                                "of the palm while contacts are refined; 0: it stays"});
  at(refinement.largest_turn, {"largest_turn_rad", at_least(0), "largest-turn-deg", "deg",
                               kContacts, "of the palm while contacts are refined"});
};

constexpr auto pre_grasp_rows = [](auto& at, auto& pre_grasp) {
  at(pre_grasp.clearance, {"clearance_m", above(0), "pre-grasp-clearance-mm", "mm", kContacts,
                           "of every link from the object and what is around it in the pre-grasp"});
  at(pre_grasp.largest_retreat,
     {"largest_retreat_m", between(0, 10000), "pre-grasp-retreat-mm", "mm", kContacts,
      "largest retreat of the palm to the pre-grasp, against its direction"});
  at(pre_grasp.retreat_step, {"retreat_step_m", above(0)});
  at(pre_grasp.opening_steps, {"opening_steps", between(1, 1000)});
  at(pre_grasp.open_neutral, {"open_neutral", kAny, "pre-grasp-open-neutral", "", kContacts,
                              "where no other way is free, joints that neither open nor close "
                              "(spread, abduction) go along to where the open hand has them; "
                              "always with target-search reach"});
  at(pre_grasp.leave_pressing, {"leave_pressing", kAny, "pre-grasp-leave-pressing", "", kContacts,
                                "where no other way is free, joints whose opening would move what "
                                "touches further onto the object stay as they are in the grasp; "
                                "always with target-search reach"});
  at(pre_grasp.way_tolerance, {"way_tolerance_m", above(0)});
};

constexpr auto squeeze_rows = [](auto& at, auto& squeeze) {
  at(squeeze.normal_sum, {"normal_sum_N", above(0), "squeeze-force", "N", kForces,
                          "sum of the normal forces of all contacts in the squeeze, in newtons"});
  at(squeeze.stiffness, {"stiffness_N_m_per_rad", above(0), "squeeze-stiffness", "N m/rad", kForces,
                         "of revolute joints under position control, in N m/rad"});
  at(squeeze.slide_stiffness, {.key = "slide_stiffness_N_per_m",
                               .range = above(0),
                               .meaning = "of slides under position control"});
  at(squeeze.largest_residual, {.key = "largest_residual",
                                .range = at_least(0),
                                .meaning = "of a squeeze that balances, over normal_sum_N"});
};

constexpr auto distinct_rows = [](auto& at, auto& distinct) {
  at(distinct.translation, {"translation_m", at_least(0), "distinct-translation-mm", "mm",
                            kDistinct, "between the palm centers of two grasps", "R"});
  at(distinct.rotation, {"rotation_rad", at_least(0), "distinct-rotation-deg", "deg", kDistinct,
                         "between the palm orientations of two grasps", "R"});
  at(distinct.joints,
     {"joints_rad", at_least(0), "distinct-joints", "rad", kDistinct,
      "of an independent joint of two grasps, in radians; of slides over 0.1 m", "R"});
  at(distinct.slide_scale, {"slide_scale_m", above(0)});
};

constexpr auto quality_rows = [](auto& at, auto& quality) {
  at(quality.alpha,
     {"alpha", at_least(0), "alpha", "1", kMeasure, "weight of contact area in M1", "P"});
  at(quality.beta,
     {"beta", at_least(0), "beta", "1", kMeasure, "weight of the centroid's distance in M3", "P"});
  at(quality.w1, {"w1", at_least(0), "w1", "1", kMeasure, "exponent of M1", "P"});
  at(quality.w2, {"w2", at_least(0), "w2", "1", kMeasure, "exponent of M2", "P"});
  at(quality.w3, {"w3", at_least(0), "w3", "1", kMeasure, "exponent of M3", "P"});
  at(quality.theta_max, {"theta_max_rad", kAcute, "theta-max-deg", "deg", kTargets,
                         "half-angle of the friction cones of targets and measure",
                         "P; one angle for both: R", "A47"});
  at(quality.units, {"units", kAny, "measure-units", "", kMeasure,
                     "of boundary distances, areas and centroid distance", "R", "A9 A10 A11"});
  at(quality.regularity,
     {"regularity", kAny, "regularity", "", kMeasure, "definition of R in M3", "R", "A13"});
  at(quality.centroid,
     {"centroid", kAny, "centroid", "", kMeasure,
      "centroid of the contacts' hull: of its area or volume, or of its corners", "R", "A15"});
  at(quality.merge_distance,
     {.key = "merge_distance_m",
      .range = at_least(0),
      .meaning = "contacts nearer to each other are one corner of the hull; 0: a tenth of a voxel",
      .is_zero_if_empty = true});
};

constexpr auto planner_rows = [](auto& at, auto& options) {
  at(options.planner, {"planner", kAny, "planner", "", kSearch,
                       "the method that guides the hand: the paper's own, or one of those that its "
                       "Table 1 compares with, as far as they are known; all else is the same",
                       "R"});
  at(options.style,
     {"style", kAny, "style", "", kRequest,
      "where targets go: to the fingertips; power: also to the palm, and links "
      "behind the tips are closed onto the object; auto, with target-search reach: "
      "to those of the fingertips, or to them and the palm or one finger more, or "
      "to the palm and the pads behind the tips, the oftener the stronger such grips are; "
      "where no fingers are named, to any",
      "P; how: R", "A39"});
  at(options.fingers,
     {"fingers", kAny, "fingers", "", kRequest,
      "the fingers that must touch, by the hand's names (Barrett: finger_1, finger_2, thumb)"});
  at(options.num_contacts,
     {"num_contacts", at_least(1), "contacts", "1", kRequest,
      "without fingers: how many of them must touch, the thumb first; at least 2 unless the palm "
      "does and, if not given, no more than the hand has",
      "P"});
  at(options.palm,
     {"palm", kAny, "palm", "", kRequest,
      "the palm must touch too, one target more; without, it must in power grasps", "P"});
  at(options.count, {"count", at_least(1), "count", "1", kSearch, "grasps to find"});
  at(options.max_attempts, {"max_attempts", at_least(1), "max-attempts", "1", kSearch,
                            "target sets tried before giving up: work, not time", "R", "A36"});
  at(options.max_iterations, {"max_iterations", at_least(1), "max-iterations", "1", kSearch,
                              "fitting and refinement steps of all attempts together: the attempt "
                              "that reaches them is the last; the same on every machine",
                              "R", "A36"});
  at(options.acceptance,
     {"acceptance", kAny, "accept", "", kSearch,
      "which grasps count: free of penetration and with every contact; or M > 0", "P"});
  at(options.missing_contact,
     {"missing_contact", kAny, "missing-contact", "", kSearch,
      "without refinement: whether an attempt fails where a part that was asked for does not "
      "touch, or is measured by the contacts that there are",
      "R", "A31"});
  at(options.rejection,
     {"rejection", kAny, "reject", "", kSearch,
      "grasps after which new targets are drawn: with a contact farther from its target than "
      "largest-deviation-mm; or M below half of the targets' own and below 0.6",
      "P; how much is too much: R", "A36"});
  at(options.largest_deviation,
     {"largest_deviation_m", above(0), "largest-deviation-mm", "mm", kSearch,
      "with reject deviation: of a contact from its target; without it the width of a fingertip "
      "pad",
      "R", "A36"});
  at(options.search,
     {"search", kAny, "search", "", kSearch,
      "best: use all attempts and return the best grasps; first: stop at the first ones; closed: "
      "at the first ones that close, others fill up where attempts end before",
      "R", "A36"});
  at(options.rank,
     {"rank", kAny, "rank", "", kSearch,
      "what is best among grasps: the largest M; or the largest epsilon at squeeze-friction, how "
      "hard the grasp is to break, then M; or with hold the largest smallest force that fails",
      "m: P; others: R"});
  at(options.target_draws, {"target_draws", at_least(1), "target-draws", "1", kTargets,
                            "target sets drawn per attempt; the one that suits the fingertips' "
                            "directions best is fitted; 1: the paper's random set",
                            "R"});
  at(options.candidate_order,
     {"candidate_order", kAny, "candidate-order", "", kTargets,
      "which of an attempt's candidates (sides of target sets) go first: those on whose targets "
      "the fingertip pads would lie flattest; or, of several sets drawn at random, those whose "
      "targets balance at squeeze-friction; no difference with target-search ranked or "
      "target-draws 1",
      "R"});
  at(options.kept, {"kept_candidate", kAny, "keep", "", kTargets,
                    "which of an attempt's candidates is kept: the first that is accepted; the "
                    "first accepted one "
                    "whose squeeze balances; or, of the sides of all sets drawn, the one with the "
                    "largest epsilon "
                    "at squeeze-friction; or the firmest (by epsilon and by the force "
                    "that is borne in every direction), until the next one promises no more",
                    "R"});
  at(options.max_placements, {"max_placements", at_least(1), "max-placements", "1", kTargets,
                              "sides that are fitted, those that suit the fingertips best first: "
                              "of one target set, with keep strongest of all sets drawn",
                              "R", "A23"});
  at(options.max_redraws,
     {"max_redraws", at_least(0), "max-redraws", "1", kTargets,
      "how often an attempt of target-search reach may draw targets anew: while no grasp is "
      "accepted; with keep balanced and strongest, while no squeeze balances; with firmest, while "
      "no grasp is as firm as 0.04; with 0 the only draw may search as long as many together",
      "R"});
  at(options.approach_O, {"approach_O", kAny, "approach", "", kRequest,
                          "wanted direction of the palm, toward the object, in the object's frame",
                          "P; reading: R", "A23"});
  at(options.approach_angle, {"approach_angle_rad",
                              {.least = 0, .most = 180, .has_least = false},
                              "approach-angle-deg",
                              "deg",
                              kRequest,
                              "with approach: largest angle of the palm's direction from it",
                              "R",
                              "A23"});
  at(options.wall_clock_limit_s,
     {"wall_clock_limit_s", above(0), "wall-clock-limit-s", "s", kSearch,
      "also stop after this time; results then depend on the machine, and say so", "", "", false});
  at(options.resolution, {"resolution", between(4, 512), "resolution", "1", kScores,
                          "voxels along the object's longest extent", "P; whose extent: R", "A8"});
  at(options.clip_thickness,
     {"clip_thickness_m", above(0), "clip-thickness-mm", "mm", kTargets,
      "of clip volumes; without it half a voxel, at least 1 mm", "R", "A33"});
  at(options.averaging,
     {"averaging", kAny, "averaging", "", kScores,
      "how the pieces of surface in a voxel or clip volume are averaged", "R", "A6 A34"});
  at(options.counted_pads,
     {"counted_pads", kAny, "counted-pads", "", kTargets,
      "whose contacts count; without it those of fingertips and palm, with style power or auto all",
      "R", "A35"});
  at(options.contact_pieces,
     {"contact_pieces", kAny, "contact-pieces", "", kTargets,
      "surface in a clip volume that does not hang together is one contact, or several where their "
      "middles are farther apart than half the pad's width",
      "joined: P; separate: R"});
  at(options.contact_faces,
     {"contact_faces", kAny, "contact-faces", "", kTargets,
      "surface in a clip volume: all of it, or without what looks away from the pad, as the far "
      "side of a thin wall does; targets by reach may then be on either side of such a wall",
      "all: P; facing: R", "A34"});
  at.group("score", options.score, score_rows);
  at.optional_group("weak", options.weak, weak_rows);
  at.group("targets", options.targets, target_rows);
  at.group("fitting", options.fitting, fitting_rows);
  at.group("sampling", options.sampling, sampling_rows);
  at.group("medial_symmetry", options.medial_symmetry, medial_symmetry_rows);
  at(options.refine, {"refine", kAny, "refine", "", kContacts,
                      "bring every pad that must touch to true contact by exact queries; off: the "
                      "paper's grasp, at the level of voxels",
                      "", "", true, "on", "off"});
  at.group("refinement", options.refinement, refinement_rows);
  at(options.idle_fingers,
     {"idle_fingers", kAny, "idle-fingers", "", kContacts,
      "what fingers do that need not touch: they stay as the search left them; or, with refine, "
      "each closes onto the object where its fingertip's pad meets it",
      "R"});
  at(options.self_overlap, {"self_overlap_m", at_least(0)});
  at(options.contact_score_threshold,
     {"contact_score_threshold", kBelowOne, "contact-score-threshold", "1", kContacts,
      "every contact's score must exceed it, not only those of targets, which fingers miss; such "
      "grasps count as usable but not valid; without it: not asked"});
  at(options.pre_grasps,
     {"pre_grasps", kAny, "pre-grasps", "", kContacts,
      "a grasp needs a pre-grasp, open and clear, from which the straight way is free"});
  at.group("pre_grasp", options.pre_grasp, pre_grasp_rows);
  at.group("squeeze", options.squeeze, squeeze_rows);
  at.group("distinct", options.distinct, distinct_rows);
  at(options.friction, {"friction", at_least(0), "friction", "1", kForces,
                        "Coulomb's coefficient of epsilon; targets and M have theta-max-deg"});
  at(options.squeeze_friction, {"squeeze_friction", at_least(0), "squeeze-friction", "1", kForces,
                                "Coulomb's coefficient within whose cones the squeeze's forces "
                                "balance: less than there is, which is left for loads"});
  at.group("quality", options.quality, quality_rows);
};

}  // namespace graspfit::grasp::internal
