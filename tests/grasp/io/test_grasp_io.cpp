#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>

#include "grasp/grasp_file_sample.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_grasp_io {

namespace {

namespace fs = std::filesystem;
using namespace graspfit;
using geometry::RigidTransform;
using testing::Contains;
using testing::sample_file;
using testing::TemporaryFolder;
using testing::unusual_options;

/// Returns the message of the IoError that `read_grasps` throws for a text.
std::string refusal(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
  try {
    grasp::read_grasps(path);
  } catch (const base::IoError& error) {
    return error.what();
  }
  return "accepted";
}

/// Returns `text` with the first `from` behind the first `anchor` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to,
                     const std::string& anchor = "") {
  const std::size_t at = text.find(from, text.find(anchor));
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

struct CommaDecimals : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_CASE("A grasp file read again holds the same values", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile written = sample_file(folder.path() / "ball.off");
  grasp::write_grasps(folder.path() / "grasps.json", written);
  const grasp::GraspFile read = grasp::read_grasps(folder.path() / "grasps.json");

  CHECK(read.object.file == written.object.file);
  CHECK(read.object.sha256 == written.object.sha256);
  CHECK(read.object.center_of_mass_O == written.object.center_of_mass_O);
  CHECK(read.object.analysis.box.max() == written.object.analysis.box.max());
  REQUIRE(read.object.repairs.size() == 1);
  CHECK(read.object.repairs[0].volume_change == 1.25e-7);
  CHECK(read.object.repairs[0].hausdorff_bound == 0.003);
  CHECK(read.object.repair.weld_distance_rel == 0.001);
  CHECK(read.object.repair.self_intersections == geometry::SelfIntersections::Report);
  REQUIRE(read.object.repair.wrap);
  CHECK(read.object.repair.wrap->alpha_rel == 0.05);
  CHECK(read.object.repair.wrap->offset_rel == 0.01);
  CHECK(read.hand.name == written.hand.name);
  CHECK(read.surroundings.table_z_O == -0.2);
  REQUIRE(read.surroundings.obstacles.size() == 1);
  CHECK(read.surroundings.obstacles[0].sha256 == written.object.sha256);
  CHECK_FALSE(read.used_meshes);
  CHECK(read.palm == written.palm);
  CHECK(read.statistics.duplicates == written.statistics.duplicates);
  CHECK(read.statistics.refinement_iterations == written.statistics.refinement_iterations);
  CHECK(read.preset == "strong");
  CHECK(read.options.seed == written.options.seed);
  CHECK(read.options.approach_O == written.options.approach_O);
  CHECK(read.options.max_iterations == written.options.max_iterations);
  CHECK(read.options.wall_clock_limit_s == written.options.wall_clock_limit_s);
  CHECK(read.options.contact_score_threshold == written.options.contact_score_threshold);
  CHECK(read.options.score.normalization == written.options.score.normalization);
  CHECK(read.options.targets.pair_rule == written.options.targets.pair_rule);
  CHECK(read.options.quality.regularity == written.options.quality.regularity);
  CHECK(read.options.quality.theta_max == written.options.quality.theta_max);
  CHECK(read.fingers == written.fingers);
  CHECK(read.voxel_size == written.voxel_size);
  CHECK(read.stop == written.stop);
  CHECK(read.statistics.outcomes == written.statistics.outcomes);
  CHECK(read.statistics.target_failures == written.statistics.target_failures);
  CHECK(read.statistics.guidance == written.statistics.guidance);
  CHECK(read.options.planner == written.options.planner);
  CHECK(read.options.sampling.count == written.options.sampling.count);
  CHECK(read.options.medial_symmetry.rim_ratio == written.options.medial_symmetry.rim_ratio);
  CHECK(read.timings.fitting_s == written.timings.fitting_s);

  REQUIRE(read.grasps.size() == written.grasps.size());
  bool some_contact = false;
  for (std::size_t i = 0; i < read.grasps.size(); ++i) {
    const grasp::Grasp& a = written.grasps[i];
    const grasp::Grasp& b = read.grasps[i];
    CHECK(b.configuration.q == a.configuration.q);
    CHECK(b.configuration.X_OH.translation() == a.configuration.X_OH.translation());
    CHECK(b.refinement_iterations == a.refinement_iterations);
    REQUIRE(b.pre_grasp.has_value() == a.pre_grasp.has_value());
    if (a.pre_grasp) {
      CHECK(b.pre_grasp->configuration.q == a.pre_grasp->configuration.q);
      CHECK(b.pre_grasp->clearance == a.pre_grasp->clearance);
      CHECK(b.pre_grasp->opening == a.pre_grasp->opening);
      CHECK(b.pre_grasp->retreat == a.pre_grasp->retreat);
    }
    REQUIRE(b.squeeze.has_value() == a.squeeze.has_value());
    if (a.squeeze) {
      CHECK(b.squeeze->configuration.q == a.squeeze->configuration.q);
      CHECK(b.squeeze->forces_O == a.squeeze->forces_O);
      CHECK(b.squeeze->residual == a.squeeze->residual);
      CHECK(b.squeeze->is_balanced == a.squeeze->is_balanced);
      CHECK(b.squeeze->is_clamped == a.squeeze->is_clamped);
    }
    REQUIRE(b.wrench.has_value() == a.wrench.has_value());
    if (a.wrench) {
      CHECK(b.wrench->epsilon == a.wrench->epsilon);
      CHECK(b.wrench->volume == a.wrench->volume);
      CHECK(b.wrench->is_force_closure == a.wrench->is_force_closure);
      CHECK(b.wrench->rank == a.wrench->rank);
      CHECK(contact::describe(b.wrench->convention) == contact::describe(a.wrench->convention));
    }
    CHECK(b.penetration.surroundings_touched == a.penetration.surroundings_touched);
    CHECK(b.quality.m == a.quality.m);
    CHECK(b.quality.m3 == a.quality.m3);
    CHECK(b.quality.stable_pairs.size() == a.quality.stable_pairs.size());
    CHECK(b.ideal_m == a.ideal_m);
    CHECK(b.penetration.object_depth == a.penetration.object_depth);
    CHECK(b.penetration.object_link == a.penetration.object_link);
    CHECK(b.is_valid() == a.is_valid());
    CHECK(b.targets.contacts[0].score == a.targets.contacts[0].score);
    CHECK(!b.targets.contacts[0].finger);
    CHECK(!b.targets.contacts[0].is_palm);
    CHECK(!b.targets.contacts[0].patch);
    CHECK(b.targets.contacts[1].is_palm == a.targets.contacts[1].is_palm);
    CHECK(b.targets.contacts[1].finger == a.targets.contacts[1].finger);
    REQUIRE(b.contacts.size() == a.contacts.size());
    for (std::size_t j = 0; j < a.contacts.size(); ++j) {
      some_contact = true;
      CHECK(b.contacts[j].point_O == a.contacts[j].point_O);
      CHECK(b.contacts[j].area == a.contacts[j].area);
      CHECK(b.contacts[j].pad == a.contacts[j].pad);
      CHECK(b.contacts[j].finger == a.contacts[j].finger);
      CHECK(b.contacts[j].weak == a.contacts[j].weak);
      CHECK(b.contacts[j].is_target == a.contacts[j].is_target);
    }
  }
  CHECK(some_contact);
}

TEST_CASE("Every option of the planner comes back from a grasp file", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  file.grasps.clear();
  file.options = unusual_options();
  const std::string usual = [&file] {
    grasp::GraspFile other = file;
    other.options = {};
    return grasp::to_json(other);
  }();
  grasp::write_grasps(folder.path() / "grasps.json", file);
  const std::string once = base::read_file(folder.path() / "grasps.json");
  grasp::write_grasps(folder.path() / "grasps.json",
                      grasp::read_grasps(folder.path() / "grasps.json"));
  CHECK(base::read_file(folder.path() / "grasps.json") == once);
  // Were a field written that the reader forgets, the second file would have its default.
  for (const std::string field : {"style",
                                  "palm",
                                  "approach_angle_rad",
                                  "weak_thickness_m",
                                  "trim_deviations",
                                  "exclude_weak",
                                  "give_up_distance_m",
                                  "ideal_m_bias",
                                  "ideal_m_draws",
                                  "angle_weight",
                                  "pool_spacing_m",
                                  "palm_reach_tolerance_m",
                                  "refine",
                                  "wanted_gap_m",
                                  "largest_gap_m",
                                  "least_distance_m",
                                  "reach_m",
                                  "largest_shift_m",
                                  "largest_turn_rad",
                                  "pre_grasps",
                                  "largest_retreat_m",
                                  "retreat_step_m",
                                  "opening_steps",
                                  "way_tolerance_m",
                                  "normal_sum_N",
                                  "stiffness_N_m_per_rad",
                                  "slide_stiffness_N_per_m",
                                  "slide_scale_m",
                                  "largest_residual",
                                  "translation_m",
                                  "rotation_rad",
                                  "joints_rad",
                                  "friction",
                                  "units"}) {
    INFO(field);
    const auto line = [&field](const std::string& text) {
      const std::size_t at = text.find('"' + field + "\": ", text.find("\"options\": "));
      REQUIRE(at != std::string::npos);
      return text.substr(at, text.find('\n', at) - at);
    };
    CHECK(line(once) != line(usual));
  }
}

TEST_CASE("Link poses survive the way through a quaternion to 1e-15", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile written = sample_file(folder.path() / "ball.off");
  grasp::write_grasps(folder.path() / "grasps.json", written);
  const grasp::GraspFile read = grasp::read_grasps(folder.path() / "grasps.json");
  for (std::size_t i = 0; i < read.grasps.size(); ++i) {
    const auto a = hands::forward_kinematics(written.hand, written.grasps[i].configuration);
    const auto b = hands::forward_kinematics(read.hand, read.grasps[i].configuration);
    for (std::size_t link = 0; link < a.size(); ++link) {
      // Rotations differ by some roundings of 1.1e-16, translations by that times lengths below 0.4
      // m.
      CHECK((a[link].linear() - b[link].linear()).cwiseAbs().maxCoeff() < 2e-15);
      CHECK((a[link].translation() - b[link].translation()).cwiseAbs().maxCoeff() < 1e-15);
    }
  }
}

TEST_CASE("M computed again from a grasp file and the object is that of the file",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::write_grasps(folder.path() / "grasps.json", sample_file(folder.path() / "ball.off"));
  const grasp::GraspFile file = grasp::read_grasps(folder.path() / "grasps.json");
  const geometry::TriangleMesh mesh = grasp::read_object(file.object);
  grasp::Surroundings surroundings;
  surroundings.table_z_O = file.surroundings.table_z_O;
  const grasp::RecordedScene scene(file, mesh, surroundings);
  for (const grasp::Grasp& stored : file.grasps) {
    const grasp::Grasp again = scene.measure(stored);
    // The poses move by about 1e-16 m, and contact areas and points follow continuously.
    CHECK(again.quality.m == Approx(stored.quality.m).margin(1e-12));
    CHECK(again.quality.m1 == Approx(stored.quality.m1).margin(1e-12));
    CHECK(again.contacts.size() == stored.contacts.size());
  }
}

TEST_CASE("The program's locale does not change a byte of grasp files", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  const std::string json = grasp::to_json(file);
  const std::string csv = grasp::to_csv(file);
  const std::string obj =
      grasp::posed_scene_obj(geometry::ball(0.05, 1), file.hand, file.grasps[0].configuration);

  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimals));
  const std::string json_with_commas = grasp::to_json(file);
  const std::string csv_with_commas = grasp::to_csv(file);
  const std::string obj_with_commas =
      grasp::posed_scene_obj(geometry::ball(0.05, 1), file.hand, file.grasps[0].configuration);
  grasp::write_grasps(folder.path() / "grasps.json", file);
  const double read_voxel_size = grasp::read_grasps(folder.path() / "grasps.json").voxel_size;
  std::locale::global(before);

  CHECK(json == json_with_commas);
  CHECK(csv == csv_with_commas);
  CHECK(obj == obj_with_commas);
  CHECK(read_voxel_size == file.voxel_size);
}

