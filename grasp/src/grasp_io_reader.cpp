#include <limits>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "internal/json_node.hpp"
#include "internal/recorded_hand.hpp"

namespace graspfit::grasp {
namespace {

using internal::JsonNode;

std::optional<double> number_or_none(const JsonNode& node) {
  return node.is_null() ? std::nullopt : std::optional(node.number());
}

geometry::MeshAnalysis read_mesh_analysis(const JsonNode& node) {
  geometry::MeshAnalysis mesh;
  mesh.num_vertices = node.at("num_vertices").count();
  mesh.num_faces = node.at("num_faces").count();
  mesh.num_parts = node.at("num_parts").count();
  mesh.is_closed = node.at("is_closed").flag();
  mesh.is_manifold = node.at("is_manifold").flag();
  mesh.is_outward = node.at("is_outward").flag();
  mesh.num_unused_vertices = node.at("num_unused_vertices").count();
  mesh.num_degenerate_faces = node.at("num_degenerate_faces").count();
  mesh.num_doubled_faces = node.at("num_doubled_faces").count();
  mesh.num_boundary_edges = node.at("num_boundary_edges").count();
  mesh.num_nonmanifold_edges = node.at("num_nonmanifold_edges").count();
  mesh.num_inconsistent_edges = node.at("num_inconsistent_edges").count();
  mesh.num_inward_parts = node.at("num_inward_parts").count();
  if (const JsonNode crossings = node.at("num_self_intersections"); !crossings.is_null()) {
    mesh.num_self_intersections = crossings.count();
  }
  const JsonNode box = node.at("bounding_box_m");
  mesh.box = {box.at("lower").vector3(), box.at("upper").vector3()};
  return mesh;
}

ObjectRecord read_object_record(const JsonNode& node) {
  ObjectRecord object;
  object.file = node.at("file").text();
  object.sha256 = node.at("sha256").text();
  object.meters_per_file_unit = node.at("meters_per_file_unit").number();
  const JsonNode repair = node.at("repair");
  object.repair.mode = repair.at("mode").choice<geometry::RepairMode>();
  object.repair.weld_distance_rel = repair.at("weld_distance_rel").number();
  object.repair.max_hole_extent_rel = repair.at("max_hole_extent_rel").number();
  object.repair.self_intersections =
      repair.at("self_intersections").choice<geometry::SelfIntersections>();
  if (const JsonNode wrap = repair.at("wrap"); !wrap.is_null()) {
    object.repair.wrap = geometry::AlphaWrap{.alpha_rel = wrap.at("alpha_rel").number(),
                                             .offset_rel = wrap.at("offset_rel").number()};
  }
  for (const JsonNode& step : repair.at("steps").items()) {
    object.repairs.push_back({step.at("what").text(), step.at("count").count(),
                              step.at("volume_change_m3").number(),
                              step.at("hausdorff_bound_m").number()});
  }
  object.analysis = read_mesh_analysis(node.at("mesh"));
  object.center_of_mass_O = node.at("center_of_mass_O_m").vector3();
  object.volume = node.at("volume_m3").number();
  object.normalizing_radius = node.at("normalizing_radius_m").number();
  return object;
}

internal::RecordedHand read_hand_record(const JsonNode& node) {
  internal::RecordedHand hand;
  hand.description_file = node.at("description_file").text();
  hand.description_sha256 = node.at("description_sha256").text();
  hand.sidecar_sha256 = node.at("sidecar_sha256").text();
  for (const JsonNode& link : node.at("links").items()) {
    const JsonNode hash = link.at("mesh_sha256");
    hand.link_mesh_sha256.push_back(hash.is_null() ? std::string() : hash.text());
  }
  return hand;
}

PlannerOptions read_options(const JsonNode& planner) {
  const JsonNode node = planner.at("options");
  PlannerOptions options;
  options.seed = planner.at("seed").unsigned_integer();
  options.style = node.at("style").choice<GraspStyle>();
  options.fingers = node.at("fingers").texts();
  options.num_contacts = node.at("num_contacts").small_integer();
  options.count = node.at("count").small_integer();
  options.max_attempts = node.at("max_attempts").small_integer();
  options.acceptance = node.at("acceptance").choice<Acceptance>();
  options.search = node.at("search").choice<SearchRule>();
  options.target_draws = node.at("target_draws").small_integer();
  if (const JsonNode approach = node.at("approach_O"); !approach.is_null()) {
    options.approach_O = approach.vector3();
  }
  options.wall_clock_limit_s = number_or_none(node.at("wall_clock_limit_s"));
  options.resolution = node.at("resolution").small_integer();
  options.clip_thickness = number_or_none(node.at("clip_thickness_m"));
  options.averaging = node.at("averaging").choice<geometry::PatchAveraging>();

  const JsonNode score = node.at("score");
  options.score.neighborhood = score.at("neighborhood").small_integer();
  options.score.gamma_deg = score.at("gamma_deg").number();
  options.score.length_voxels = score.at("length_voxels").number();
  options.score.normalization = score.at("normalization").choice<ScoreNormalization>();
  options.score.plane_distance = score.at("plane_distance").choice<PlaneDistance>();
  options.score.mean_filter_radius = score.at("mean_filter_radius").small_integer();
  options.score.mean_filter_passes = score.at("mean_filter_passes").small_integer();
  options.score.floor = score.at("floor").number();
  options.score.median_factor = score.at("median_factor").number();

  const JsonNode targets = node.at("targets");
  options.targets.score_threshold = targets.at("score_threshold").number();
  options.targets.theta_max = targets.at("theta_max_rad").number();
  options.targets.pair_rule = targets.at("pair_rule").choice<PairRule>();
  options.targets.edge_tolerance_rel = targets.at("edge_tolerance_rel").number();
  options.targets.centroid_limit_rel = targets.at("centroid_limit_rel").number();
  options.targets.pool_fraction = targets.at("pool_fraction").number();
  options.targets.pool_minimum = targets.at("pool_minimum").small_integer();
  options.targets.max_seeds = targets.at("max_seeds").small_integer();
  options.targets.relax_after_seeds = targets.at("relax_after_seeds").small_integer();
  options.targets.min_separation = targets.at("min_separation_m").number();

  const JsonNode fitting = node.at("fitting");
  options.fitting.clearance = fitting.at("clearance_m").number();
  options.fitting.large_step_at = fitting.at("large_step_at_voxels").number();
  options.fitting.large_step_limit = fitting.at("large_step_limit_voxels").number();
  options.fitting.small_step = fitting.at("small_step_voxels").number();
  options.fitting.max_halvings = fitting.at("max_halvings").small_integer();
  options.fitting.max_iterations = fitting.at("max_iterations").small_integer();
  options.fitting.sample_spacing = fitting.at("sample_spacing_voxels").number();
  options.fitting.guard = fitting.at("guard").choice<PenetrationGuard>();
  options.fitting.settle = fitting.at("settle").flag();
  options.fitting.settle_tolerance = fitting.at("settle_tolerance_m").number();
  options.self_overlap = node.at("self_overlap_m").number();

  const JsonNode quality = node.at("quality");
  options.quality.alpha = quality.at("alpha").number();
  options.quality.beta = quality.at("beta").number();
  options.quality.w1 = quality.at("w1").number();
  options.quality.w2 = quality.at("w2").number();
  options.quality.w3 = quality.at("w3").number();
  options.quality.theta_max = quality.at("theta_max_rad").number();
  options.quality.units = quality.at("units").choice<MeasureUnits>();
  options.quality.regularity = quality.at("regularity").choice<Regularity>();
  options.quality.centroid = quality.at("centroid").choice<HullCentroid>();
  options.quality.merge_distance = quality.at("merge_distance_m").number();
  try {
    options.validate();
  } catch (const geometry::InvalidInput& error) {
    node.fail(error.what());
  }
  return options;
}

template <class Item>
int index_by_name(const std::vector<Item>& items, const JsonNode& name) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name.text()) return static_cast<int>(i);
  }
  name.fail("the hand has nothing named \"" + name.text() + "\"");
}

