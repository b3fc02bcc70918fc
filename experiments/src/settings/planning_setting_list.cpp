#include "settings/planning_setting_list.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "graspfit/base/units.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "settings/option_value.hpp"

namespace graspfit::experiments::internal {
namespace {

using base::above;
using base::at_least;
using base::between;
using base::NumberRange;
using grasp::PlannerOptions;
using Schema = nlohmann::ordered_json;

constexpr int kMostSteps = grasp::RefinementOptions::kMostSteps;

/// To twelve digits: what a conversion of units adds behind them is not the setting's.
std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.11e", value);
  return base::plain_decimal(std::strtod(text, nullptr));
}

Schema of_type(const char* type) { return {{"type", type}}; }
Schema text() { return {{"type", "string"}, {"minLength", 1}}; }
Schema planning_methods() {
  Schema names = Schema::array();
  for (const auto& method : grasp::planning_methods().all())
    names.push_back(std::string(method.name));
  return {{"enum", names}};
}
Schema three_numbers() {
  return {{"type", "array"}, {"items", of_type("number")}, {"minItems", 3}, {"maxItems", 3}};
}

using Apply = std::function<void(PlannerOptions&, const sweep::SettingValue&)>;

PlanningSetting option(const char* name, const char* unit, const char* meaning, Schema schema,
                       Apply apply, std::optional<NumberRange> range = {},
                       std::string fallback = "") {
  return {{name, unit, meaning},
          std::move(schema),
          [apply = std::move(apply)](PlanningSettings& settings, const sweep::SettingValue& value) {
            apply(settings.options, value);
          },
          range,
          std::move(fallback)};
}

/// An option that is a member (of a member) of the planner's options; `Field` returns it.
template <class Field>
PlanningSetting number(const char* name, const char* unit, const char* meaning,
                       const NumberRange& range, Field field, double factor = 1.0) {
  PlannerOptions defaults;
  return option(
      name, unit, meaning, of_type("number"),
      [field, factor](PlannerOptions& o, const sweep::SettingValue& v) {
        field(o) = v.number() * factor;
      },
      range, number_text(field(defaults) / factor));
}
template <class Field>
PlanningSetting integer(const char* name, const char* meaning, const NumberRange& range,
                        Field field) {
  PlannerOptions defaults;
  return option(
      name, "1", meaning, of_type("integer"),
      [field](PlannerOptions& o, const sweep::SettingValue& v) { field(o) = v.integer(); }, range,
      std::to_string(field(defaults)));
}
template <class Field>
PlanningSetting yes_or_no(const char* name, const char* meaning, Field field) {
  PlannerOptions defaults;
  return option(
      name, "", meaning, of_type("boolean"),
      [field](PlannerOptions& o, const sweep::SettingValue& v) { field(o) = v.yes_or_no(); }, {},
      field(defaults) ? "true" : "false");
}
template <class Enum, class Field>
PlanningSetting choice(const char* name, const char* meaning, Field field) {
  PlannerOptions defaults;
  Schema names = Schema::array();
  for (const auto& named : grasp::named_values<Enum>()) names.push_back(std::string(named.name));
  return option(
      name, "", meaning, {{"enum", names}},
      [field](PlannerOptions& o, const sweep::SettingValue& v) {
        field(o) = option_value<Enum>(v);
      },
      {}, std::string(grasp::name_of(field(defaults))));
}

std::vector<PlanningSetting> object_and_hand_settings() {
  return {
      {{"file", "", "the object's mesh in the data folder"},
       text(),
       [](PlanningSettings& s, const sweep::SettingValue& v) { s.object.file = v.text(); }},
      {{"packaged", "", "instead of file: a mesh of libcgal-demo, by the name of its file"},
       text(),
       [](PlanningSettings& s, const sweep::SettingValue& v) {
         s.object.packaged = v.text();
         if (v.text().find('/') != std::string::npos) v.fail("must be a file's name, no path");
       }},
      {{"shape", "", "instead of file: a shape of graspfit shape"},
       text(),
       [](PlanningSettings& s, const sweep::SettingValue& v) { s.object.shape = v.text(); }},
      {{"size_m", "m", "length of the object's bounding box along size_axis"},
       of_type("number"),
       [](PlanningSettings& s, const sweep::SettingValue& v) { s.object.size = v.number(); },
       above(0)},
      {{"size_axis", "", "edge of the bounding box that size_m is for"},
       {{"enum", {"x", "y", "z", "longest"}}},
       [](PlanningSettings& s, const sweep::SettingValue& v) {
         if (v.text() != "longest") s.object.size_axis = v.axis();
       },
       {},
       "longest"},
      {{"largest_thickness_m", "m", "scaled down where the bounding box's shortest edge is longer"},
       of_type("number"),
       [](PlanningSettings& s, const sweep::SettingValue& v) {
         s.object.largest_thickness = v.number();
       },
       above(0)},
      {{"rotation_deg", "deg",
        "[x, y, z]: the object is turned before planning, about its frame's x, then y, then z "
        "axis"},
       three_numbers(),
       [](PlanningSettings& s, const sweep::SettingValue& v) {
         s.object.rotation_xyz = v.vector3() * base::kRadiansPerDegree;
       }},
      {{"hand", "", "a shipped hand, or a description in the data folder"},
       text(),
       [](PlanningSettings& s, const sweep::SettingValue& v) { s.hand = v.text(); }}};
}

std::vector<PlanningSetting> request_settings() {
  return {
      choice<grasp::GraspStyle>(
          "style", "where targets go", [](PlannerOptions & o) -> auto& { return o.style; }),
      option("fingers", "", "array of the fingers that must touch, by the hand's names",
             {{"type", "array"}, {"items", text()}, {"minItems", 1}},
             [](PlannerOptions& o, const sweep::SettingValue& v) {
               o.fingers = v.texts();
               o.num_contacts = static_cast<int>(o.fingers.size());
             }),
      integer(
          "contacts", "without fingers: how many of them must touch", at_least(1),
          [](PlannerOptions & o) -> auto& { return o.num_contacts; }),
      option("palm", "", "whether the palm must touch; without it, it must if style is power",
             of_type("boolean"),
             [](PlannerOptions& o, const sweep::SettingValue& v) { o.palm = v.yes_or_no(); }),
      option("approach", "", "[x, y, z]: wanted direction of the palm in the object's frame",
             three_numbers(),
             [](PlannerOptions& o, const sweep::SettingValue& v) { o.approach_O = v.vector3(); }),
      number(
          "approach-angle-deg", "deg", "largest angle of the palm's direction from it",
          {.least = 0, .most = 180, .has_least = false},
          [](PlannerOptions & o) -> auto& { return o.approach_angle; }, base::kRadiansPerDegree),
      integer(
          "count", "grasps to collect", at_least(1),
          [](PlannerOptions & o) -> auto& { return o.count; }),
      integer(
          "max-attempts", "target sets fitted", at_least(1),
          [](PlannerOptions & o) -> auto& { return o.max_attempts; }),
      option(
          "max-iterations", "1", "fitting and refinement steps of all attempts together",
          of_type("integer"),
          [](PlannerOptions& o, const sweep::SettingValue& v) { o.max_iterations = v.integer(); },
          at_least(1)),
      {{"table", "m", "a table: everything at or below this z of the object's frame is solid"},
       of_type("number"),
       [](PlanningSettings& s, const sweep::SettingValue& v) { s.table_z_O = v.number(); }},
      choice<grasp::Acceptance>(
          "accept", "which grasps are collected",
          [](PlannerOptions & o) -> auto& { return o.acceptance; }),
      option(
          "planner", "", "the method that guides the hand", planning_methods(),
          [](PlannerOptions& o, const sweep::SettingValue& v) { o.planner = v.text(); }, {},
          PlannerOptions{}.planner),
      choice<grasp::ApproachSource>(
          "gs-sampling", "of planner gs: where its points come from",
          [](PlannerOptions & o) -> auto& { return o.sampling.source; }),
      integer(
          "gs-samples", "of planner gs: points drawn on the surface", between(1, 1000000),
          [](PlannerOptions & o) -> auto& { return o.sampling.count; }),
      integer(
          "ma-samples", "of planner ma: points at which balls are looked for", between(1, 1000000),
          [](PlannerOptions & o) -> auto& { return o.medial_symmetry.samples; }),
      choice<grasp::MissingContact>(
          "missing-contact", "without refinement: what becomes of an attempt that lacks one",
          [](PlannerOptions & o) -> auto& { return o.missing_contact; }),
      choice<grasp::Rejection>(
          "reject", "which usable grasps are rejected for new targets",
          [](PlannerOptions & o) -> auto& { return o.rejection; }),
      option(
          "largest-deviation-mm", "mm",
          "with reject deviation: of a contact from its target; without it a fingertip pad's width",
          of_type("number"),
          [](PlannerOptions& o, const sweep::SettingValue& v) {
            o.largest_deviation = v.number() * base::kMetersPerMillimeter;
          },
          above(0)),
      choice<grasp::SearchRule>(
          "search", "when the planner stops looking",
          [](PlannerOptions & o) -> auto& { return o.search; })};
}

std::vector<PlanningSetting> score_settings() {
  return {
      integer(
          "resolution", "voxels along the object's longest extent", between(4, 512),
          [](PlannerOptions & o) -> auto& { return o.resolution; }),
      choice<geometry::PatchAveraging>(
          "averaging", "how pieces of surface are averaged",
          [](PlannerOptions & o) -> auto& { return o.averaging; }),
      integer(
          "neighborhood", "edge of the score's window in voxels, odd", between(3, 63),
          [](PlannerOptions & o) -> auto& { return o.score.neighborhood; }),
      choice<grasp::ScoreNormalization>(
          "score-normalization", "how raw scores become comparable with the threshold",
          [](PlannerOptions & o) -> auto& { return o.score.normalization; }),
      choice<grasp::PlaneDistance>(
          "plane-distance", "distances of neighbors to the voxel's plane",
          [](PlannerOptions & o) -> auto& { return o.score.plane_distance; }),
      number(
          "score-length-voxels", "1", "normalizer of the mean plane distance in voxels", above(0),
          [](PlannerOptions & o) -> auto& { return o.score.length_voxels; }),
      integer(
          "mean-filter-radius", "of the smoothing of scores in voxels", between(0, 31),
          [](PlannerOptions & o) -> auto& { return o.score.mean_filter_radius; }),
      integer(
          "mean-filter-passes", "of the smoothing of scores", between(0, 1000),
          [](PlannerOptions & o) -> auto& { return o.score.mean_filter_passes; }),
      number(
          "score-threshold", "1", "every target's score must exceed it",
          {.least = 0, .most = 1, .has_most = false},
          [](PlannerOptions & o) -> auto& { return o.targets.score_threshold; }),
      option(
          "contact-score-threshold", "1", "every contact's score must exceed it", of_type("number"),
          [](PlannerOptions& o, const sweep::SettingValue& v) {
            o.contact_score_threshold = v.number();
          },
          NumberRange{.least = 0, .most = 1, .has_most = false}),
      option(
          "weak-thickness-mm", "mm", "parts thinner are fragile; 0: none are looked for",
          of_type("number"),
          [](PlannerOptions& o, const sweep::SettingValue& v) {
            if (v.number() == 0.0) {
              o.weak.reset();
            } else {
              o.weak = geometry::WeakRegionOptions{};
              o.weak->weak_thickness = v.number() * base::kMetersPerMillimeter;
            }
          },
          at_least(0),
          number_text(PlannerOptions{}.weak->weak_thickness / base::kMetersPerMillimeter))};
}

std::vector<PlanningSetting> target_settings() {
  return {
      option(
          "theta-max-deg", "deg", "half-angle of the friction cones of targets and measure",
          of_type("number"),
          [](PlannerOptions& o, const sweep::SettingValue& v) {
            o.quality.theta_max = o.targets.theta_max = v.number() * base::kRadiansPerDegree;
          },
          NumberRange{.least = 0, .most = 90, .has_least = false, .has_most = false},
          number_text(PlannerOptions{}.quality.theta_max / base::kRadiansPerDegree)),
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
          "ideal-m-bias", "1", "how strongly sets with a large ideal M are preferred", at_least(0),
          [](PlannerOptions & o) -> auto& { return o.targets.ideal_m_bias; }),
      integer(
          "ideal-m-draws", "with ideal-m-bias: complete sets to draw one from", at_least(1),
          [](PlannerOptions & o) -> auto& { return o.targets.ideal_m_draws; }),
      number(
          "angle-weight", "1", "weight of stable pairs' angles in the rank of target sets",
          at_least(0), [](PlannerOptions & o) -> auto& { return o.targets.angle_weight; }),
      number(
          "palm-reach-tolerance-mm", "mm", "how far a target may lie from where its tip gets",
          at_least(0), [](PlannerOptions & o) -> auto& { return o.targets.palm_reach_tolerance; },
          base::kMetersPerMillimeter),
      integer(
          "max-placements", "sides of one target set, or of all sets drawn, that are fitted",
          at_least(1), [](PlannerOptions & o) -> auto& { return o.max_placements; }),
      number(
          "edge-tolerance", "1", "largest difference of target distances over the first one",
          at_least(0), [](PlannerOptions & o) -> auto& { return o.targets.edge_tolerance_rel; }),
      number(
          "centroid-limit", "1", "largest distance of the targets' centroid from the mass center",
          at_least(0), [](PlannerOptions & o) -> auto& { return o.targets.centroid_limit_rel; }),
      number(
          "pool-fraction", "1", "share of the ranked candidates that is drawn from",
          {.least = 0, .most = 1, .has_least = false},
          [](PlannerOptions & o) -> auto& { return o.targets.pool_fraction; }),
      number(
          "pool-spacing-mm", "mm", "candidates nearer than this to a better one are passed over",
          at_least(0), [](PlannerOptions & o) -> auto& { return o.targets.pool_spacing; },
          base::kMetersPerMillimeter),
      integer(
          "target-draws", "target sets drawn per attempt", at_least(1),
          [](PlannerOptions & o) -> auto& { return o.target_draws; }),
      choice<grasp::AttemptChoice>(
          "attempt-choice", "which of the starts that an attempt has is kept",
          [](PlannerOptions & o) -> auto& { return o.attempt_choice; }),
      integer(
          "max-seeds", "seeds tried per target set", at_least(1),
          [](PlannerOptions & o) -> auto& { return o.targets.max_seeds; })};
}

