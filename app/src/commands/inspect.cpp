#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/likely_rest_pose.hpp"
#include "graspfit/geometry/shape_diameter.hpp"
#include "graspfit/geometry/weak_regions.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/object_difference.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "input/object_loading.hpp"
#include "input/planner_flags.hpp"
#include "output/output_folder.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"
#include "output/vtk_files.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using base::shortest_decimal;
using geometry::MeshAnalysis;

Command inspect_command() {
  po::options_description more = option_group("Hand and output");
  add_option(more, "hand", "NAME|FILE", std::nullopt, "check the object's size for this hand");
  add_option(more, "weak-thickness-mm", "MM", "6",
             "what counts as fragile: slender features thinner than this; found once per object, "
             "then read from the user's cache folder");
  add_switch(more, "no-cache", "find weak features anew, and keep nothing");
  add_switch(more, "no-thickness", "leave out thickness and weak features, the slowest part");
  add_option(
      more, "out", "DIR", std::nullopt,
      "write voxels.vti, score_map.vti, distance_map.vti and patches.ply there, for ParaView "
      "and MeshLab");
  Command command{"inspect", "OBJECT",
                  "Reports what OBJECT is like: mesh and repairs, mass, voxels, contact scores.\n",
                  option_group(), ""};
  command.options.add(object_options()).add(score_map_options()).add(more);
  return command;
}

void print_row(const std::string& name, const std::string& value) {
  std::printf("%-20s%s\n", name.c_str(), value.c_str());
}

