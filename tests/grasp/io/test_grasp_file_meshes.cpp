#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "grasp/grasp_file_sample.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/path_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_grasp_file_meshes {

// These tests are about the meshes that a grasp file names, and those written beside it.
namespace {

namespace fs = std::filesystem;
using namespace graspfit;
using testing::Contains;
using testing::sample_file;
using testing::TemporaryFolder;

TEST_CASE("Meshes as used are written beside a grasp file, which names them", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  const geometry::TriangleMesh object = grasp::read_object(file.object);
  const grasp::Surroundings surroundings = grasp::read_surroundings(file.surroundings);
  REQUIRE(surroundings.obstacles.size() == 1);
  fs::create_directory(folder.path() / "out");
  file.used_meshes =
      grasp::write_used_meshes(folder.path() / "out", file.hand, object, surroundings);
  grasp::write_grasps(folder.path() / "out/grasps.json", file);

  const grasp::GraspFile read = grasp::read_grasps(folder.path() / "out/grasps.json");
  REQUIRE(read.used_meshes);
  const auto mesh = [&folder](const std::string& name) {
    return geometry::read_mesh(folder.path() / ("out/" + name)).mesh;
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
  const grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  CHECK(grasp::read_surroundings(file.surroundings).table_z_O == -0.2);
  std::ofstream(folder.path() / "ball.off", std::ios::app) << "# changed\n";
  CHECK_THROWS_WITH(grasp::read_surroundings(file.surroundings),
                    Contains("ball.off") && Contains("SHA-256"));
}

TEST_CASE("A hand with package:// and file:// meshes, two on one link, is recorded and found again",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const fs::path shipped = hands::shipped_hand_file("barrett");
  fs::copy(shipped.parent_path(), folder.path() / "hand", fs::copy_options::recursive);
  const fs::path description = folder.path() / "hand" / shipped.filename();
  std::string urdf = base::read_file(description);
  const auto replace_all = [&urdf](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = urdf.find(from, at)) != std::string::npos; at += to.size()) {
      urdf.replace(at, from.size(), to);
    }
  };
  // The palm's mesh is there twice, as two closed parts that happen to coincide.
  const std::string palm = "<mesh filename=\"meshes/palm.obj\"/>";
  const std::string again = "</geometry></collision><collision><geometry>";
  REQUIRE(urdf.find(palm) != std::string::npos);
  const std::string start = "<collision><geometry>";
  const std::string from_file =
      "<mesh filename=\"file://" + (folder.path() / "hand/meshes/palm.obj").string() + "\"/>";
  replace_all(start + palm, start + from_file + again + palm);
  replace_all("\"meshes/", "\"package://barrett_description/meshes/");
  std::ofstream(description) << urdf;

  const hands::HandModel hand = hands::read_hand_model(description);
  const fs::path palm_file = folder.path() / "hand/meshes/palm.obj";
  CHECK(hand.links[0].mesh_files == std::vector<std::string>{"meshes/palm.obj", "meshes/palm.obj"});

  geometry::write_mesh(folder.path() / "ball.off", geometry::ball(0.05, 2));
  const grasp::ObjectFile object = grasp::read_object_file(folder.path() / "ball.off");
  grasp::PlannerOptions options;
  options.resolution = 10;
  const grasp::ObjectModel model = grasp::prepare_object(object.mesh, hand, options);
  grasp::write_grasps(folder.path() / "grasps.json",
                      grasp::make_grasp_file(object.record, hand, options, model, {}));
  const grasp::GraspFile read = grasp::read_grasps(folder.path() / "grasps.json");
  CHECK(read.statistics.usable() == 0);  // Nothing was planned, so that no outcome is named.
  const std::string bytes = base::read_file(palm_file);
  CHECK(read.link_mesh_sha256[0] == base::sha256_hex(bytes + bytes));

  std::ofstream(palm_file, std::ios::app) << "# another file now\n";
  CHECK_THROWS_AS(grasp::read_grasps(folder.path() / "grasps.json"), base::IoError);
}

