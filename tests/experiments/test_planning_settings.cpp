#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/sweep/data_needs.hpp"
#include "settings/planning_setting_list.hpp"
#include "support/catch.hpp"
#include "support/environment_variable.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_planning_settings {

using namespace graspfit::sweep;
using namespace graspfit::experiments;
namespace grasp = graspfit::grasp;

namespace {

/// Returns the settings of a ball and a Barrett hand with these members added.
PlanningSettings settings_with(const std::string& members) {
  return planning_settings(R"({"shape": "ball", "hand": "barrett")" + members + "}", 5);
}

}  // namespace

TEST_CASE("Settings reach the option that they name", "[experiments][planning_settings]") {
  const PlanningSettings plain = settings_with("");
  CHECK(plain.options.seed == 5);
  CHECK(plain.object.shape == "ball");
  CHECK_FALSE(plain.object.size.has_value());

  const PlanningSettings settings = settings_with(R"(,
    "size_m": 0.08, "size_axis": "y", "style": "power", "fingers": ["thumb", "finger_1"],
    "palm": false, "approach": [0, 0, -1], "approach-angle-deg": 45, "resolution": 20,
    "theta-max-deg": 30, "score-threshold": 0.5, "target-search": "ranked", "refine": false,
    "weak-thickness-mm": 4, "clearance-mm": 10, "search": "first", "w3": 0.25, "friction": 0.7,
    "table": -0.04, "angle-weight": 1, "ideal-m-draws": 3, "palm-reach-tolerance-mm": 20,
    "max-placements": 2, "least-distance-mm": 0.01, "largest-shift-mm": 8,
    "largest-turn-deg": 9, "largest_thickness_m": 0.05)");
  const grasp::PlannerOptions& options = settings.options;
  CHECK(settings.object.size == 0.08);
  CHECK(settings.object.size_axis == 1);
  CHECK(options.style == grasp::GraspStyle::Power);
  CHECK(options.fingers == std::vector<std::string>{"thumb", "finger_1"});
  CHECK(options.num_contacts == 2);
  CHECK(options.palm == false);
  CHECK(*options.approach_O == Eigen::Vector3d(0, 0, -1));
  CHECK(options.approach_angle == Approx(std::numbers::pi / 4));
  CHECK(options.resolution == 20);
  CHECK(options.quality.theta_max == Approx(std::numbers::pi / 6));
  CHECK(options.targets.theta_max == options.quality.theta_max);
  CHECK(options.targets.score_threshold == 0.5);
  CHECK(options.targets.search == grasp::TargetSearch::Ranked);
  CHECK_FALSE(options.refine);
  CHECK(options.weak->weak_thickness == Approx(0.004));
  CHECK(options.fitting.clearance == Approx(0.01));
  CHECK(options.search == grasp::SearchRule::First);
  CHECK(options.quality.w3 == 0.25);
  CHECK(options.friction == 0.7);
  CHECK_FALSE(plain.table_z_O.has_value());
  CHECK(settings.table_z_O == -0.04);
  CHECK(surroundings_of(settings).table_z_O == -0.04);
  CHECK(surroundings_of(settings).table_clearance == 0.001);
  CHECK(surroundings_of(plain).is_empty());
  const PlanningSettings laid = settings_with(R"(, "rest_pose": 2)");
  CHECK(laid.object.rest_pose == 2);
  CHECK(surroundings_of(laid).table_z_O == 0.0);
  CHECK(laid.object.key() != plain.object.key());
  CHECK(options.targets.angle_weight == 1.0);
  CHECK(options.targets.ideal_m_draws == 3);
  CHECK(options.targets.palm_reach_tolerance == Approx(0.02));
  CHECK(options.max_placements == 2);
  CHECK(options.refinement.least_distance == Approx(0.00001));
  CHECK(options.refinement.largest_shift == Approx(0.008));
  CHECK(options.refinement.largest_turn == Approx(std::numbers::pi / 20));
  CHECK_FALSE(settings_with(R"(, "weak-thickness-mm": 0)").options.weak.has_value());
}

TEST_CASE("The paper's angle keeps its bits on the way through degrees",
          "[experiments][planning_settings]") {
  const PlanningSettings settings = settings_with(R"(, "theta-max-deg": 45)");
  CHECK(settings.options.quality.theta_max == grasp::PlannerOptions{}.quality.theta_max);
}

