#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "metrics/metric_list.hpp"

namespace graspfit::grasp::internal {
namespace {

using Value = std::optional<double>;
using Contacts = std::span<const contact::Contact>;

GraspMetric of_contacts(std::string name, std::string unit, std::string meaning, BetterValue better,
                        double (*value)(Contacts)) {
  return {.name = std::move(name),
          .group = "contacts",
          .unit = std::move(unit),
          .meaning = std::move(meaning),
          .better = better,
          .value = [value](const GraspMetricInput& input) -> Value {
            if (input.contacts().empty()) return std::nullopt;
            return value(input.contacts());
          },
          .convention = nullptr};
}

bool has_smaller_gap(const contact::Contact& a, const contact::Contact& b) { return a.gap < b.gap; }

double largest_gap(Contacts contacts) {
  return std::max_element(contacts.begin(), contacts.end(), has_smaller_gap)->gap;
}

double sum(Contacts contacts, double contact::Contact::*field) {
  return std::accumulate(
      contacts.begin(), contacts.end(), 0.0,
      [field](double total, const contact::Contact& contact) { return total + contact.*field; });
}

/// Mean or largest distance of the targets from their contacts; none without targets, and where one
/// has no contact.
Value distance_from_targets(const GraspMetricInput& input, bool is_mean) {
  if (input.facts().grasp == nullptr) return std::nullopt;
  const std::vector<double> distances = target_distances(*input.facts().grasp);
  if (distances.empty()) return std::nullopt;
  const double largest = *std::max_element(distances.begin(), distances.end());
  if (!std::isfinite(largest)) return std::nullopt;
  if (!is_mean) return largest;
  return std::accumulate(distances.begin(), distances.end(), 0.0) /
         static_cast<double>(distances.size());
}

}  // namespace

std::vector<GraspMetric> contact_metrics() {
  std::vector<GraspMetric> metrics = {
      of_contacts("contact_area", "m2", "object surface inside the clip volumes, all contacts",
                  BetterValue::Larger,
                  [](Contacts contacts) { return sum(contacts, &contact::Contact::area); }),
      of_contacts("contact_gap_mean", "m", "mean distance of the contacts' pads from the surface",
                  BetterValue::Smaller,
                  [](Contacts contacts) {
                    return sum(contacts, &contact::Contact::gap) /
                           static_cast<double>(contacts.size());
                  }),
      of_contacts("contact_gap_spread", "m", "largest less smallest gap of the contacts",
                  BetterValue::Smaller,
                  [](Contacts contacts) {
                    return largest_gap(contacts) -
                           std::min_element(contacts.begin(), contacts.end(), has_smaller_gap)->gap;
                  }),
      of_contacts("contact_gap_max", "m", "largest gap of a contact", BetterValue::Smaller,
                  largest_gap)};
  metrics.push_back({.name = "requested_gap_max",
                     .group = "contacts",
                     .unit = "m",
                     .meaning = "largest gap of the contacts that were asked for",
                     .better = BetterValue::Smaller,
                     .value = [](const GraspMetricInput& input) -> Value {
                       Value largest;
                       for (const contact::Contact& contact : input.contacts()) {
                         if (contact.is_target)
                           largest = std::max(largest.value_or(0), contact.gap);
                       }
                       return largest;
                     },
                     .convention = nullptr});
  for (const auto& [name, meaning, is_mean] :
       {std::tuple("target_distance_mean", "mean distance of the contacts from their targets",
                   true),
        std::tuple("target_distance_max", "largest distance of a contact from its target",
                   false)}) {
    metrics.push_back({.name = name,
                       .group = "contacts",
                       .unit = "m",
                       .meaning = meaning,
                       .better = BetterValue::Smaller,
                       .value = [is_mean = is_mean](const GraspMetricInput& input) -> Value {
                         return distance_from_targets(input, is_mean);
                       },
                       .convention = nullptr});
  }
  metrics.push_back({.name = "num_contacts",
                     .group = "contacts",
                     .unit = "1",
                     .meaning = "number of contacts, N'",
                     .better = BetterValue::Larger,
                     .value = [](const GraspMetricInput& input) -> Value {
                       return static_cast<double>(input.contacts().size());
                     },
                     .convention = nullptr});
  metrics.push_back({.name = "num_touching",
                     .group = "contacts",
                     .unit = "1",
                     .meaning = "number of contacts that bear forces: of refined grasps those that "
                                "touch",
                     .better = BetterValue::Larger,
                     .value = [](const GraspMetricInput& input) -> Value {
                       return static_cast<double>(input.touching().size());
                     },
                     .convention = nullptr});
  return metrics;
}

}  // namespace graspfit::grasp::internal
