#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace {

namespace fs = std::filesystem;
using namespace graspfit;
using Catch::Matchers::Contains;
using geometry::RigidTransform;

/// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "graspfit-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// Every field away from its default, so that one that is not written, or not read, shows.
grasp::PlannerOptions unusual_options() {
  grasp::PlannerOptions options;
  options.style = grasp::GraspStyle::Power;
  options.palm = false;
  options.seed = 18446744073709551615U;  // the largest there is
  options.search = grasp::SearchRule::First;
  options.acceptance = grasp::Acceptance::Quality;
  options.count = 7;
  options.max_attempts = 77;
  options.approach_O = Eigen::Vector3d(0.1, -1.0 / 3.0, 0.7);
  options.approach_angle = 0.4;
  options.wall_clock_limit_s = 12.5;
  options.resolution = 31;
  options.clip_thickness = 0.1;
  options.score.normalization = grasp::ScoreNormalization::Raw;
  options.weak->weak_thickness = 0.004;
  options.weak->min_length_ratio = 1.5;
  options.weak->shape_diameter.trim_deviations = std::numeric_limits<double>::infinity();
  options.targets.pair_rule = grasp::PairRule::AllPairs;
  options.targets.search = grasp::TargetSearch::Ranked;
  options.targets.exclude_weak = false;
  options.targets.ideal_m_bias = 1.25;
  options.targets.ideal_m_draws = 9;
  options.targets.angle_weight = 0.5;
  options.targets.pool_spacing = 0.01;
  options.targets.palm_reach_tolerance = 0.02;
  options.target_draws = 3;
  options.max_placements = 2;
  options.fitting.give_up_distance = 0.02;
  options.fitting.guard = grasp::PenetrationGuard::Voxels;
  options.refine = false;
  options.refinement.wanted_gap = 3e-5;
  options.refinement.largest_gap = 3e-4;
  options.refinement.least_distance = 2e-6;
  options.refinement.max_iterations = 61;
  options.refinement.slide_steps = 3;
  options.refinement.reach = 0.04;
  options.refinement.largest_shift = 0.01;
  options.refinement.largest_turn = 0.25;
  options.self_overlap = 0.002;
  options.pre_grasps = false;
  options.pre_grasp.clearance = 0.006;
  options.pre_grasp.largest_retreat = 0.2;
  options.pre_grasp.retreat_step = 0.02;
  options.pre_grasp.opening_steps = 11;
  options.pre_grasp.way_tolerance = 2e-5;
  options.squeeze.normal_sum = 12.0;
  options.squeeze.stiffness = 4.0;
  options.squeeze.slide_stiffness = 2100.0;
  options.squeeze.largest_residual = 0.06;
  options.distinct.translation = 0.02;
  options.distinct.rotation = 0.3;
  options.distinct.joints = 0.4;
  options.distinct.slide_scale = 0.2;
  options.friction = 0.7;
  options.quality.regularity = grasp::Regularity::EdgeOnly;
  options.quality.units = grasp::MeasureUnits::Centimeters;
  options.quality.alpha = 0.1;
  return options;
}

