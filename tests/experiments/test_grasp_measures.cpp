#include <set>
#include <string>

#include "cells/grasp_measures.hpp"
#include "graspfit/grasp/grasp_metric.hpp"
#include "support/catch.hpp"

namespace test_grasp_measures {

using namespace graspfit;
using namespace graspfit::sweep;
using namespace graspfit::experiments;

TEST_CASE("Every metric but those of pose robustness is a column with its unit and meaning",
          "[experiments][grasp_measures]") {
  const std::vector<Column> columns = internal::grasp_measure_columns();
  std::set<std::string> names;
  for (const Column& column : columns) {
    CHECK(names.insert(column.name).second);
    CHECK_FALSE(column.meaning.empty());
  }
  std::size_t num_left_out = 0;
  for (const grasp::GraspMetric& metric : grasp::grasp_metrics().all()) {
    INFO(metric.name);
    CHECK((names.count(metric.name) == 0) == (metric.group == "pose robustness"));
    if (names.count(metric.name) == 0) ++num_left_out;
  }
  CHECK(num_left_out > 0);
  CHECK(columns.size() + num_left_out == grasp::grasp_metrics().all().size());
  for (const std::string& name : internal::correlated_measures()) CHECK(names.count(name) == 1);
}

}  // namespace test_grasp_measures
