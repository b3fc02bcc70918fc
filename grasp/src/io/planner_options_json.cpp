#include "io/planner_options_json.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "graspfit/base/errors.hpp"
#include "graspfit/grasp/option_names.hpp"

namespace graspfit::grasp::internal {
namespace {

using Json = nlohmann::ordered_json;

/// Puts fields into a JSON object under their names.
class Writer {
 public:
  explicit Writer(Json& json) : json_(json) {}

  template <class Value>
  void operator()(const char* name, const Value& value) {
    json_[name] = to_json(value);
  }
  template <class Options, class Fields>
  void group(const char* name, Options& options, const Fields& fields) {
    Json json = Json::object();
    Writer writer(json);
    fields(writer, options);
    json_[name] = std::move(json);
  }
  template <class Options, class Fields>
  void optional_group(const char* name, std::optional<Options>& options, const Fields& fields) {
    json_[name] = nullptr;
    if (options) group(name, *options, fields);
  }

 private:
  static Json to_json(double value) {
    return std::isinf(value) ? Json("infinity") : Json(value);  // JSON has no infinity
  }
  static Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
  template <class Value>
  static Json to_json(const std::optional<Value>& value) {
    return value ? to_json(*value) : Json(nullptr);
  }
  template <class Value>
  static Json to_json(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      return std::string(name_of(value));
    } else {
      return value;
    }
  }

  Json& json_;
};

/// Sets fields from the members of a JSON object with their names.
class Reader {
 public:
  explicit Reader(JsonNode node) : node_(std::move(node)) {}

  template <class Value>
  void operator()(const char* name, Value& value) const {
    read(node_.at(name), value);
  }
  template <class Options, class Fields>
  void group(const char* name, Options& options, const Fields& fields) const {
    Reader reader(node_.at(name));
    fields(reader, options);
  }
  template <class Options, class Fields>
  void optional_group(const char* name, std::optional<Options>& options,
                      const Fields& fields) const {
    options.reset();
    if (!node_.at(name).is_null()) group(name, options.emplace(), fields);
  }