std::vector<PlanningSetting> fitting_settings() {
  return {
      number(
          "clearance-mm", "mm", "between the object and the palm at the start", between(0, 10000),
          [](PlannerOptions & o) -> auto& { return o.fitting.clearance; },
          base::kMetersPerMillimeter),
      choice<grasp::PenetrationGuard>(
          "guard", "what a motion must not enter",
          [](PlannerOptions & o) -> auto& { return o.fitting.guard; }),
      yes_or_no(
          "guard-self", "fingers stop at each other while they close",
          [](PlannerOptions & o) -> auto& { return o.fitting.guard_self; }),
      choice<grasp::ContactState>(
          "contact-state", "when a closing part has touched",
          [](PlannerOptions & o) -> auto& { return o.fitting.contact_state; }),
      choice<grasp::PalmAfterContact>(
          "palm-after-contact", "what the palm does once a finger touches",
          [](PlannerOptions & o) -> auto& { return o.fitting.palm_after_contact; }),
      option("counted-pads", "",
             "whose contacts count; without it: power grasps all, others tips-and-palm",
             {{"enum", {"all", "tips-and-palm"}}},
             [](PlannerOptions& o, const sweep::SettingValue& v) {
               o.counted_pads = option_value<contact::CountedPads>(v);
             }),
      choice<contact::ContactPieces>(
          "contact-pieces", "what becomes of surface in several pieces",
          [](PlannerOptions & o) -> auto& { return o.contact_pieces; }),
      option(
          "clip-thickness-mm", "mm", "of clip volumes; without it half a voxel, at least 1 mm",
          of_type("number"),
          [](PlannerOptions& o, const sweep::SettingValue& v) {
            o.clip_thickness = v.number() * base::kMetersPerMillimeter;
          },
          above(0)),
      yes_or_no(
          "refine", "contacts are made real by exact queries",
          [](PlannerOptions & o) -> auto& { return o.refine; }),
      number(
          "largest-gap-mm", "mm", "a claimed pad within this has contact", above(0),
          [](PlannerOptions & o) -> auto& { return o.refinement.largest_gap; },
          base::kMetersPerMillimeter),
      number(
          "wanted-gap-mm", "mm", "to which claimed pads are brought", above(0),
          [](PlannerOptions & o) -> auto& { return o.refinement.wanted_gap; },
          base::kMetersPerMillimeter),
      number(
          "least-distance-mm", "mm", "kept between all that must not touch", above(0),
          [](PlannerOptions & o) -> auto& { return o.refinement.least_distance; },
          base::kMetersPerMillimeter),
      number(
          "largest-shift-mm", "mm", "of the palm while contacts are refined", at_least(0),
          [](PlannerOptions & o) -> auto& { return o.refinement.largest_shift; },
          base::kMetersPerMillimeter),
      number(
          "largest-turn-deg", "deg", "of the palm while contacts are refined", at_least(0),
          [](PlannerOptions & o) -> auto& { return o.refinement.largest_turn; },
          base::kRadiansPerDegree),
      integer(
          "refine-iterations", "of contact refinement", between(1, kMostSteps),
          [](PlannerOptions & o) -> auto& { return o.refinement.max_iterations; }),
      integer(
          "slide-steps", "of touching pads toward their targets; 0: none", between(0, kMostSteps),
          [](PlannerOptions & o) -> auto& { return o.refinement.slide_steps; }),
      integer(
          "near-pad-steps", "of each further pad that nearly touches toward the surface; 0: none",
          between(0, kMostSteps),
          [](PlannerOptions & o) -> auto& { return o.refinement.near_pad_steps; }),
      yes_or_no(
          "pre-grasps", "a grasp needs a pre-grasp with a free way in",
          [](PlannerOptions & o) -> auto& { return o.pre_grasps; }),
      number(
          "pre-grasp-clearance-mm", "mm", "of every link in the pre-grasp", above(0),
          [](PlannerOptions & o) -> auto& { return o.pre_grasp.clearance; },
          base::kMetersPerMillimeter),
      number(
          "pre-grasp-retreat-mm", "mm", "largest retreat of the palm to the pre-grasp",
          between(0, 10000),
          [](PlannerOptions & o) -> auto& { return o.pre_grasp.largest_retreat; },
          base::kMetersPerMillimeter),
      yes_or_no(
          "pre-grasp-open-neutral", "spread and abduction may go along to the pre-grasp",
          [](PlannerOptions & o) -> auto& { return o.pre_grasp.open_neutral; }),
      number(
          "squeeze-force", "N", "sum of the normal forces of the squeeze", above(0),
          [](PlannerOptions & o) -> auto& { return o.squeeze.normal_sum; }),
      number(
          "squeeze-stiffness", "N m/rad", "of the position-controlled joints", above(0),
          [](PlannerOptions & o) -> auto& { return o.squeeze.stiffness; }),
      number(
          "distinct-translation-mm", "mm", "palms farther apart are of distinct grasps",
          at_least(0), [](PlannerOptions & o) -> auto& { return o.distinct.translation; },
          base::kMetersPerMillimeter),
      number(
          "distinct-rotation-deg", "deg", "palms turned more are of distinct grasps", at_least(0),
          [](PlannerOptions & o) -> auto& { return o.distinct.rotation; }, base::kRadiansPerDegree),
      number(
          "distinct-joints", "rad", "joints that differ more are of distinct grasps", at_least(0),
          [](PlannerOptions & o) -> auto& { return o.distinct.joints; })};
}

