#include <algorithm>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/json_value.hpp"
#include "graspfit/base/replacement_mark.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "io/grasp_fields.hpp"
#include "io/json_fields.hpp"
#include "io/recorded_hand.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp {
namespace {

using base::JsonValue;
using internal::JsonReader;

ObjectRecord read_object_record(const JsonValue& node) {
  ObjectRecord object;
  object.file = node.at("file").path();
  const JsonReader at(node);
  at(object.sha256, "sha256");
  at(object.meters_per_file_unit, "meters_per_file_unit");
  // Files of earlier versions lack it.
  if (node.has("laid")) at.optional_group("laid", object.laid, internal::laid_fields);
  at.group("repair", object, internal::repair_fields);
  at.group("mesh", object.analysis, internal::mesh_fields);
  const JsonValue box = node.at("mesh").at("bounding_box_m");
  object.analysis.box = {internal::vector3(box.at("lower")), internal::vector3(box.at("upper"))};
  at(object.center_of_mass_O, "center_of_mass_O_m");
  at(object.volume, "volume_m3");
  at(object.normalizing_radius, "normalizing_radius_m");
  return object;
}

SurroundingsRecord read_surroundings_record(const JsonValue& node) {
  SurroundingsRecord surroundings;
  const JsonReader at(node);
  at(surroundings.table_z_O, "table_z_O_m");
  if (node.has("table_clearance_m")) at(surroundings.table_clearance, "table_clearance_m");
  for (const JsonValue& obstacle : node.at("obstacles").items()) {
    surroundings.obstacles.push_back(read_object_record(obstacle));
  }
  return surroundings;
}

/// The names of meshes as used, where the file has them.
std::optional<UsedMeshFiles> read_used_meshes(const JsonValue& root) {
  const JsonValue object = root.at("object").at("used_mesh_file");
  if (object.is_null()) return std::nullopt;
  UsedMeshFiles files;
  files.object = object.text();
  for (const JsonValue& obstacle : root.at("surroundings").at("obstacles").items()) {
    files.obstacles.push_back(obstacle.at("used_mesh_file").text());
  }
  for (const JsonValue& link : root.at("hand").at("links").items()) {
    const JsonValue file = link.at("used_mesh_file");
    files.links.push_back(file.is_null() ? std::string() : file.text());
  }
  return files;
}

internal::RecordedHand read_hand_record(const JsonValue& node) {
  internal::RecordedHand hand;
  hand.description_file = node.at("description_file").path();
  hand.description_sha256 = node.at("description_sha256").text();
  hand.sidecar_sha256 = node.at("sidecar_sha256").text();
  for (const JsonValue& link : node.at("links").items()) {
    const JsonValue hash = link.at("mesh_sha256");
    hand.link_mesh_sha256.push_back(hash.is_null() ? std::string() : hash.text());
  }
  return hand;
}

/// Reads what refers to links, joints, fingers and pads of a hand by name.
class GraspReader {
 public:
  explicit GraspReader(const hands::HandModel& hand) : hand_(hand) {}

  Grasp read(const JsonValue& node) const {
    const JsonReader at(node, &hand_);
    Grasp grasp;
    grasp.configuration = read_configuration(node);
    if (const JsonValue pre_grasp = node.at("pre_grasp"); !pre_grasp.is_null()) {
      grasp.pre_grasp = read_pre_grasp(pre_grasp);
    }
    at(grasp.has_all_contacts, "has_all_contacts");
    at.list(grasp.contacts, "contacts", internal::contact_fields);
    if (const JsonValue squeeze = node.at("squeeze"); !squeeze.is_null()) {
      grasp.squeeze = read_squeeze(squeeze, grasp.contacts.size());
    }
    internal::quality_fields(at, grasp.quality);
    grasp.quality.stable_pairs = read_stable_pairs(node.at("stable_pairs"), grasp.contacts.size());
    at.optional_group("wrench", grasp.wrench, internal::wrench_fields);
    if (grasp.wrench) {
      node.at("wrench").at("convention").at("torque_scale_m").positive_number();
    }
    at(grasp.ideal_m, "ideal_m");
    at.group("penetration", grasp.penetration, internal::penetration_fields);
    at.group("targets", grasp.targets, internal::targets_fields);
    at(grasp.attempt, "attempt");
    at(grasp.iterations, "iterations");
    at(grasp.refinement_iterations, "refinement_iterations");
    return grasp;
  }