 private:
  static void read(const JsonNode& node, double& value) {
    if (node.is_text() && node.text() == "infinity") {
      value = std::numeric_limits<double>::infinity();
    } else {
      value = node.number();
    }
  }
  static void read(const JsonNode& node, int& value) { value = node.small_integer(); }
  static void read(const JsonNode& node, std::int64_t& value) { value = node.integer(); }
  static void read(const JsonNode& node, bool& value) { value = node.flag(); }
  static void read(const JsonNode& node, std::string& value) { value = node.text(); }
  static void read(const JsonNode& node, std::vector<std::string>& value) { value = node.texts(); }
  static void read(const JsonNode& node, Eigen::Vector3d& value) { value = node.vector3(); }
  template <class Value>
  static void read(const JsonNode& node, std::optional<Value>& value) {
    value.reset();
    if (!node.is_null()) read(node, value.emplace());
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  static void read(const JsonNode& node, Enum& value) { value = node.choice<Enum>(); }

  JsonNode node_;
};

// Each function names the fields of one struct, in the order of the file: once, for writing and for
// reading. Fields without a unit in their name have none.

constexpr auto score_fields = [](auto& at, auto& score) {
  at("neighborhood", score.neighborhood);
  at("gamma_deg", score.gamma_deg);
  at("length_voxels", score.length_voxels);
  at("normalization", score.normalization);
  at("plane_distance", score.plane_distance);
  at("mean_filter_radius", score.mean_filter_radius);
  at("mean_filter_passes", score.mean_filter_passes);
  at("floor", score.floor);
  at("median_factor", score.median_factor);
};

constexpr auto shape_diameter_fields = [](auto& at, auto& rays) {
  at("num_rays", rays.num_rays);
  at("cone_angle_deg", rays.cone_angle_deg);
  at("trim_deviations", rays.trim_deviations);
};

constexpr auto weak_fields = [](auto& at, auto& weak) {
  at("weak_thickness_m", weak.weak_thickness);
  at("min_length_ratio", weak.min_length_ratio);
  at("voxels_per_thickness", weak.voxels_per_thickness);
  at("max_resolution", weak.max_resolution);
  at.group("shape_diameter", weak.shape_diameter, shape_diameter_fields);
};

constexpr auto target_fields = [](auto& at, auto& targets) {
  at("score_threshold", targets.score_threshold);
  at("theta_max_rad", targets.theta_max);
  at("pair_rule", targets.pair_rule);
  at("edge_tolerance_rel", targets.edge_tolerance_rel);
  at("centroid_limit_rel", targets.centroid_limit_rel);
  at("angle_weight", targets.angle_weight);
  at("pool_fraction", targets.pool_fraction);
  at("pool_minimum", targets.pool_minimum);
  at("max_seeds", targets.max_seeds);
  at("relax_after_seeds", targets.relax_after_seeds);
  at("min_separation_m", targets.min_separation);
  at("pool_spacing_m", targets.pool_spacing);
  at("search", targets.search);
  at("exclude_weak", targets.exclude_weak);
  at("ideal_m_bias", targets.ideal_m_bias);
  at("ideal_m_draws", targets.ideal_m_draws);
  at("palm_reach_tolerance_m", targets.palm_reach_tolerance);
};

constexpr auto fitting_fields = [](auto& at, auto& fitting) {
  at("clearance_m", fitting.clearance);
  at("large_step_at_voxels", fitting.large_step_at);
  at("large_step_limit_voxels", fitting.large_step_limit);
  at("small_step_voxels", fitting.small_step);
  at("max_halvings", fitting.max_halvings);
  at("max_iterations", fitting.max_iterations);
  at("sample_spacing_voxels", fitting.sample_spacing);
  at("guard", fitting.guard);
  at("contact_state", fitting.contact_state);
  at("closing_tolerance_m", fitting.closing_tolerance);
  at("palm_after_contact", fitting.palm_after_contact);
  at("guard_self", fitting.guard_self);
  at("give_up_distance_m", fitting.give_up_distance);
};

constexpr auto sampling_fields = [](auto& at, auto& sampling) {
  at("source", sampling.source);
  at("count", sampling.count);
  at("box_margin_m", sampling.box_margin);
  at("box_spacing_m", sampling.box_spacing);
  at("largest_standoff_m", sampling.largest_standoff);
};

constexpr auto medial_symmetry_fields = [](auto& at, auto& medial) {
  at("samples", medial.samples);
  at("min_object_angle_deg", medial.min_object_angle_deg);
  at("axis_ratio", medial.axis_ratio);
  at("rim_ratio", medial.rim_ratio);
  at("search_radius_m", medial.search_radius);
  at("search_radius_rel", medial.search_radius_rel);
  at("least_spread_rel", medial.least_spread_rel);
};

constexpr auto refinement_fields = [](auto& at, auto& refinement) {
  at("wanted_gap_m", refinement.wanted_gap);
  at("largest_gap_m", refinement.largest_gap);
  at("least_distance_m", refinement.least_distance);
  at("max_iterations", refinement.max_iterations);
  at("slide_steps", refinement.slide_steps);
  at("near_pad_steps", refinement.near_pad_steps);
  at("reach_m", refinement.reach);
  at("largest_shift_m", refinement.largest_shift);
  at("largest_turn_rad", refinement.largest_turn);
};

constexpr auto pre_grasp_fields = [](auto& at, auto& pre_grasp) {
  at("clearance_m", pre_grasp.clearance);
  at("largest_retreat_m", pre_grasp.largest_retreat);
  at("retreat_step_m", pre_grasp.retreat_step);
  at("opening_steps", pre_grasp.opening_steps);
  at("open_neutral", pre_grasp.open_neutral);
  at("way_tolerance_m", pre_grasp.way_tolerance);
};

constexpr auto squeeze_fields = [](auto& at, auto& squeeze) {
  at("normal_sum_N", squeeze.normal_sum);
  at("stiffness_N_m_per_rad", squeeze.stiffness);
  at("slide_stiffness_N_per_m", squeeze.slide_stiffness);
  at("largest_residual", squeeze.largest_residual);
};

constexpr auto distinct_fields = [](auto& at, auto& distinct) {
  at("translation_m", distinct.translation);
  at("rotation_rad", distinct.rotation);
  at("joints_rad", distinct.joints);
  at("slide_scale_m", distinct.slide_scale);
};

constexpr auto quality_fields = [](auto& at, auto& quality) {
  at("alpha", quality.alpha);
  at("beta", quality.beta);
  at("w1", quality.w1);
  at("w2", quality.w2);
  at("w3", quality.w3);
  at("theta_max_rad", quality.theta_max);
  at("units", quality.units);
  at("regularity", quality.regularity);
  at("centroid", quality.centroid);
  at("merge_distance_m", quality.merge_distance);
};

constexpr auto planner_fields = [](auto& at, auto& options) {
  at("planner", options.planner);
  at("style", options.style);
  at("fingers", options.fingers);
  at("num_contacts", options.num_contacts);
  at("palm", options.palm);
  at("count", options.count);
  at("max_attempts", options.max_attempts);
  at("max_iterations", options.max_iterations);
  at("acceptance", options.acceptance);
  at("missing_contact", options.missing_contact);
  at("rejection", options.rejection);
  at("largest_deviation_m", options.largest_deviation);
  at("search", options.search);
  at("target_draws", options.target_draws);
  at("attempt_choice", options.attempt_choice);
  at("max_placements", options.max_placements);
  at("approach_O", options.approach_O);
  at("approach_angle_rad", options.approach_angle);
  at("wall_clock_limit_s", options.wall_clock_limit_s);
  at("resolution", options.resolution);
  at("clip_thickness_m", options.clip_thickness);
  at("averaging", options.averaging);
  at("counted_pads", options.counted_pads);
  at("contact_pieces", options.contact_pieces);
  at.group("score", options.score, score_fields);
  at.optional_group("weak", options.weak, weak_fields);
  at.group("targets", options.targets, target_fields);
  at.group("fitting", options.fitting, fitting_fields);
  at.group("sampling", options.sampling, sampling_fields);
  at.group("medial_symmetry", options.medial_symmetry, medial_symmetry_fields);
  at("refine", options.refine);
  at.group("refinement", options.refinement, refinement_fields);
  at("self_overlap_m", options.self_overlap);
  at("contact_score_threshold", options.contact_score_threshold);
  at("pre_grasps", options.pre_grasps);
  at.group("pre_grasp", options.pre_grasp, pre_grasp_fields);
  at.group("squeeze", options.squeeze, squeeze_fields);
  at.group("distinct", options.distinct, distinct_fields);
  at("friction", options.friction);
  at("squeeze_friction", options.squeeze_friction);
  at.group("quality", options.quality, quality_fields);
};

}  // namespace

Json planner_options_json(const PlannerOptions& options) {
  PlannerOptions copy = options;  // the fields' list is written for reading, too
  Json json = Json::object();
  Writer writer(json);
  planner_fields(writer, copy);
  return json;
}

PlannerOptions read_planner_options(const JsonNode& node, std::uint64_t seed) {
  PlannerOptions options;
  Reader reader(node);
  planner_fields(reader, options);
  options.seed = seed;
  try {
    options.validate();
  } catch (const base::InvalidInput& error) {
    node.fail(error.what());
  }
  return options;
}

}  // namespace graspfit::grasp::internal