TEST_CASE("Timings are the only thing that a second run changes", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  const std::string first = grasp::to_json(file);
  file.timings.total_s = 99.0;
  const std::string second = grasp::to_json(file);
  CHECK(first != second);
  const std::size_t timings = first.find("\n  \"timings\": ");
  REQUIRE(timings != std::string::npos);
  CHECK(first.substr(0, timings) == second.substr(0, timings));
}

TEST_CASE("Numbers of a grasp file are as short as they can be", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const std::string json = grasp::to_json(sample_file(folder.path() / "ball.off"));
  // Grisu2, which the JSON library prints with, gives 0.1 as such too, but not every number.
  CHECK_THAT(json, Contains("\"alpha\": 0.1,"));
  CHECK_THAT(json, Contains("\"approach_O\": [0.1, -0.3333333333333333, 0.7]"));
  CHECK_THAT(json, Contains("\"seed\": 18446744073709551615,"));
  CHECK_THAT(json, Contains("\"weak\": null"));
  CHECK_THAT(json, Contains("\"score\": \"infinity\""));
}

TEST_CASE("Distances that are left to the planner are 0 in a grasp file", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "distances.json";
  const std::string left_open = grasp::to_json(sample_file(folder.path() / "ball.off"));
  CHECK(refusal(path, replaced(left_open, "\"min_separation_m\": 0,",
                               "\"min_separation_m\": 0.25,")) == "accepted");
  CHECK(grasp::read_grasps(path).options.targets.min_separation == 0.25);
  CHECK_THAT(
      refusal(path, replaced(left_open, "\"min_separation_m\": 0,", "\"min_separation_m\": null,")),
      Contains("min_separation_m: is null, must be a number"));
  CHECK_THAT(refusal(path, replaced(left_open, "\"merge_distance_m\": 0",
                                    "\"merge_distance_m\": null", "\"quality\"")),
             Contains("merge_distance_m: is null, must be a number"));
  CHECK(refusal(path, left_open) == "accepted");
  CHECK_FALSE(grasp::read_grasps(path).options.targets.min_separation);
  CHECK_FALSE(grasp::read_grasps(path).options.quality.merge_distance);
}

