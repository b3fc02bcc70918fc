#include <algorithm>
#include <limits>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/replacement_mark.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "io/json_node.hpp"
#include "io/planner_options_json.hpp"
#include "io/record_json.hpp"
#include "io/recorded_hand.hpp"

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
  object.file = node.at("file").path();
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

SurroundingsRecord read_surroundings_record(const JsonNode& node) {
  SurroundingsRecord surroundings;
  surroundings.table_z_O = number_or_none(node.at("table_z_O_m"));
  for (const JsonNode& obstacle : node.at("obstacles").items()) {
    surroundings.obstacles.push_back(read_object_record(obstacle));
  }
  return surroundings;
}

/// The names of meshes as used, where the file has them.
std::optional<UsedMeshFiles> read_used_meshes(const JsonNode& root) {
  const JsonNode object = root.at("object").at("used_mesh_file");
  if (object.is_null()) return std::nullopt;
  UsedMeshFiles files;
  files.object = object.text();
  for (const JsonNode& obstacle : root.at("surroundings").at("obstacles").items()) {
    files.obstacles.push_back(obstacle.at("used_mesh_file").text());
  }
  for (const JsonNode& link : root.at("hand").at("links").items()) {
    const JsonNode file = link.at("used_mesh_file");
    files.links.push_back(file.is_null() ? std::string() : file.text());
  }
  return files;
}

