
#include "graspfit/base/path_text.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "io/grasp_fields.hpp"
#include "io/json_fields.hpp"
#include "io/json_text.hpp"
#include "io/record_json.hpp"
#include "planner/planner_readings.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp {
namespace {

using geometry::RigidTransform;
using internal::Json;
using internal::JsonWriter;
using internal::to_json;

Json conventions() {
  return {
      {"units", "meters, radians, square meters, seconds unless a key names another unit"},
      {"frames",
       "O: object, the axes and origin of the object's file after scaling, unless it was laid "
       "down. "
       "H: hand base, the frame "
       "of the root link. L: a link. C: a pad, z leaving the link. X_AB is the pose of frame B in "
       "frame A: p_A = X_AB p_B."},
      {"rotation_wxyz", "unit quaternion, scalar first: [w, x, y, z]"},
      {"half_space", "the points p with normal . p <= offset_m"},
      {"contact",
       "object surface inside the pad's clip volume: point and normal are means over the clipped "
       "pieces, the point projected to the surface; area_m2 is their area; pad_boundary_distance_m "
       "is the distance of the point, in the pad's plane, from the outline; gap_m is the smallest "
       "distance between the pad's part of the link's mesh and the object's surface, 0 where they "
       "cross: of the mesh, its faces that look along the pad's z, cut along the prism over the "
       "outline, not deeper than 1 mm below the pad; weak is null where it is not known; target: "
       "the pad was asked to touch"},
      {"used_mesh_file",
       "the mesh as it was used, beside this file: scaled, repaired, closed, in meters, as PLY; of "
       "object and obstacles in O, of links in L"},
      {"surroundings",
       "solid: everything at or below table_z_O_m, and the obstacles, all in O; the hand stays "
       "table_clearance_m above the table"},
      {"laid",
       "where it is not null, O is not the file's own frame F (each coordinate times "
       "meters_per_file_unit): the mesh was repaired in F, then moved by X_OF"},
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
      {"largest_requested_gap_m", "over the contacts with target true"},
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
       "margins_N, the smallest force that fails for each, unless a rank was asked for"},
      {"imported",
       "only where grasps come from another tool's file: poses and joints are that file's, "
       "everything else is computed by the planner's options; attempt is the grasp's place in that "
       "file, from 0"},
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
  Json json = {{"name", name}, {"version", file.version}, {"seed", file.options.seed}};
  if (!file.preset.empty()) json["preset"] = file.preset;
  JsonWriter(json).group("options", file.options, internal::planner_rows);
  json["used"] = {{"fingers", file.fingers},
                  {"palm", file.palm},
                  {"voxel_size_m", file.voxel_size},
                  {"clip_thickness_m", file.clip_thickness},
                  {"merge_distance_m", file.merge_distance}};
  json["readings"] = readings;
  return json;
}

Json joints_json(const hands::HandModel& hand, const Eigen::VectorXd& q) {
  Json joints = Json::object();
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    joints[hand.joints[i].name] = q[i];
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

Json stable_pairs_json(const std::vector<contact::StablePair>& pairs) {
  Json json = Json::array();
  for (const contact::StablePair& pair : pairs) {
    json.push_back(
        {{"contacts", Json::array({pair.first, pair.second})}, {"angle_rad", pair.angle}});
  }
  return json;
}

Json grasp_json(const hands::HandModel& hand, const Grasp& grasp, std::size_t rank) {
  Json json = {{"rank", rank},
               {"usable", grasp.is_usable()},
               {"valid", grasp.is_valid()},
               {"has_all_contacts", grasp.has_all_contacts}};
  JsonWriter at(json, &hand);
  internal::quality_fields(at, grasp.quality);
  json["stable_pairs"] = stable_pairs_json(grasp.quality.stable_pairs);
  at(grasp.ideal_m, "ideal_m");
  at(largest_penetration(grasp), "largest_penetration_m");
  at(largest_contact_gap(grasp), "largest_contact_gap_m");
  at(largest_requested_gap(grasp), "largest_requested_gap_m");
  at.optional_group("wrench", grasp.wrench, internal::wrench_fields);
  json.update(configuration_json(hand, grasp.configuration));
  at.list(grasp.contacts, "contacts", internal::contact_fields);
  at.group("penetration", grasp.penetration, internal::penetration_fields);
  at.group("targets", grasp.targets, internal::targets_fields);
  at(grasp.attempt, "attempt");
  at(grasp.iterations, "iterations");
  at(grasp.refinement_iterations, "refinement_iterations");
  json["pre_grasp"] = pre_grasp_json(hand, grasp.pre_grasp);
  json["squeeze"] = squeeze_json(hand, grasp.squeeze);
  return json;
}

Json hold_json(const HoldRecord& hold) {
  Json json = {{"protocol", hold.protocol}};
  JsonWriter at(json);
  at.counts(hold.stages, "stages");
  json["margins_N"] = hold.margins.empty() ? Json(nullptr) : Json(hold.margins);
  return json;
}

Json statistics_json(const PlannerStatistics& statistics) {
  Json json = {{"attempts", statistics.attempts}, {"outcomes", Json::object()}};
  for (const auto& [outcome, count] : statistics.outcomes) {
    json["outcomes"][outcome_name(outcome)] = count;
  }
  JsonWriter at(json);
  at.counts(statistics.target_failures, "target_failures");
  at.counts(statistics.guidance, "guidance");
  at(statistics.seeds_tried, "seeds_tried");
  at(statistics.fitting_iterations, "fitting_iterations");
  at(statistics.refinement_iterations, "refinement_iterations");
  at(statistics.duplicates, "duplicates");
  return json;
}

Json results_json(const GraspFile& file) {
  Json json = {{"stop", name_of(file.stop)}, {"statistics", statistics_json(file.statistics)}};
  if (file.hold) json["hold"] = hold_json(*file.hold);
  json["grasps"] = Json::array();
  for (const Grasp& grasp : file.grasps) {
    json["grasps"].push_back(grasp_json(file.hand, grasp, json["grasps"].size() + 1));
  }
  return json;
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
  JsonWriter(json).group("timings", file.timings, internal::timings_fields);
  return internal::json_text(json);
}

}  // namespace graspfit::grasp
