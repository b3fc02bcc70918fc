#include "input/planner_flags.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/number_text.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using base::shortest_decimal;
using grasp::name_of;
using grasp::names_of;
using grasp::PlannerOptions;

/// Adds an option for the enumeration of `fallback`.
template <class Enum>
void add_choice(po::options_description& options, const std::string& name, Enum fallback,
                const std::string& description) {
  add_option(options, name, names_of<Enum>(), std::string(name_of(fallback)), description);
}

void add_number(po::options_description& options, const std::string& name, double fallback,
                const std::string& description) {
  add_option(options, name, "NUMBER", shortest_decimal(fallback), description);
}

void add_integer(po::options_description& options, const std::string& name, std::uint64_t fallback,
                 const std::string& description) {
  add_option(options, name, "INTEGER", std::to_string(fallback), description);
}

}  // namespace

po::options_description score_map_options() {
  const PlannerOptions defaults;
  const grasp::ScoreOptions& score = defaults.score;
  po::options_description options = option_group("Voxels and contact score map");
  add_integer(options, "resolution", static_cast<std::uint64_t>(defaults.resolution),
              "voxels along the object's longest extent, 4 to 512 [P; whose extent: R, A8]");
  add_choice(options, "averaging", defaults.averaging,
             "how the pieces of surface in a voxel or clip volume are averaged [R, A6 A34]");
  add_choice(options, "score-normalization", score.normalization,
             "how raw scores become comparable with the threshold [R, A1]");
  add_choice(options, "plane-distance", score.plane_distance,
             "distances of neighbors to the voxel's plane [R, A2]");
  add_number(options, "score-length-voxels", score.length_voxels,
             "L, the normalizer of the mean plane distance, in voxels [R, A3]");
  add_integer(options, "mean-filter-radius", static_cast<std::uint64_t>(score.mean_filter_radius),
              "of the smoothing of scores, in voxels [R, A5]");
  add_integer(options, "mean-filter-passes", static_cast<std::uint64_t>(score.mean_filter_passes),
              "of the smoothing of scores [R, A5]");
  add_number(options, "score-threshold", defaults.targets.score_threshold,
             "every target's score must exceed it, from 0 to below 1 [P]");
  return options;
}

