#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/exchange/imported_grasps.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_imported_grasps {

namespace {

using namespace graspfit;
using exchange::import_grasps;
using exchange::ImportedGrasp;
using testing::Contains;
using testing::TemporaryFolder;

const grasp::ImportRecord kSource = {"isaac_grasp 1.0", "elsewhere.yaml", std::string(64, 'a')};

/// Returns a grasp of the parallel gripper around a box 40 mm wide, its pads `gap` beside it.
ImportedGrasp pinch(const hands::HandModel& hand, const std::string& name, double gap) {
  ImportedGrasp grasp;
  grasp.name = name;
  grasp.configuration = hands::open_configuration(hand);
  grasp.configuration.q.setConstant(0.02 + gap);
  // The middle between the pads is at the origin.
  grasp.configuration.X_OH.translation().z() = -0.062;
  return grasp;
}

struct Scene {
  Scene() {
    geometry::write_mesh(folder.path() / "box.off", geometry::box({0.04, 0.02, 0.03}));
    object = grasp::read_object_file(folder.path() / "box.off");
    options.num_contacts = 2;
    options.weak.reset();
  }
  TemporaryFolder folder;
  hands::HandModel hand = hands::find_hand("parallel_gripper");
  grasp::ObjectFile object;
  grasp::PlannerOptions options;
};

}  // namespace

TEST_CASE("Imported grasps are measured from the meshes and stand best first",
          "[exchange][imported_grasps]") {
  const Scene scene;
  // Beyond the clip volume there is no contact and so no M.
  const std::vector<ImportedGrasp> grasps = {pinch(scene.hand, "wide", 0.005),
                                             pinch(scene.hand, "close", 5e-5),
                                             pinch(scene.hand, "cutting", -0.001)};
  const exchange::ImportResult result =
      import_grasps(scene.object, scene.hand, grasps, kSource, scene.options);
  REQUIRE(result.file.grasps.size() == 3);
  CHECK(result.sources.front() == 1);
  for (std::size_t i = 1; i < 3; ++i) {
    CHECK(result.file.grasps[i - 1].quality.m >= result.file.grasps[i].quality.m);
  }
  const auto named = [&](std::size_t index) -> const grasp::Grasp& {
    for (const grasp::Grasp& grasp : result.file.grasps) {
      if (grasp.attempt == static_cast<std::int64_t>(index)) return grasp;
    }
    throw std::out_of_range("no such grasp");
  };
  const grasp::Grasp& close = named(1);
  CHECK(close.is_valid());
  REQUIRE(close.contacts.size() == 2);
  CHECK(close.contacts[0].gap == Approx(5e-5).epsilon(1e-6));
  CHECK(close.squeeze.has_value());
  CHECK(named(0).quality.m == 0.0);
  CHECK(named(0).contacts.empty());
  CHECK_FALSE(named(0).squeeze.has_value());
  CHECK(named(2).penetration.object_intersects);
  CHECK(named(2).penetration.object_depth <= 0.001 + 1e-9);
  CHECK(named(2).penetration.object_depth_bound >= 0.001 - 1e-9);
  CHECK_FALSE(named(2).pre_grasp.has_value());
  CHECK(result.file.fingers.size() == 2);
  CHECK(result.file.voxel_size == Approx(0.04 / 30));
  CHECK(result.file.statistics.attempts == 0);
}

TEST_CASE("A pre-grasp of the file is kept where it is clear and its way free, else one is found",
          "[exchange][imported_grasps]") {
  const Scene scene;
  ImportedGrasp clear = pinch(scene.hand, "clear", 5e-5);
  clear.pre_grasp_q = Eigen::VectorXd::Constant(2, 0.028);  // This is 8 mm beside the box.
  ImportedGrasp near = clear;
  near.name = "near";
  // This is less than the 5 mm that are wanted.
  near.pre_grasp_q = Eigen::VectorXd::Constant(2, 0.021);
  ImportedGrasp none = pinch(scene.hand, "none", 5e-5);
  const exchange::ImportResult result =
      import_grasps(scene.object, scene.hand, std::vector<ImportedGrasp>{clear, near, none},
                    kSource, scene.options);
  REQUIRE(result.file.grasps.size() == 3);
  for (const grasp::Grasp& grasp : result.file.grasps) {
    REQUIRE(grasp.pre_grasp);
    CHECK(grasp.pre_grasp->clearance >= scene.options.pre_grasp.clearance);
  }
  const grasp::PreGrasp& kept = *result.file.grasps[0].pre_grasp;
  CHECK(kept.configuration.q == *clear.pre_grasp_q);
  CHECK(kept.retreat == 0.0);
  CHECK(kept.clearance <= 0.008 + 1e-12);
  CHECK(kept.opening > 0.0);
  CHECK(result.file.grasps[1].pre_grasp->configuration.q != *near.pre_grasp_q);
  REQUIRE(result.notes.size() == 2);
  CHECK_THAT(result.notes[0], Contains("near: its pre-grasp is not clear"));
  CHECK_THAT(result.notes[1],
             Contains("none: the file has no pre-grasp at its palm's pose, another one was found"));
}

TEST_CASE("Where imported grasps come from is written, read again, and no planner is named",
          "[exchange][imported_grasps]") {
  const Scene scene;
  const exchange::ImportResult result = import_grasps(
      scene.object, scene.hand, std::vector<ImportedGrasp>{pinch(scene.hand, "close", 5e-5)},
      kSource, scene.options);
  const std::string json = grasp::to_json(result.file);
  CHECK_THAT(json, Contains("\"name\": \"none: imported\""));
  const auto path = scene.folder.path() / "grasps.json";
  grasp::write_grasps(path, result.file);
  const grasp::GraspFile read = grasp::read_grasps(path);
  REQUIRE(read.imported);
  CHECK(read.imported->format == kSource.format);
  CHECK(read.imported->file == kSource.file);
  CHECK(read.imported->sha256 == kSource.sha256);
  CHECK(read.grasps[0].configuration.q == result.file.grasps[0].configuration.q);
}

TEST_CASE("What cannot be imported is refused", "[exchange][imported_grasps]") {
  Scene scene;
  const std::vector<ImportedGrasp> grasps = {pinch(scene.hand, "close", 5e-5)};
  scene.options.fingers = {"pinky"};
  CHECK_THROWS_AS(import_grasps(scene.object, scene.hand, grasps, kSource, scene.options),
                  base::InvalidInput);
  scene.options.fingers.clear();
  grasp::ObjectFile open = scene.object;
  open.record.analysis.is_closed = false;
  CHECK_THROWS_WITH(import_grasps(open, scene.hand, grasps, kSource, scene.options),
                    Contains("is not a closed outward solid"));
  std::vector<ImportedGrasp> beyond = grasps;
  beyond[0].configuration.q.setConstant(1.0);
  CHECK_THROWS_AS(import_grasps(scene.object, scene.hand, beyond, kSource, scene.options),
                  base::InvalidInput);
}

}  // namespace test_imported_grasps