std::vector<PlanningSetting> measure_settings() {
  return {number(
              "alpha", "1", "weight of contact area in M1", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.quality.alpha; }),
          number(
              "beta", "1", "weight of the centroid's distance in M3", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.quality.beta; }),
          number(
              "w1", "1", "exponent of M1", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.quality.w1; }),
          number(
              "w2", "1", "exponent of M2", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.quality.w2; }),
          number(
              "w3", "1", "exponent of M3", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.quality.w3; }),
          choice<contact::MeasureUnits>(
              "measure-units", "of distances and areas in M",
              [](PlannerOptions & o) -> auto& { return o.quality.units; }),
          choice<contact::Regularity>(
              "regularity", "definition of R in M3",
              [](PlannerOptions & o) -> auto& { return o.quality.regularity; }),
          choice<contact::HullCentroid>(
              "centroid", "centroid of the contacts' hull",
              [](PlannerOptions & o) -> auto& { return o.quality.centroid; }),
          number(
              "squeeze-friction", "1", "Coulomb's mu of the squeeze", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.squeeze_friction; }),
          number(
              "friction", "1", "Coulomb's mu of epsilon", at_least(0),
              [](PlannerOptions & o) -> auto& { return o.friction; })};
}

}  // namespace

const std::vector<PlanningSetting>& planning_setting_list() {
  static const std::vector<PlanningSetting> settings = [] {
    std::vector<PlanningSetting> all;
    for (std::vector<PlanningSetting> group :
         {object_and_hand_settings(), request_settings(), score_settings(), target_settings(),
          fitting_settings(), measure_settings()}) {
      std::move(group.begin(), group.end(), std::back_inserter(all));
    }
    return all;
  }();
  return settings;
}

}  // namespace graspfit::experiments::internal