TEST_CASE("A preset is applied before the settings beside it", "[experiments][planning_settings]") {
  // "keep" comes before "preset" in the order of names.
  const grasp::PlannerOptions options =
      settings_with(R"(, "keep": "first", "preset": "strong")").options;
  CHECK(options.style == grasp::GraspStyle::Auto);
  CHECK(options.kept == grasp::KeptCandidate::First);
}

TEST_CASE("Settings that cannot be used say which and what is allowed",
          "[experiments][planning_settings]") {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {R"(, "styles": "power")", {"styles", "is no setting; there are file, packaged, shape"}},
      {R"(, "style": "pinch")", {"style", "is \"pinch\", must be one of precision|power"}},
      {R"(, "resolution": 20.5)", {"resolution", "must be an integer"}},
      {R"(, "resolution": 1)", {"resolution", "is 1, must be in [4, 512]"}},
      {R"(, "least-distance-mm": 5)", {"least-distance-mm", "is 5, must be at most wanted-gap-mm"}},
      {R"(, "contacts": 1)", {"contacts", "asks for 1 finger"}},
      {R"(, "approach": [0, 0, 0])", {"approach", "without length"}},
      {R"(, "missing-contact": "measured")", {"missing-contact", "turn refine off"}},
      {R"(, "size_m": 0)", {"size_m", "is 0, must be > 0"}},
      {R"(, "preset": "weak")", {"preset", "is \"weak\", must be one of paper|exact|fast|strong"}},
      {R"(, "size_axis": "w")", {"size_axis", "must be one of x|y|z"}},
      {R"(, "approach": [0, 1])", {"approach", "must be three numbers [x, y, z]"}},
      {R"(, "fingers": [])", {"fingers", "at least one value"}},
      {R"(, "file": "ball.obj")", {"", "a file, a packaged mesh or a shape; set one"}},
      {R"(, "packaged": "cube.off")", {"", "a file, a packaged mesh or a shape; set one"}},
      {R"(, "packaged": "../cube.off")", {"packaged", "must be a file's name, no path"}},
      {R"(, "slide-steps": 99999)", {"slide-steps", "is 99999, must be in [0, 1000]"}},
      {R"(, "refine": "yes")", {"refine", "must be true or false"}}};
  for (const auto& [members, expected] : cases) {
    INFO(members);
    try {
      settings_with(members);
      FAIL("accepted");
    } catch (const SettingError& error) {
      CHECK(error.key() == expected[0]);
      CHECK_THAT(error.what(), graspfit::testing::Contains(expected[1]));
    }
  }
}

TEST_CASE("Numbers have the ranges that are written here", "[experiments][planning_settings]") {
  std::map<std::string, std::vector<std::string>> ranges;
  for (const SettingDescription& setting : planning_setting_descriptions()) {
    if (setting.range) ranges[setting.range->text()].push_back(setting.name.name);
  }
  for (auto& [range, names] : ranges) std::sort(names.begin(), names.end());
  CHECK(ranges == std::map<std::string, std::vector<std::string>>{
                      {"> 0",
                       {"clip-thickness-mm", "largest-deviation-mm", "largest-gap-mm",
                        "largest_thickness_m", "least-distance-mm", "meters_per_unit",
                        "pre-grasp-clearance-mm", "score-length-voxels", "size_m", "squeeze-force",
                        "squeeze-stiffness", "wanted-gap-mm"}},
                      {">= 0",
                       {"alpha",
                        "angle-weight",
                        "beta",
                        "centroid-limit",
                        "distinct-joints",
                        "distinct-rotation-deg",
                        "distinct-translation-mm",
                        "edge-tolerance",
                        "friction",
                        "ideal-m-bias",
                        "largest-shift-mm",
                        "largest-turn-deg",
                        "max-redraws",
                        "palm-reach-tolerance-mm",
                        "pool-spacing-mm",
                        "squeeze-friction",
                        "w1",
                        "w2",
                        "w3",
                        "weak-thickness-mm"}},
                      {">= 1",
                       {"contacts", "count", "ideal-m-draws", "max-attempts", "max-iterations",
                        "max-placements", "max-seeds", "rest_pose", "target-draws"}},
                      {"in (0, 180]", {"approach-angle-deg"}},
                      {"in (0, 1]", {"pool-fraction"}},
                      {"in (0, 90)", {"theta-max-deg"}},
                      {"in [0, 1)", {"contact-score-threshold", "score-threshold"}},
                      {"in [0, 10000]", {"clearance-mm", "pre-grasp-retreat-mm"}},
                      {"in [0, 1000]", {"mean-filter-passes", "near-pad-steps", "slide-steps"}},
                      {"in [0, 31]", {"mean-filter-radius"}},
                      {"in [1, 1000000]", {"gs-samples", "ma-samples"}},
                      {"in [1, 1000]", {"refine-iterations"}},
                      {"in [3, 63]", {"neighborhood"}},
                      {"in [4, 512]", {"resolution"}}});
}

