#include <cmath>
#include <nlohmann/json.hpp>

#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "internal/json_text.hpp"
#include "internal/planner_readings.hpp"
#include "internal/pose_numbers.hpp"

namespace graspfit::grasp {
namespace {

using Json = nlohmann::ordered_json;
using geometry::RigidTransform;

Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json to_json(const RigidTransform& X_AB) {
  return {{"translation_m", to_json(Eigen::Vector3d(X_AB.translation()))},
          {"rotation_wxyz", internal::rotation_wxyz(X_AB)}};
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// JSON has no infinity; raw scores of planes are infinite.
Json score_or_infinity(double score) {
  return std::isfinite(score) ? Json(score) : Json("infinity");
}

template <class Enum>
Json choice(Enum value) {
  return std::string(name_of(value));
}

Json conventions() {
  return {
      {"units", "meters, radians, square meters, seconds unless a key names another unit"},
      {"frames",
       "O: object, the axes and origin of the object's file after scaling. H: hand base, the frame "
       "of "
       "the root link. L: a link. C: a pad, z leaving the link. X_AB is the pose of frame B in "
       "frame "
       "A: p_A = X_AB p_B."},
      {"rotation_wxyz", "unit quaternion, scalar first: [w, x, y, z]"},
      {"half_space", "the points p with normal . p <= offset_m"},
      {"contact",
       "object surface inside the pad's clip volume: point and normal are means over the clipped "
       "pieces, the point projected to the surface; area_m2 is their area; pad_boundary_distance_m "
       "is the distance of the point, in the pad's plane, from the outline; gap_m is the smallest "
       "height of the surface over the pad; weak is null where it is not known"},
      {"m",
       "m1^w1 * m2^w2 * m3^w3; 0 if there are fewer than two contacts, no stable pair, or m3 <= 0"},
      {"m1",
       "mean over contacts of (boundary_distance + alpha * area) * strength, the listed "
       "sustainability_terms: pad_boundary_distance_m and area_m2, normalized (over the pad's "
       "largest_boundary_distance_m and area_m2, at most 1 each) or in centimeters"},
      {"m2", "sum over stable pairs of 1 - angle_rad / theta_max"},
      {"m3", "regularity - beta * scaled_centroid_distance"},
      {"stable_pair",
       "contacts of different fingers whose connecting line lies inside both friction cones; the "
       "angle is the mean of its angles to the two normals"},
      {"centroid_distance_m",
       "from the centroid of the contacts' hull to the center of mass; scaled: over the object's "
       "normalizing_radius_m, or in centimeters"},
      {"usable", "m > 0"},
      {"valid",
       "usable, no link shares a point with the object or another link that is not excluded, and "
       "every requested finger or palm has a contact"}};
}

Json mesh_json(const geometry::MeshAnalysis& mesh) {
  return {{"num_vertices", mesh.num_vertices},
          {"num_faces", mesh.num_faces},
          {"num_parts", mesh.num_parts},
          {"is_closed", mesh.is_closed},
          {"is_manifold", mesh.is_manifold},
          {"is_outward", mesh.is_outward},
          {"num_unused_vertices", mesh.num_unused_vertices},
          {"num_degenerate_faces", mesh.num_degenerate_faces},
          {"num_doubled_faces", mesh.num_doubled_faces},
          {"num_boundary_edges", mesh.num_boundary_edges},
          {"num_nonmanifold_edges", mesh.num_nonmanifold_edges},
          {"num_inconsistent_edges", mesh.num_inconsistent_edges},
          {"num_inward_parts", mesh.num_inward_parts},
          {"num_self_intersections", or_null(mesh.num_self_intersections)},
          {"bounding_box_m",
           {{"lower", to_json(Eigen::Vector3d(mesh.box.min()))},
            {"upper", to_json(Eigen::Vector3d(mesh.box.max()))}}}};
}

Json object_json(const ObjectRecord& object) {
  Json repairs = Json::array();
  for (const geometry::RepairStep& step : object.repairs) {
    repairs.push_back({{"what", step.what},
                       {"count", step.count},
                       {"volume_change_m3", step.volume_change},
                       {"hausdorff_bound_m", step.hausdorff_bound}});
  }
  Json wrap = nullptr;
  if (object.repair.wrap) {
    wrap = {{"alpha_rel", object.repair.wrap->alpha_rel},
            {"offset_rel", object.repair.wrap->offset_rel}};
  }
  return {{"file", object.file},
          {"sha256", object.sha256},
          {"meters_per_file_unit", object.meters_per_file_unit},
          {"repair",
           {{"mode", choice(object.repair.mode)},
            {"weld_distance_rel", object.repair.weld_distance_rel},
            {"max_hole_extent_rel", object.repair.max_hole_extent_rel},
            {"self_intersections", choice(object.repair.self_intersections)},
            {"wrap", wrap},
            {"steps", repairs}}},
          {"mesh", mesh_json(object.analysis)},
          {"center_of_mass_O_m", to_json(object.center_of_mass_O)},
          {"volume_m3", object.volume},
          {"normalizing_radius_m", object.normalizing_radius}};
}

const char* joint_unit(const hands::Joint& joint) {
  return joint.type == hands::JointType::Revolute ? "rad" : "m";
}

Json joint_json(const hands::HandModel& hand, const hands::Joint& joint) {
  Json coupling = nullptr;
  if (joint.coupling) {
    coupling = {{"leader", hand.joints[joint.coupling->leader].name},
                {"ratio", joint.coupling->ratio},
                {"offset", joint.coupling->offset},
                {"breakaway", joint.coupling->breakaway}};
  }
  return {{"name", joint.name},
          {"type", joint.type == hands::JointType::Revolute ? "revolute" : "prismatic"},
          {"unit", joint_unit(joint)},
          {"lower", joint.lower},
          {"upper", joint.upper},
          {"parent_link", hand.links[joint.parent_link].name},
          {"child_link", hand.links[joint.child_link].name},
          {"X_PJ", to_json(joint.X_PJ)},
          {"axis_J", to_json(joint.axis_J)},
          {"closing_sign", joint.closing_sign},
          {"coupling", coupling}};
}

std::string finger_name(const hands::HandModel& hand, int finger) {
  return finger < 0 ? "palm" : hand.fingers[finger].name;
}

Json pad_json(const hands::HandModel& hand, const hands::ContactPad& pad, double clip_thickness) {
  Json outline = Json::array();
  for (const Eigen::Vector2d& corner : pad.outline) {
    outline.push_back(Json::array({corner.x(), corner.y()}));
  }
  const double thickness = pad.clip_thickness.value_or(clip_thickness);
  Json half_spaces = Json::array();
  for (const geometry::HalfSpace& half_space :
       hands::transformed(hands::clip_volume_C(pad, thickness), pad.X_LC)) {
    half_spaces.push_back(
        {{"normal_L", to_json(half_space.normal)}, {"offset_m", half_space.offset}});
  }
  return {{"name", pad.name},
          {"link", hand.links[pad.link].name},
          {"finger", finger_name(hand, pad.finger)},
          {"X_LC", to_json(pad.X_LC)},
          {"outline_C_m", outline},
          {"largest_boundary_distance_m", hands::largest_boundary_distance(pad)},
          {"area_m2", hands::pad_area(pad)},
          {"clip_volume_L", {{"thickness_m", thickness}, {"half_spaces", half_spaces}}}};
}

Json hand_json(const GraspFile& file) {
  const hands::HandModel& hand = file.hand;
  Json links = Json::array();
  for (std::size_t i = 0; i < hand.links.size(); ++i) {
    const bool has_file = !hand.links[i].mesh_files.empty();
    links.push_back(
        {{"name", hand.links[i].name},
         {"mesh_files", hand.links[i].mesh_files},
         {"mesh_sha256", has_file ? Json(file.link_mesh_sha256.at(i)) : Json(nullptr)}});
  }
  Json joints = Json::array();
  for (const hands::Joint& joint : hand.joints) joints.push_back(joint_json(hand, joint));
  Json fingers = Json::array();
  for (const hands::Finger& finger : hand.fingers) {
    Json finger_links = Json::array();
    for (int link : finger.links) finger_links.push_back(hand.links[link].name);
    Json finger_joints = Json::array();
    for (int joint : finger.joints) finger_joints.push_back(hand.joints[joint].name);
    fingers.push_back(
        {{"name", finger.name},
         {"is_thumb", finger.is_thumb},
         {"links", finger_links},
         {"joints", finger_joints},
         {"tip_pad", finger.tip_pad < 0 ? Json(nullptr) : Json(hand.pads[finger.tip_pad].name)}});
  }
  Json pads = Json::array();
  for (const hands::ContactPad& pad : hand.pads) {
    pads.push_back(pad_json(hand, pad, file.clip_thickness));
  }
  Json exclusions = Json::array();
  for (const hands::CollisionExclusion& exclusion : hand.exclusions) {
    exclusions.push_back(
        Json::array({hand.links[exclusion.link_a].name, hand.links[exclusion.link_b].name}));
  }
  return {{"name", hand.name},
          {"description_file", hand.description_file},
          {"description_sha256", hand.description_sha256},
          {"sidecar_file", hand.sidecar_file},
          {"sidecar_sha256", hand.sidecar_sha256},
          {"palm",
           {{"link", hand.links[hand.palm.link].name},
            {"center_H_m", to_json(hand.palm.center_H)},
            {"direction_H", to_json(hand.palm.direction_H)}}},
          {"links", links},
          {"joints", joints},
          {"fingers", fingers},
          {"pads", pads},
          {"collision_exclusions", exclusions}};
}

Json options_json(const PlannerOptions& options) {
  const ScoreOptions& score = options.score;
  const TargetOptions& targets = options.targets;
  const FittingOptions& fitting = options.fitting;
  const QualityOptions& quality = options.quality;
  return {{"style", choice(options.style)},
          {"fingers", options.fingers},
          {"num_contacts", options.num_contacts},
          {"count", options.count},
          {"max_attempts", options.max_attempts},
          {"acceptance", choice(options.acceptance)},
          {"search", choice(options.search)},
          {"target_draws", options.target_draws},
          {"approach_O", options.approach_O ? to_json(*options.approach_O) : Json(nullptr)},
          {"wall_clock_limit_s", or_null(options.wall_clock_limit_s)},
          {"resolution", options.resolution},
          {"clip_thickness_m", or_null(options.clip_thickness)},
          {"averaging", choice(options.averaging)},
          {"score",
           {{"neighborhood", score.neighborhood},
            {"gamma_deg", score.gamma_deg},
            {"length_voxels", score.length_voxels},
            {"normalization", choice(score.normalization)},
            {"plane_distance", choice(score.plane_distance)},
            {"mean_filter_radius", score.mean_filter_radius},
            {"mean_filter_passes", score.mean_filter_passes},
            {"floor", score.floor},
            {"median_factor", score.median_factor}}},
          {"targets",
           {{"score_threshold", targets.score_threshold},
            {"theta_max_rad", targets.theta_max},
            {"pair_rule", choice(targets.pair_rule)},
            {"edge_tolerance_rel", targets.edge_tolerance_rel},
            {"centroid_limit_rel", targets.centroid_limit_rel},
            {"pool_fraction", targets.pool_fraction},
            {"pool_minimum", targets.pool_minimum},
            {"max_seeds", targets.max_seeds},
            {"relax_after_seeds", targets.relax_after_seeds},
            {"min_separation_m", targets.min_separation}}},
          {"fitting",
           {{"clearance_m", fitting.clearance},
            {"large_step_at_voxels", fitting.large_step_at},
            {"large_step_limit_voxels", fitting.large_step_limit},
            {"small_step_voxels", fitting.small_step},
            {"max_halvings", fitting.max_halvings},
            {"max_iterations", fitting.max_iterations},
            {"sample_spacing_voxels", fitting.sample_spacing},
            {"guard", choice(fitting.guard)},
            {"settle", fitting.settle},
            {"settle_tolerance_m", fitting.settle_tolerance}}},
          {"self_overlap_m", options.self_overlap},
          {"quality",
           {{"alpha", quality.alpha},
            {"beta", quality.beta},
            {"w1", quality.w1},
            {"w2", quality.w2},
            {"w3", quality.w3},
            {"theta_max_rad", quality.theta_max},
            {"units", choice(quality.units)},
            {"regularity", choice(quality.regularity)},
            {"centroid", choice(quality.centroid)},
            {"merge_distance_m", quality.merge_distance}}}};
}

Json planner_json(const GraspFile& file) {
  Json readings = Json::object();
  for (const auto& [point, reading] : internal::planner_readings(file.options)) {
    readings[point] = reading;
  }
  return {{"name", "hand-object geometric fitting"},
          {"version", file.version},
          {"seed", file.options.seed},
          {"options", options_json(file.options)},
          {"used",
           {{"fingers", file.fingers},
            {"voxel_size_m", file.voxel_size},
            {"clip_thickness_m", file.clip_thickness},
            {"merge_distance_m", file.merge_distance}}},
          {"readings", readings}};
}

Json joints_json(const hands::HandModel& hand, const Eigen::VectorXd& q) {
  Json joints = Json::object();
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    joints[hand.joints[i].name] = q[static_cast<Eigen::Index>(i)];
  }
  return joints;
}

Json configuration_json(const hands::HandModel& hand,
                        const std::optional<hands::HandConfiguration>& configuration) {
  if (!configuration) return nullptr;
  return {{"X_OH", to_json(configuration->X_OH)}, {"joints", joints_json(hand, configuration->q)}};
}

Json contact_json(const hands::HandModel& hand, const Contact& contact) {
  return {{"link", hand.links[contact.link].name},
          {"pad", hand.pads[contact.pad].name},
          {"finger", finger_name(hand, contact.finger)},
          {"point_O_m", to_json(contact.point_O)},
          {"inward_normal_O", to_json(contact.inward_normal_O)},
          {"area_m2", contact.area},
          {"pad_boundary_distance_m", contact.pad_boundary_distance},
          {"gap_m", contact.gap},
          {"weak", or_null(contact.weak)},
          {"target", contact.is_target}};
}

/// Adds the measure and every term it came from to a grasp's object.
void add_quality(const ContactQuality& quality, Json& grasp) {
  Json terms = Json::array();
  for (const SustainabilityTerm& term : quality.terms) {
    terms.push_back({{"boundary_distance", term.boundary_distance},
                     {"area", term.area},
                     {"strength", term.strength}});
  }
  Json pairs = Json::array();
  for (const StablePair& pair : quality.stable_pairs) {
    pairs.push_back(
        {{"contacts", Json::array({pair.first, pair.second})}, {"angle_rad", pair.angle}});
  }
  grasp["m"] = quality.m;
  grasp["m1"] = quality.m1;
  grasp["m2"] = quality.m2;
  grasp["m3"] = quality.m3;
  grasp["regularity"] = quality.regularity;
  grasp["centroid_distance_m"] = quality.centroid_distance;
  grasp["scaled_centroid_distance"] = quality.scaled_centroid_distance;
  grasp["sustainability_terms"] = terms;
  grasp["stable_pairs"] = pairs;
}

Json penetration_json(const hands::HandModel& hand, const GraspPenetration& penetration) {
  const auto link_name = [&hand](int link) {
    return link < 0 ? Json(nullptr) : Json(hand.links[link].name);
  };
  return {{"object_intersects", penetration.object_intersects},
          {"object_depth_m", penetration.object_depth},
          {"object_depth_bound_m", penetration.object_depth_bound},
          {"object_link", link_name(penetration.object_link)},
          {"self_intersects", penetration.self_intersects},
          {"self_depth_m", penetration.self_depth},
          {"self_link_a", link_name(penetration.self_link_a)},
          {"self_link_b", link_name(penetration.self_link_b)}};
}

Json targets_json(const hands::HandModel& hand, const TargetContacts& targets) {
  Json contacts = Json::array();
  for (const TargetContact& target : targets.contacts) {
    contacts.push_back({{"finger", finger_name(hand, target.finger)},
                        {"point_O_m", to_json(target.point_O)},
                        {"outward_normal_O", to_json(target.outward_normal_O)},
                        {"patch", target.patch},
                        {"score", score_or_infinity(target.score)}});
  }
  return {{"seeds_tried", targets.seeds_tried}, {"contacts", contacts}};
}

Json grasp_json(const hands::HandModel& hand, const Grasp& grasp, std::size_t rank) {
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, grasp.configuration);
  Json links = Json::object();
  for (std::size_t i = 0; i < hand.links.size(); ++i) links[hand.links[i].name] = to_json(X_OL[i]);
  Json contacts = Json::array();
  for (const Contact& contact : grasp.contacts) contacts.push_back(contact_json(hand, contact));
  Json json = {{"rank", rank},
               {"usable", grasp.is_usable()},
               {"valid", grasp.is_valid()},
               {"has_all_contacts", grasp.has_all_contacts}};
  add_quality(grasp.quality, json);
  json["ideal_m"] = grasp.ideal_m;
  json["largest_penetration_m"] = largest_penetration(grasp);
  json["largest_contact_gap_m"] = largest_contact_gap(grasp);
  json["X_OH"] = to_json(grasp.configuration.X_OH);
  json["joints"] = joints_json(hand, grasp.configuration.q);
  json["X_OL"] = links;
  json["contacts"] = contacts;
  json["penetration"] = penetration_json(hand, grasp.penetration);
  json["targets"] = targets_json(hand, grasp.targets);
  json["attempt"] = grasp.attempt;
  json["iterations"] = grasp.iterations;
  json["pre_grasp"] = configuration_json(
      hand, grasp.pre_grasp ? std::optional(grasp.pre_grasp->configuration) : std::nullopt);
  json["squeeze"] = configuration_json(
      hand, grasp.squeeze ? std::optional(grasp.squeeze->configuration) : std::nullopt);
  return json;
}

Json results_json(const GraspFile& file) {
  Json grasps = Json::array();
  for (const Grasp& grasp : file.grasps) {
    grasps.push_back(grasp_json(file.hand, grasp, grasps.size() + 1));
  }
  Json outcomes = Json::object();
  for (const auto& [outcome, count] : file.statistics.outcomes) {
    outcomes[outcome_name(outcome)] = count;
  }
  Json target_failures = Json::object();
  for (const auto& [reason, count] : file.statistics.target_failures) {
    target_failures[reason] = count;
  }
  return {{"stop", choice(file.stop)},
          {"statistics",
           {{"attempts", file.statistics.attempts},
            {"outcomes", outcomes},
            {"target_failures", target_failures},
            {"seeds_tried", file.statistics.seeds_tried},
            {"fitting_iterations", file.statistics.fitting_iterations}}},
          {"grasps", grasps}};
}

Json timings_json(const PlannerTimings& timings) {
  return {{"object",
           {{"query_s", timings.object.query_s},
            {"patches_s", timings.object.patches_s},
            {"voxels_s", timings.object.voxels_s},
            {"distance_s", timings.object.distance_s},
            {"scores_s", timings.object.scores_s}}},
          {"targets_s", timings.targets_s},
          {"fitting_s", timings.fitting_s},
          {"contact_tests_s", timings.contact_tests_s},
          {"measure_s", timings.measure_s},
          {"refinement_s", timings.refinement_s},
          {"pre_grasp_s", timings.pre_grasp_s},
          {"total_s", timings.total_s}};
}

}  // namespace

std::string to_json(const GraspFile& file) {
  return internal::json_text({{"format", "graspfit-grasps"},
                              {"version", 1},
                              {"conventions", conventions()},
                              {"object", object_json(file.object)},
                              {"hand", hand_json(file)},
                              {"planner", planner_json(file)},
                              {"results", results_json(file)},
                              {"timings", timings_json(file.timings)}});
}

}  // namespace graspfit::grasp
