#include "exchanged_grasps.hpp"
#include "graspfit/exchange/posed_glb.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_posed_glb {

using namespace graspfit;

TEST_CASE("A posed scene as GLB is, read by assimp, the posed scene to single precision",
          "[exchange][posed_glb]") {
  const testing::TemporaryFolder folder;
  const grasp::GraspFile file = testing::random_grasps(hands::find_hand("barrett"), folder, 2);
  const geometry::TriangleMesh object = geometry::box({0.04, 0.02, 0.03});
  const hands::HandConfiguration& configuration = file.grasps[1].configuration;
  const std::string bytes = exchange::posed_scene_glb(object, file.hand, configuration);
  CHECK(bytes == exchange::posed_scene_glb(object, file.hand, configuration));
  const geometry::TriangleMesh read = geometry::read_mesh(folder.write("scene.glb", bytes)).mesh;
  const geometry::TriangleMesh expected = grasp::posed_scene(object, file.hand, configuration);
  REQUIRE(read.faces.size() == expected.faces.size());
  // Single precision is off by half of 2^-23 of the largest coordinate in a link's frame (0.2 m)
  // and of the pose, with a few roundings.
  constexpr double kSinglePrecision = 1e-7;
  double largest = 0.0;
  for (std::size_t i = 0; i < read.faces.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto a = static_cast<std::size_t>(read.faces[i][corner]);
      const auto b = static_cast<std::size_t>(expected.faces[i][corner]);
      largest = std::max(largest, (read.vertices[a] - expected.vertices[b]).norm());
    }
  }
  CHECK(largest < kSinglePrecision);
  CHECK(largest > 0.0);
}

}  // namespace test_posed_glb
