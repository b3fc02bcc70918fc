#include <algorithm>
#include <set>
#include <string>

#include "graspfit/grasp/planner_presets.hpp"
#include "support/catch.hpp"

namespace test_planner_presets {

namespace {

using namespace graspfit::grasp;

PlannerOptions options_of(std::string_view name) {
  PlannerOptions options;
  apply_preset(options, *preset_named(name));
  return options;
}

TEST_CASE("Presets are options of the table with values that they may have",
          "[grasp][planner_presets]") {
  std::set<std::string_view> names;
  for (const PlannerPreset& preset : planner_presets()) {
    CAPTURE(std::string(preset.name));
    CHECK(names.insert(preset.name).second);
    CHECK_FALSE(preset.meaning.empty());
    std::set<std::string_view> changed;
    for (const auto& [name, value] : preset.values) {
      CAPTURE(std::string(name));
      CHECK(changed.insert(name).second);
      const auto& table = planner_option_table();
      const auto option = std::find_if(table.begin(), table.end(),
                                       [&, &name = name](const auto& o) { return o.name == name; });
      REQUIRE(option != table.end());
      CHECK(static_cast<OptionKind>(value.index()) == option->kind);
      if (const auto* const text = std::get_if<std::string>(&value)) {
        CHECK(option->has_choice(*text));
      }
    }
    CHECK_NOTHROW(options_of(preset.name).validate());
  }
  CHECK(names == std::set<std::string_view>{"paper", "exact", "fast", "strong"});
  CHECK(preset_named("Strong") == nullptr);
}

TEST_CASE("Presets set what they are for and nothing else", "[grasp][planner_presets]") {
  const PlannerOptions paper = options_of("paper");
  CHECK_FALSE(paper.refine);
  CHECK_FALSE(paper.pre_grasps);
  CHECK(paper.fitting.guard == PenetrationGuard::Voxels);
  CHECK(paper.acceptance == Acceptance::Usable);
  CHECK(paper.rejection == Rejection::Deviation);
  CHECK(paper.missing_contact == MissingContact::Fails);
  CHECK(preset_named("paper")->values.size() == 5);
  CHECK(options_of("fast").search == SearchRule::First);
  CHECK(options_of("fast").kept == KeptCandidate::First);
  const PlannerOptions strong = options_of("strong");
  CHECK(strong.style == GraspStyle::Auto);
  CHECK(strong.targets.search == TargetSearch::Reach);
  CHECK(strong.kept == KeptCandidate::Firmest);
  CHECK(strong.max_redraws == 5);
  CHECK(strong.idle_fingers == IdleFingers::Close);
  CHECK(strong.contact_faces == graspfit::contact::ContactFaces::Facing);
  CHECK(strong.count == 5);
  CHECK(strong.search == SearchRule::Closed);
  CHECK(strong.rank == RankRule::Epsilon);
  CHECK(strong.refine);
  CHECK(preset_named("strong")->values.size() == 9);
  CHECK(preset_named("fast")->values.size() == 1);
  CHECK(preset_named("exact")->values.empty());
  CHECK(paper.rank == RankRule::M);
}

}  // namespace

}  // namespace test_planner_presets
