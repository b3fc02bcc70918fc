#include "graspfit/grasp/grasp_metric.hpp"

#include <algorithm>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "metrics/metric_list.hpp"

namespace graspfit::grasp {
namespace {

bool is_snake_case(std::string_view name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && is_letter(name.front()) && name.back() != '_' &&
         name.find("__") == std::string_view::npos &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

/// Whether contacts have a torque scale in a convention that takes it from them.
bool is_spread(std::span<const contact::Contact> contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [&](const contact::Contact& contact) {
    return contact.point_O != contacts.front().point_O;
  });
}

}  // namespace

GraspMetricInput::GraspMetricInput(GraspMetricFacts facts)
    : facts_(std::move(facts)),
      touching_(contact::touching_contacts(facts_.contacts, facts_.bearing_gap)) {}

const std::optional<contact::WrenchConvention>& GraspMetricInput::convention() const {
  if (has_asked_for_convention_) return convention_;
  if (!touching().empty() &&
      (facts_.tool != contact::WrenchTool::DexGraspBench || is_spread(touching()))) {
    convention_ =
        contact::wrench_convention(facts_.tool, facts_.object, touching(), facts_.friction);
  }
  has_asked_for_convention_ = true;  // set last, so that facts that are refused are refused again
  return convention_;
}

const contact::GraspWrenchSpace* GraspMetricInput::wrench_space() const {
  if (!wrench_space_ && convention())
    wrench_space_ = contact::grasp_wrench_space(touching(), *convention());
  return wrench_space_ ? &*wrench_space_ : nullptr;
}

const contact::ContactQuality* GraspMetricInput::quality() const {
  if (facts_.grasp != nullptr) return &facts_.grasp->quality;
  if (!quality_ && facts_.quality_context) {
    quality_ =
        contact::contact_quality(contacts(), *facts_.quality_context, facts_.quality_options);
  }
  return quality_ ? &*quality_ : nullptr;
}

const PoseRobustness* GraspMetricInput::robustness() const {
  if (!robustness_) robustness_ = pose_robustness(facts_);
  return robustness_ ? &*robustness_ : nullptr;
}

GraspMetricValue evaluate(const GraspMetric& metric, const GraspMetricInput& input) {
  return {metric.value(input), metric.convention ? metric.convention(input) : std::string()};
}

void GraspMetrics::add(GraspMetric metric) {
  const auto check = [&](bool is_met, std::string_view field, std::string_view value,
                         std::string_view rule) {
    base::require(is_met, "GraspMetric", field, value, rule);
  };
  check(is_snake_case(metric.name), "name", metric.name, "in snake_case");
  check(!contains(metric.name), "name", metric.name, "new: there is such a metric");
  const std::string of = " of " + metric.name;
  check(!metric.group.empty(), "group" + of, metric.group, "given");
  check(!metric.unit.empty(), "unit" + of, metric.unit, "given, 1 where it has none");
  check(!metric.meaning.empty(), "meaning" + of, metric.meaning, "given");
  check(metric.value != nullptr, "value" + of, "null", "a function");
  const auto last_of_group =
      std::find_if(metrics_.rbegin(), metrics_.rend(),
                   [&](const GraspMetric& other) { return other.group == metric.group; });
  const auto position = last_of_group == metrics_.rend() ? metrics_.end() : last_of_group.base();
  metrics_.insert(position, std::move(metric));
}

bool GraspMetrics::contains(std::string_view name) const {
  return std::any_of(metrics_.begin(), metrics_.end(),
                     [&](const GraspMetric& metric) { return metric.name == name; });
}

const GraspMetric& GraspMetrics::at(std::string_view name) const {
  const auto found = std::find_if(metrics_.begin(), metrics_.end(),
                                  [&](const GraspMetric& metric) { return metric.name == name; });
  if (found != metrics_.end()) return *found;
  std::vector<std::string> names;
  for (const GraspMetric& metric : metrics_) names.push_back(metric.name);
  throw base::InvalidInput("there is no metric \"" + std::string(name) + "\"; there are " +
                           base::known_names(name, names));
}

GraspMetrics GraspMetrics::selected(std::span<const std::string> names) const {
  for (const std::string& name : names) {
    at(name);
    base::require(std::count(names.begin(), names.end(), name) == 1, "metrics", "name", name,
                  "given once");
  }
  GraspMetrics chosen;
  for (const GraspMetric& metric : metrics_) {
    if (std::count(names.begin(), names.end(), metric.name) > 0) chosen.metrics_.push_back(metric);
  }
  return chosen;
}

const GraspMetrics& grasp_metrics() {
  static const GraspMetrics metrics = [] {
    GraspMetrics all;
    for (const auto& family : {
             internal::contact_quality_metrics(),
             internal::wrench_space_metrics(),
             internal::epsilon_linf_metrics(),
             internal::min_weight_metrics(),
             internal::balance_metrics(),
             internal::grasp_matrix_metrics(),
             internal::contact_metrics(),
             internal::penetration_metrics(),
             internal::pose_robustness_metrics(),
         }) {
      for (const GraspMetric& metric : family) all.add(metric);
    }
    return all;
  }();
  return metrics;
}

GraspMetricFacts metric_facts(const ObjectModel& object, const hands::HandModel& hand,
                              const PlannerOptions& options, const Grasp& grasp) {
  GraspMetricFacts facts;
  facts.contacts = grasp.contacts;
  facts.bearing_gap = bearing_gap(options);
  facts.object = contact::wrench_object(object.mesh(), object.mass.center_of_mass);
  facts.friction = options.friction;
  facts.grasp = &grasp;
  facts.surface = &object.query;
  facts.quality_context = contact::QualityContext{.center_of_mass_O = object.mass.center_of_mass,
                                                  .normalizing_radius = object.normalizing_radius,
                                                  .hand = &hand};
  facts.quality_options = options.quality;
  facts.quality_options.merge_distance = merge_distance(options, object.grid.lattice.voxel_size);
  return facts;
}

std::string internal::describe_convention(const GraspMetricInput& input) {
  return input.convention() ? contact::describe(*input.convention()) : std::string();
}

}  // namespace graspfit::grasp
