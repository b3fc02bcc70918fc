#include "input/object_loading.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/grasp/object_difference.hpp"
#include "graspfit/grasp/object_laid_down.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

using base::shortest_decimal;

constexpr double kLeastProbability = 0.01;  // of a pose that "all" poses include
constexpr double kMillimetersPerMeter = 1e3;

constexpr std::array<std::pair<const char*, double>, 4> kMeshUnits = {
    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}}};

}  // namespace

double meters_per(const Flags& flags, const std::string& flag) {
  const std::string& unit = flags.text(flag);
  for (const auto& [name, meters] : kMeshUnits) {
    if (unit == name) return meters;
  }
  fail_choice(flag, unit, "m|cm|mm|in");
}

boost::program_options::options_description object_options() {
  boost::program_options::options_description options = option_group("Object");
  add_option(options, "mesh-unit", "m|cm|mm|in", std::nullopt,
             "unit of the numbers in the file; without this and --longest they are meters");
  add_option(options, "longest", "LENGTH_M", std::nullopt,
             "instead of a unit: scale the object so that its bounding box's longest edge is this "
             "long [m]");
  const geometry::MeshRepairOptions repair;
  add_option(
      options, "repair", "repair|strict|as-is", std::string(grasp::name_of(repair.mode)),
      "mend a mesh that is not a closed outward surface, or refuse what remains open; refuse "
      "any defect; change nothing [R, A46]");
  add_option(options, "max-hole", "SHARE", shortest_decimal(repair.max_hole_extent_rel),
             "largest hole that repair fills: its extent over the object's, 0 to 1 [R, A46]");
  add_option(
      options, "weld", "SHARE", shortest_decimal(repair.weld_distance_rel),
      "vertices this close become one when the mesh is mended: over the object's extent, 0 to "
      "0.01; 0: equal ones only");
  add_option(options, "self-intersections", "leave|report|resolve",
             std::string(grasp::name_of(repair.self_intersections)),
             "faces that cross: not looked for, counted, or cut so that only what bounds the solid "
             "stays; the solid is the same");
  add_switch(options, "wrap",
             "last resort for a mesh that would be refused: a closed surface around it");
  const geometry::AlphaWrap wrap;
  add_option(options, "wrap-alpha", "SHARE", shortest_decimal(wrap.alpha_rel),
             "with --wrap: narrowest gap that it enters, over the object's extent, 0.001 to 1");
  add_option(options, "wrap-offset", "SHARE", shortest_decimal(wrap.offset_rel),
             "with --wrap: its distance from the object, over the object's extent, 0.0001 to 1");
  return options;
}

grasp::ObjectReadOptions object_read_options(const Flags& flags) {
  if (flags.has("mesh-unit") && flags.has("longest")) {
    throw UsageError("--mesh-unit and --longest exclude each other");
  }
  grasp::ObjectReadOptions options;
  if (flags.has("mesh-unit")) options.meters_per_file_unit = meters_per(flags, "mesh-unit");
  options.longest_extent = flags.optional_number("longest");
  if (options.longest_extent && !(*options.longest_extent > 0.0)) {
    throw UsageError("--longest " + flags.text("longest") + " is not a length above 0 m");
  }
  options.repair.mode = flags.choice<geometry::RepairMode>("repair");
  options.repair.max_hole_extent_rel = flags.number("max-hole", base::between(0, 1));
  options.repair.weld_distance_rel = flags.number("weld", base::between(0, 0.01));
  options.repair.self_intersections =
      flags.choice<geometry::SelfIntersections>("self-intersections");
  if (flags.has("wrap")) {
    options.repair.wrap =
        geometry::AlphaWrap{.alpha_rel = flags.number("wrap-alpha", base::between(0.001, 1)),
                            .offset_rel = flags.number("wrap-offset", base::between(0.0001, 1))};
  }
  for (const char* flag : {"wrap-alpha", "wrap-offset"}) {
    if (!flags.has("wrap") && !flags.is_default(flag)) {
      throw UsageError("--" + std::string(flag) + " means nothing without --wrap");
    }
  }
  options.validate();
  return options;
}

boost::program_options::options_description surroundings_options() {
  boost::program_options::options_description options =
      option_group("What the hand must not touch");
  add_option(options, "table", "Z", std::nullopt,
             "a table: everything at or below this z of the object's frame is solid [m] [R, A45]");
  add_switch(options, "on-table",
             "lay the object down first, on a table at z = 0, in a pose in which it rests; the "
             "frame is then the table's, with the object's center of mass over its origin");
  add_option(options, "rest-pose", "N|all", "1",
             "with --on-table: which pose, 1 the likeliest (inspect lists them); all: in each that "
             "is at least as likely as 1 %, into DIR/rest_pose_N");
  add_option(
      options, "table-clearance-mm", "MM",
      base::plain_decimal(kMillimetersPerMeter * grasp::kTableClearance),
      "the hand comes no nearer to the table than this [mm]; 0: fingertips may come down to it");
  add_repeatable_option(options, "obstacle", "FILE",
                        "a solid in the object's frame; may be given again for further ones "
                        "[R, A45]");
  add_option(options, "obstacle-unit", "m|cm|mm|in", "m", "of the numbers in those files");
  return options;
}

