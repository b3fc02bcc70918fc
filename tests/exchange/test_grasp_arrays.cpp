#include "exchanged_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/exchange/grasp_arrays.hpp"
#include "support/catch.hpp"

namespace test_grasp_arrays {

using namespace graspfit;
using exchange::GraspArrays;
using exchange::HoldFinding;
using testing::TemporaryFolder;

TEST_CASE("Arrays hold every grasp of every object, and the same ones give the same bytes",
          "[exchange][grasp_arrays]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = testing::random_grasps(hands::find_hand("barrett"), folder, 3);
  const auto filled = [&](double margin) {
    GraspArrays arrays;
    arrays.add("a", "CC0", file, {{true, margin, 0.1}, {false, {}, {}}, {{}, {}, {}}});
    arrays.add("b", "", file, std::vector<HoldFinding>(3));
    return arrays;
  };
  const GraspArrays arrays = filled(2.0);
  CHECK(arrays.num_objects() == 2);
  CHECK(arrays.num_grasps() == 6);
  const std::string bytes = arrays.npz();
  CHECK(bytes.starts_with("PK"));
  for (const char* const name : {"grasp_qpos", "object_index", "contact_start", "held"}) {
    CHECK(bytes.find(std::string(name) + ".npy") != std::string::npos);
  }
  CHECK(bytes == filled(2.0).npz());
  CHECK(bytes != filled(3.0).npz());
}

TEST_CASE("Arrays are of one hand, with a finding per grasp", "[exchange][grasp_arrays]") {
  const TemporaryFolder folder;
  const grasp::GraspFile file = testing::random_grasps(hands::find_hand("barrett"), folder, 2);
  const grasp::GraspFile other =
      testing::random_grasps(hands::find_hand("parallel_gripper"), folder, 1);
  GraspArrays arrays;
  CHECK_THROWS_WITH(arrays.add("a", "", file, {{}}),
                    testing::Contains("2 grasps") && testing::Contains("1 findings"));
  CHECK(arrays.num_objects() == 0);
  arrays.add("a", "", file, {{}, {}});
  CHECK_THROWS_AS(arrays.add("b", "", other, {{}}), base::InvalidInput);
  CHECK(arrays.num_objects() == 1);
}

}  // namespace test_grasp_arrays