namespace {

po::options_description request_options() {
  const PlannerOptions defaults;
  po::options_description request = option_group("Hand and request");
  add_option(request, "hand", "NAME|FILE", "barrett",
             "a shipped hand (graspfit hand list), or the description of any hand: URDF, MJCF or "
             "GraspIt! XML; what no sidecar beside it says is derived");
  add_option(request, "fingers", "A,B,...", std::nullopt,
             "the fingers that must touch, by the hand's names (Barrett: finger_1, finger_2, "
             "thumb)");
  add_integer(request, "contacts", static_cast<std::uint64_t>(defaults.num_contacts),
              "without --fingers: how many fingers must touch, the thumb first; at least 2 and, if "
              "not given, no more than the hand has [P]");
  add_choice(request, "style", defaults.style,
             "where targets go: to the fingertips; power: also to the palm, and links behind the "
             "tips are closed onto the object [P; how: R, A39]");
  add_switch(request, "palm", "the palm must touch too, one target more [P]; power grasps: always");
  add_switch(request, "no-palm", "power grasps: the palm need not touch");
  add_option(request, "approach", "X,Y,Z", std::nullopt,
             "wanted direction of the palm, toward the object, in the object's frame [P; reading: "
             "R, A23]");
  add_number(request, "approach-angle-deg", defaults.approach_angle / base::kRadiansPerDegree,
             "with --approach: largest angle of the palm's direction from it, above 0 to 180 "
             "[R, A23]");
  return request;
}

po::options_description search_options() {
  const PlannerOptions defaults;
  po::options_description search = option_group("Search");
  add_option(search, "planner", grasp::planning_methods().names(), defaults.planner,
             "the method that guides the hand: the paper's own, or one of those that its Table 1 "
             "compares with, as far as they are known; all else is the same [R]");
  add_choice(search, "gs-sampling", defaults.sampling.source,
             "with --planner gs: points drawn on the surface, or hit by rays from a box around it "
             "[R]");
  add_integer(search, "gs-samples", static_cast<std::uint64_t>(defaults.sampling.count),
              "with --planner gs: points drawn on the surface [R]");
  add_integer(search, "ma-samples", static_cast<std::uint64_t>(defaults.medial_symmetry.samples),
              "with --planner ma: points of the surface at which balls are looked for [R]");
  add_integer(search, "count", static_cast<std::uint64_t>(defaults.count),
              "grasps to find, at least 1");
  add_integer(search, "seed", defaults.seed, "of the random numbers; same seed, same grasps");
  add_choice(search, "accept", defaults.acceptance,
             "which grasps count: free of penetration and with every contact; or M > 0 [P]");
  add_choice(search, "reject", defaults.rejection,
             "grasps after which new targets are drawn: with a contact farther from its target "
             "than --largest-deviation-mm; or M below half of the targets' own and below 0.6 [P; "
             "how much is too much: R, A36]");
  add_option(search, "largest-deviation-mm", "NUMBER", std::nullopt,
             "with --reject deviation: of a contact from its target; without it the width of a "
             "fingertip pad [R, A36]");
  add_choice(search, "missing-contact", defaults.missing_contact,
             "without refinement: whether an attempt fails where a part that was asked for does "
             "not touch, or is measured by the contacts that there are [R, A31]");
  add_choice(search, "search", defaults.search,
             "best: use all attempts and return the best grasps; first: stop at the first ones "
             "[R, A36]");
  add_integer(search, "max-attempts", static_cast<std::uint64_t>(defaults.max_attempts),
              "target sets tried before giving up: work, not time [R, A36]");
  add_option(search, "max-iterations", "N", std::nullopt,
             "fitting and refinement steps of all attempts together: the attempt that reaches them "
             "is the last; the same on every machine [R, A36]");
  add_option(search, "wall-clock-limit-s", "SECONDS", std::nullopt,
             "also stop after this time; results then depend on the machine, and say so");

  add_integer(search, "threads", 0,
              "attempts side by side; 0: as many as the machine has; the grasps do not depend on "
              "it");
  return search;
}

po::options_description distinct_options() {
  const PlannerOptions defaults;
  po::options_description distinct =
      option_group("Two grasps are different if any of these is exceeded");
  add_number(distinct, "distinct-translation-mm", defaults.distinct.translation * 1000.0,
             "between their palm centers [R]");
  add_number(distinct, "distinct-rotation-deg",
             defaults.distinct.rotation / base::kRadiansPerDegree,
             "between their palms' orientations [R]");
  add_number(distinct, "distinct-joints", defaults.distinct.joints,
             "of an independent joint, in radians; of slides over 0.1 m [R]");
  return distinct;
}

po::options_description target_options() {
  const PlannerOptions defaults;
  const grasp::TargetOptions& targets = defaults.targets;
  const contact::QualityOptions& quality = defaults.quality;
  po::options_description target = option_group("Target contacts and fitting");
  add_choice(target, "target-search", targets.search,
             "sets of targets at random [P], or best first until all are tried, which may end with "
             "the proof that there is none [R]");
  add_number(target, "ideal-m-bias", targets.ideal_m_bias,
             "random sets: how strongly those with a large M of their own are preferred; 0: not "
             "[R, A48]");
  add_integer(target, "ideal-m-draws", static_cast<std::uint64_t>(targets.ideal_m_draws),
              "with --ideal-m-bias: complete sets to draw one from, at least 1 [R, A48]");
  add_number(target, "theta-max-deg", quality.theta_max / base::kRadiansPerDegree,
             "half-angle of the friction cones of targets and measure, in degrees between 0 and 90 "
             "[P; one angle for both: R, A47]");
  add_choice(target, "pair-rule", targets.pair_rule,
             "with which earlier targets a new one must form a stable pair [R, A17]");
  add_number(target, "edge-tolerance", targets.edge_tolerance_rel,
             "largest difference of target distances over the first one [R, A19]");
  add_number(target, "centroid-limit", targets.centroid_limit_rel,
             "largest distance of the targets' centroid from the center of mass, over half the "
             "bounding box's diagonal [R, A19]");
  add_number(target, "angle-weight", targets.angle_weight,
             "weight of the angles between lines and normals of stable pairs in the rank of target "
             "sets; 0: not ranked by angles [R, A19]");
  add_number(target, "pool-fraction", targets.pool_fraction,
             "share of the ranked candidates that is drawn from, above 0 to 1 [R, A20]");
  add_number(target, "pool-spacing-mm", targets.pool_spacing * 1000.0,
             "of all candidates in a cube of this size the best one stays; 0: all [P: sampling]; a "
             "pad's width makes ranked searches for four and more targets short");
  add_number(target, "palm-reach-tolerance-mm", targets.palm_reach_tolerance * 1000.0,
             "with the palm: how far a target may lie from where its fingertip gets [R]");
  add_integer(
      target, "max-placements", static_cast<std::uint64_t>(defaults.max_placements),
      "sides that are fitted, those that suit the fingertips best first: of one target set, "
      "with --attempt-choice strongest of all sets drawn [R, A23]");
  add_integer(
      target, "target-draws", static_cast<std::uint64_t>(defaults.target_draws),
      "target sets drawn per attempt; the one that suits the fingertips' directions best is "
      "fitted [R]; 1: the paper's random set");
  add_choice(target, "attempt-choice", defaults.attempt_choice,
             "which of the sides an attempt tries is kept: the first that is accepted; the first "
             "accepted one whose squeeze balances, target sets that balance at --squeeze-friction "
             "first; or, of sides of all sets drawn, the one with the largest epsilon at "
             "--squeeze-friction [R]");
  add_integer(target, "max-seeds", static_cast<std::uint64_t>(targets.max_seeds),
              "seeds tried per target set [R, A20]");
  add_number(target, "clearance-mm", defaults.fitting.clearance * 1000.0,
             "between the object and the palm at the start [R, A24]");
  add_choice(target, "guard", defaults.fitting.guard,
             "what a motion must not enter: full voxels [P], or also, near the surface, the true "
             "meshes [R]");
  add_option(target, "guard-self", "yes|no", defaults.fitting.guard_self ? "yes" : "no",
             "fingers stop at each other, too, while they close, those without a target swing out "
             "of the way, and sets for which none cross go first; no: fingers close through each "
             "other, and refinement parts them or gives up [R]");
  add_choice(
      target, "contact-state", defaults.fitting.contact_state,
      "when a closing finger has touched: when its next motion would enter the object [P], or "
      "when its clip volume holds a first sliver of surface, for comparison [R, A32]");
  add_choice(
      target, "palm-after-contact", defaults.fitting.palm_after_contact,
      "once a finger touches the palm stays, or goes on when all have closed, as long as "
      "contacts come nearer to their targets, fingers giving way and closing again [R, A29]");
  add_option(target, "counted-pads", names_of<contact::CountedPads>(), std::nullopt,
             "whose contacts count; without it those of fingertips and palm, in power grasps all "
             "[R, A35]");
  add_choice(target, "contact-pieces", defaults.contact_pieces,
             "surface in a clip volume that does not hang together is one contact [P], or several "
             "where their middles are farther apart than half the pad's width [R]");
  add_option(target, "clip-thickness-mm", "NUMBER", std::nullopt,
             "of clip volumes; without it max(0.5 voxel, 1 mm) [R, A33]");

  add_option(target, "exclude-weak", "yes|no", targets.exclude_weak ? "yes" : "no",
             "no targets on fragile features [R, A37]");
  add_number(target, "weak-thickness-mm", defaults.weak->weak_thickness * 1000.0,
             "slender features thinner than this are fragile: S = 0 in M1 [P; what is fragile: R, "
             "A37]");
  add_switch(target, "no-weak", "look for no fragile features: S = 1 everywhere [R, A37]");
  return target;
}

po::options_description refinement_options() {
  const PlannerOptions defaults;
  po::options_description refinement =
      option_group("From voxels to contacts, and the way there [R]");
  const grasp::RefinementOptions& limits = defaults.refinement;
  add_option(refinement, "refine", "on|off", defaults.refine ? "on" : "off",
             "bring every claimed pad to true contact by exact queries; off: the paper's grasp, at "
             "the level of voxels");
  add_number(refinement, "largest-gap-mm", limits.largest_gap * 1000.0,
             "a claimed pad within this of the object has contact");
  add_number(refinement, "wanted-gap-mm", limits.wanted_gap * 1000.0,
             "to which claimed pads are brought, below --largest-gap-mm");
  add_number(refinement, "least-distance-mm", limits.least_distance * 1000.0,
             "kept between all that must not touch");
  add_number(refinement, "largest-shift-mm", limits.largest_shift * 1000.0,
             "of the palm while contacts are refined; 0: it stays");
  add_number(refinement, "largest-turn-deg", limits.largest_turn / base::kRadiansPerDegree,
             "of the palm while contacts are refined");
  add_integer(refinement, "refine-iterations", static_cast<std::uint64_t>(limits.max_iterations),
              "at most");
  add_integer(refinement, "slide-steps", static_cast<std::uint64_t>(limits.slide_steps),
              "in which pads that touch are slid toward their targets: larger M, more work; 8 is a "
              "good number, 0: not");
  add_integer(refinement, "near-pad-steps", static_cast<std::uint64_t>(limits.near_pad_steps),
              "in which each further pad that nearly touches is brought to touch where all others "
              "keep touching; 0: it stays");
  add_option(refinement, "contact-score-threshold", "NUMBER", std::nullopt,
             "every contact's score must exceed it, 0 to 1, not only those of targets, which "
             "fingers miss; such grasps count as usable but not valid; without: not asked [R]");
  add_option(refinement, "pre-grasps", "yes|no", defaults.pre_grasps ? "yes" : "no",
             "a grasp needs a pre-grasp, open and clear, from which the straight way is free");
  add_number(refinement, "pre-grasp-clearance-mm", defaults.pre_grasp.clearance * 1000.0,
             "of every link from the object and what is around it");
  add_number(refinement, "pre-grasp-retreat-mm", defaults.pre_grasp.largest_retreat * 1000.0,
             "largest one of the palm, against its direction");
  add_option(
      refinement, "pre-grasp-open-neutral", "yes|no",
      defaults.pre_grasp.open_neutral ? "yes" : "no",
      "where no other way is free, joints that neither open nor close (spread, abduction) go "
      "along to where the open hand has them");
  return refinement;
}

po::options_description force_options() {
  const PlannerOptions defaults;
  po::options_description forces = option_group("Forces: epsilon and squeeze [R]");
  add_number(forces, "friction", defaults.friction,
             "Coulomb's coefficient of epsilon; targets and M have --theta-max-deg");
  add_number(
      forces, "squeeze-friction", defaults.squeeze_friction,
      "Coulomb's coefficient within whose cones the squeeze's forces balance: less than there "
      "is, which is left for loads");
  add_number(forces, "squeeze-force", defaults.squeeze.normal_sum,
             "sum of the normal forces of all contacts in the squeeze, in newtons");
  add_number(forces, "squeeze-stiffness", defaults.squeeze.stiffness,
             "of revolute joints under position control, in N m/rad");
  return forces;
}

po::options_description measure_options() {
  const contact::QualityOptions quality;
  po::options_description measure = option_group("Measure M = M1^w1 * M2^w2 * M3^w3");
  add_number(measure, "alpha", quality.alpha, "weight of contact area in M1 [P]");
  add_number(measure, "beta", quality.beta, "weight of the centroid's distance in M3 [P]");
  add_number(measure, "w1", quality.w1, "exponent of M1 [P]");
  add_number(measure, "w2", quality.w2, "exponent of M2 [P]");
  add_number(measure, "w3", quality.w3, "exponent of M3 [P]");
  add_choice(measure, "measure-units", quality.units,
             "of boundary distances, areas and centroid distance [R, A9-A11]");
  add_choice(measure, "regularity", quality.regularity, "definition of R in M3 [R, A13]");
  add_choice(measure, "centroid", quality.centroid,
             "centroid of the contacts' hull: of its area or volume, or of its corners [R, A15]");
  return measure;
}

}  // namespace