TEST_CASE("Ranges of settings end where the planner's own checks do",
          "[experiments][planning_settings]") {
  // The difference is in the setting's unit, beside a bound that is itself outside the range.
  constexpr double kJustInside = 1e-9;
  // Returns whether the planner's check accepts the value; all else is such that only the value can
  // be wrong.
  const auto is_accepted = [](const internal::PlanningSetting& setting, double value) {
    const bool is_integer = setting.schema.at("type") == "integer";
    const nlohmann::json json =
        is_integer ? nlohmann::json(static_cast<int>(value)) : nlohmann::json(value);
    PlanningSettings settings;
    settings.options.palm = true;
    settings.options.refinement.least_distance = 1e-13;
    settings.options.refinement.wanted_gap =
        setting.name.name == "least-distance-mm" ? 1e-5 : 5e-13;
    setting.apply(settings, graspfit::sweep::setting_value(setting.name.name, json));
    try {
      settings.options.validate();
      return true;
    } catch (const graspfit::base::InvalidInput&) {
      return false;
    }
  };
  int num_checked = 0;
  for (const internal::PlanningSetting& setting : internal::planning_setting_list()) {
    const std::string& name = setting.name.name;
    if (!setting.range || name == "size_m" || name == "meters_per_unit" ||
        name == "largest_thickness_m" || name == "rest_pose") {
      continue;
    }
    INFO(name);
    const bool is_integer = setting.schema.at("type") == "integer";
    const double step = is_integer ? 1.0 : 1e-3;
    const auto& range = *setting.range;
    CHECK(is_accepted(setting, range.has_least ? range.least : range.least + kJustInside));
    CHECK_FALSE(is_accepted(setting, range.has_least ? range.least - step : range.least));
    ++num_checked;
    if (!std::isfinite(range.most)) continue;
    CHECK(is_accepted(setting, range.has_most ? range.most : range.most - kJustInside));
    CHECK_FALSE(is_accepted(setting, range.has_most ? range.most + step : range.most));
  }
  CHECK(num_checked > 45);
}

TEST_CASE("Defaults of settings are those of the planner", "[experiments][planning_settings]") {
  for (const SettingDescription& setting : planning_setting_descriptions()) {
    INFO(setting.name.name << " = " << setting.fallback);
    CHECK_FALSE(setting.allowed.empty());
    if (setting.fallback.empty() || setting.name.name == "size_axis") continue;
    if (setting.range) CHECK(setting.range->contains(std::stod(setting.fallback)));
    // A default that is given as it stands there changes nothing: conversions of units keep 12
    // digits.
    const nlohmann::json parsed = nlohmann::json::parse(setting.fallback, nullptr, false);
    const std::string value = parsed.is_discarded() ? '"' + setting.fallback + '"' : parsed.dump();
    const PlanningSettings given = settings_with(", \"" + setting.name.name + "\": " + value);
    const PlanningSettings plain = settings_with("");
    CHECK(given.options.quality.theta_max ==
          Approx(plain.options.quality.theta_max).epsilon(1e-11));
    CHECK(given.options.refinement.wanted_gap ==
          Approx(plain.options.refinement.wanted_gap).epsilon(1e-11));
    CHECK(given.options.weak->weak_thickness ==
          Approx(plain.options.weak->weak_thickness).epsilon(1e-11));
    CHECK(given.options.resolution == plain.options.resolution);
    CHECK(given.options.style == plain.options.style);
    CHECK(given.options.num_contacts == plain.options.num_contacts);
  }
}