/// Reads what refers to links, joints, fingers and pads of a hand by name.
class GraspReader {
 public:
  explicit GraspReader(const hands::HandModel& hand) : hand_(hand) {}

  Grasp read(const JsonNode& node) const {
    Grasp grasp;
    grasp.configuration = read_configuration(node);
    if (const auto c = read_optional_configuration(node.at("pre_grasp"))) {
      grasp.pre_grasp = PreGrasp{*c, 0.0, 0.0, 0.0};
    }
    if (const auto c = read_optional_configuration(node.at("squeeze"))) {
      grasp.squeeze = Squeeze{*c, {}, 0.0, false, false};
    }
    grasp.has_all_contacts = node.at("has_all_contacts").flag();
    for (const JsonNode& contact : node.at("contacts").items()) {
      grasp.contacts.push_back(read_contact(contact));
    }
    grasp.quality = read_quality(node, grasp.contacts.size());
    grasp.ideal_m = node.at("ideal_m").number();
    grasp.penetration = read_penetration(node.at("penetration"));
    grasp.targets = read_targets(node.at("targets"));
    grasp.attempt = node.at("attempt").integer();
    grasp.iterations = node.at("iterations").small_integer();
    return grasp;
  }

 private:
  int link_or_none(const JsonNode& name) const {
    return name.is_null() ? -1 : index_by_name(hand_.links, name);
  }
  int finger_or_palm(const JsonNode& name) const {
    return name.text() == "palm" ? -1 : index_by_name(hand_.fingers, name);
  }