/// A number as text, with four significant digits.
std::string rounded_text(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

/// An analysis as text: "8 vertices, 12 faces, 1 part; closed, manifold, outward; degenerate faces
/// 2"; it names only defects that exist.
std::string analysis_text(const MeshAnalysis& mesh) {
  std::string text = std::to_string(mesh.num_vertices) + " vertices, " +
                     std::to_string(mesh.num_faces) + " faces, " + std::to_string(mesh.num_parts) +
                     (mesh.num_parts == 1 ? " part" : " parts");
  text += mesh.is_closed ? "; closed" : "; open";
  text += mesh.is_manifold ? ", manifold" : ", not manifold";
  if (mesh.is_closed) text += mesh.is_outward ? ", outward" : ", inside-out";
  const auto defect = [&text](std::size_t count, const char* what) {
    if (count > 0) text += std::string("; ") + what + ' ' + std::to_string(count);
  };
  defect(mesh.num_unused_vertices, "unused vertices");
  defect(mesh.num_degenerate_faces, "degenerate faces");
  defect(mesh.num_doubled_faces, "doubled faces");
  defect(mesh.num_boundary_edges, "boundary edges");
  defect(mesh.num_nonmanifold_edges, "non-manifold edges");
  defect(mesh.num_inconsistent_edges, "edges run through twice in one direction");
  defect(mesh.num_inward_parts, "parts inside-out");
  if (mesh.num_self_intersections == 0U) text += "; no crossing faces";
  defect(mesh.num_self_intersections.value_or(0), "pairs of crossing faces");
  return text;
}

void print_mesh(const grasp::ObjectFile& object) {
  const grasp::ObjectRecord& record = object.record;
  const geometry::MeshFileReport& report = object.report;
  print_row("file", record.file);
  print_row("SHA-256", record.sha256);
  print_row("read", std::to_string(report.num_file_vertices) + " vertices, " +
                        std::to_string(report.num_file_polygons) + " polygons as " + report.format +
                        "; " + std::to_string(report.num_polygons_triangulated) +
                        " polygons triangulated, " + std::to_string(report.num_vertices_welded) +
                        " vertices welded");
  print_row("scale", shortest_decimal(record.meters_per_file_unit) + " m per unit of the file");
  print_row("before repair", analysis_text(object.before));
  for (const geometry::RepairStep& step : record.repairs) {
    print_row("repair", step.what + ' ' + std::to_string(step.count) + ", volume changed by " +
                            rounded_text(step.volume_change) + " m3, surface by at most " +
                            rounded_text(step.hausdorff_bound) + " m");
  }
  if (record.repairs.empty()) print_row("repair", "nothing changed");
  if (const auto reason = grasp::reason_against_wrap(record)) print_row("wrap", *reason);
  if (const auto difference = grasp::difference_from_file(record)) {
    print_row("difference", *difference);
  }
  print_row("after repair", analysis_text(record.analysis));
  print_row("extents", extents_text(object.mesh));
  print_row("box", vector_text(record.analysis.box.min(), 6) + " to " +
                       vector_text(record.analysis.box.max(), 6) + " m");
}

void print_mass(const grasp::ObjectModel& object) {
  print_row(
      "volume",
      shortest_decimal(object.mass.volume) + " m3" +
          (object.mass.method == geometry::MassMethod::SolidBoundary ? ", parts united" : ""));
  print_row("center of mass", vector_text(object.mass.center_of_mass, 6) + " m");
  print_row("normalizing radius", fixed_decimal(object.normalizing_radius, 6) + " m");
}

/// How the solid rests on a table, for `plan --on-table`.
void print_rest_poses(const grasp::ObjectModel& object) {
  constexpr std::size_t kMost = 5;
  const std::vector<geometry::LikelyRestPose> poses =
      geometry::likely_rest_poses(object.mesh(), object.mass.center_of_mass);
  for (std::size_t i = 0; i < std::min(kMost, poses.size()); ++i) {
    const geometry::RestPose& pose = poses[i].pose;
    print_row("rest pose " + std::to_string(i + 1),
              probability_text(poses[i].probability) + " of falls, up " +
                  vector_text(pose.up_O, 3) + ", center of mass " + fixed_decimal(pose.height, 4) +
                  " m high");
  }
  if (poses.size() > kMost) {
    print_row("", std::to_string(poses.size() - kMost) + " further ones are less likely");
  }
}

void print_voxels(const grasp::ObjectModel& object) {
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  print_row("voxels", std::to_string(lattice.counts[0]) + " x " +
                          std::to_string(lattice.counts[1]) + " x " +
                          std::to_string(lattice.counts[2]) + " of " +
                          shortest_decimal(lattice.voxel_size) + " m");
  print_row("classes", std::to_string(object.grid.count(geometry::VoxelClass::Empty)) + " empty, " +
                           std::to_string(object.grid.count(geometry::VoxelClass::Partial)) +
                           " partial, " +
                           std::to_string(object.grid.count(geometry::VoxelClass::Full)) + " full");
  const auto without_normal =
      std::count_if(object.patches.begin(), object.patches.end(),
                    [](const geometry::SurfacePatch& patch) { return !patch.has_normal; });
  print_row("patches", std::to_string(object.patches.size()) + ", " +
                           std::to_string(without_normal) + " without a normal");
}

std::string decimal_or_infinity(double value) {
  return std::isfinite(value) ? fixed_decimal(value, 4) : "infinity";
}

void print_scores(const grasp::ObjectModel& object, double threshold) {
  std::vector<double> scores = object.scores.scores;
  if (scores.empty()) return;
  std::sort(scores.begin(), scores.end());
  const auto quantile = [&scores](double share) {
    const auto index = static_cast<std::size_t>(share * static_cast<double>(scores.size() - 1));
    return decimal_or_infinity(scores[index]);
  };
  const auto above = std::count_if(scores.begin(), scores.end(),
                                   [threshold](double score) { return score > threshold; });
  print_row("scores", "lowest " + quantile(0.0) + ", 5% " + quantile(0.05) + ", median " +
                          quantile(0.5) + ", 95% " + quantile(0.95) + ", highest " + quantile(1.0));
  print_row("above threshold",
            std::to_string(above) + " patches (" +
                fixed_decimal(
                    100.0 * static_cast<double>(above) / static_cast<double>(scores.size()), 1) +
                "%) above " + shortest_decimal(threshold));
}

/// The thickness below which `share` of the surface's area lies.
double thickness_at(const std::vector<std::pair<double, double>>& thickness_and_area,
                    double share) {
  double total = 0.0;
  for (const auto& [thickness, area] : thickness_and_area) total += area;
  double sum = 0.0;
  for (const auto& [thickness, area] : thickness_and_area) {
    sum += area;
    if (sum >= share * total) return thickness;
  }
  return std::numeric_limits<double>::infinity();
}

void print_thickness(const geometry::MeshQuery& object) {
  constexpr std::size_t kMostMeasured = 5000;  // Half a second of rays; quantiles need no more.
  const geometry::TriangleMesh& mesh = object.mesh();
  const std::size_t step = (mesh.faces.size() + kMostMeasured - 1) / kMostMeasured;
  std::vector<std::int32_t> faces;
  for (std::size_t face = 0; face < mesh.faces.size(); face += step) {
    faces.push_back(base::as_index<std::int32_t>(face));
  }
  const std::vector<double> thickness = geometry::shape_diameter(object, faces).thickness;
  std::vector<std::pair<double, double>> thickness_and_area;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    thickness_and_area.emplace_back(thickness[i], geometry::vector_area(mesh, faces[i]).norm());
  }
  std::sort(thickness_and_area.begin(), thickness_and_area.end());
  std::string quantiles;
  for (const auto& [name, share] :
       {std::pair{"lowest ", 0.0}, {", 5% ", 0.05}, {", median ", 0.5}, {", 95% ", 0.95}}) {
    quantiles += name + decimal_or_infinity(thickness_at(thickness_and_area, share));
  }
  print_row("thickness", quantiles + " m (shares of the surface" +
                             (step > 1 ? ", one face in " + std::to_string(step) : "") + ")");
}

