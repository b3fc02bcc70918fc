#include "graspfit/experiments/planning_settings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "graspfit/grasp/grasp_guidance.hpp"
#include "internal/planning_setting_schemas.hpp"
#include "internal/setting_value.hpp"

namespace graspfit::experiments {
namespace {

using grasp::PlannerOptions;
using internal::SettingValue;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kMetersPerMillimeter = 1e-3;

using Schema = nlohmann::ordered_json;

/// A setting by name.
struct Setting {
  Column name;
  Schema schema;  ///< Of its values.
  std::function<void(PlanningSettings&, const SettingValue&)> apply;
};

Schema of_type(const char* type) { return {{"type", type}}; }
Schema above_zero() { return {{"type", "number"}, {"exclusiveMinimum", 0}}; }
Schema text() { return {{"type", "string"}, {"minLength", 1}}; }
Schema planning_methods() {
  Schema names = Schema::array();
  for (const auto& method : grasp::planning_methods()) names.push_back(std::string(method.name));
  return {{"enum", names}};
}
Schema three_numbers() {
  return {{"type", "array"}, {"items", of_type("number")}, {"minItems", 3}, {"maxItems", 3}};
}

using Apply = std::function<void(PlannerOptions&, const SettingValue&)>;

Setting option(const char* name, const char* unit, const char* meaning, Schema schema,
               Apply apply) {
  return {{name, unit, meaning},
          std::move(schema),
          [apply = std::move(apply)](PlanningSettings& settings, const SettingValue& value) {
            apply(settings.options, value);
          }};
}

/// An option that is a member (of a member) of the planner's options; `Field` returns it.
template <class Field>
Setting number(const char* name, const char* unit, const char* meaning, Field field,
               double factor = 1.0) {
  return option(name, unit, meaning, of_type("number"),
                [field, factor](PlannerOptions& o, const SettingValue& v) {
                  field(o) = v.number() * factor;
                });
}
template <class Field>
Setting integer(const char* name, const char* meaning, Field field) {
  return option(name, "1", meaning, of_type("integer"),
                [field](PlannerOptions& o, const SettingValue& v) { field(o) = v.integer(); });
}
template <class Field>
Setting yes_or_no(const char* name, const char* meaning, Field field) {
  return option(name, "", meaning, of_type("boolean"),
                [field](PlannerOptions& o, const SettingValue& v) { field(o) = v.yes_or_no(); });
}
template <class Enum, class Field>
Setting choice(const char* name, const char* meaning, Field field) {
  Schema names = Schema::array();
  for (const auto& named : grasp::named_values<Enum>()) names.push_back(std::string(named.name));
  return option(name, "", meaning, {{"enum", names}},
                [field](PlannerOptions& o, const SettingValue& v) { field(o) = v.choice<Enum>(); });
}

std::vector<Setting> object_and_hand_settings() {
  return {
      {{"file", "", "the object's mesh in the data folder"},
       text(),
       [](PlanningSettings& s, const SettingValue& v) { s.object.file = v.text(); }},
      {{"shape", "", "instead of file: a shape of graspfit shape"},
       text(),
       [](PlanningSettings& s, const SettingValue& v) { s.object.shape = v.text(); }},
      {{"size_m", "m", "length of the object's bounding box along size_axis"},
       above_zero(),
       [](PlanningSettings& s, const SettingValue& v) { s.object.size = v.positive_number(); }},
      {{"size_axis", "", "x, y, z or longest, which it is if not given"},
       {{"enum", {"x", "y", "z", "longest"}}},
       [](PlanningSettings& s, const SettingValue& v) {
         if (v.text() != "longest") s.object.size_axis = v.axis();
       }},
      {{"largest_thickness_m", "m", "scaled down where the bounding box's shortest edge is longer"},
       above_zero(),
       [](PlanningSettings& s, const SettingValue& v) {
         s.object.largest_thickness = v.positive_number();
       }},
      {{"rotation_deg", "deg",
        "[x, y, z]: the object is turned before planning, about its frame's x, then y, then z "
        "axis"},
       three_numbers(),
       [](PlanningSettings& s, const SettingValue& v) {
         s.object.rotation_xyz = v.vector3() * kRadiansPerDegree;
       }},
      {{"hand", "", "a shipped hand, or a description in the data folder"},
       text(),
       [](PlanningSettings& s, const SettingValue& v) { s.hand = v.text(); }}};
}

std::vector<Setting> request_settings() {
  return {choice<grasp::GraspStyle>(
              "style", "where targets go", [](PlannerOptions & o) -> auto& { return o.style; }),
          option("fingers", "", "array of the fingers that must touch, by the hand's names",
                 {{"type", "array"}, {"items", text()}, {"minItems", 1}},
                 [](PlannerOptions& o, const SettingValue& v) {
                   o.fingers = v.texts();
                   o.num_contacts = static_cast<int>(o.fingers.size());
                 }),
          integer(
              "contacts", "without fingers: how many of them must touch",
              [](PlannerOptions & o) -> auto& { return o.num_contacts; }),
          option("palm", "", "true or false: whether the palm must touch", of_type("boolean"),
                 [](PlannerOptions& o, const SettingValue& v) { o.palm = v.yes_or_no(); }),
          option("approach", "", "[x, y, z]: wanted direction of the palm in the object's frame",
                 three_numbers(),
                 [](PlannerOptions& o, const SettingValue& v) { o.approach_O = v.vector3(); }),
          number(
              "approach-angle-deg", "deg", "largest angle of the palm's direction from it",
              [](PlannerOptions & o) -> auto& { return o.approach_angle; }, kRadiansPerDegree),
          integer(
              "count", "grasps to collect", [](PlannerOptions & o) -> auto& { return o.count; }),
          integer(
              "max-attempts", "target sets fitted",
              [](PlannerOptions & o) -> auto& { return o.max_attempts; }),
          option("max-iterations", "1",
                 "fitting and refinement steps of all attempts together; none without",
                 of_type("integer"),
                 [](PlannerOptions& o, const SettingValue& v) { o.max_iterations = v.integer(); }),
          {{"table", "m",
            "a table: everything at or below this z of the object's frame is solid; none without"},
           of_type("number"),
           [](PlanningSettings& s, const SettingValue& v) { s.table_z_O = v.number(); }},
          choice<grasp::Acceptance>(
              "accept", "which grasps are collected",
              [](PlannerOptions & o) -> auto& { return o.acceptance; }),
          option("planner", "", "the method that guides the hand", planning_methods(),
                 [](PlannerOptions& o, const SettingValue& v) { o.planner = v.text(); }),
          choice<grasp::ApproachSource>(
              "gs-sampling", "of planner gs: where its points come from",
              [](PlannerOptions & o) -> auto& { return o.sampling.source; }),
          integer(
              "gs-samples", "of planner gs: points drawn on the surface",
              [](PlannerOptions & o) -> auto& { return o.sampling.count; }),
          integer(
              "ma-samples", "of planner ma: points at which balls are looked for",
              [](PlannerOptions & o) -> auto& { return o.medial_symmetry.samples; }),
          choice<grasp::MissingContact>(
              "missing-contact", "without refinement: what becomes of an attempt that lacks one",
              [](PlannerOptions & o) -> auto& { return o.missing_contact; }),
          choice<grasp::SearchRule>(
              "search", "when the planner stops looking",
              [](PlannerOptions & o) -> auto& { return o.search; })};
}

std::vector<Setting> score_settings() {
  return {integer(
              "resolution", "voxels along the object's longest extent",
              [](PlannerOptions & o) -> auto& { return o.resolution; }),
          choice<geometry::PatchAveraging>(
              "averaging", "how pieces of surface are averaged",
              [](PlannerOptions & o) -> auto& { return o.averaging; }),
          integer(
              "neighborhood", "edge of the score's window in voxels",
              [](PlannerOptions & o) -> auto& { return o.score.neighborhood; }),
          choice<grasp::ScoreNormalization>(
              "score-normalization", "how raw scores become comparable with the threshold",
              [](PlannerOptions & o) -> auto& { return o.score.normalization; }),
          choice<grasp::PlaneDistance>(
              "plane-distance", "distances of neighbors to the voxel's plane",
              [](PlannerOptions & o) -> auto& { return o.score.plane_distance; }),
          number(
              "score-length-voxels", "1", "normalizer of the mean plane distance in voxels",
              [](PlannerOptions & o) -> auto& { return o.score.length_voxels; }),
          integer(
              "mean-filter-radius", "of the smoothing of scores in voxels",
              [](PlannerOptions & o) -> auto& { return o.score.mean_filter_radius; }),
          integer(
              "mean-filter-passes", "of the smoothing of scores",
              [](PlannerOptions & o) -> auto& { return o.score.mean_filter_passes; }),
          number(
              "score-threshold", "1", "every target's score must exceed it",
              [](PlannerOptions & o) -> auto& { return o.targets.score_threshold; }),
          option("contact-score-threshold", "1",
                 "every contact's score must exceed it; none without", of_type("number"),
                 [](PlannerOptions& o, const SettingValue& v) {
                   o.contact_score_threshold = v.number();
                 }),
          option("weak-thickness-mm", "mm", "parts thinner are fragile; 0: none are looked for",
                 of_type("number"), [](PlannerOptions& o, const SettingValue& v) {
                   if (v.number() == 0.0) {
                     o.weak.reset();
                   } else {
                     o.weak = geometry::WeakRegionOptions{};
                     o.weak->weak_thickness = v.number() * kMetersPerMillimeter;
                   }
                 })};
}

std::vector<Setting> target_settings() {
  return {
      option("theta-max-deg", "deg", "half-angle of the friction cones of targets and measure",
             of_type("number"),
             [](PlannerOptions& o, const SettingValue& v) {
               o.quality.theta_max = o.targets.theta_max = v.number() * kRadiansPerDegree;
             }),
      choice<grasp::PairRule>(
          "pair-rule", "with which targets a new one must form a stable pair",
          [](PlannerOptions & o) -> auto& { return o.targets.pair_rule; }),
      choice<grasp::TargetSearch>(
          "target-search", "how target sets are found",
          [](PlannerOptions & o) -> auto& { return o.targets.search; }),
      yes_or_no(
          "exclude-weak", "no targets on fragile parts",
          [](PlannerOptions & o) -> auto& { return o.targets.exclude_weak; }),
      number(
          "ideal-m-bias", "1", "how strongly sets with a large ideal M are preferred",
          [](PlannerOptions & o) -> auto& { return o.targets.ideal_m_bias; }),
      integer(
          "ideal-m-draws", "with ideal-m-bias: complete sets to draw one from",
          [](PlannerOptions & o) -> auto& { return o.targets.ideal_m_draws; }),
      number(
          "angle-weight", "1", "weight of stable pairs' angles in the rank of target sets",
          [](PlannerOptions & o) -> auto& { return o.targets.angle_weight; }),
      number(
          "palm-reach-tolerance-mm", "mm", "how far a target may lie from where its tip gets",
          [](PlannerOptions & o) -> auto& { return o.targets.palm_reach_tolerance; },
          kMetersPerMillimeter),
      integer(
          "max-placements", "sides of one target set that are fitted",
          [](PlannerOptions & o) -> auto& { return o.max_placements; }),
      number(
          "edge-tolerance", "1", "largest difference of target distances over the first one",
          [](PlannerOptions & o) -> auto& { return o.targets.edge_tolerance_rel; }),
      number(
          "centroid-limit", "1", "largest distance of the targets' centroid from the mass center",
          [](PlannerOptions & o) -> auto& { return o.targets.centroid_limit_rel; }),
      number(
          "pool-fraction", "1", "share of the ranked candidates that is drawn from",
          [](PlannerOptions & o) -> auto& { return o.targets.pool_fraction; }),
      number(
          "pool-spacing-mm", "mm", "candidates nearer than this to a better one are passed over",
          [](PlannerOptions & o) -> auto& { return o.targets.pool_spacing; }, kMetersPerMillimeter),
      integer(
          "target-draws", "target sets drawn per attempt",
          [](PlannerOptions & o) -> auto& { return o.target_draws; }),
      yes_or_no(
          "prefer-balanced", "sets and sides are looked for whose squeeze balances",
          [](PlannerOptions & o) -> auto& { return o.prefer_balanced; }),
      integer(
          "max-seeds", "seeds tried per target set",
          [](PlannerOptions & o) -> auto& { return o.targets.max_seeds; })};
}

std::vector<Setting> fitting_settings() {
  return {
      number(
          "clearance-mm", "mm", "between the object and the palm at the start",
          [](PlannerOptions & o) -> auto& { return o.fitting.clearance; }, kMetersPerMillimeter),
      choice<grasp::PenetrationGuard>(
          "guard", "what a motion must not enter",
          [](PlannerOptions & o) -> auto& { return o.fitting.guard; }),
      yes_or_no(
          "guard-self", "fingers stop at each other while they close",
          [](PlannerOptions & o) -> auto& { return o.fitting.guard_self; }),
      yes_or_no(
          "settle", "fingers close on until they touch",
          [](PlannerOptions & o) -> auto& { return o.fitting.settle; }),
      option("clip-thickness-mm", "mm", "of clip volumes", above_zero(),
             [](PlannerOptions& o, const SettingValue& v) {
               o.clip_thickness = v.positive_number() * kMetersPerMillimeter;
             }),
      yes_or_no(
          "refine", "contacts are made real by exact queries",
          [](PlannerOptions & o) -> auto& { return o.refine; }),
      number(
          "largest-gap-mm", "mm", "a claimed pad within this has contact",
          [](PlannerOptions & o) -> auto& { return o.refinement.largest_gap; },
          kMetersPerMillimeter),
      number(
          "wanted-gap-mm", "mm", "to which claimed pads are brought",
          [](PlannerOptions & o) -> auto& { return o.refinement.wanted_gap; },
          kMetersPerMillimeter),
      number(
          "least-distance-mm", "mm", "kept between all that must not touch",
          [](PlannerOptions & o) -> auto& { return o.refinement.least_distance; },
          kMetersPerMillimeter),
      number(
          "largest-shift-mm", "mm", "of the palm while contacts are refined",
          [](PlannerOptions & o) -> auto& { return o.refinement.largest_shift; },
          kMetersPerMillimeter),
      number(
          "largest-turn-deg", "deg", "of the palm while contacts are refined",
          [](PlannerOptions & o) -> auto& { return o.refinement.largest_turn; }, kRadiansPerDegree),
      integer(
          "refine-iterations", "of contact refinement",
          [](PlannerOptions & o) -> auto& { return o.refinement.max_iterations; }),
      integer(
          "slide-steps", "of touching pads toward their targets; 0: none",
          [](PlannerOptions & o) -> auto& { return o.refinement.slide_steps; }),
      yes_or_no(
          "pre-grasps", "a grasp needs a pre-grasp with a free way in",
          [](PlannerOptions & o) -> auto& { return o.pre_grasps; }),
      number(
          "pre-grasp-clearance-mm", "mm", "of every link in the pre-grasp",
          [](PlannerOptions & o) -> auto& { return o.pre_grasp.clearance; }, kMetersPerMillimeter),
      number(
          "pre-grasp-retreat-mm", "mm", "largest retreat of the palm to the pre-grasp",
          [](PlannerOptions & o) -> auto& { return o.pre_grasp.largest_retreat; },
          kMetersPerMillimeter),
      yes_or_no(
          "pre-grasp-open-neutral", "spread and abduction may go along to the pre-grasp",
          [](PlannerOptions & o) -> auto& { return o.pre_grasp.open_neutral; }),
      number(
          "squeeze-force", "N", "sum of the normal forces of the squeeze",
          [](PlannerOptions & o) -> auto& { return o.squeeze.normal_sum; }),
      number(
          "squeeze-stiffness", "N m/rad", "of the position-controlled joints",
          [](PlannerOptions & o) -> auto& { return o.squeeze.stiffness; }),
      number(
          "distinct-translation-mm", "mm", "palms farther apart are of distinct grasps",
          [](PlannerOptions & o) -> auto& { return o.distinct.translation; }, kMetersPerMillimeter),
      number(
          "distinct-rotation-deg", "deg", "palms turned more are of distinct grasps",
          [](PlannerOptions & o) -> auto& { return o.distinct.rotation; }, kRadiansPerDegree),
      number(
          "distinct-joints", "rad", "joints that differ more are of distinct grasps",
          [](PlannerOptions & o) -> auto& { return o.distinct.joints; })};
}

std::vector<Setting> measure_settings() {
  return {
      number(
          "alpha", "1", "weight of contact area in M1",
          [](PlannerOptions & o) -> auto& { return o.quality.alpha; }),
      number(
          "beta", "1", "weight of the centroid's distance in M3",
          [](PlannerOptions & o) -> auto& { return o.quality.beta; }),
      number(
          "w1", "1", "exponent of M1", [](PlannerOptions & o) -> auto& { return o.quality.w1; }),
      number(
          "w2", "1", "exponent of M2", [](PlannerOptions & o) -> auto& { return o.quality.w2; }),
      number(
          "w3", "1", "exponent of M3", [](PlannerOptions & o) -> auto& { return o.quality.w3; }),
      choice<grasp::MeasureUnits>(
          "measure-units", "of distances and areas in M",
          [](PlannerOptions & o) -> auto& { return o.quality.units; }),
      choice<grasp::Regularity>(
          "regularity", "definition of R in M3",
          [](PlannerOptions & o) -> auto& { return o.quality.regularity; }),
      choice<grasp::HullCentroid>(
          "centroid", "centroid of the contacts' hull",
          [](PlannerOptions & o) -> auto& { return o.quality.centroid; }),
      number(
          "squeeze-friction", "1", "Coulomb's mu of the squeeze",
          [](PlannerOptions & o) -> auto& { return o.squeeze_friction; }),
      number(
          "friction", "1", "Coulomb's mu of epsilon",
          [](PlannerOptions & o) -> auto& { return o.friction; })};
}

const std::vector<Setting>& all_settings() {
  static const std::vector<Setting> settings = [] {
    std::vector<Setting> all;
    for (std::vector<Setting> group :
         {object_and_hand_settings(), request_settings(), score_settings(), target_settings(),
          fitting_settings(), measure_settings()}) {
      std::move(group.begin(), group.end(), std::back_inserter(all));
    }
    return all;
  }();
  return settings;
}

[[noreturn]] void fail_unknown(const std::string& key, const std::vector<Column>& others) {
  std::string names;
  for (const Column& other : others) names += (names.empty() ? "" : ", ") + other.name;
  for (const Setting& setting : all_settings()) {
    names += (names.empty() ? "" : ", ") + setting.name.name;
  }
  throw SettingError(key, "is no setting; there are " + names);
}

}  // namespace

const std::vector<Column>& planning_setting_names() {
  static const std::vector<Column> names = [] {
    std::vector<Column> columns;
    for (const Setting& setting : all_settings()) columns.push_back(setting.name);
    return columns;
  }();
  return names;
}

const Schema& internal::planning_setting_schemas() {
  static const Schema schemas = [] {
    Schema all;
    for (const Setting& setting : all_settings()) {
      all[setting.name.name] = setting.schema;
      const std::string& unit = setting.name.unit;
      all[setting.name.name]["description"] =
          setting.name.meaning + (unit.empty() || unit == "1" ? "" : " [" + unit + ']');
    }
    return all;
  }();
  return schemas;
}

PlanningSettings planning_settings(const std::string& text, std::uint64_t seed,
                                   const std::vector<Column>& others) {
  const nlohmann::json json = nlohmann::json::parse(text);
  PlanningSettings settings;
  for (const auto& [key, value] : json.items()) {
    if (std::any_of(others.begin(), others.end(),
                    [&, &name = key](const Column& other) { return other.name == name; })) {
      continue;
    }
    const auto found = std::find_if(
        all_settings().begin(), all_settings().end(),
        [&, &name = key](const Setting& setting) { return setting.name.name == name; });
    if (found == all_settings().end()) fail_unknown(key, others);
    found->apply(settings, SettingValue(key, value));
  }
  if (settings.object.file.empty() == settings.object.shape.empty()) {
    throw SettingError("", "an object is either a file or a shape; set one of the two");
  }
  if (settings.hand.empty()) throw SettingError("", "there is no setting hand");
  settings.options.seed = seed;
  try {
    settings.options.validate();
  } catch (const geometry::InvalidInput& error) {
    throw SettingError("", error.what());
  }
  return settings;
}

PlanningSettings planning_settings(const Cell& cell, const std::vector<Column>& others) {
  return planning_settings(cell.settings, cell.seed, others);
}

}  // namespace graspfit::experiments
