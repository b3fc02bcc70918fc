#include <cmath>

#include "graspfit/base/path_text.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "io/json_text.hpp"
#include "io/planner_options_json.hpp"
#include "io/record_json.hpp"
#include "planner/planner_readings.hpp"

namespace graspfit::grasp {
namespace {

using geometry::RigidTransform;
using internal::finger_name;
using internal::Json;
using internal::or_null;
using internal::to_json;

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
       "distance between the pad's part of the link's mesh and the object's surface, 0 where they "
       "cross: of the mesh, its faces that look along the pad's z, cut along the prism over the "
       "outline, not deeper than 1 mm below the pad; weak is null where it is not known; target: "
       "the pad was "
       "asked to touch"},
      {"used_mesh_file",
       "the mesh as it was used, beside this file: scaled, repaired, closed, in meters, as PLY; of "
       "object and obstacles in O, of links in L"},
      {"surroundings", "solid: everything at or below table_z_O_m, and the obstacles, all in O"},
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
      {"epsilon",
       "radius of the largest ball around the origin in the convex hull of the wrenches s [e; "
       "(point - reference_point) x e / torque_scale] of all contacts and cone edges e = n + "
       "friction (cos(phi) t1 + sin(phi) t2), phi = 0, 2 pi / num_cone_edges, ...; n: the inward "
       "normal; t1: n x (1, 0, 0), n x (0, 1, 0) where |n_x| >= 0.9, of length 1; t2 = n x t1; s: "
       "force_limit for unit-normal, over the length of e for unit-edge. Where the origin is "
       "outside: 0, -1, or (signed) minus its distance"},
      {"largest_claimed_gap_m", "over the contacts with target true"},
      {"touching",
       "of refined grasps contacts with a gap of at most options.refinement.largest_gap_m; of "
       "others all. wrench and squeeze are of these alone; m is of all contacts, as the paper has "
       "it"},
      {"pre_grasp",
       "open, every link at least clearance_m from object and surroundings, the straight way from "
       "it to the grasp free; opening: share of the way from the grasp's joints to open ones; "
       "retreat_m: of the palm, against its direction"},
      {"squeeze",
       "commanded joints beyond the surface, by contact forces that balance one another; forces: "
       "per contact, on the object, 0 where it does not touch; residual: what stays unbalanced "
       "over the sum of normal forces"},
      {"hold",
       "only where planned grasps were tested in physics: those that did not hold under the "
       "protocol are left out and counted by the stage they came to, the others are ordered by "
       "margins_N, the smallest force that fails for each"},
      {"imported",
       "only where grasps come from another tool's file: poses and joints are that file's, "
       "everything "
       "else is computed by the planner's options; attempt is the grasp's place in that file, from "
       "0"},
      {"usable", "m > 0"},
      {"valid",
       "usable, no link shares a point with the object, the surroundings or another link that is "
       "not excluded, and every requested finger and the palm, if requested, has a contact: of a "
       "refined grasp one with a gap of at most options.refinement.largest_gap_m"}};
}