TEST_CASE("Every setting has a name of its own, a meaning and a unit",
          "[experiments][planning_settings]") {
  std::set<std::string> names;
  for (const Column& setting : planning_setting_names()) {
    CHECK(names.insert(setting.name).second);
    CHECK_FALSE(setting.meaning.empty());
  }
  CHECK(names.count("score-threshold") == 1);
}

TEST_CASE("Objects come in the size asked for", "[experiments][planning_settings]") {
  ObjectSettings torus;
  torus.shape = "torus";
  torus.size = 0.16;
  torus.size_axis = 0;
  const auto object = load_object(torus);
  CHECK(graspfit::geometry::bounding_box(object->mesh).sizes().x() == Approx(0.16));
  CHECK(load_object(torus) == object);  // The object is not built again.

  // The torus is too thick for the hand and is scaled down; its bounding box's shortest edge is
  // along z.
  torus.largest_thickness = 0.02;
  const Eigen::Vector3d sizes = graspfit::geometry::bounding_box(load_object(torus)->mesh).sizes();
  CHECK(sizes.minCoeff() == Approx(0.02));
  CHECK(sizes.x() < 0.16);
  torus.largest_thickness = 0.2;
  CHECK(graspfit::geometry::bounding_box(load_object(torus)->mesh).sizes().x() == Approx(0.16));

  ObjectSettings missing;
  missing.file = "meshes/no_such_object.off";
  CHECK_THROWS_WITH(load_object(missing), graspfit::testing::Contains("GRASPFIT_DATA"));
  CHECK_THROWS_AS(load_object(missing), MissingData);
  CHECK_THROWS_AS(load_hand("hands/no_such_hand.urdf"), MissingData);
  missing = {};
  missing.packaged = "no_such_mesh.off";
  CHECK_THROWS_WITH(load_object(missing), graspfit::testing::Contains("GRASPFIT_PACKAGED_MESHES"));
  CHECK_THROWS_AS(load_object(missing), MissingData);
}

TEST_CASE("Settings say what they need and whether it is there",
          "[experiments][planning_settings]") {
  const auto needs_of = [](const std::string& settings) { return data_needs(settings); };
  CHECK(needs_of(R"({"hand": "barrett", "resolution": 20, "note": "file"})").empty());
  const auto shape = needs_of(R"({"shape": "torus", "size_m": 0.1})");
  REQUIRE(shape.size() == 1);
  CHECK(shape[0].source == DataSource::BuiltIn);
  CHECK(shape[0].is_there);
  const auto own = needs_of(R"({"file": "/no/such/mesh.off"})");
  CHECK(own.at(0).source == DataSource::OwnFile);
  CHECK_FALSE(own.at(0).is_there);
  const auto packaged = needs_of(R"({"packaged": "no_such_mesh.off"})");
  CHECK(packaged.at(0).source == DataSource::Packaged);
  CHECK_FALSE(packaged.at(0).is_there);
  CHECK_FALSE(has_all_data(R"({"packaged": "no_such_mesh.off"})"));
  CHECK(needs_of(R"({"file": "meshes/paper/bunny.off"})").at(0).source ==
        DataSource::DataFolderOrPackaged);
  // The last ones are nested, or are hands that are not shipped.
  const auto nested = needs_of(
      R"({"objects": [{"shape": "mug"}, {"file": "meshes/none.obj"}], "hand": "hands/none.urdf"})");
  REQUIRE(nested.size() == 3);
  CHECK(nested[0].name == "hands/none.urdf");
  CHECK(nested[0].source == DataSource::DataFolder);
  CHECK(nested[1].source == DataSource::BuiltIn);
  CHECK(nested[2].name == "meshes/none.obj");
  CHECK(nested[2].source == DataSource::DataFolder);
}