 private:
  hands::HandConfiguration read_configuration(const JsonValue& node) const {
    hands::HandConfiguration configuration;
    configuration.X_OH = internal::pose(node.at("X_OH"));
    const JsonValue joints = node.at("joints");
    configuration.q.resize(std::ssize(hand_.joints));
    for (std::size_t i = 0; i < hand_.joints.size(); ++i) {
      configuration.q[i] = joints.at(hand_.joints[i].name).number();
    }
    try {
      hands::validate(hand_, configuration);
    } catch (const base::InvalidInput& error) {
      joints.fail(error.what());
    }
    return configuration;
  }

  PreGrasp read_pre_grasp(const JsonValue& node) const {
    return {.configuration = read_configuration(node),
            .clearance = node.at("clearance_m").number(),
            .opening = node.at("opening").number(),
            .retreat = node.at("retreat_m").number()};
  }

  contact::Squeeze read_squeeze(const JsonValue& node, std::size_t num_contacts) const {
    contact::Squeeze squeeze;
    squeeze.configuration = read_configuration(node);
    const JsonValue forces = node.at("forces_O_N");
    const std::vector<JsonValue> items = forces.items();
    if (items.size() != num_contacts) {
      forces.fail("has " + std::to_string(items.size()) + " forces for " +
                  std::to_string(num_contacts) + " contacts");
    }
    squeeze.forces_O.resize(3, std::ssize(items));
    for (int i = 0; i < std::ssize(items); ++i) {
      squeeze.forces_O.col(i) = internal::vector3(items[i]);
    }
    squeeze.residual = node.at("residual").number();
    squeeze.is_balanced = node.at("is_balanced").flag();
    squeeze.is_clamped = node.at("is_clamped").flag();
    return squeeze;
  }

  static std::vector<contact::StablePair> read_stable_pairs(const JsonValue& node,
                                                            std::size_t num_contacts) {
    std::vector<contact::StablePair> pairs;
    for (const JsonValue& pair : node.items()) {
      const JsonValue contacts = pair.at("contacts");
      const std::vector<JsonValue> indices = contacts.items();
      if (indices.size() != 2) contacts.fail("is not a pair");
      for (const JsonValue& index : indices) {
        if (index.unsigned_integer() >= num_contacts) index.fail("is not the index of a contact");
      }
      pairs.push_back(
          {indices[0].small_integer(), indices[1].small_integer(), pair.at("angle_rad").number()});
    }
    return pairs;
  }

  const hands::HandModel& hand_;
};

PlannerStatistics read_statistics(const JsonValue& node) {
  PlannerStatistics statistics;
  const JsonReader at(node);
  at(statistics.attempts, "attempts");
  at(statistics.seeds_tried, "seeds_tried");
  at(statistics.fitting_iterations, "fitting_iterations");
  at(statistics.refinement_iterations, "refinement_iterations");
  at(statistics.duplicates, "duplicates");
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
  at.counts(statistics.guidance, "guidance");
  at.counts(statistics.target_failures, "target_failures");
  return statistics;
}

HoldRecord read_hold(const JsonValue& node, std::size_t num_grasps) {
  HoldRecord hold;
  hold.protocol = node.at("protocol").text();
  JsonReader{node}.counts(hold.stages, "stages");
  const JsonValue margins = node.at("margins_N");
  if (margins.is_null()) return hold;
  for (const JsonValue& margin : margins.items()) hold.margins.push_back(margin.number());
  if (hold.margins.size() != num_grasps) {
    margins.fail("has " + std::to_string(hold.margins.size()) + " margins for " +
                 std::to_string(num_grasps) + " grasps");
  }
  return hold;
}

/// Sets options from the members of a JSON object. Those that it lacks keep their defaults; members
/// that are no options are refused.
class OptionReader {
 public:
  explicit OptionReader(JsonValue node) : node_(std::move(node)) {}

  template <class Options, class Rows>
  void read(Options& options, const Rows& rows) {
    rows(*this, options);
    node_.require_members({}, keys_);
  }

  template <class Value>
  void operator()(Value& value, const OptionRow& row) {
    if (is_given(row.key)) JsonReader{node_}(value, row);
  }
  template <class Options, class Rows>
  void group(std::string_view key, Options& within, const Rows& rows) {
    if (is_given(key)) OptionReader(node_.at(keys_.back())).read(within, rows);
  }
  template <class Options, class Rows>
  void optional_group(std::string_view key, std::optional<Options>& within, const Rows& rows) {
    if (!is_given(key)) return;
    const JsonValue given = node_.at(keys_.back());
    within.reset();
    if (!given.is_null()) OptionReader(given).read(within.emplace(), rows);
  }

