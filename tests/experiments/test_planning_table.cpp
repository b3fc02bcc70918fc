#include "graspfit/grasp/grasp.hpp"
#include "internal/planning_table.hpp"
#include "support/catch.hpp"

TEST_CASE("Closure that only rounding makes does not count", "[experiments][planning_table]") {
  using graspfit::experiments::internal::is_closed;
  graspfit::grasp::Grasp grasp;
  grasp.wrench.epsilon = -1.0;
  CHECK_FALSE(is_closed(grasp));
  grasp.wrench.is_force_closure = true;
  grasp.wrench.epsilon = 1e-17;
  CHECK_FALSE(is_closed(grasp));
  grasp.wrench.epsilon = 1e-3;
  CHECK(is_closed(grasp));
}