po::options_description planner_options() {
  po::options_description all = option_group();
  all.add(request_options());
  all.add(search_options());
  all.add(distinct_options());
  all.add(target_options());
  all.add(refinement_options());
  all.add(force_options());
  all.add(measure_options());
  return all;
}

void require_ranges(const Flags& flags) {
  for (const auto& setting : experiments::planning_setting_descriptions()) {
    const std::string& name = setting.name.name;
    if (setting.range && flags.has(name)) flags.number(name, *setting.range);
  }
}

void read_score_map_flags(const Flags& flags, PlannerOptions& options) {
  options.resolution = flags.integer("resolution");
  options.averaging = flags.choice<geometry::PatchAveraging>("averaging");
  options.score.normalization = flags.choice<grasp::ScoreNormalization>("score-normalization");
  options.score.plane_distance = flags.choice<grasp::PlaneDistance>("plane-distance");
  options.score.length_voxels = flags.number("score-length-voxels");
  options.score.mean_filter_radius = flags.integer("mean-filter-radius");
  options.score.mean_filter_passes = flags.integer("mean-filter-passes");
  options.targets.score_threshold = flags.number("score-threshold");
}

namespace {

/// An angle in degrees as radians; the default keeps its bits on the way.
void read_angle(const Flags& flags, const std::string& name, double& angle) {
  const double degrees = flags.number(name);
  if (!flags.is_default(name)) angle = degrees * base::kRadiansPerDegree;
}

void read_millimeters(const Flags& flags, const std::string& name, double& length) {
  const double millimeters = flags.number(name);
  if (!flags.is_default(name)) length = millimeters / 1000.0;
}

void read_approach_flags(const Flags& flags, PlannerOptions& options) {
  if (!flags.has("approach")) {
    if (!flags.is_default("approach-angle-deg")) {
      throw UsageError("--approach-angle-deg means nothing without --approach");
    }
    return;
  }
  const std::vector<double> approach = flags.numbers("approach");
  if (approach.size() != 3) {
    throw UsageError("--approach \"" + flags.text("approach") + "\" is not three numbers X,Y,Z");
  }
  options.approach_O = Eigen::Vector3d(approach[0], approach[1], approach[2]);
  read_angle(flags, "approach-angle-deg", options.approach_angle);
}

void read_weak_flags(const Flags& flags, PlannerOptions& options) {
  options.targets.exclude_weak = flags.yes_or_no("exclude-weak");
  flags.number("weak-thickness-mm", base::above(0));  // of settings 0 means --no-weak
  read_millimeters(flags, "weak-thickness-mm", options.weak->weak_thickness);
  if (!flags.has("no-weak")) return;
  for (const char* flag : {"exclude-weak", "weak-thickness-mm"}) {
    if (flags.is_default(flag)) continue;
    throw UsageError("--" + std::string(flag) + " means nothing with --no-weak");
  }
  options.weak.reset();
}

/// Refinement, pre-grasps, squeeze and what tells grasps apart.
void read_contact_flags(const Flags& flags, PlannerOptions& options) {
  options.refine = flags.either("refine", "on", "off");
  grasp::RefinementOptions& limits = options.refinement;
  read_millimeters(flags, "largest-gap-mm", limits.largest_gap);
  read_millimeters(flags, "wanted-gap-mm", limits.wanted_gap);
  read_millimeters(flags, "least-distance-mm", limits.least_distance);
  read_millimeters(flags, "largest-shift-mm", limits.largest_shift);
  read_angle(flags, "largest-turn-deg", limits.largest_turn);
  limits.max_iterations = flags.integer("refine-iterations");
  limits.slide_steps = flags.integer("slide-steps");
  limits.near_pad_steps = flags.integer("near-pad-steps");
  options.contact_score_threshold = flags.optional_number("contact-score-threshold");
  options.pre_grasps = flags.yes_or_no("pre-grasps");
  read_millimeters(flags, "pre-grasp-clearance-mm", options.pre_grasp.clearance);
  read_millimeters(flags, "pre-grasp-retreat-mm", options.pre_grasp.largest_retreat);
  options.pre_grasp.open_neutral = flags.yes_or_no("pre-grasp-open-neutral");
  options.friction = flags.number("friction");
  options.squeeze_friction = flags.number("squeeze-friction");
  options.squeeze.normal_sum = flags.number("squeeze-force");
  options.squeeze.stiffness = flags.number("squeeze-stiffness");
  read_millimeters(flags, "distinct-translation-mm", options.distinct.translation);
  read_angle(flags, "distinct-rotation-deg", options.distinct.rotation);
  options.distinct.joints = flags.number("distinct-joints");
}

void read_request_flags(const Flags& flags, PlannerOptions& options) {
  options.style = flags.choice<grasp::GraspStyle>("style");
  options.num_contacts = flags.integer("contacts");
  if (flags.has("fingers")) {
    options.fingers = flags.words("fingers");
    if (!flags.is_default("contacts") &&
        options.num_contacts != static_cast<int>(options.fingers.size())) {
      throw UsageError("--contacts " + flags.text("contacts") + " contradicts the " +
                       std::to_string(options.fingers.size()) + " named by --fingers");
    }
    options.num_contacts = static_cast<int>(options.fingers.size());
  }
  if (flags.has("palm") && flags.has("no-palm")) {
    throw UsageError("--palm and --no-palm exclude each other");
  }
  if (flags.has("palm")) options.palm = true;
  if (flags.has("no-palm")) options.palm = false;
  read_approach_flags(flags, options);
}

void read_search_flags(const Flags& flags, PlannerOptions& options) {
  options.count = flags.integer("count");
  options.seed = flags.unsigned_integer("seed");
  options.acceptance = flags.choice<grasp::Acceptance>("accept");
  options.missing_contact = flags.choice<grasp::MissingContact>("missing-contact");
  options.rejection = flags.choice<grasp::Rejection>("reject");
  if (const auto deviation_mm = flags.optional_number("largest-deviation-mm")) {
    if (options.rejection != grasp::Rejection::Deviation) {
      throw UsageError("--largest-deviation-mm means nothing without --reject deviation");
    }
    options.largest_deviation = *deviation_mm / 1000.0;
  }
  options.search = flags.choice<grasp::SearchRule>("search");
  options.target_draws = flags.integer("target-draws");
  options.attempt_choice = flags.choice<grasp::AttemptChoice>("attempt-choice");
  options.max_placements = flags.integer("max-placements");
  options.max_attempts = flags.integer("max-attempts");
  if (flags.has("max-iterations")) options.max_iterations = flags.integer("max-iterations");
  if (flags.has("wall-clock-limit-s")) {
    options.wall_clock_limit_s = flags.number("wall-clock-limit-s", base::above(0));
  }
}

/// Which method, and what it alone has.
void read_method_flags(const Flags& flags, PlannerOptions& options) {
  options.planner = flags.text("planner");
  if (grasp::planning_methods().find(options.planner) == nullptr) {
    fail_choice("planner", options.planner, grasp::planning_methods().names());
  }
  for (const auto& [flag, prefix] : {std::pair("gs-sampling", "gs"), std::pair("gs-samples", "gs"),
                                     std::pair("ma-samples", "ma")}) {
    if (flags.is_default(flag) || options.planner.starts_with(prefix)) continue;
    throw UsageError("--" + std::string(flag) + " means nothing with --planner " + options.planner);
  }
  options.sampling.source = flags.choice<grasp::ApproachSource>("gs-sampling");
  options.sampling.count = flags.integer("gs-samples");
  options.medial_symmetry.samples = flags.integer("ma-samples");
}

void read_target_flags(const Flags& flags, PlannerOptions& options) {
  read_angle(flags, "theta-max-deg", options.quality.theta_max);
  options.targets.theta_max = options.quality.theta_max;
  options.targets.pair_rule = flags.choice<grasp::PairRule>("pair-rule");
  options.targets.edge_tolerance_rel = flags.number("edge-tolerance");
  options.targets.centroid_limit_rel = flags.number("centroid-limit");
  options.targets.pool_fraction = flags.number("pool-fraction");
  options.targets.angle_weight = flags.number("angle-weight");
  options.targets.ideal_m_draws = flags.integer("ideal-m-draws");
  read_millimeters(flags, "palm-reach-tolerance-mm", options.targets.palm_reach_tolerance);
  options.targets.max_seeds = flags.integer("max-seeds");
  options.targets.search = flags.choice<grasp::TargetSearch>("target-search");
  options.targets.ideal_m_bias = flags.number("ideal-m-bias");
  read_millimeters(flags, "pool-spacing-mm", options.targets.pool_spacing);
  options.fitting.guard = flags.choice<grasp::PenetrationGuard>("guard");
  options.fitting.guard_self = flags.yes_or_no("guard-self");
  options.fitting.contact_state = flags.choice<grasp::ContactState>("contact-state");
  options.fitting.palm_after_contact = flags.choice<grasp::PalmAfterContact>("palm-after-contact");
  options.fitting.clearance = flags.number("clearance-mm") / 1000.0;
  if (const auto thickness_mm = flags.optional_number("clip-thickness-mm")) {
    options.clip_thickness = *thickness_mm / 1000.0;
  }
  if (flags.has("counted-pads")) {
    options.counted_pads = flags.choice<contact::CountedPads>("counted-pads");
  }
  options.contact_pieces = flags.choice<contact::ContactPieces>("contact-pieces");
}

void read_measure_flags(const Flags& flags, PlannerOptions& options) {
  options.quality.alpha = flags.number("alpha");
  options.quality.beta = flags.number("beta");
  options.quality.w1 = flags.number("w1");
  options.quality.w2 = flags.number("w2");
  options.quality.w3 = flags.number("w3");
  options.quality.units = flags.choice<contact::MeasureUnits>("measure-units");
  options.quality.regularity = flags.choice<contact::Regularity>("regularity");
  options.quality.centroid = flags.choice<contact::HullCentroid>("centroid");
}

void validate_flags(const PlannerOptions& options) {
  try {
    experiments::require_compatible(options);
  } catch (const sweep::SettingError& error) {
    throw UsageError("--" + error.key() + ' ' + error.what());
  }
  options.validate();
}

}  // namespace

PlannerOptions read_planner_flags(const Flags& flags) {
  require_ranges(flags);
  PlannerOptions options;
  read_score_map_flags(flags, options);
  read_request_flags(flags, options);
  read_search_flags(flags, options);
  read_method_flags(flags, options);
  read_target_flags(flags, options);
  read_weak_flags(flags, options);
  read_contact_flags(flags, options);
  read_measure_flags(flags, options);
  validate_flags(options);
  return options;
}

}  // namespace graspfit::app