 private:
  bool is_given(std::string_view key) {
    keys_.emplace_back(key);
    return node_.has(keys_.back());
  }

  JsonValue node_;
  std::vector<std::string> keys_;
};

/// A file of an earlier version as one of this version. Version 4 had order and choice of
/// candidates in one option, `attempt_choice`; up to version 5 the wrench convention of graspfit
/// was "house".
JsonValue upgraded(const JsonValue& root, std::int64_t version) {
  internal::Json json = root.json();
  if (version < 5) {
    const JsonValue choice = root.at("planner").at("options").at("attempt_choice");
    if (!value_named<KeptCandidate>(choice.text())) {
      choice.refuse("must be one of " + names_of<KeptCandidate>());
    }
    internal::Json& options = json["planner"]["options"];
    options["candidate_order"] = choice.text() == "first" ? "pads" : "balance";
    options["kept_candidate"] = choice.text();
    options.erase("attempt_choice");
  }
  const std::vector<JsonValue> grasps = root.at("results").at("grasps").items();
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const JsonValue wrench = grasps[i].at("wrench");
    if (wrench.is_null()) continue;
    const JsonValue tool = wrench.at("convention").at("tool");
    if (!tool.is_text() || tool.text() != "house") continue;
    json["results"]["grasps"][i]["wrench"]["convention"]["tool"] =
        name_of(contact::WrenchTool::Graspfit);
  }
  return root.with_root(json);
}

}  // namespace

GraspFile read_grasps(const std::filesystem::path& path) {
  base::require_no_replacement_mark(path);
  JsonValue root = JsonValue::parsed<base::IoError>(base::read_json_file(path), path.string());
  if (root.at("format").text() != "graspfit-grasps") {
    root.at("format").fail("is \"" + root.at("format").text() + "\", not \"graspfit-grasps\"");
  }
  const std::int64_t version = root.at("version").integer();
  if (version < internal::kOldestGraspFileVersion || version > internal::kGraspFileVersion) {
    root.at("version").fail("is " + std::to_string(version) + "; this program reads versions " +
                            std::to_string(internal::kOldestGraspFileVersion) + " to " +
                            std::to_string(internal::kGraspFileVersion) + ": plan again");
  }
  if (version < internal::kGraspFileVersion) root = upgraded(root, version);

  GraspFile file;
  file.object = read_object_record(root.at("object"));
  file.surroundings = read_surroundings_record(root.at("surroundings"));
  file.used_meshes = read_used_meshes(root);
  const JsonValue hand = root.at("hand");
  const internal::RecordedHand recorded_hand = read_hand_record(hand);
  try {
    file.hand = internal::read_recorded_hand(recorded_hand, path.parent_path());
  } catch (const base::Error& error) {
    hand.fail(error.what());
  }
  file.link_mesh_sha256 = recorded_hand.link_mesh_sha256;

  const JsonValue planner = root.at("planner");
  OptionReader(planner.at("options")).read(file.options, internal::planner_rows);
  file.options.seed = planner.at("seed").unsigned_integer();
  if (const auto preset = planner.find("preset")) file.preset = preset->name();
  try {
    file.options.validate();
  } catch (const base::InvalidInput& error) {
    planner.at("options").fail(error.what());
  }
  file.version = planner.at("version").text();
  const JsonValue used = planner.at("used");
  for (const JsonValue& finger : used.at("fingers").items()) {
    internal::index_by_name(file.hand.fingers, finger);
    file.fingers.push_back(finger.text());
  }
  file.palm = used.at("palm").flag();
  file.voxel_size = used.at("voxel_size_m").positive_number();
  file.clip_thickness = used.at("clip_thickness_m").positive_number();
  file.merge_distance = used.at("merge_distance_m").positive_number();

  const JsonValue results = root.at("results");
  JsonReader{results}(file.stop, "stop");
  file.statistics = read_statistics(results.at("statistics"));
  const GraspReader reader(file.hand);
  for (const JsonValue& grasp : results.at("grasps").items()) {
    file.grasps.push_back(reader.read(grasp));
  }
  for (const auto& [key, node] : results.members()) {
    if (key == "hold") file.hold = read_hold(node, file.grasps.size());
  }
  for (const auto& [key, node] : root.members()) {
    if (key != "imported") continue;
    file.imported = {node.at("format").text(), node.at("file").path(), node.at("sha256").text()};
  }
  JsonReader{root}.group("timings", file.timings, internal::timings_fields);
  return file;
}

}  // namespace graspfit::grasp