TEST_CASE("Meshes that libcgal-demo has, too, are read from there, and only the same bytes",
          "[experiments][planning_settings]") {
  const auto bunny = graspfit::testing::packaged_mesh("bunny00.off");
  if (!bunny) GRASPFIT_SKIP_TEST("no packaged meshes; set GRASPFIT_PACKAGED_MESHES");
  const graspfit::testing::TemporaryFolder folder;
  const std::string text = graspfit::base::read_file(*bunny);
  const auto find_with = [&](const std::string& bytes) {
    folder.write("bunny00.off", bytes);
    const graspfit::testing::EnvironmentVariable data("GRASPFIT_DATA",
                                                      (folder.path() / "none").string());
    const graspfit::testing::EnvironmentVariable packaged("GRASPFIT_PACKAGED_MESHES",
                                                          folder.path().string());
    return graspfit::sweep::find_data_file("meshes/paper/bunny.off");
  };
  CHECK(find_with(text) == folder.path() / "bunny00.off");
  CHECK_FALSE(find_with(text + "# another version\n").has_value());
}

TEST_CASE("Every axis that sweeps are made of is a setting by name",
          "[experiments][planning_settings]") {
  const auto bytes_of = [](const std::string& member) {
    const grasp::PlannerOptions o = settings_with(member).options;
    return std::vector<double>{static_cast<double>(o.resolution),
                               o.quality.alpha,
                               o.quality.beta,
                               o.quality.w1,
                               o.quality.w2,
                               o.quality.w3,
                               o.targets.score_threshold,
                               o.quality.theta_max,
                               static_cast<double>(o.score.neighborhood),
                               static_cast<double>(o.score.normalization),
                               static_cast<double>(o.score.mean_filter_passes),
                               static_cast<double>(o.quality.regularity),
                               o.clip_thickness.value_or(-1.0),
                               static_cast<double>(o.refine),
                               static_cast<double>(o.num_contacts)};
  };
  const std::vector<double> defaults = bytes_of("");
  const std::vector<std::string> changes = {R"(, "resolution": 10)",
                                            R"(, "alpha": 1)",
                                            R"(, "beta": 0)",
                                            R"(, "w1": 2)",
                                            R"(, "w2": 2)",
                                            R"(, "w3": 1)",
                                            R"(, "score-threshold": 0)",
                                            R"(, "theta-max-deg": 60)",
                                            R"(, "neighborhood": 3)",
                                            R"(, "score-normalization": "raw")",
                                            R"(, "mean-filter-passes": 3)",
                                            R"(, "regularity": "angle-only")",
                                            R"(, "clip-thickness-mm": 2)",
                                            R"(, "refine": false)",
                                            R"(, "contacts": 2)"};
  REQUIRE(changes.size() == defaults.size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO(changes[i]);
    const std::vector<double> changed = bytes_of(changes[i]);
    for (std::size_t k = 0; k < changed.size(); ++k) CHECK((changed[k] != defaults[k]) == (k == i));
  }
  CHECK(settings_with(R"(, "resolution": 120)").options.resolution == 120);
}

TEST_CASE("An object is turned about x, then y, then z, after it is scaled",
          "[experiments][planning_settings]") {
  // A bottle stands along z; a quarter turn about x lays it along -y.
  const auto box_of = [](const std::string& members) {
    return graspfit::geometry::bounding_box(
        load_object(
            planning_settings(
                R"({"shape": "bottle", "hand": "barrett", "size_m": 0.2)" + members + "}", 5)
                .object)
            ->mesh);
  };
  const Eigen::AlignedBox3d as_it_is = box_of("");
  REQUIRE(as_it_is.sizes().z() == Approx(0.2));
  const Eigen::AlignedBox3d lying = box_of(R"(, "rotation_deg": [90, 0, 0])");
  CHECK(lying.sizes().y() == Approx(0.2));
  CHECK(lying.min().y() == Approx(-as_it_is.max().z()));
  CHECK(lying.max().z() == Approx(as_it_is.max().y()));
  // The first turn is about x: z goes to -y, which a quarter turn about z takes to x. The other
  // order leaves z.
  const Eigen::AlignedBox3d along_x = box_of(R"(, "rotation_deg": [90, 0, 90])");
  CHECK(along_x.sizes().x() == Approx(0.2));
  CHECK(along_x.max().x() == Approx(as_it_is.max().z()));
  CHECK_THROWS_WITH(settings_with(R"(, "rotation_deg": [90, 0])"),
                    "is [90,0], must be three numbers [x, y, z]");
}

}  // namespace test_planning_settings