/// A Barrett hand in some pose around a ball of 5 cm radius, measured as the planner measures.
grasp::GraspFile sample_file(const fs::path& object_file) {
  geometry::write_mesh(object_file, geometry::ball(0.05, 2));
  const grasp::ObjectFile object = grasp::read_object_file(object_file);

  grasp::GraspFile file;
  file.object = object.record;
  file.object.repairs = {{"filled holes", 2, 1.25e-7, 0.003}};
  file.object.repair.weld_distance_rel = 0.001;
  file.object.repair.self_intersections = geometry::SelfIntersections::Report;
  file.object.repair.wrap = geometry::AlphaWrap{.alpha_rel = 0.05, .offset_rel = 0.01};
  file.hand = hands::find_hand("barrett");
  file.link_mesh_sha256.resize(file.hand.links.size());
  for (std::size_t i = 0; i < file.hand.links.size(); ++i) {
    if (file.hand.links[i].mesh_files.empty()) continue;
    file.link_mesh_sha256[i] = geometry::sha256_hex(geometry::read_file(
        fs::path(file.hand.description_file).parent_path() / file.hand.links[i].mesh_files.at(0)));
  }
  file.options = unusual_options();
  file.options.quality.units = grasp::MeasureUnits::Normalized;
  file.options.weak.reset();  // a search takes seconds
  file.surroundings.table_z_O = -0.2;
  file.surroundings.obstacles.push_back(object.record);
  file.fingers = {"thumb", "finger_1", "finger_2"};
  file.voxel_size = 0.1 / 30.0;
  file.clip_thickness = 0.1;  // so thick that every pad meets the ball
  file.merge_distance = 0.1 * file.voxel_size;
  file.stop = grasp::PlannerStop::WallClock;
  file.statistics.attempts = 5;
  for (int i = 0; i <= static_cast<int>(grasp::AttemptOutcome::PoorShape); ++i) {
    file.statistics.outcomes[static_cast<grasp::AttemptOutcome>(i)] = i;
  }
  file.statistics.target_failures["no seed"] = 3;
  file.statistics.duplicates = 2;
  file.statistics.refinement_iterations = 123;
  file.timings.fitting_s = 0.25;

  grasp::Surroundings surroundings;
  surroundings.table_z_O = file.surroundings.table_z_O;
  const grasp::RecordedScene scene(file, object.mesh, surroundings);
  geometry::Random random(3);
  for (int i = 0; i < 4; ++i) {
    hands::HandConfiguration configuration = hands::open_configuration(file.hand);
    for (Eigen::Index j = 0; j < configuration.q.size(); ++j) {
      const hands::Joint& joint = file.hand.joints[static_cast<std::size_t>(j)];
      configuration.q[j] = random.uniform(joint.lower, 0.4 * joint.upper);
    }
    hands::apply_couplings(file.hand, configuration.q);
    const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    configuration.X_OH =
        Eigen::Translation3d(0.0, 0.0, 0.0) *
        Eigen::AngleAxisd(random.uniform(-3.14, 3.14), axis.normalized()) *
        Eigen::Translation3d(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), -0.15);
    grasp::Grasp measured = scene.measure(configuration);
    measured.attempt = i;
    measured.ideal_m = 1.0 / 3.0;
    measured.targets.contacts.resize(2);
    measured.targets.contacts[0].score = std::numeric_limits<double>::infinity();
    measured.targets.contacts[1].finger = 1;
    measured.refinement_iterations = 10 + i;
    if (i == 1) {
      measured.pre_grasp = grasp::PreGrasp{hands::open_configuration(file.hand), 0.011, 0.7, 0.03};
      measured.squeeze = grasp::Squeeze{
          configuration,
          Eigen::Matrix3Xd::Random(3, static_cast<Eigen::Index>(measured.contacts.size())), 0.125,
          false, true};
    }
    if (i == 3) {
      measured.wrench = {0.0625, 0.5, true, 6, {}};
      measured.wrench.convention.tool = grasp::WrenchTool::GraspIt;
      measured.wrench.convention.reference_point_O = Eigen::Vector3d(0.1, 0.2, 0.3);
      measured.wrench.convention.options = {.num_cone_edges = 6,
                                            .friction = 0.7,
                                            .torque_scale = 0.05,
                                            .force_scaling = grasp::ForceScaling::UnitEdge,
                                            .force_limit = 2.0,
                                            .outside = grasp::OutsideValue::MinusOne};
      measured.penetration.surroundings_touched = true;
      measured.targets.contacts[1].finger = grasp::kPalm;
    }
    if (!measured.contacts.empty()) measured.contacts[0].weak = i == 2;
    file.grasps.push_back(measured);
  }
  return file;
}

/// The message of the IoError that `read_grasps` throws for a text.
std::string refusal(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
  try {
    grasp::read_grasps(path);
  } catch (const geometry::IoError& error) {
    return error.what();
  }
  return "accepted";
}

