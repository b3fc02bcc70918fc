#include "graspfit/grasp/grasp.hpp"

#include <algorithm>
#include <limits>

namespace graspfit::grasp {

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