TEST_CASE("Files of version 5 are read: their convention of graspfit had another name",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const std::string now = grasp::to_json(sample_file(folder.path() / "ball.off"));
  const fs::path path = folder.path() / "old.json";
  const std::string named = replaced(now, "\"tool\": \"graspit\"", "\"tool\": \"house\"");
  CHECK_THAT(refusal(path, named), Contains("/convention/tool: is \"house\""));
  CHECK(refusal(path, replaced(named, "\"version\": 6", "\"version\": 5")) == "accepted");
  const std::vector<grasp::Grasp> grasps = grasp::read_grasps(path).grasps;
  CHECK(std::any_of(grasps.begin(), grasps.end(), [](const grasp::Grasp& grasp) {
    return grasp.wrench && grasp.wrench->convention.tool == contact::WrenchTool::Graspfit;
  }));
}

TEST_CASE("Options that a file lacks have their defaults, what is no option is refused",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const std::string now = grasp::to_json(sample_file(folder.path() / "ball.off"));
  const fs::path path = folder.path() / "older.json";
  CHECK_THAT(refusal(path, replaced(now, "\"alpha\": ", "\"alpah\": ")),
             Contains("/planner/options/quality/alpah: is not a member that is known here") &&
                 Contains("alpha"));
  CHECK_THAT(refusal(path, replaced(now, "\"search\": \"", "\"serach\": \"")),
             Contains("serach: is not a member"));
  std::string without = replaced(now, "\"alpha\": 0.1,", "");
  without = replaced(without, "\"candidate_order\": \"balance\",", "");
  CHECK(refusal(path, without) == "accepted");
  const grasp::PlannerOptions options = grasp::read_grasps(path).options;
  CHECK(options.quality.alpha == grasp::PlannerOptions{}.quality.alpha);
  CHECK(options.quality.alpha != 0.1);
  CHECK(options.candidate_order == grasp::CandidateOrder::Pads);
  CHECK(options.kept == grasp::KeptCandidate::Balanced);
}