/// `text` with the first `from` behind the first `anchor` replaced.
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
  const grasp::GraspFile written = sample_file(folder / "ball.off");
  grasp::write_grasps(folder / "grasps.json", written);
  const grasp::GraspFile read = grasp::read_grasps(folder / "grasps.json");

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
  CHECK(read.options.seed == written.options.seed);
  CHECK(read.options.approach_O == written.options.approach_O);
  CHECK(read.options.wall_clock_limit_s == written.options.wall_clock_limit_s);
  CHECK(read.options.score.normalization == written.options.score.normalization);
  CHECK(read.options.targets.pair_rule == written.options.targets.pair_rule);
  CHECK(read.options.quality.regularity == written.options.quality.regularity);
  CHECK(read.options.quality.theta_max == written.options.quality.theta_max);
  CHECK(read.fingers == written.fingers);
  CHECK(read.voxel_size == written.voxel_size);
  CHECK(read.stop == written.stop);
  CHECK(read.statistics.outcomes == written.statistics.outcomes);
  CHECK(read.statistics.target_failures == written.statistics.target_failures);
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
    CHECK(b.wrench.epsilon == a.wrench.epsilon);
    CHECK(b.wrench.volume == a.wrench.volume);
    CHECK(b.wrench.is_force_closure == a.wrench.is_force_closure);
    CHECK(b.wrench.rank == a.wrench.rank);
    if (!std::isnan(a.wrench.convention.options.torque_scale)) {
      CHECK(grasp::describe(b.wrench.convention) == grasp::describe(a.wrench.convention));
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
    CHECK(b.targets.contacts[0].finger == grasp::kUnassigned);
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
  grasp::GraspFile file = sample_file(folder / "ball.off");
  file.grasps.clear();
  file.options = unusual_options();
  const std::string usual = [&file] {
    grasp::GraspFile other = file;
    other.options = {};
    return grasp::to_json(other);
  }();
  grasp::write_grasps(folder / "grasps.json", file);
  const std::string once = geometry::read_file(folder / "grasps.json");
  grasp::write_grasps(folder / "grasps.json", grasp::read_grasps(folder / "grasps.json"));
  CHECK(geometry::read_file(folder / "grasps.json") == once);
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

TEST_CASE("Meshes as used are written beside a grasp file, which names them", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder / "ball.off");
  const geometry::TriangleMesh object = grasp::read_object(file.object);
  const grasp::Surroundings surroundings = grasp::read_surroundings(file.surroundings);
  REQUIRE(surroundings.obstacles.size() == 1);
  fs::create_directory(folder / "out");
  file.used_meshes = grasp::write_used_meshes(folder / "out", file.hand, object, surroundings);
  grasp::write_grasps(folder / "out/grasps.json", file);

  const grasp::GraspFile read = grasp::read_grasps(folder / "out/grasps.json");
  REQUIRE(read.used_meshes);
  const auto mesh = [&folder](const std::string& name) {
    return geometry::read_mesh(folder / ("out/" + name)).mesh;
  };
  CHECK(mesh(read.used_meshes->object) == object);
  REQUIRE(read.used_meshes->obstacles.size() == 1);
  CHECK(mesh(read.used_meshes->obstacles[0]) == object);
  REQUIRE(read.used_meshes->links.size() == file.hand.links.size());
  for (std::size_t i = 0; i < file.hand.links.size(); ++i) {
    const geometry::TriangleMesh& link = file.hand.links[i].mesh_L;
    CHECK(read.used_meshes->links[i].empty() == link.faces.empty());
    if (!link.faces.empty()) CHECK(mesh(read.used_meshes->links[i]) == link);
  }
}

TEST_CASE("An obstacle that has changed is not taken for the recorded one", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder / "ball.off");
  CHECK(grasp::read_surroundings(file.surroundings).table_z_O == -0.2);
  std::ofstream(folder / "ball.off", std::ios::app) << "# changed\n";
  CHECK_THROWS_WITH(grasp::read_surroundings(file.surroundings),
                    Contains("ball.off") && Contains("SHA-256"));
}

