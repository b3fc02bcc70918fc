#include <string>
#include <vector>

#include "internal/metric_columns.hpp"
#include "support/catch.hpp"

using namespace graspfit;
using namespace graspfit::experiments;

TEST_CASE("Metrics become columns with their units, empty where they are not defined",
          "[experiments][metric_columns]") {
  const grasp::GraspMetrics metrics = grasp::grasp_metrics().selected(
      std::vector<std::string>{"m", "contact_area", "num_contacts"});
  const std::vector<Column> columns = internal::metric_columns(metrics);
  REQUIRE(columns.size() == 3);
  CHECK(columns[0].name == "m");
  CHECK(columns[1].name == "contact_area_m2");
  CHECK(columns[1].unit == "m2");
  CHECK(columns[2].name == "num_contacts");
  for (const Column& column : columns) CHECK_FALSE(column.meaning.empty());

  grasp::Contact contact;
  contact.area = 0.25;
  ResultRow row(columns);
  internal::fill_metric_columns(
      metrics, grasp::GraspMetricInput({.contacts = {contact, contact}, .object = {}}), row);
  CHECK(row.csv_fields() == std::vector<std::string>{"", "0.5", "2"});
}
