#include <fstream>

#include "grasp/grasp_file_sample.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/object_laid_down.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_object_laid_down {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using testing::TemporaryFolder;

/// Returns a box of 40 x 60 x 100 mm somewhere in its file's frame, in a file.
grasp::ObjectFile box_somewhere(const TemporaryFolder& folder) {
  geometry::TriangleMesh box = geometry::box({0.04, 0.06, 0.10});
  for (Vector3d& vertex : box.vertices) vertex += Vector3d(0.3, -0.2, 0.7);
  geometry::write_mesh(folder.path() / "box.off", box);
  return grasp::read_object_file(folder.path() / "box.off");
}

std::vector<geometry::LikelyRestPose> poses_of(const grasp::ObjectFile& object) {
  return geometry::likely_rest_poses(object.mesh, object.record.center_of_mass_O);
}

}  // namespace

TEST_CASE("An object that is laid down stands on z = 0 over the origin", "[grasp][object_file]") {
  const TemporaryFolder folder;
  const grasp::ObjectFile object = box_somewhere(folder);
  const auto poses = poses_of(object);
  REQUIRE(poses.size() == 6);
  const double heights[] = {0.04, 0.04, 0.06, 0.06, 0.10, 0.10};
  for (int i = 0; i < 6; ++i) {
    const grasp::ObjectFile laid = grasp::laid_down(object, poses[i], i + 1);
    const Eigen::AlignedBox3d box = geometry::bounding_box(laid.mesh);
    CHECK(box.min().z() == Approx(0.0).margin(1e-15));
    CHECK(box.max().z() == Approx(heights[i]));
    CHECK(laid.record.analysis.box.max() == box.max());
    const Vector3d center = geometry::mass_properties(laid.mesh).center_of_mass;
    CHECK((center - Vector3d(0.0, 0.0, 0.5 * heights[i])).norm() < 1e-12);
    CHECK((laid.record.center_of_mass_O - center).norm() < 1e-12);
    REQUIRE(laid.record.laid);
    CHECK(laid.record.laid->rank == i + 1);
    CHECK(laid.record.laid->probability == poses[i].probability);
    // A pose in O and the same pose in the file's frame.
    geometry::RigidTransform X_OB = geometry::RigidTransform::Identity();
    X_OB.translation() = Vector3d(0.1, 0.2, 0.3);
    const geometry::RigidTransform X_FB = laid.record.in_file_frame(X_OB);
    CHECK((laid.record.laid->X_OF() * X_FB).isApprox(X_OB, 1e-12));
    CHECK(object.record.in_file_frame(X_OB).matrix() == X_OB.matrix());
    CHECK_THROWS_AS(grasp::laid_down(laid, poses[0], 1), base::InvalidInput);
  }
}

TEST_CASE("An object has no rest pose beyond its last", "[grasp][object_file]") {
  const TemporaryFolder folder;
  const grasp::ObjectFile object = box_somewhere(folder);
  const grasp::ObjectFile last = grasp::laid_down(object, 6);
  CHECK(last.mesh == grasp::laid_down(object, poses_of(object)[5], 6).mesh);
  CHECK(last.record.laid->rank == 6);
  for (const int rank : {0, 7}) {
    CHECK_THROWS_WITH(grasp::laid_down(object, rank),
                      testing::EndsWith("box.off: there is no rest pose " + std::to_string(rank) +
                                        " among its 6 (graspfit inspect lists them)"));
  }
}

TEST_CASE("A grasp file brings an object to the bit to where it was laid", "[grasp][object_file]") {
  const TemporaryFolder folder;
  const grasp::ObjectFile object = box_somewhere(folder);
  const grasp::ObjectFile laid = grasp::laid_down(object, poses_of(object)[2], 3);
  grasp::GraspFile file = testing::sample_file(folder.path() / "ball.off");
  file.object = laid.record;
  file.surroundings.table_z_O = 0.0;
  file.surroundings.table_clearance = 0.0025;
  const auto path = folder.path() / "grasps.json";
  grasp::write_grasps(path, file);
  const grasp::GraspFile read = grasp::read_grasps(path);
  REQUIRE(read.object.laid);
  CHECK(read.object.laid->rotation_wxyz == laid.record.laid->rotation_wxyz);
  CHECK(read.object.laid->translation == laid.record.laid->translation);
  CHECK(read.object.laid->rank == 3);
  CHECK(read.object.laid->probability == laid.record.laid->probability);
  CHECK(grasp::read_object(read.object) == laid.mesh);
  CHECK(grasp::read_surroundings(read.surroundings).table_clearance == 0.0025);
}

TEST_CASE("Grasp files from before objects were laid down are read", "[grasp][object_file]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = testing::sample_file(folder.path() / "ball.off");
  std::string text = grasp::to_json(file);
  for (const std::string key : {"\"laid\": null,", "\"table_clearance_m\": 0,"}) {
    std::size_t at = 0;
    std::size_t num_found = 0;
    while ((at = text.find(key, at)) != std::string::npos) {
      text.erase(at, key.size());
      ++num_found;
    }
    CAPTURE(key);
    CHECK(num_found > 0);
  }
  const auto path = folder.write("old.json", text);
  const grasp::GraspFile read = grasp::read_grasps(path);
  CHECK_FALSE(read.object.laid);
  CHECK(read.surroundings.table_clearance == 0.0);
}

}  // namespace test_object_laid_down