TEST_CASE("A hand with package:// and file:// meshes, two on one link, is recorded and found again",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const fs::path shipped = hands::shipped_hand_file("barrett");
  fs::copy(shipped.parent_path(), folder / "hand", fs::copy_options::recursive);
  const fs::path description = folder / "hand" / shipped.filename();
  std::string urdf = geometry::read_file(description);
  const auto replace_all = [&urdf](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = urdf.find(from, at)) != std::string::npos; at += to.size()) {
      urdf.replace(at, from.size(), to);
    }
  };
  // The palm's mesh twice: two closed parts that happen to coincide.
  const std::string palm = "<mesh filename=\"meshes/palm.obj\"/>";
  const std::string again = "</geometry></collision><collision><geometry>";
  REQUIRE(urdf.find(palm) != std::string::npos);
  const std::string start = "<collision><geometry>";
  const std::string from_file =
      "<mesh filename=\"file://" + (folder / "hand/meshes/palm.obj").string() + "\"/>";
  replace_all(start + palm, start + from_file + again + palm);
  replace_all("\"meshes/", "\"package://barrett_description/meshes/");
  std::ofstream(description) << urdf;

  const hands::HandModel hand = hands::read_hand_model(description);
  const fs::path palm_file = folder / "hand/meshes/palm.obj";
  CHECK(hand.links[0].mesh_files == std::vector<std::string>{"meshes/palm.obj", "meshes/palm.obj"});

  geometry::write_mesh(folder / "ball.off", geometry::ball(0.05, 2));
  const grasp::ObjectFile object = grasp::read_object_file(folder / "ball.off");
  grasp::PlannerOptions options;
  options.resolution = 10;
  const grasp::ObjectModel model = grasp::prepare_object(object.mesh, hand, options);
  grasp::write_grasps(folder / "grasps.json",
                      grasp::make_grasp_file(object.record, hand, options, model, {}));
  const grasp::GraspFile read = grasp::read_grasps(folder / "grasps.json");
  const std::string bytes = geometry::read_file(palm_file);
  CHECK(read.link_mesh_sha256[0] == geometry::sha256_hex(bytes + bytes));

  std::ofstream(palm_file, std::ios::app) << "# another file now\n";
  CHECK_THROWS_AS(grasp::read_grasps(folder / "grasps.json"), geometry::IoError);
}

TEST_CASE("Link poses survive the way through a quaternion to 1e-15", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile written = sample_file(folder / "ball.off");
  grasp::write_grasps(folder / "grasps.json", written);
  const grasp::GraspFile read = grasp::read_grasps(folder / "grasps.json");
  for (std::size_t i = 0; i < read.grasps.size(); ++i) {
    const auto a = hands::forward_kinematics(written.hand, written.grasps[i].configuration);
    const auto b = hands::forward_kinematics(read.hand, read.grasps[i].configuration);
    for (std::size_t link = 0; link < a.size(); ++link) {
      // Some roundings of 1.1e-16 in rotations, times lengths below 0.4 m for translations.
      CHECK((a[link].linear() - b[link].linear()).cwiseAbs().maxCoeff() < 2e-15);
      CHECK((a[link].translation() - b[link].translation()).cwiseAbs().maxCoeff() < 1e-15);
    }
  }
}

TEST_CASE("M computed again from a grasp file and the object is that of the file",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::write_grasps(folder / "grasps.json", sample_file(folder / "ball.off"));
  const grasp::GraspFile file = grasp::read_grasps(folder / "grasps.json");
  const geometry::TriangleMesh mesh = grasp::read_object(file.object);
  grasp::Surroundings surroundings;
  surroundings.table_z_O = file.surroundings.table_z_O;
  const grasp::RecordedScene scene(file, mesh, surroundings);
  for (const grasp::Grasp& stored : file.grasps) {
    const grasp::Grasp again = scene.measure(stored.configuration);
    // The poses moved by about 1e-16 m; contact areas and points follow continuously.
    CHECK(again.quality.m == Approx(stored.quality.m).margin(1e-12));
    CHECK(again.quality.m1 == Approx(stored.quality.m1).margin(1e-12));
    CHECK(again.contacts.size() == stored.contacts.size());
  }
}

