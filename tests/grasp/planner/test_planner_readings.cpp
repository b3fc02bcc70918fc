#include <map>
#include <string>

#include "planner/planner_readings.hpp"
#include "support/catch.hpp"

namespace test_planner_readings {

using namespace graspfit;

namespace {

std::map<std::string, std::string> readings_of(const grasp::PlannerOptions& options) {
  const auto readings = grasp::internal::planner_readings(options);
  return {readings.begin(), readings.end()};
}

}  // namespace

TEST_CASE("Methods without targets say which readings they use", "[grasp][planner_readings]") {
  grasp::PlannerOptions options;
  const auto fitting = readings_of(options);
  for (const char* const planner : {"gs", "ma", "ma-full-retreat"}) {
    CAPTURE(planner);
    options.planner = planner;
    options.contact_score_threshold.reset();
    const std::string unused = std::string("not used by planner ") + planner;
    const auto plain = readings_of(options);
    for (const char* const number : {"A1", "A2", "A3", "A4", "A5", "A17", "A28", "A48"}) {
      CHECK(plain.at(number) == unused);
    }
    // The angle of M2 is used by these methods, too.
    CHECK(plain.at("A47").find("of the measure alone") == 0);
    CHECK(plain.at("A13") == fitting.at("A13"));

    // The threshold is of real contacts and needs the score map.
    options.contact_score_threshold = 0.5;
    const auto scored = readings_of(options);
    for (const char* const number : {"A1", "A2", "A3", "A4", "A5"}) {
      CHECK(scored.at(number) == fitting.at(number));
    }
    CHECK(scored.at("A17") == unused);
  }
}

}  // namespace test_planner_readings
