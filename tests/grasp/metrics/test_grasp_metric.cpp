#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "contact/known_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/contact/epsilon_linf.hpp"
#include "graspfit/contact/grasp_matrix_quality.hpp"
#include "graspfit/grasp/grasp_metric.hpp"
#include "support/catch.hpp"

namespace test_grasp_metric {

using namespace graspfit;
using namespace graspfit::contact;
using namespace graspfit::grasp;
using base::InvalidInput;
using testing::antipodal;
using testing::Contacts;
using testing::on_cube;
using testing::on_tetrahedron;
using testing::unit_ball;

namespace {

GraspMetricInput input_of(const Contacts& contacts, double friction,
                          WrenchTool tool = WrenchTool::Graspfit) {
  return GraspMetricInput(
      {.contacts = contacts, .object = unit_ball(), .friction = friction, .tool = tool});
}

std::optional<double> value_of(const std::string& name, const GraspMetricInput& input) {
  return evaluate(grasp_metrics().at(name), input).value;
}

GraspMetric sum_of_heights() {
  return {.name = "sum_of_heights",
          .group = "my own",
          .unit = "m",
          .meaning = "sum of the contacts' z",
          .better = BetterValue::Larger,
          .value = [](const GraspMetricInput& input) -> std::optional<double> {
            double sum = 0.0;
            for (const Contact& contact : input.contacts()) sum += contact.point_O.z();
            return sum;
          },
          .convention = nullptr};
}

std::string refusal(GraspMetrics metrics, const GraspMetric& metric) {
  try {
    metrics.add(metric);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

constexpr double kRounding = 1e-12;

}  // namespace

TEST_CASE("Every metric has a name of its own, a unit and a meaning; groups hang together",
          "[grasp][grasp_metric]") {
  std::set<std::string> names;
  std::set<std::string> groups;
  std::string group;
  for (const GraspMetric& metric : grasp_metrics().all()) {
    CAPTURE(metric.name);
    CHECK(names.insert(metric.name).second);
    CHECK(&grasp_metrics().at(metric.name) == &metric);
    CHECK_FALSE(metric.unit.empty());
    CHECK(metric.meaning.size() <= 80);
    if (metric.group != group) CHECK(groups.insert(metric.group).second);
    group = metric.group;
  }
  for (const char* const name : {"m", "m1", "m2", "m3", "epsilon", "epsilon_graspit", "volume",
                                 "force_closure", "balance_residual", "contact_area"}) {
    CHECK(grasp_metrics().contains(name));
  }
}

TEST_CASE("Metrics of contacts alone have the known values", "[grasp][grasp_metric]") {
  const double mu = 0.5;
  const GraspMetricInput cube = input_of(on_cube(), mu);
  CHECK(*value_of("epsilon", cube) == Approx(mu * std::sqrt(2.0 / 3.0)).epsilon(kRounding));
  CHECK(*value_of("epsilon_graspit", cube) == *value_of("epsilon", cube));
  CHECK(*value_of("volume", cube) == Approx(0.598633733).epsilon(3e-9));
  CHECK(*value_of("force_closure", cube) == 1.0);
  CHECK(*value_of("wrench_rank", cube) == 6.0);
  CHECK(*value_of("balance_residual", cube) == Approx(0.0).margin(kRounding));

  const GraspMetricInput two = input_of(antipodal(), mu);
  CHECK(*value_of("epsilon", two) == 0.0);
  CHECK(*value_of("force_closure", two) == 0.0);
  CHECK(*value_of("wrench_rank", two) == 5.0);
  CHECK(*value_of("volume", two) == 0.0);

  // One contact with unit normal force and no friction leaves that force over.
  const GraspMetricInput one = input_of({antipodal().front()}, 0.0);
  CHECK(*value_of("balance_residual", one) == Approx(1.0).epsilon(kRounding));
  CHECK(*value_of("epsilon", one) == 0.0);
  CHECK(*value_of("epsilon_graspit", one) == -1.0);
}

TEST_CASE("A metric is in the convention that was asked for, and says so",
          "[grasp][grasp_metric]") {
  const double mu = 0.5;
  const GraspMetric& epsilon = grasp_metrics().at("epsilon");
  const GraspMetricValue own = evaluate(epsilon, input_of(on_cube(), mu));
  CHECK(
      own.convention ==
      "graspfit: torques about (0, 0, 0) m over 1 m, friction 0.5, 8 inscribed edges from normal x "
      "e_x, L1, unit normal force, outside 0");
  // Half the longest extent of the ball is its radius, so that only the forces are shorter.
  const GraspMetricValue simox = evaluate(epsilon, input_of(on_cube(), mu, WrenchTool::Simox));
  CHECK(*simox.value == Approx(*own.value / std::hypot(1.0, mu)).epsilon(kRounding));
  CHECK_THAT(simox.convention, testing::StartsWith("Simox: "));
  for (const WrenchTool tool :
       {WrenchTool::DexNet, WrenchTool::Frogger, WrenchTool::DexGraspBench}) {
    const GraspMetricValue value = evaluate(epsilon, input_of(on_cube(), mu, tool));
    CHECK(*value.value > 0.0);
    CHECK(value.convention != own.convention);
  }
}

TEST_CASE("Metrics have no value where what they need is not there", "[grasp][grasp_metric]") {
  // Metrics of a measured grasp are not known of contacts alone.
  const GraspMetricInput contacts_only = input_of(on_cube(), 0.5);
  for (const char* const name : {"m", "m1", "m2", "m3", "penetration", "penetrates"}) {
    CHECK_FALSE(value_of(name, contacts_only).has_value());
  }
  CHECK_FALSE(value_of("requested_gap_max", contacts_only).has_value());
  const GraspMetricInput nothing = input_of({}, 0.5);
  for (const GraspMetric& metric : grasp_metrics().all()) {
    CAPTURE(metric.name);
    const GraspMetricValue found = evaluate(metric, nothing);
    CHECK(found.value.has_value() ==
          (metric.name == "num_contacts" || metric.name == "num_touching"));
  }
  CHECK(*value_of("num_contacts", nothing) == 0.0);
  // DexGraspBench has no torque scale for contacts in one point.
  const Contacts same = {on_cube()[0], on_cube()[0]};
  CHECK_FALSE(value_of("epsilon", input_of(same, 0.5, WrenchTool::DexGraspBench)).has_value());
  CHECK(value_of("epsilon", input_of(same, 0.5)).has_value());
  CHECK_THROWS_AS(value_of("epsilon", input_of(on_cube(), -0.5)), InvalidInput);
}

TEST_CASE("Pads that do not touch bear no force, but count in M", "[grasp][grasp_metric]") {
  Contacts contacts = on_tetrahedron();
  contacts[3].gap = 0.0002;
  const Contacts touching(contacts.begin(), contacts.begin() + 3);
  grasp::GraspMetricFacts facts = input_of(contacts, 0.5).facts();
  facts.bearing_gap = 0.0001;
  const GraspMetricInput some(facts);
  const GraspMetricInput three = input_of(touching, 0.5);
  for (const char* const name :
       {"epsilon", "epsilon_graspit", "volume", "force_closure", "wrench_rank", "epsilon_linf",
        "min_weight", "balance_residual", "sigma_min"}) {
    CAPTURE(name);
    CHECK(value_of(name, some) == value_of(name, three));
  }
  CHECK(*value_of("epsilon", some) != *value_of("epsilon", input_of(contacts, 0.5)));
  CHECK(*value_of("num_contacts", some) == 4.0);
  CHECK(*value_of("num_touching", some) == 3.0);
  CHECK(*value_of("num_touching", input_of(contacts, 0.5)) == 4.0);  // No gap is too large.
}

TEST_CASE("Areas and gaps are those of the contacts", "[grasp][grasp_metric]") {
  Contacts contacts = on_tetrahedron();
  const std::vector<double> gaps = {0.0001, 0.0004, 0.0, 0.0011};
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    contacts[i].gap = gaps[i];
    contacts[i].area = 1e-4 * static_cast<double>(i + 1);
    contacts[i].is_target = i < 2;
  }
  const GraspMetricInput input = input_of(contacts, 0.5);
  CHECK(*value_of("contact_area", input) == Approx(1e-3).epsilon(kRounding));
  CHECK(*value_of("contact_gap_mean", input) == Approx(0.0004).epsilon(kRounding));
  CHECK(*value_of("contact_gap_spread", input) == Approx(0.0011).epsilon(kRounding));
  CHECK(*value_of("contact_gap_max", input) == 0.0011);
  CHECK(*value_of("requested_gap_max", input) == 0.0004);
  CHECK(*value_of("num_contacts", input) == 4.0);
}

TEST_CASE(
    "Min-weight, singular values and epsilon, L-infinity, are those of the library's functions",
    "[grasp][grasp_metric]") {
  const double mu = 0.5;
  const GraspMetricInput cube = input_of(on_cube(), mu);
  // The known min-weight of case F is 1/48 for its 48 edges.
  CHECK(*value_of("min_weight", cube) == Approx(1.0).epsilon(1e-9));
  // Of six contacts on a ball three singular values are the root of 6, three are 2.
  CHECK(*value_of("sigma_min", cube) == Approx(2.0).epsilon(kRounding));
  CHECK(*value_of("sigma_product", cube) ==
        Approx(std::pow(2.0 * std::sqrt(6.0), 3)).epsilon(kRounding));
  CHECK(*value_of("sigma_ratio", cube) == Approx(2.0 / std::sqrt(6.0)).epsilon(kRounding));

  // Two opposite contacts balance evenly without closure: rank 5 has no min-weight.
  const GraspMetricInput two = input_of(antipodal(), mu);
  CHECK_FALSE(value_of("min_weight", two).has_value());
  CHECK(*value_of("sigma_min", two) == Approx(0.0).margin(1e-15));
  CHECK(*value_of("epsilon_linf", two) == 0.0);

  const GraspMetricInput four = input_of(on_tetrahedron(), mu);
  const WrenchConvention& convention = *four.convention();
  const GraspMatrixQuality matrix = grasp_matrix_quality(
      on_tetrahedron(), convention.reference_point_O, convention.options.torque_scale.value());
  CHECK(*value_of("sigma_min", four) == matrix.smallest());
  CHECK(*value_of("sigma_ratio", four) == matrix.ratio());
  const GraspMetricValue linf = evaluate(grasp_metrics().at("epsilon_linf"), four);
  CHECK(*linf.value == epsilon_linf(on_tetrahedron(), convention).lower);
  CHECK(*linf.value > *value_of("epsilon", four));
  CHECK_THAT(linf.convention, testing::EndsWith("certified lower bound"));
}

TEST_CASE("Bad facts are refused every time that they are asked for", "[grasp][grasp_metric]") {
  const GraspMetricInput bad = input_of(on_cube(), -0.5);
  CHECK_THROWS_AS(bad.convention(), InvalidInput);
  CHECK_THROWS_AS(bad.convention(), InvalidInput);
  CHECK_THROWS_AS(value_of("epsilon", bad), InvalidInput);
}

TEST_CASE("Metrics of a measured grasp are its own numbers", "[grasp][grasp_metric]") {
  Grasp grasp;
  grasp.contacts = on_cube();
  grasp.quality.m1 = 1.5;
  grasp.quality.m2 = 3.0;
  grasp.quality.m3 = 0.25;
  grasp.quality.m = 2.25;
  grasp.penetration.object_depth = 0.002;
  grasp.penetration.object_depth_bound = 0.003;
  grasp.penetration.self_depth = 0.001;
  const GraspMetricInput input(
      {.contacts = grasp.contacts, .object = unit_ball(), .grasp = &grasp});
  CHECK(*value_of("m", input) == 2.25);
  CHECK(*value_of("m1", input) == 1.5);
  CHECK(*value_of("m2", input) == 3.0);
  CHECK(*value_of("m3", input) == 0.25);
  CHECK(*value_of("penetration", input) == 0.002);
  CHECK(*value_of("penetration_bound", input) == 0.003);
  CHECK(*value_of("self_penetration", input) == 0.001);
  CHECK(*value_of("penetrates", input) == 0.0);
  grasp.penetration.surroundings_touched = true;
  CHECK(*value_of("penetrates", input) == 1.0);
}

TEST_CASE("Metrics of one's own are added, chosen by name and refused where they are not whole",
          "[grasp][grasp_metric]") {
  GraspMetrics metrics = grasp_metrics();
  metrics.add(sum_of_heights());
  CHECK(metrics.all().back().name == "sum_of_heights");
  CHECK_FALSE(grasp_metrics().contains("sum_of_heights"));
  CHECK(*evaluate(metrics.at("sum_of_heights"), input_of(on_cube(), 0.5)).value ==
        Approx(0.0).margin(kRounding));

  GraspMetric of_contacts = sum_of_heights();
  of_contacts.name = "of_contacts";
  of_contacts.group = "contacts";
  metrics.add(of_contacts);  // It goes after the last of its group.
  const auto all = metrics.all();
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].name == "of_contacts") CHECK(all[i - 1].group == "contacts");
  }

  const GraspMetrics chosen = metrics.selected(std::vector<std::string>{"sum_of_heights", "m"});
  REQUIRE(chosen.all().size() == 2);
  CHECK(chosen.all()[0].name == "m");
  CHECK_THROWS_WITH(metrics.at("sum"), testing::Contains("no metric \"sum\"; there are m, m1"));
  CHECK_THROWS_AS(metrics.selected(std::vector<std::string>{"m", "m"}), InvalidInput);

  const auto changed = [](auto change) {
    GraspMetric metric = sum_of_heights();
    change(metric);
    return metric;
  };
  CHECK_THAT(refusal(metrics, sum_of_heights()), testing::Contains("new: there is such a metric"));
  for (const char* const name : {"", "Sum", "sum of", "_sum", "sum_", "sum__of", "2_sums"}) {
    CHECK_THAT(refusal({}, changed([&](GraspMetric& metric) { metric.name = name; })),
               testing::Contains("snake_case"));
  }
  CHECK_THAT(refusal({}, changed([](GraspMetric& metric) { metric.unit.clear(); })),
             testing::Contains("unit of sum_of_heights"));
  CHECK_THAT(refusal({}, changed([](GraspMetric& metric) { metric.group.clear(); })),
             testing::Contains("group of sum_of_heights"));
  CHECK_THAT(refusal({}, changed([](GraspMetric& metric) { metric.meaning.clear(); })),
             testing::Contains("meaning of sum_of_heights"));
  CHECK_THAT(refusal({}, changed([](GraspMetric& metric) { metric.value = nullptr; })),
             testing::Contains("value of sum_of_heights"));
}

}  // namespace test_grasp_metric