TEST_CASE("The program's locale does not change a byte of grasp files", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder / "ball.off");
  const std::string json = grasp::to_json(file);
  const std::string csv = grasp::to_csv(file);
  const std::string obj =
      grasp::posed_scene_obj(geometry::ball(0.05, 1), file.hand, file.grasps[0].configuration);

  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaDecimals));
  const std::string json_with_commas = grasp::to_json(file);
  const std::string csv_with_commas = grasp::to_csv(file);
  const std::string obj_with_commas =
      grasp::posed_scene_obj(geometry::ball(0.05, 1), file.hand, file.grasps[0].configuration);
  grasp::write_grasps(folder / "grasps.json", file);
  const double read_voxel_size = grasp::read_grasps(folder / "grasps.json").voxel_size;
  std::locale::global(before);

  CHECK(json == json_with_commas);
  CHECK(csv == csv_with_commas);
  CHECK(obj == obj_with_commas);
  CHECK(read_voxel_size == file.voxel_size);
}

TEST_CASE("Timings are the only thing that a second run changes", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder / "ball.off");
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
  const std::string json = grasp::to_json(sample_file(folder / "ball.off"));
  // Grisu2, which the JSON library prints with, gives 0.1 as such too, but not every number.
  CHECK_THAT(json, Contains("\"alpha\": 0.1,"));
  CHECK_THAT(json, Contains("\"approach_O\": [0.1, -0.3333333333333333, 0.7]"));
  CHECK_THAT(json, Contains("\"seed\": 18446744073709551615,"));
  CHECK_THAT(json, Contains("\"weak\": null"));
  CHECK_THAT(json, Contains("\"score\": \"infinity\""));
}

TEST_CASE("A file that is not a grasp file is refused with the place and the reason",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const std::string good = grasp::to_json(sample_file(folder / "ball.off"));
  const fs::path path = folder / "bad.json";
  CHECK(refusal(path, good) == "accepted");

  CHECK_THAT(refusal(path, ""), Contains("bad.json: is not JSON"));
  CHECK_THAT(refusal(path, good.substr(0, good.size() / 2)), Contains("is not JSON"));
  CHECK_THAT(refusal(path, "[]"), Contains("/: is not an object"));
  CHECK_THAT(refusal(path, "{}"), Contains("/format: is missing"));
  CHECK_THAT(refusal(path, replaced(good, "\"version\": 2", "\"version\": 1")),
             Contains("/version: is 1; this program reads version 2"));
  CHECK_THAT(refusal(path, replaced(good, "\"outside\": \"minus-one\"", "\"outside\": \"far\"")),
             Contains("/results/grasps/0/wrench/convention/outside: is \"far\"") &&
                 Contains("zero|minus-one|signed"));
  CHECK_THAT(refusal(path, replaced(good, "\"forces_O_N\": [", "\"forces_O_N\": [[0, 0, 0], ")),
             Contains("/results/grasps/1/squeeze/forces_O_N: has"));
  CHECK_THAT(refusal(path, replaced(good, "\"alpha\": 0.1", "\"alpha\": 1e999")),
             Contains("bad.json"));
  CHECK_THAT(refusal(path, replaced(good, "\"stop\": \"wall-clock\"", "\"stop\": 3")),
             Contains("/results/stop: is not a text"));
  CHECK_THAT(refusal(path, replaced(good, "\"alpha\": 0.1", "\"alpha\": -0.1")),
             Contains("/planner/options: ") && Contains("alpha"));
  CHECK_THAT(
      refusal(path, replaced(good, "\"rotation_wxyz\": [", "\"rotation_wxyz\": [2, ", "\"X_OH\"")),
      Contains("/results/grasps/0/X_OH/rotation_wxyz: has 5 numbers, not 4"));
  CHECK_THAT(refusal(path, replaced(good, "\"voxel_size_m\": ", "\"voxel_size_m\": -")),
             Contains("/planner/used/voxel_size_m: is -") && Contains("must be > 0"));
  CHECK_THAT(
      refusal(path, replaced(good, "\"fingers\": [", "\"fingers\": [\"pinky\", ", "\"used\"")),
      Contains("/planner/used/fingers/0: the hand has nothing named \"pinky\""));
  const std::string hash = sample_file(folder / "ball.off").hand.sidecar_sha256;
  CHECK_THAT(refusal(path, replaced(good, hash, std::string(64, 'f'))), Contains("sidecar"));
}