TEST_CASE("Files of version 4 are read: their one choice was order and choice of candidates",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const std::string now = grasp::to_json(sample_file(folder.path() / "ball.off"));
  const fs::path path = folder.path() / "old.json";
  for (const auto& [choice, order, kept] :
       {std::tuple("first", grasp::CandidateOrder::Pads, grasp::KeptCandidate::First),
        std::tuple("balanced", grasp::CandidateOrder::Balance, grasp::KeptCandidate::Balanced),
        std::tuple("strongest", grasp::CandidateOrder::Balance, grasp::KeptCandidate::Strongest)}) {
    CAPTURE(choice);
    std::string old = replaced(now, "\"version\": 6", "\"version\": 4");
    old = replaced(old, "\"candidate_order\": \"balance\"",
                   "\"attempt_choice\": \"" + std::string(choice) + '"');
    old = replaced(old, "\"kept_candidate\": \"balanced\",", "");
    base::write_file_atomically(path, old);
    const grasp::GraspFile file = grasp::read_grasps(path);
    CHECK(file.options.candidate_order == order);
    CHECK(file.options.kept == kept);
    CHECK(file.grasps.size() == sample_file(folder.path() / "ball.off").grasps.size());
  }
}

TEST_CASE("The pad that a target is for comes back, and is refused where it is not of its finger",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  const fs::path path = folder.path() / "grasps.json";
  grasp::TargetContact& target = file.grasps.front().targets.contacts[1];
  target.finger = file.hand.finger_index("finger_2");
  target.pad = file.hand.pad_index("finger_2_proximal_pad");
  const std::string text = grasp::to_json(file);
  CHECK(refusal(path, text) == "accepted");
  const grasp::GraspFile read = grasp::read_grasps(path);
  CHECK(read.grasps.front().targets.contacts[0].pad == std::nullopt);
  CHECK(read.grasps.front().targets.contacts[1].pad == target.pad);
  const std::string wrong = replaced(text, "\"pad\": \"finger_2_proximal_pad\"",
                                     "\"pad\": \"thumb_proximal_pad\"", "\"targets\"");
  CHECK_THAT(refusal(path, wrong),
             Contains("/results/grasps/0/targets/contacts/1/pad: pad \"thumb_proximal_pad\" is not "
                      "of the target's finger"));
}

