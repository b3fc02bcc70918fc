#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/hold_test/hold_batch.hpp"
#include "graspfit/hold_test/hold_report.hpp"
#include "support/catch.hpp"

namespace graspfit::test_hold_report {
namespace {

using hold_test::HoldMargin;
using hold_test::HoldStage;
using hold_test::TestedGrasp;

TestedGrasp tested(std::size_t index, HoldStage stage, std::optional<double> margin = {}) {
  TestedGrasp grasp;
  grasp.index = index;
  grasp.verdict.stage = stage;
  if (margin) {
    grasp.margin = HoldMargin{};
    grasp.margin->force = *margin;
  }
  return grasp;
}

TEST_CASE("Grasps that hold come with the largest margin first, equal ones in their order",
          "[hold_test][hold_batch]") {
  const std::vector<TestedGrasp> all = {
      tested(4, HoldStage::Held, 1.5), tested(2, HoldStage::Load, 9.0),
      tested(7, HoldStage::Held, 3.0), tested(0, HoldStage::Held, 1.5),
      tested(5, HoldStage::Rejected)};
  CHECK(hold_test::held_best_first(all) == std::vector<std::size_t>{7, 4, 0});
  const auto counts = hold_test::count_stages(all);
  CHECK(counts.at(HoldStage::Held) == 3);
  CHECK(counts.at(HoldStage::Load) == 1);
  CHECK(counts.at(HoldStage::Approach) == 0);
  CHECK(counts.at(HoldStage::Rejected) == 1);
}

TEST_CASE("A report has a row of the same width for every grasp, whatever stage it came to",
          "[hold_test][hold_report]") {
  hold_test::HoldReport report;
  report.protocol = hold_test::hold_protocol("dexgraspbench-100g");
  report.tested = {tested(0, HoldStage::Rejected), tested(1, HoldStage::Held, 2.5)};
  report.tested[0].verdict.reason = "links a, \"b\" overlap";
  for (int i = 0; i < 6; ++i) {
    report.tested[1].verdict.directions.push_back(
        {Eigen::Vector3d::Unit(i / 2) * (i % 2 == 0 ? 1.0 : -1.0), HoldStage::Held, std::nullopt,
         0.001 * i, 0.0});
  }
  const std::string csv = hold_test::to_csv(report);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1) {
    lines.push_back(csv.substr(at, csv.find('\n', at) - at));
  }
  REQUIRE(lines.size() == 3);
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  CHECK(commas(lines[2]) == commas(lines[0]));
  CHECK(commas(lines[1]) == commas(lines[0]) + 1);  // The one more is inside quotes.
  CHECK_THAT(lines[1],
             testing::StartsWith("1,false,rejected,\"links a, \"\"b\"\" overlap\",0,0,0,"));

  const auto data = nlohmann::json::parse(hold_test::to_json(report));
  const auto& grasps = data["results"]["grasps"];
  CHECK(grasps[0]["reason"] == report.tested[0].verdict.reason);
  CHECK(grasps[0]["margin"].is_null());
  CHECK(grasps[1]["margin"]["force_N"] == 2.5);
  CHECK(grasps[1]["directions"][5]["load"] == "-z");
  CHECK(grasps[1]["directions"][5]["largest_shift_m"] == 0.005);
  CHECK(data["protocol"]["parameters"]["force_N"] == 1.0);
  CHECK(hold_test::to_json(report) == hold_test::to_json(report));
}

}  // namespace
}  // namespace graspfit::test_hold_report