TEST_CASE("An object is read by its record, bit for bit, however it was scaled",
          "[grasp][object_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder / "ball.obj";
  geometry::write_mesh(path, geometry::ball(37.0, 2));

  grasp::ObjectReadOptions options;
  options.longest_extent = 0.15;
  const grasp::ObjectFile object = grasp::read_object_file(path, options);
  CHECK(geometry::longest_extent(object.mesh) == Approx(0.15).epsilon(1e-15));
  CHECK(object.record.analysis.is_closed);
  CHECK(grasp::read_object(object.record) == object.mesh);

  std::ofstream(path, std::ios::app) << "# another comment\n";
  CHECK_THROWS_WITH(grasp::read_object(object.record), Contains("ball.obj") && Contains("SHA-256"));
  options.longest_extent = -1.0;
  CHECK_THROWS_AS(grasp::read_object_file(path, options), geometry::InvalidInput);
  CHECK_THROWS_WITH(grasp::read_object_file(folder / "no.obj"), Contains("no.obj"));
}

TEST_CASE("The table has a row per grasp and a unit in every column that needs one",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder / "ball.off");
  std::istringstream csv(grasp::to_csv(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  REQUIRE(lines.size() == 1 + file.grasps.size());
  for (const char* column :
       {"largest_penetration_m", "epsilon", "largest_claimed_gap_m", "palm_touches",
        "pre_grasp_clearance_m", "pre_grasp_palm_x_m", "squeeze_residual"}) {
    CHECK_THAT(lines[0], Contains(column));
  }
  CHECK_THAT(lines[0], Contains(file.hand.joints[0].name + "_rad"));
  const auto num_commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  for (const std::string& line : lines) CHECK(num_commas(line) == num_commas(lines[0]));
}

TEST_CASE("A posed scene holds the object and every link where the hand has it",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder / "ball.off");
  const geometry::TriangleMesh object = geometry::ball(0.05, 1);
  const hands::HandConfiguration& configuration = file.grasps[0].configuration;
  const geometry::TriangleMesh scene = grasp::posed_scene(object, file.hand, configuration);

  std::size_t num_faces = object.faces.size();
  for (const hands::Link& link : file.hand.links) num_faces += link.mesh_L.faces.size();
  CHECK(scene.faces.size() == num_faces);

  std::ofstream(folder / "scene.obj") << grasp::posed_scene_obj(object, file.hand, configuration);
  const std::string text = geometry::read_file(folder / "scene.obj");
  CHECK_THAT(text, Contains("o object\n"));
  for (const hands::Link& link : file.hand.links) {
    if (!link.mesh_L.faces.empty()) CHECK_THAT(text, Contains("o link " + link.name + '\n'));
  }
  const geometry::TriangleMesh read = geometry::read_mesh(folder / "scene.obj").mesh;
  CHECK(read.faces.size() == num_faces);
  CHECK(geometry::bounding_box(read).isApprox(geometry::bounding_box(scene), 1e-6));
}

TEST_CASE("Every choice has a name that is read back, and no two share one",
          "[grasp][option_names]") {
  const auto check = [](auto value) {
    using Enum = decltype(value);
    std::vector<std::string_view> names;
    for (const auto& named : grasp::named_values<Enum>()) {
      CHECK(grasp::value_named<Enum>(named.name) == named.value);
      CHECK(grasp::name_of(named.value) == named.name);
      CHECK(std::count(names.begin(), names.end(), named.name) == 0);
      names.push_back(named.name);
    }
    CHECK_FALSE(grasp::value_named<Enum>("no such name").has_value());
  };
  check(grasp::GraspStyle{});
  check(grasp::Acceptance{});
  check(geometry::PatchAveraging{});
  check(grasp::ScoreNormalization{});
  check(grasp::PlaneDistance{});
  check(grasp::PairRule{});
  check(grasp::MeasureUnits{});
  check(grasp::Regularity{});
  check(grasp::HullCentroid{});
  check(grasp::PlannerStop{});
  check(geometry::RepairMode{});
  check(geometry::SelfIntersections{});
  CHECK(grasp::names_of<grasp::Acceptance>() == "valid|usable|quality");
}

}  // namespace