TEST_CASE("File names that are not UTF-8 come back from a grasp file", "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder.path() / "caf\xe9 100%.off");
  const fs::path hand = folder.path() / "h\xffnd.urdf";
  fs::copy(hands::shipped_hand_file("barrett").parent_path(), folder.path(),
           fs::copy_options::recursive);
  fs::rename(folder.path() / "barrett.urdf", hand);
  fs::rename(folder.path() / "barrett.graspfit.json", hands::sidecar_file_of(hand));
  file.hand = hands::read_hand_model(hand);
  file.imported = {"isaac_grasp 1.0", "file:\x80", std::string(64, '0')};
  grasp::write_grasps(folder.path() / "grasps.json", file);
  const std::string text = base::read_file(folder.path() / "grasps.json");
  CHECK(base::is_utf8(text));
  CHECK_THAT(text, Contains("/caf%E9%20100%25.off\"") && Contains("/h%FFnd.urdf\"") &&
                       Contains("\"file:file%3A%80\""));

  const grasp::GraspFile read = grasp::read_grasps(folder.path() / "grasps.json");
  CHECK(read.object.file == file.object.file);
  CHECK(read.surroundings.obstacles[0].file == file.object.file);
  CHECK(read.hand.description_file == hand.string());
  CHECK(read.imported->file == "file:\x80");
  CHECK_NOTHROW(grasp::read_object(read.object));
}

TEST_CASE("A grasp file names shipped hands alike on every machine, and finds others beside it",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  const std::string shipped = grasp::to_json(file);
  CHECK_THAT(shipped, Contains("\"description_file\": \"barrett/barrett.urdf\"") &&
                          Contains("\"sidecar_file\": \"barrett/barrett.graspfit.json\""));
  std::ofstream(folder.path() / "grasps.json") << shipped;
  CHECK(grasp::read_grasps(folder.path() / "grasps.json").hand.description_file ==
        file.hand.description_file);

  // A copy of the hand moves with the grasp file.
  const fs::path before = folder.path() / "before";
  fs::copy(hands::shipped_hand_file("barrett").parent_path(), before, fs::copy_options::recursive);
  std::ofstream(before / "barrett.urdf", std::ios::app) << "<!-- not the shipped one -->\n";
  file.hand = hands::read_hand_model(before / "barrett.urdf");
  grasp::write_grasps(before / "grasps.json", file);
  CHECK_THAT(base::read_file(before / "grasps.json"),
             Contains("\"description_file\": \"" + before.string() + "/barrett.urdf\""));
  const fs::path after = folder.path() / "after";
  fs::rename(before, after);
  CHECK(grasp::read_grasps(after / "grasps.json").hand.description_file ==
        (after / "barrett.urdf").string());
  std::ofstream(after / "barrett.urdf", std::ios::app) << "<!-- another one -->\n";
  CHECK_THROWS_WITH(grasp::read_grasps(after / "grasps.json"),
                    Contains("before/barrett.urdf") && Contains("beside the grasp file"));
}

TEST_CASE("An object is read by its record, bit for bit, however it was scaled",
          "[grasp][object_file]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "ball.obj";
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
  CHECK_THROWS_AS(grasp::read_object_file(path, options), base::InvalidInput);
  CHECK_THROWS_WITH(grasp::read_object_file(folder.path() / "no.obj"), Contains("no.obj"));
}

TEST_CASE("A posed scene holds the object and every link where the hand has it",
          "[grasp][grasp_io]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = sample_file(folder.path() / "ball.off");
  const geometry::TriangleMesh object = geometry::ball(0.05, 1);
  const hands::HandConfiguration& configuration = file.grasps[0].configuration;
  const geometry::TriangleMesh scene = grasp::posed_scene(object, file.hand, configuration);

  std::size_t num_faces = object.faces.size();
  for (const hands::Link& link : file.hand.links) num_faces += link.mesh_L.faces.size();
  CHECK(scene.faces.size() == num_faces);

  std::ofstream(folder.path() / "scene.obj")
      << grasp::posed_scene_obj(object, file.hand, configuration);
  const std::string text = base::read_file(folder.path() / "scene.obj");
  CHECK_THAT(text, Contains("o object\n"));
  for (const hands::Link& link : file.hand.links) {
    if (!link.mesh_L.faces.empty()) CHECK_THAT(text, Contains("o link " + link.name + '\n'));
  }
  const geometry::TriangleMesh read = geometry::read_mesh(folder.path() / "scene.obj").mesh;
  CHECK(read.faces.size() == num_faces);
  CHECK(geometry::bounding_box(read).isApprox(geometry::bounding_box(scene), 1e-6));
}

}  // namespace

}  // namespace test_grasp_file_meshes
