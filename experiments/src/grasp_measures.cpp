#include "internal/grasp_measures.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace graspfit::experiments::internal {
namespace {

struct Measure {
  Column column;
  std::optional<double> (*value)(const grasp::Grasp&);
};

const std::array<Measure, 7>& all_measures() {
  using grasp::Grasp;
  static const std::array<Measure, 7> measures = {
      {{{"m", "1", "M"}, [](const Grasp& g) -> std::optional<double> { return g.quality.m; }},
       {{"m1", "1", "M1"}, [](const Grasp& g) -> std::optional<double> { return g.quality.m1; }},
       {{"m2", "1", "M2"}, [](const Grasp& g) -> std::optional<double> { return g.quality.m2; }},
       {{"m3", "1", "M3"}, [](const Grasp& g) -> std::optional<double> { return g.quality.m3; }},
       {{"epsilon", "1", "epsilon, GraspIt!'s convention, 0 without closure"},
        [](const Grasp& g) -> std::optional<double> { return std::max(0.0, g.wrench.epsilon); }},
       {{"volume", "1", "volume of the wrench space, GraspIt!'s convention"},
        [](const Grasp& g) -> std::optional<double> { return g.wrench.volume; }},
       {{"contact_area_m2", "m2", "of all contacts"}, [](const Grasp& g) -> std::optional<double> {
          double area = 0.0;
          for (const grasp::Contact& contact : g.contacts) area += contact.area;
          return area;
        }}}};
  return measures;
}

}  // namespace

std::vector<Column> grasp_measure_columns() {
  std::vector<Column> columns;
  for (const Measure& measure : all_measures()) columns.push_back(measure.column);
  return columns;
}

GraspMeasures measures_of(const Planned&, const grasp::Grasp& grasp, double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  GraspMeasures values;
  for (const Measure& measure : all_measures()) {
    values[measure.column.name] = measure.value(grasp);
  }
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return values;
}

std::vector<std::string> correlated_measures() {
  return {"m", "m1", "m2", "m3", "epsilon", "volume"};
}

}  // namespace graspfit::experiments::internal