LoadedSurroundings load_surroundings(const Flags& flags, const geometry::TriangleMesh& object_O) {
  LoadedSurroundings loaded;
  if (flags.has("table") && flags.has("on-table")) {
    throw UsageError("--table and --on-table exclude each other: --on-table puts the table there");
  }
  std::optional<double> table = flags.optional_number("table");
  if (flags.has("on-table")) table = 0.0;
  if (!table && !flags.is_default("table-clearance-mm")) {
    throw UsageError("--table-clearance-mm means nothing without --table or --on-table");
  }
  const double clearance = flags.number("table-clearance-mm", base::at_least(0));
  loaded.record.table_z_O = loaded.surroundings.table_z_O = table;
  loaded.record.table_clearance = loaded.surroundings.table_clearance =
      table ? clearance / kMillimetersPerMeter : 0.0;
  const double top = geometry::bounding_box(object_O).max().z();
  if (loaded.record.table_z_O && top <= *loaded.record.table_z_O) {
    throw UsageError("--table " + flags.text("table") +
                     " is above the whole object, whose highest z is " + shortest_decimal(top) +
                     " m");
  }
  if (!flags.has("obstacle") && !flags.is_default("obstacle-unit")) {
    throw UsageError("--obstacle-unit means nothing without --obstacle");
  }
  // Obstacles are repaired as the object is, so that the flags that messages advise have an effect.
  grasp::ObjectReadOptions options;
  options.repair = object_read_options(flags).repair;
  options.meters_per_file_unit = meters_per(flags, "obstacle-unit");
  for (const std::string& file : flags.texts("obstacle")) {
    const SecondsBar seconds(!flags.has("quiet"), "reading and repairing " + file);
    grasp::ObjectFile obstacle = grasp::read_object_file(file, options);
    require_solid(obstacle);
    loaded.record.obstacles.push_back(obstacle.record);
    loaded.surroundings.obstacles.emplace_back(std::move(obstacle.mesh));
  }
  return loaded;
}

grasp::ObjectFile load_object(const Flags& flags, const std::string& file) {
  return load_object(flags, file, object_read_options(flags));
}

grasp::ObjectFile load_object(const Flags& flags, const std::string& file,
                              const grasp::ObjectReadOptions& options) {
  const SecondsBar seconds(!flags.has("quiet"), "reading and repairing " + file);
  return grasp::read_object_file(file, options);
}

std::vector<grasp::ObjectFile> load_placed_objects(const Flags& flags, const std::string& file) {
  if (!flags.has("on-table") && !flags.is_default("rest-pose")) {
    throw UsageError("--rest-pose means nothing without --on-table");
  }
  std::vector<grasp::ObjectFile> objects;
  grasp::ObjectFile object = load_object(flags, file);
  if (!flags.has("on-table")) {
    objects.push_back(std::move(object));
    return objects;
  }
  require_solid(object);
  if (asks_for_all_rest_poses(flags)) {
    const std::vector<geometry::LikelyRestPose> poses =
        geometry::likely_rest_poses(object.mesh, object.record.center_of_mass_O);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (poses[i].probability < kLeastProbability) break;
      objects.push_back(grasp::laid_down(object, poses[i], base::as_index<int>(i + 1)));
    }
    return objects;
  }
  const int rank = flags.integer("rest-pose", base::at_least(1));
  objects.push_back(grasp::laid_down(std::move(object), rank));
  return objects;
}

bool asks_for_all_rest_poses(const Flags& flags) { return flags.text("rest-pose") == "all"; }

std::string probability_text(double probability) {
  return base::plain_decimal(std::round(1e3 * probability) / 10.0) + " %";
}

void require_solid(const grasp::ObjectFile& object) {
  const geometry::MeshAnalysis& mesh = object.record.analysis;
  if (mesh.is_closed && mesh.is_outward) return;
  throw base::InvalidInput(
      object.record.file + ": is " +
      (mesh.is_closed ? "inside-out"
                      : "open (" + std::to_string(mesh.num_boundary_edges) + " boundary edges)") +
      "; --repair repair mends what it can");
}

void warn_of_differences(const std::string& command, const grasp::ObjectRecord& object,
                         const std::vector<grasp::ObjectRecord>& obstacles) {
  const auto say = [&command](const std::optional<std::string>& line) {
    if (line) std::fprintf(stderr, "graspfit %s: %s\n", command.c_str(), line->c_str());
  };
  say(grasp::reason_against_wrap(object));
  say(grasp::difference_from_file(object));
  for (const grasp::ObjectRecord& obstacle : obstacles) say(grasp::difference_from_file(obstacle));
}

std::string extents_text(const geometry::TriangleMesh& mesh) {
  const Eigen::Vector3d size = geometry::bounding_box(mesh).sizes();
  constexpr double kSmall = 1e-3;  // [m]
  const bool is_small = size.maxCoeff() < kSmall;
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += " x ";
    text += is_small ? significant_decimal(size[axis], 4)
                     : shortest_decimal(std::round(size[axis] * 1e6) / 1e6);
  }
  return text + " m";
}

}  // namespace graspfit::app