internal::RecordedHand read_hand_record(const JsonNode& node) {
  internal::RecordedHand hand;
  hand.description_file = node.at("description_file").path();
  hand.description_sha256 = node.at("description_sha256").text();
  hand.sidecar_sha256 = node.at("sidecar_sha256").text();
  for (const JsonNode& link : node.at("links").items()) {
    const JsonNode hash = link.at("mesh_sha256");
    hand.link_mesh_sha256.push_back(hash.is_null() ? std::string() : hash.text());
  }
  return hand;
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
    if (const JsonNode pre_grasp = node.at("pre_grasp"); !pre_grasp.is_null()) {
      grasp.pre_grasp = read_pre_grasp(pre_grasp);
    }
    grasp.has_all_contacts = node.at("has_all_contacts").flag();
    for (const JsonNode& contact : node.at("contacts").items()) {
      grasp.contacts.push_back(read_contact(contact));
    }
    if (const JsonNode squeeze = node.at("squeeze"); !squeeze.is_null()) {
      grasp.squeeze = read_squeeze(squeeze, grasp.contacts.size());
    }
    grasp.quality = read_quality(node, grasp.contacts.size());
    if (const JsonNode wrench = node.at("wrench"); !wrench.is_null()) {
      grasp.wrench = read_wrench(wrench);
    }
    grasp.ideal_m = node.at("ideal_m").number();
    grasp.penetration = read_penetration(node.at("penetration"));
    grasp.targets = read_targets(node.at("targets"));
    grasp.attempt = node.at("attempt").integer();
    grasp.iterations = node.at("iterations").small_integer();
    grasp.refinement_iterations = node.at("refinement_iterations").small_integer();
    return grasp;
  }

 private:
  int link_or_none(const JsonNode& name) const {
    return name.is_null() ? -1 : index_by_name(hand_.links, name);
  }
  int finger_or_palm(const JsonNode& name) const {
    return name.text() == "palm" ? contact::kPalm : index_by_name(hand_.fingers, name);
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
    } catch (const base::InvalidInput& error) {
      joints.fail(error.what());
    }
    return configuration;
  }

  PreGrasp read_pre_grasp(const JsonNode& node) const {
    return {.configuration = read_configuration(node),
            .clearance = node.at("clearance_m").number(),
            .opening = node.at("opening").number(),
            .retreat = node.at("retreat_m").number()};
  }

  contact::Squeeze read_squeeze(const JsonNode& node, std::size_t num_contacts) const {
    contact::Squeeze squeeze;
    squeeze.configuration = read_configuration(node);
    const JsonNode forces = node.at("forces_O_N");
    const std::vector<JsonNode> items = forces.items();
    if (items.size() != num_contacts) {
      forces.fail("has " + std::to_string(items.size()) + " forces for " +
                  std::to_string(num_contacts) + " contacts");
    }
    squeeze.forces_O.resize(3, static_cast<Eigen::Index>(items.size()));
    for (std::size_t i = 0; i < items.size(); ++i) {
      squeeze.forces_O.col(static_cast<Eigen::Index>(i)) = items[i].vector3();
    }
    squeeze.residual = node.at("residual").number();
    squeeze.is_balanced = node.at("is_balanced").flag();
    squeeze.is_clamped = node.at("is_clamped").flag();
    return squeeze;
  }

  static contact::WrenchQuality read_wrench(const JsonNode& node) {
    contact::WrenchQuality wrench;
    wrench.epsilon = node.at("epsilon").number();
    wrench.volume = node.at("volume").number();
    wrench.is_force_closure = node.at("is_force_closure").flag();
    wrench.rank = node.at("rank").small_integer();
    const JsonNode convention = node.at("convention");
    if (const JsonNode tool = convention.at("tool"); !tool.is_null()) {
      wrench.convention.tool = tool.choice<contact::WrenchTool>();
    }
    wrench.convention.reference_point_O = convention.at("reference_point_O_m").vector3();
    contact::WrenchSpaceOptions& options = wrench.convention.options;
    options.torque_scale = convention.at("torque_scale_m").positive_number();
    options.friction = convention.at("friction").number();
    options.num_cone_edges = convention.at("num_cone_edges").small_integer();
    options.norm = convention.at("norm").choice<contact::ForceNorm>();
    options.force_scaling = convention.at("force_scaling").choice<contact::ForceScaling>();
    options.force_limit = convention.at("force_limit").number();
    options.outside = convention.at("outside").choice<contact::OutsideValue>();
    return wrench;
  }

  contact::Contact read_contact(const JsonNode& node) const {
    contact::Contact contact;
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

  static contact::ContactQuality read_quality(const JsonNode& node, std::size_t num_contacts) {
    contact::ContactQuality quality;
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
    penetration.surroundings_touched = node.at("surroundings_touched").flag();
    return penetration;
  }

  TargetContacts read_targets(const JsonNode& node) const {
    TargetContacts targets;
    targets.seeds_tried = node.at("seeds_tried").small_integer();
    targets.rank = node.at("rank").number();
    for (const JsonNode& item : node.at("contacts").items()) {
      TargetContact target;
      const JsonNode finger = item.at("finger");
      target.finger = finger.is_null() ? kUnassigned : finger_or_palm(finger);
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
  statistics.refinement_iterations = node.at("refinement_iterations").integer();
  statistics.duplicates = node.at("duplicates").integer();
  // Every outcome is there, also those that a file leaves out. PoorShape is the last of them.
  for (int i = 0; i <= static_cast<int>(AttemptOutcome::PoorShape); ++i) {
    statistics.outcomes[static_cast<AttemptOutcome>(i)] = 0;
  }
  for (const auto& [name, count] : node.at("outcomes").members()) {
    const auto known = std::find_if(
        statistics.outcomes.begin(), statistics.outcomes.end(),
        [&name = name](const auto& outcome) { return name == outcome_name(outcome.first); });
    if (known == statistics.outcomes.end()) count.fail("is not an outcome of this version");
    known->second = count.integer();
  }
  for (const auto& [what, count] : node.at("guidance").members()) {
    statistics.guidance[what] = count.integer();
  }
  for (const auto& [reason, count] : node.at("target_failures").members()) {
    statistics.target_failures[reason] = count.integer();
  }
  return statistics;
}

HoldRecord read_hold(const JsonNode& node, std::size_t num_grasps) {
  HoldRecord hold;
  hold.protocol = node.at("protocol").text();
  for (const auto& [stage, count] : node.at("stages").members()) {
    hold.stages[stage] = count.integer();
  }
  const JsonNode margins = node.at("margins_N");
  if (margins.is_null()) return hold;
  for (const JsonNode& margin : margins.items()) hold.margins.push_back(margin.number());
  if (hold.margins.size() != num_grasps) {
    margins.fail("has " + std::to_string(hold.margins.size()) + " margins for " +
                 std::to_string(num_grasps) + " grasps");
  }
  return hold;
}

PlannerTimings read_timings(const JsonNode& node) {
  PlannerTimings timings;
  const JsonNode object = node.at("object");
  timings.object.query_s = object.at("query_s").number();
  timings.object.patches_s = object.at("patches_s").number();
  timings.object.voxels_s = object.at("voxels_s").number();
  timings.object.distance_s = object.at("distance_s").number();
  timings.object.scores_s = object.at("scores_s").number();
  timings.object.weak_s = object.at("weak_s").number();
  timings.guidance_s = node.at("guidance_s").number();
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
  base::require_no_replacement_mark(path);
  const JsonNode root = JsonNode::read(path);
  if (root.at("format").text() != "graspfit-grasps") {
    root.at("format").fail("is \"" + root.at("format").text() + "\", not \"graspfit-grasps\"");
  }
  if (const std::int64_t version = root.at("version").integer();
      version != internal::kGraspFileVersion) {
    root.at("version").fail("is " + std::to_string(version) + "; this program reads version " +
                            std::to_string(internal::kGraspFileVersion) + ": plan again");
  }

  GraspFile file;
  file.object = read_object_record(root.at("object"));
  file.surroundings = read_surroundings_record(root.at("surroundings"));
  file.used_meshes = read_used_meshes(root);
  const JsonNode hand = root.at("hand");
  const internal::RecordedHand recorded_hand = read_hand_record(hand);
  try {
    file.hand = internal::read_recorded_hand(recorded_hand, path.parent_path());
  } catch (const base::Error& error) {
    hand.fail(error.what());
  }
  file.link_mesh_sha256 = recorded_hand.link_mesh_sha256;

  const JsonNode planner = root.at("planner");
  file.options =
      internal::read_planner_options(planner.at("options"), planner.at("seed").unsigned_integer());
  file.version = planner.at("version").text();
  const JsonNode used = planner.at("used");
  for (const JsonNode& finger : used.at("fingers").items()) {
    index_by_name(file.hand.fingers, finger);
    file.fingers.push_back(finger.text());
  }
  file.palm = used.at("palm").flag();
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
  for (const auto& [key, node] : results.members()) {
    if (key == "hold") file.hold = read_hold(node, file.grasps.size());
  }
  for (const auto& [key, node] : root.members()) {
    if (key != "imported") continue;
    file.imported = {node.at("format").text(), node.at("file").path(), node.at("sha256").text()};
  }
  file.timings = read_timings(root.at("timings"));
  return file;
}

}  // namespace graspfit::grasp