TEST_CASE("A file that is not a grasp file is refused with the place and the reason",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const std::string good = grasp::to_json(sample_file(folder.path() / "ball.off"));
  const fs::path path = folder.path() / "bad.json";
  CHECK(refusal(path, good) == "accepted");

  CHECK_THAT(refusal(path, ""), Contains("bad.json: is not JSON"));
  CHECK_THAT(refusal(path, good.substr(0, good.size() / 2)), Contains("is not JSON"));
  // The nesting is refused in a member that nobody reads, too, as the whole file becomes a tree.
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  CHECK_THAT(refusal(path, "{\"unread\": " + deep + good.substr(1).insert(0, ",")),
             Contains("bad.json: line 1, column 75: nests deeper than 64 levels"));
  CHECK_THAT(refusal(path, "[]"), Contains("/: is [], must be an object"));
  CHECK_THAT(refusal(path, "{}"), Contains("/format: is missing"));
  CHECK_THAT(refusal(path, replaced(good, "\"version\": 6", "\"version\": 1")),
             Contains("/version: is 1; this program reads versions 4 to 6"));
  CHECK_THAT(
      refusal(path, replaced(good, "\"torque_scale_m\": 0.05,", "\"torque_scale_m\": null,")),
      Contains("/convention/torque_scale_m: is null, must be a number"));
  CHECK_THAT(refusal(path, replaced(good, "\"norm\": \"l1\"", "\"norm\": \"l2\"")),
             Contains("/convention/norm: is \"l2\", must be one of l1"));
  CHECK_THAT(refusal(path, replaced(good, "\"outside\": \"minus-one\"", "\"outside\": \"far\"")),
             Contains("/results/grasps/0/wrench/convention/outside: is \"far\"") &&
                 Contains("zero|minus-one|signed"));
  CHECK_THAT(refusal(path, replaced(good, "\"forces_O_N\": [", "\"forces_O_N\": [[0, 0, 0], ")),
             Contains("/results/grasps/1/squeeze/forces_O_N: has"));
  CHECK_THAT(refusal(path, replaced(good, "\"alpha\": 0.1", "\"alpha\": 1e999")),
             Contains("bad.json"));
  CHECK_THAT(refusal(path, replaced(good, "\"stop\": \"wall-clock\"", "\"stop\": 3")),
             Contains("/results/stop: is 3, must be a text"));
  CHECK_THAT(refusal(path, replaced(good, "\"no way in\": ", "\"no way out\": ")),
             Contains("/results/statistics/outcomes/no way out: is not an outcome"));
  CHECK_THAT(refusal(path, replaced(good, "\"alpha\": 0.1", "\"alpha\": -0.1")),
             Contains("/planner/options: ") && Contains("alpha"));
  CHECK_THAT(
      refusal(path, replaced(good, "\"rotation_wxyz\": [", "\"rotation_wxyz\": [2, ", "\"X_OH\"")),
      Contains("/results/grasps/0/X_OH/rotation_wxyz: has 5 of 4 numbers"));
  CHECK_THAT(refusal(path, replaced(good, "\"voxel_size_m\": ", "\"voxel_size_m\": -")),
             Contains("/planner/used/voxel_size_m: is -") && Contains("must be > 0"));
  CHECK_THAT(
      refusal(path, replaced(good, "\"fingers\": [", "\"fingers\": [\"pinky\", ", "\"used\"")),
      Contains("/planner/used/fingers/0: the hand has nothing named \"pinky\""));
  // Only options and raw scores may be infinite, and only a target may lack its finger.
  CHECK_THAT(refusal(path, replaced(good, "\"area_m2\": ", "\"area_m2\": \"infinity\", \"was\": ",
                                    "\"results\"")),
             Contains("/contacts/0/area_m2: is \"infinity\", must be a number"));
  CHECK_THAT(
      refusal(path, replaced(good, "\"finger\": ", "\"finger\": null, \"was\": ", "\"results\"")),
      Contains("/contacts/0/finger: is null, must be a text"));
  const std::string hash = sample_file(folder.path() / "ball.off").hand.sidecar_sha256;
  CHECK_THAT(refusal(path, replaced(good, hash, std::string(64, 'f'))), Contains("sidecar"));
}

TEST_CASE("The table has a row per grasp and a unit in every column that needs one",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  std::istringstream csv(grasp::to_csv(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  REQUIRE(lines.size() == 1 + file.grasps.size());
  for (const char* column :
       {"largest_penetration_m", "epsilon", "largest_requested_gap_m", "palm_touches",
        "pre_grasp_clearance_m", "pre_grasp_palm_x_m", "squeeze_residual"}) {
    CHECK_THAT(lines[0], Contains(column));
  }
  CHECK_THAT(lines[0], Contains(file.hand.joints[0].name + "_rad"));
  const auto num_commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  for (const std::string& line : lines) CHECK(num_commas(line) == num_commas(lines[0]));
}

}  // namespace

}  // namespace test_grasp_io
