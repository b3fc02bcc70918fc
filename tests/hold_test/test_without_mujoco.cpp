#include "hold_scenes.hpp"
#include "support/catch.hpp"

namespace test_without_mujoco {

namespace {

using namespace graspfit;

TEST_CASE("A build without MuJoCo says so", "[hold_test]") {
  CHECK_FALSE(hold_test::is_available());
  CHECK_THROWS_WITH(testing::jaws_on_cube(hold_test::hold_protocol("dexgraspbench-100g")),
                    testing::Contains("MuJoCo") && testing::Contains("GRASPFIT_WITH_MUJOCO"));
}

}  // namespace

}  // namespace test_without_mujoco
