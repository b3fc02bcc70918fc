#include <algorithm>
#include <string_view>
#include <vector>

#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "support/catch.hpp"

namespace test_option_names {

namespace {

using namespace graspfit;

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
  check(grasp::MissingContact{});
  check(grasp::Rejection{});
  check(grasp::ContactState{});
  check(grasp::PalmAfterContact{});
  check(contact::CountedPads{});
  check(contact::ContactPieces{});
  check(contact::ContactFaces{});
  check(grasp::ApproachSource{});
  check(geometry::PatchAveraging{});
  check(grasp::ScoreNormalization{});
  check(grasp::PlaneDistance{});
  check(grasp::PairRule{});
  check(contact::MeasureUnits{});
  check(contact::Regularity{});
  check(contact::HullCentroid{});
  check(grasp::PlannerStop{});
  check(geometry::RepairMode{});
  check(geometry::SelfIntersections{});
  CHECK(grasp::names_of<grasp::Acceptance>() == "valid|usable");
}

}  // namespace

}  // namespace test_option_names
