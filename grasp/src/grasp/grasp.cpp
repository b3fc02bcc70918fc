#include "graspfit/grasp/grasp.hpp"

#include <algorithm>
#include <limits>

namespace graspfit::grasp {

namespace {

template <class IsMeant>
bool has_target(const Grasp& grasp, const IsMeant& is_meant) {
  return std::any_of(grasp.targets.contacts.begin(), grasp.targets.contacts.end(), is_meant);
}

}  // namespace

bool Grasp::has_palm_target() const {
  return has_target(*this, [](const TargetContact& target) { return target.is_palm; });
}

bool Grasp::has_target_behind_tip() const {
  return has_target(*this, [](const TargetContact& target) { return target.pad.has_value(); });
}

std::vector<double> target_distances(const Grasp& grasp) {
  std::vector<double> distances;
  for (const TargetContact& target : grasp.targets.contacts) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const contact::Contact& contact : grasp.contacts) {
      if (!contact.is_target || !is_for_part_of(target, contact)) continue;
      nearest = std::min(nearest, (contact.point_O - target.point_O).norm());
    }
    distances.push_back(nearest);
  }
  return distances;
}

}  // namespace graspfit::grasp