  hands::HandConfiguration read_configuration(const JsonNode& node) const {
    hands::HandConfiguration configuration;
    configuration.X_OH = node.at("X_OH").pose();
    const JsonNode joints = node.at("joints");
    configuration.q.resize(static_cast<Eigen::Index>(hand_.joints.size()));
    for (std::size_t i = 0; i < hand_.joints.size(); ++i) {
      configuration.q[static_cast<Eigen::Index>(i)] = joints.at(hand_.joints[i].name).number();
    }
    try {
      hands::validate(hand_, configuration);
    } catch (const geometry::InvalidInput& error) {
      joints.fail(error.what());
    }
    return configuration;
  }

  std::optional<hands::HandConfiguration> read_optional_configuration(const JsonNode& node) const {
    if (node.is_null()) return std::nullopt;
    return read_configuration(node);
  }

  Contact read_contact(const JsonNode& node) const {
    Contact contact;
    contact.link = index_by_name(hand_.links, node.at("link"));
    contact.pad = index_by_name(hand_.pads, node.at("pad"));
    contact.finger = finger_or_palm(node.at("finger"));
    contact.point_O = node.at("point_O_m").vector3();
    contact.inward_normal_O = node.at("inward_normal_O").vector3();
    contact.area = node.at("area_m2").number();
    contact.pad_boundary_distance = node.at("pad_boundary_distance_m").number();
    contact.gap = node.at("gap_m").number();
    contact.is_target = node.at("target").flag();
    if (const JsonNode weak = node.at("weak"); !weak.is_null()) contact.weak = weak.flag();
    return contact;
  }

  static ContactQuality read_quality(const JsonNode& node, std::size_t num_contacts) {
    ContactQuality quality;
    quality.m = node.at("m").number();
    quality.m1 = node.at("m1").number();
    quality.m2 = node.at("m2").number();
    quality.m3 = node.at("m3").number();
    quality.regularity = node.at("regularity").number();
    quality.centroid_distance = node.at("centroid_distance_m").number();
    quality.scaled_centroid_distance = node.at("scaled_centroid_distance").number();
    for (const JsonNode& term : node.at("sustainability_terms").items()) {
      quality.terms.push_back({term.at("boundary_distance").number(), term.at("area").number(),
                               term.at("strength").number()});
    }
    for (const JsonNode& pair : node.at("stable_pairs").items()) {
      const JsonNode contacts = pair.at("contacts");
      const std::vector<JsonNode> indices = contacts.items();
      if (indices.size() != 2) contacts.fail("is not a pair");
      for (const JsonNode& index : indices) {
        if (index.count() >= num_contacts) index.fail("is not the index of a contact");
      }
      quality.stable_pairs.push_back(
          {indices[0].small_integer(), indices[1].small_integer(), pair.at("angle_rad").number()});
    }
    return quality;
  }

  GraspPenetration read_penetration(const JsonNode& node) const {
    GraspPenetration penetration;
    penetration.object_intersects = node.at("object_intersects").flag();
    penetration.object_depth = node.at("object_depth_m").number();
    penetration.object_depth_bound = node.at("object_depth_bound_m").number();
    penetration.object_link = link_or_none(node.at("object_link"));
    penetration.self_intersects = node.at("self_intersects").flag();
    penetration.self_depth = node.at("self_depth_m").number();
    penetration.self_link_a = link_or_none(node.at("self_link_a"));
    penetration.self_link_b = link_or_none(node.at("self_link_b"));
    return penetration;
  }

