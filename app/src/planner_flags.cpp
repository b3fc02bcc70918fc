#include "planner_flags.hpp"

#include <cmath>
#include <numbers>

#include "graspfit/geometry/atomic_file.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using geometry::shortest_decimal;
using grasp::name_of;
using grasp::names_of;
using grasp::PlannerOptions;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

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

po::options_description planner_options() {
  const PlannerOptions defaults;
  const grasp::TargetOptions& targets = defaults.targets;
  const grasp::QualityOptions& quality = defaults.quality;

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
  add_choice(request, "style", defaults.style, "where targets go: to the fingertips [P]");
  add_option(request, "approach", "X,Y,Z", std::nullopt,
             "wanted direction of the palm, toward the object, in the object's frame [P; reading: "
             "R, A23]");

  po::options_description search = option_group("Search");
  add_integer(search, "count", static_cast<std::uint64_t>(defaults.count),
              "grasps to find, at least 1");
  add_integer(search, "seed", defaults.seed, "of the random numbers; same seed, same grasps");
  add_choice(
      search, "accept", defaults.acceptance,
      "which grasps count: free of penetration and with every contact; M > 0 [P]; M at least "
      "half of the targets' own or 0.6 [R, A36]");
  add_choice(search, "search", defaults.search,
             "best: use all attempts and return the best grasps; first: stop at the first ones "
             "[R, A36]");
  add_integer(search, "max-attempts", static_cast<std::uint64_t>(defaults.max_attempts),
              "target sets tried before giving up: work, not time [R, A36]");
  add_option(search, "wall-clock-limit-s", "SECONDS", std::nullopt,
             "also stop after this time; results then depend on the machine, and say so");

  po::options_description target = option_group("Target contacts and fitting");
  add_number(target, "theta-max-deg", quality.theta_max / kRadiansPerDegree,
             "half-angle of the friction cones of targets and measure, in degrees between 0 and 90 "
             "[P; one angle for both: R, A47]");
  add_choice(target, "pair-rule", targets.pair_rule,
             "with which earlier targets a new one must form a stable pair [R, A17]");
  add_number(target, "edge-tolerance", targets.edge_tolerance_rel,
             "largest difference of target distances over the first one [R, A19]");
  add_number(target, "centroid-limit", targets.centroid_limit_rel,
             "largest distance of the targets' centroid from the center of mass, over half the "
             "bounding box's diagonal [R, A19]");
  add_number(target, "pool-fraction", targets.pool_fraction,
             "share of the ranked candidates that is drawn from, above 0 to 1 [R, A20]");
  add_integer(
      target, "target-draws", static_cast<std::uint64_t>(defaults.target_draws),
      "target sets drawn per attempt; the one that suits the fingertips' directions best is "
      "fitted [R]; 1: the paper's random set");
  add_integer(target, "max-seeds", static_cast<std::uint64_t>(targets.max_seeds),
              "seeds tried per target set [R, A20]");
  add_number(target, "clearance-mm", defaults.fitting.clearance * 1000.0,
             "between the object and the palm at the start [R, A24]");
  add_choice(target, "guard", defaults.fitting.guard,
             "what a motion must not enter: full voxels [P], or also, near the surface, the true "
             "meshes [R]");
  add_option(target, "settle", "yes|no", "yes",
             "after the clip test, close fingers on until they touch [R]; no: the paper's contact");
  add_option(target, "clip-thickness-mm", "NUMBER", std::nullopt,
             "of clip volumes; without it max(0.5 voxel, 1 mm) [R, A33]");

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

  po::options_description all = option_group();
  all.add(request).add(search).add(target).add(measure);
  return all;
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

PlannerOptions read_planner_flags(const Flags& flags) {
  PlannerOptions options;
  read_score_map_flags(flags, options);

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
  if (flags.has("approach")) {
    const std::vector<double> approach = flags.numbers("approach");
    if (approach.size() != 3) {
      throw UsageError("--approach \"" + flags.text("approach") + "\" is not three numbers X,Y,Z");
    }
    options.approach_O = Eigen::Vector3d(approach[0], approach[1], approach[2]);
  }

  options.count = flags.integer("count");
  options.seed = flags.unsigned_integer("seed");
  options.acceptance = flags.choice<grasp::Acceptance>("accept");
  options.search = flags.choice<grasp::SearchRule>("search");
  options.target_draws = flags.integer("target-draws");
  options.fitting.guard = flags.choice<grasp::PenetrationGuard>("guard");
  options.fitting.settle = flags.yes_or_no("settle");
  options.max_attempts = flags.integer("max-attempts");
  options.wall_clock_limit_s = flags.optional_number("wall-clock-limit-s");

  const double theta_max_deg = flags.number("theta-max-deg");
  if (!(theta_max_deg > 0.0 && theta_max_deg < 90.0)) {
    throw UsageError("--theta-max-deg " + flags.text("theta-max-deg") +
                     " is not between 0 and 90 degrees");
  }
  // The default angle keeps its bits on the way through degrees.
  if (!flags.is_default("theta-max-deg")) {
    options.quality.theta_max = theta_max_deg * kRadiansPerDegree;
  }
  options.targets.theta_max = options.quality.theta_max;
  options.targets.pair_rule = flags.choice<grasp::PairRule>("pair-rule");
  options.targets.edge_tolerance_rel = flags.number("edge-tolerance");
  options.targets.centroid_limit_rel = flags.number("centroid-limit");
  options.targets.pool_fraction = flags.number("pool-fraction");
  options.targets.max_seeds = flags.integer("max-seeds");
  options.fitting.clearance = flags.number("clearance-mm") / 1000.0;
  if (const auto thickness_mm = flags.optional_number("clip-thickness-mm")) {
    options.clip_thickness = *thickness_mm / 1000.0;
  }

  options.quality.alpha = flags.number("alpha");
  options.quality.beta = flags.number("beta");
  options.quality.w1 = flags.number("w1");
  options.quality.w2 = flags.number("w2");
  options.quality.w3 = flags.number("w3");
  options.quality.units = flags.choice<grasp::MeasureUnits>("measure-units");
  options.quality.regularity = flags.choice<grasp::Regularity>("regularity");
  options.quality.centroid = flags.choice<grasp::HullCentroid>("centroid");
  options.validate();
  return options;
}

}  // namespace graspfit::app