Json planner_json(const GraspFile& file) {
  Json readings = Json::object();
  for (const auto& [point, reading] : internal::planner_readings(file.options)) {
    readings[point] = reading;
  }
  const PlanningMethod* const method = planning_methods().find(file.options.planner);
  const std::string name = file.imported       ? "none: imported"
                           : method != nullptr ? method->title
                                               : "of another library: " + file.options.planner;
  return {{"name", name},
          {"version", file.version},
          {"seed", file.options.seed},
          {"options", internal::planner_options_json(file.options)},
          {"used",
           {{"fingers", file.fingers},
            {"palm", file.palm},
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

/// Palm pose, joints and what follows from them: the pose of every link.
Json configuration_json(const hands::HandModel& hand,
                        const hands::HandConfiguration& configuration) {
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  Json links = Json::object();
  for (std::size_t i = 0; i < hand.links.size(); ++i) links[hand.links[i].name] = to_json(X_OL[i]);
  return {{"X_OH", to_json(configuration.X_OH)},
          {"joints", joints_json(hand, configuration.q)},
          {"X_OL", links}};
}

Json pre_grasp_json(const hands::HandModel& hand, const std::optional<PreGrasp>& pre_grasp) {
  if (!pre_grasp) return nullptr;
  Json json = configuration_json(hand, pre_grasp->configuration);
  json["clearance_m"] = pre_grasp->clearance;
  json["opening"] = pre_grasp->opening;
  json["retreat_m"] = pre_grasp->retreat;
  return json;
}

Json squeeze_json(const hands::HandModel& hand, const std::optional<contact::Squeeze>& squeeze) {
  if (!squeeze) return nullptr;
  Json forces = Json::array();
  for (const auto& force : squeeze->forces_O.colwise()) {
    forces.push_back(to_json(Eigen::Vector3d(force)));
  }
  Json json = configuration_json(hand, squeeze->configuration);
  json["forces_O_N"] = forces;
  json["residual"] = squeeze->residual;
  json["is_balanced"] = squeeze->is_balanced;
  json["is_clamped"] = squeeze->is_clamped;
  return json;
}

/// What the grasp withstands and all that the numbers depend on; null where it was not measured,
/// which leaves the torque scale unset.
Json wrench_json(const contact::WrenchQuality& wrench) {
  const contact::WrenchConvention& convention = wrench.convention;
  const contact::WrenchSpaceOptions& options = convention.options;
  if (std::isnan(options.torque_scale)) return nullptr;
  return {{"epsilon", wrench.epsilon},
          {"volume", wrench.volume},
          {"is_force_closure", wrench.is_force_closure},
          {"rank", wrench.rank},
          {"convention",
           {{"tool", convention.tool ? choice(*convention.tool) : Json(nullptr)},
            {"reference_point_O_m", to_json(convention.reference_point_O)},
            {"torque_scale_m", options.torque_scale},
            {"friction", options.friction},
            {"num_cone_edges", options.num_cone_edges},
            {"norm", choice(options.norm)},
            {"force_scaling", choice(options.force_scaling)},
            {"force_limit", options.force_limit},
            {"outside", choice(options.outside)}}}};
}

Json contact_json(const hands::HandModel& hand, const contact::Contact& contact) {
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
void add_quality(const contact::ContactQuality& quality, Json& grasp) {
  Json terms = Json::array();
  for (const contact::SustainabilityTerm& term : quality.terms) {
    terms.push_back({{"boundary_distance", term.boundary_distance},
                     {"area", term.area},
                     {"strength", term.strength}});
  }
  Json pairs = Json::array();
  for (const contact::StablePair& pair : quality.stable_pairs) {
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
          {"self_link_b", link_name(penetration.self_link_b)},
          {"surroundings_touched", penetration.surroundings_touched}};
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
  return {{"seeds_tried", targets.seeds_tried}, {"rank", targets.rank}, {"contacts", contacts}};
}

Json grasp_json(const hands::HandModel& hand, const Grasp& grasp, std::size_t rank) {
  Json contacts = Json::array();
  for (const contact::Contact& contact : grasp.contacts)
    contacts.push_back(contact_json(hand, contact));
  Json json = {{"rank", rank},
               {"usable", grasp.is_usable()},
               {"valid", grasp.is_valid()},
               {"has_all_contacts", grasp.has_all_contacts}};
  add_quality(grasp.quality, json);
  json["ideal_m"] = grasp.ideal_m;
  json["largest_penetration_m"] = largest_penetration(grasp);
  json["largest_contact_gap_m"] = largest_contact_gap(grasp);
  json["largest_claimed_gap_m"] = largest_claimed_gap(grasp);
  json["wrench"] = wrench_json(grasp.wrench);
  json.update(configuration_json(hand, grasp.configuration));
  json["contacts"] = contacts;
  json["penetration"] = penetration_json(hand, grasp.penetration);
  json["targets"] = targets_json(hand, grasp.targets);
  json["attempt"] = grasp.attempt;
  json["iterations"] = grasp.iterations;
  json["refinement_iterations"] = grasp.refinement_iterations;
  json["pre_grasp"] = pre_grasp_json(hand, grasp.pre_grasp);
  json["squeeze"] = squeeze_json(hand, grasp.squeeze);
  return json;
}

Json hold_json(const HoldRecord& hold) {
  Json stages = Json::object();
  for (const auto& [stage, count] : hold.stages) stages[stage] = count;
  return {{"protocol", hold.protocol},
          {"stages", stages},
          {"margins_N", hold.margins.empty() ? Json(nullptr) : Json(hold.margins)}};
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
  Json guidance = Json::object();
  for (const auto& [what, count] : file.statistics.guidance) guidance[what] = count;
  Json target_failures = Json::object();
  for (const auto& [reason, count] : file.statistics.target_failures) {
    target_failures[reason] = count;
  }
  Json json = {{"stop", choice(file.stop)},
               {"statistics",
                {{"attempts", file.statistics.attempts},
                 {"outcomes", outcomes},
                 {"target_failures", target_failures},
                 {"guidance", guidance},
                 {"seeds_tried", file.statistics.seeds_tried},
                 {"fitting_iterations", file.statistics.fitting_iterations},
                 {"refinement_iterations", file.statistics.refinement_iterations},
                 {"duplicates", file.statistics.duplicates}}}};
  if (file.hold) json["hold"] = hold_json(*file.hold);
  json["grasps"] = grasps;
  return json;
}

Json timings_json(const PlannerTimings& timings) {
  return {{"object",
           {{"query_s", timings.object.query_s},
            {"patches_s", timings.object.patches_s},
            {"voxels_s", timings.object.voxels_s},
            {"distance_s", timings.object.distance_s},
            {"scores_s", timings.object.scores_s},
            {"weak_s", timings.object.weak_s}}},
          {"guidance_s", timings.guidance_s},
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
  const auto used_mesh_file =
      file.used_meshes ? std::optional(file.used_meshes->object) : std::nullopt;
  Json json = {{"format", "graspfit-grasps"},
               {"version", internal::kGraspFileVersion},
               {"conventions", conventions()},
               {"object", internal::object_json(file.object, used_mesh_file)},
               {"surroundings", internal::surroundings_json(file)},
               {"hand", internal::hand_json(file)},
               {"planner", planner_json(file)}};
  if (file.imported) {
    json["imported"] = {{"format", file.imported->format},
                        {"file", base::path_text(file.imported->file)},
                        {"sha256", file.imported->sha256}};
  }
  json["results"] = results_json(file);
  json["timings"] = timings_json(file.timings);
  return internal::json_text(json);
}

}  // namespace graspfit::grasp