  TargetContacts read_targets(const JsonNode& node) const {
    TargetContacts targets;
    targets.seeds_tried = node.at("seeds_tried").small_integer();
    for (const JsonNode& item : node.at("contacts").items()) {
      TargetContact target;
      target.finger = finger_or_palm(item.at("finger"));
      target.point_O = item.at("point_O_m").vector3();
      target.outward_normal_O = item.at("outward_normal_O").vector3();
      target.patch = item.at("patch").small_integer();
      const JsonNode score = item.at("score");
      target.score = score.is_text() ? std::numeric_limits<double>::infinity() : score.number();
      targets.contacts.push_back(target);
    }
    return targets;
  }

  const hands::HandModel& hand_;
};

PlannerStatistics read_statistics(const JsonNode& node) {
  PlannerStatistics statistics;
  statistics.attempts = node.at("attempts").integer();
  statistics.seeds_tried = node.at("seeds_tried").integer();
  statistics.fitting_iterations = node.at("fitting_iterations").integer();
  for (const auto& [name, count] : node.at("outcomes").members()) {
    bool is_known = false;
    // PoorShape is the last of the enumeration.
    for (int i = 0; i <= static_cast<int>(AttemptOutcome::PoorShape); ++i) {
      const auto outcome = static_cast<AttemptOutcome>(i);
      if (name != outcome_name(outcome)) continue;
      statistics.outcomes[outcome] = count.integer();
      is_known = true;
    }
    if (!is_known) count.fail("is not an outcome of this version");
  }
  for (const auto& [reason, count] : node.at("target_failures").members()) {
    statistics.target_failures[reason] = count.integer();
  }
  return statistics;
}

PlannerTimings read_timings(const JsonNode& node) {
  PlannerTimings timings;
  const JsonNode object = node.at("object");
  timings.object.query_s = object.at("query_s").number();
  timings.object.patches_s = object.at("patches_s").number();
  timings.object.voxels_s = object.at("voxels_s").number();
  timings.object.distance_s = object.at("distance_s").number();
  timings.object.scores_s = object.at("scores_s").number();
  timings.targets_s = node.at("targets_s").number();
  timings.fitting_s = node.at("fitting_s").number();
  timings.contact_tests_s = node.at("contact_tests_s").number();
  timings.measure_s = node.at("measure_s").number();
  timings.refinement_s = node.at("refinement_s").number();
  timings.pre_grasp_s = node.at("pre_grasp_s").number();
  timings.total_s = node.at("total_s").number();
  return timings;
}

}  // namespace

GraspFile read_grasps(const std::filesystem::path& path) {
  const JsonNode root = JsonNode::parse(path.string(), geometry::read_file(path));
  if (root.at("format").text() != "graspfit-grasps") {
    root.at("format").fail("is \"" + root.at("format").text() + "\", not \"graspfit-grasps\"");
  }
  if (root.at("version").integer() != 1) {
    root.at("version").fail("is " + std::to_string(root.at("version").integer()) +
                            "; this program reads version 1");
  }

  GraspFile file;
  file.object = read_object_record(root.at("object"));
  const JsonNode hand = root.at("hand");
  const internal::RecordedHand recorded_hand = read_hand_record(hand);
  try {
    file.hand = internal::read_recorded_hand(recorded_hand, path.parent_path());
  } catch (const geometry::Error& error) {
    hand.fail(error.what());
  }
  file.link_mesh_sha256 = recorded_hand.link_mesh_sha256;

  const JsonNode planner = root.at("planner");
  file.options = read_options(planner);
  file.version = planner.at("version").text();
  const JsonNode used = planner.at("used");
  for (const JsonNode& finger : used.at("fingers").items()) {
    index_by_name(file.hand.fingers, finger);
    file.fingers.push_back(finger.text());
  }
  file.voxel_size = used.at("voxel_size_m").positive_number();
  file.clip_thickness = used.at("clip_thickness_m").positive_number();
  file.merge_distance = used.at("merge_distance_m").positive_number();

  const JsonNode results = root.at("results");
  file.stop = results.at("stop").choice<PlannerStop>();
  file.statistics = read_statistics(results.at("statistics"));
  const GraspReader reader(file.hand);
  for (const JsonNode& grasp : results.at("grasps").items()) {
    file.grasps.push_back(reader.read(grasp));
  }
  file.timings = read_timings(root.at("timings"));
  return file;
}

}  // namespace graspfit::grasp
