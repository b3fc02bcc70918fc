#include <algorithm>

#include "cells/planning_table.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "support/catch.hpp"

namespace test_planning_table {

using namespace graspfit;
using namespace graspfit::experiments;

TEST_CASE("Closure that only rounding makes does not count", "[experiments][planning_table]") {
  graspfit::grasp::Grasp grasp;
  grasp.wrench.emplace();
  grasp.wrench->epsilon = -1.0;
  CHECK_FALSE(grasp.is_closed());
  grasp.wrench->is_force_closure = true;
  grasp.wrench->epsilon = 1e-17;
  CHECK_FALSE(grasp.is_closed());
  grasp.wrench->epsilon = 1e-3;
  CHECK(grasp.is_closed());
}

TEST_CASE("A cell's hand keeps above its table", "[experiments][planning_table]") {
  const auto planned_over = [](const std::string& table) {
    return internal::plan(planning_settings(
        R"({"shape": "torus", "size_m": 0.14, "hand": "barrett", "count": 3, "max-attempts": 3,
            "resolution": 20, "weak-thickness-mm": 0)" +
            table + "}",
        1));
  };
  const auto lowest_hand = [](const internal::Planned& planned) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const grasp::Grasp& grasp : planned.result.grasps) {
      const auto poses = hands::forward_kinematics(*planned.hand, grasp.configuration);
      for (std::size_t l = 0; l < planned.hand->links.size(); ++l) {
        for (const Eigen::Vector3d& vertex : planned.hand->links[l].mesh_L.vertices) {
          lowest = std::min(lowest, (poses[l] * vertex).z());
        }
      }
    }
    return lowest;
  };
  const double table_z = -0.04;  // The torus reaches down to -0.016.
  const internal::Planned free = planned_over(R"(, "approach": [0, 0, 1])");
  const internal::Planned above = planned_over(R"(, "approach": [0, 0, -1], "table": -0.04)");
  REQUIRE_FALSE(above.result.grasps.empty());
  CHECK(lowest_hand(above) > table_z);
  CHECK(lowest_hand(free) < table_z);
  CHECK_THROWS_WITH(planned_over(R"(, "table": 0.05)"),
                    testing::Contains("table 0.05 is above the whole object"));
}

}  // namespace test_planning_table
