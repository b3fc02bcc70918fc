#include "output/metric_report.hpp"

#include <nlohmann/json.hpp>

#include "graspfit/base/number_text.hpp"
#include "graspfit/sweep/result_table.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

using grasp::GraspMetric;
using grasp::GraspMetricValue;

const char* name_of(grasp::BetterValue better) {
  return better == grasp::BetterValue::Larger ? "larger" : "smaller";
}

/// Heading of a metric in a table: "contact_area [m2]".
std::string heading(const GraspMetric& metric) {
  return metric.unit == "1" ? metric.name : metric.name + " [" + metric.unit + "]";
}

std::string text_of(const std::optional<double>& value) {
  return value ? significant_decimal(*value, 6) : "-";
}

}  // namespace

void MetricReport::add(const grasp::GraspMetricInput& input) {
  std::vector<GraspMetricValue> row;
  for (const GraspMetric& metric : metrics_.all()) row.push_back(evaluate(metric, input));
  values_.push_back(std::move(row));
}

std::string MetricReport::group_table(std::size_t first, std::size_t last) const {
  const auto metrics = metrics_.all();
  std::vector<std::vector<std::string>> rows = {{"rank"}};
  for (std::size_t m = first; m < last; ++m) rows[0].push_back(heading(metrics[m]));
  for (const auto& values : values_) {
    std::vector<std::string> row = {std::to_string(rows.size())};
    for (std::size_t m = first; m < last; ++m) row.push_back(text_of(values[m].value));
    rows.push_back(std::move(row));
  }
  std::string text = metrics[first].group + "\n" + text_table(rows);
  // A convention is printed once for the metrics that have it in common. If it changes from grasp
  // to grasp, as for a tool that scales by contacts, the first grasp's is printed.
  std::vector<std::pair<std::string, std::string>> names_of_convention;
  for (std::size_t m = first; m < last && !values_.empty(); ++m) {
    const std::string& convention = values_[0][m].convention;
    if (convention.empty()) continue;
    if (!names_of_convention.empty() && names_of_convention.back().first == convention) {
      names_of_convention.back().second += ", " + metrics[m].name;
    } else {
      names_of_convention.emplace_back(convention, metrics[m].name);
    }
  }
  for (const auto& [convention, names] : names_of_convention) {
    text.append("  ").append(names).append(": ").append(convention).append("\n");
  }
  return text;
}

std::string MetricReport::tables() const {
  const auto metrics = metrics_.all();
  std::string text;
  for (std::size_t first = 0; first < metrics.size();) {
    std::size_t last = first + 1;
    while (last < metrics.size() && metrics[last].group == metrics[first].group) ++last;
    text += "\n" + group_table(first, last);
    first = last;
  }
  return text;
}

std::string MetricReport::csv() const {
  std::string text = sweep::csv_line({"grasp", "metric", "value", "unit", "better", "convention"});
  for (std::size_t g = 0; g < values_.size(); ++g) {
    for (std::size_t m = 0; m < values_[g].size(); ++m) {
      const GraspMetric& metric = metrics_.all()[m];
      const GraspMetricValue& value = values_[g][m];
      text += sweep::csv_line({std::to_string(g + 1), metric.name,
                               value.value ? base::shortest_decimal(*value.value) : std::string(),
                               metric.unit, name_of(metric.better),
                               sweep::csv_field(value.convention)});
    }
  }
  return text;
}

std::string MetricReport::json(std::size_t grasp) const {
  std::string text = "{";
  const auto quoted = [](const std::string& words) { return nlohmann::json(words).dump(); };
  for (std::size_t m = 0; m < values_[grasp].size(); ++m) {
    const GraspMetric& metric = metrics_.all()[m];
    const GraspMetricValue& value = values_[grasp][m];
    text += (m == 0 ? "\n" : ",\n") + ("       " + quoted(metric.name)) + ": {\"value\": " +
            (value.value ? base::shortest_decimal(*value.value) : std::string("null")) +
            ", \"unit\": " + quoted(metric.unit) +
            ", \"better\": " + quoted(name_of(metric.better)) +
            ", \"convention\": " + quoted(value.convention) + "}";
  }
  return text + "}";
}

std::string metrics_help() {
  std::string text;
  std::string group;
  for (const GraspMetric& metric : grasp::grasp_metrics().all()) {
    if (metric.group != group) text += "\n  " + metric.group + "\n";
    group = metric.group;
    text += "    " + heading(metric) + ": " + metric.meaning +
            (metric.better == grasp::BetterValue::Larger ? "" : " (smaller is better)") + "\n";
  }
  return text;
}

}  // namespace graspfit::app