void print_weak(const geometry::TriangleMesh& mesh, const geometry::WeakRegions& weak) {
  double area = 0.0;
  double weak_area = 0.0;
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    const double own = geometry::vector_area(mesh, face).norm();
    area += own;
    if (weak.is_weak[face]) weak_area += own;
  }
  switch (weak.outcome) {
    case geometry::WeakOutcome::NothingLeft:
      return print_row("weak", "nothing: the object is thinner than that everywhere");
    case geometry::WeakOutcome::TooCoarse:
      return print_row("weak", "not known: the object is too large for that thickness");
    case geometry::WeakOutcome::Searched:
      break;
  }
  const std::array<const char*, 5> names = {"weak", "too short", "held at several places",
                                            "held all around", "on their own"};
  std::array<int, 5> counts{};
  for (const geometry::WeakRegion& region : weak.regions) {
    ++counts[static_cast<std::size_t>(region.verdict)];
  }
  std::string text = fixed_decimal(100.0 * weak_area / area, 1) +
                     "% of the surface; thin regions: " + std::to_string(weak.regions.size());
  for (std::size_t verdict = 0; verdict < counts.size(); ++verdict) {
    if (counts[verdict] == 0) continue;
    text += ", " + std::to_string(counts[verdict]) + ' ' + names[verdict];
  }
  print_row("weak", text);
}

/// Values of patches as one value per voxel; NaN where there is no surface.
std::vector<float> per_voxel(const grasp::ObjectModel& object, const std::vector<double>& values) {
  std::vector<float> result(object.patch_of_voxel.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t voxel = 0; voxel < std::ssize(result); ++voxel) {
    const auto patch = object.patch_in(voxel);
    if (patch) result[voxel] = static_cast<float>(values.at(*patch));
  }
  return result;
}

bool is_inspect_file(const std::string& name) {
  return name == "voxels.vti" || name == "score_map.vti" || name == "distance_map.vti" ||
         name == "patches.ply";
}

void write_files(const grasp::ObjectModel& object, OutputFolder& out) {
  const auto write = [&out](const std::string& name, const std::string& text) {
    base::write_file_atomically(out.staging() / name, text);
  };
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  std::vector<std::uint8_t> classes;
  classes.reserve(object.grid.classes.size());
  for (geometry::VoxelClass voxel_class : object.grid.classes) {
    classes.push_back(static_cast<std::uint8_t>(voxel_class));
  }
  write("voxels.vti", vtk_image(lattice, {cell_array("class_0empty_1partial_2full", classes)}));
  write("score_map.vti",
        vtk_image(lattice, {cell_array("score", per_voxel(object, object.scores.scores)),
                            cell_array("mean_plane_distance_voxels",
                                       per_voxel(object, object.scores.mean_plane_distance)),
                            cell_array("mean_normal_angle_deg",
                                       per_voxel(object, object.scores.mean_normal_angle_deg))}));
  write("distance_map.vti",
        vtk_image(lattice, {cell_array("signed_distance_voxels", object.distance.values)}));
  write("patches.ply", patches_ply(object));
  out.commit("patches.ply");
}

}  // namespace

ExitCode run_inspect(const std::vector<std::string>& arguments) {
  const Command command = inspect_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  grasp::PlannerOptions options;
  read_score_map_flags(flags, options);
  geometry::WeakRegionOptions weak_options;
  weak_options.weak_thickness = 1e-3 * flags.number("weak-thickness-mm", base::above(0));
  weak_options.validate();
  std::optional<hands::HandModel> hand;
  if (flags.has("hand")) hand = hands::find_hand(flags.text("hand"));
  std::optional<OutputFolder> out;
  if (flags.has("out")) out.emplace(flags.text("out"), is_inspect_file);

  ProgressBar progress(true);
  const grasp::ObjectFile object_file = load_object(flags, flags.positional());
  const bool is_solid =
      object_file.record.analysis.is_closed && object_file.record.analysis.is_outward;
  std::optional<grasp::ObjectModel> object;
  if (is_solid) {
    progress.show("voxels and contact scores");
    if (hand) {
      object = grasp::prepare_object(object_file.mesh, *hand, options);
    } else {
      grasp::ObjectModelOptions object_options;
      object_options.resolution = options.resolution;
      object_options.averaging = options.averaging;
      object_options.score = options.score;
      object = grasp::build_object_model(object_file.mesh, object_options);
    }
  } else if (out) {
    require_solid(object_file);
  }
  std::optional<geometry::WeakRegions> weak;
  if (object && !flags.has("no-thickness")) {
    progress.show("thickness and weak features");
    weak = geometry::cached_weak_regions(object->query, weak_options,
                                         {.is_on = !flags.has("no-cache")});
  }
  if (out) {
    progress.show("writing files");
    write_files(*object, *out);
  }
  progress.clear();

  print_mesh(object_file);
  if (object) {
    print_mass(*object);
    print_rest_poses(*object);
    print_voxels(*object);
    print_scores(*object, options.targets.score_threshold);
    if (weak) {
      print_thickness(object->query);
      print_weak(object->query.mesh(), *weak);
    }
  } else {
    print_row("voxels", "none: the surface bounds no solid");
  }
  if (out) print_row("written to", out->target().string());
  return kSuccess;
}

}  // namespace graspfit::app
