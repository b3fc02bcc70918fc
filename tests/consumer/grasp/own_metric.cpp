// A metric of one's own: the largest load along -z that contacts carry, over the sum of their
// normal forces.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "graspfit/grasp/grasp_metric.hpp"

using namespace graspfit::contact;
using namespace graspfit::grasp;

// How far the wrench space reaches along the force e_z: the nearest facet's plane on the way.
std::optional<double> carried_load(const GraspMetricInput& input) {
  const GraspWrenchSpace* space = input.wrench_space();
  if (space == nullptr || !is_force_closure(*space)) return std::nullopt;
  double reach = std::numeric_limits<double>::infinity();
  for (int f = 0; f < space->hull.num_facets(); ++f) {
    const double slope = space->hull.normals()(2, f);
    if (slope > 0.0) reach = std::min(reach, space->hull.offsets()[f] / slope);
  }
  return reach;
}

Contact contact(const Eigen::Vector3d& point) {
  Contact contact;
  contact.point_O = point;
  contact.inward_normal_O = -point.normalized();
  return contact;
}

int main() {
  GraspMetrics metrics = grasp_metrics();
  metrics.add({.name = "carried_load",
               .group = "my metrics",
               .unit = "1",
               .meaning = "largest load along -z over the sum of normal forces",
               .better = BetterValue::Larger,
               .value = carried_load,
               .convention = nullptr});

  // Four fingers around the equator of a ball: friction alone carries, mu newtons per newton.
  const double r = 0.04;
  const double mu = 0.5;
  const GraspMetricInput grasp(
      {.contacts = {contact({r, 0, 0}), contact({-r, 0, 0}), contact({0, r, 0}),
                    contact({0, -r, 0})},
       .object = {.largest_radius = r, .extents_O = Eigen::Vector3d::Constant(2 * r)},
       .friction = mu});
  for (const char* const name : {"epsilon", "min_weight", "carried_load"}) {
    const GraspMetricValue found = evaluate(metrics.at(name), grasp);
    std::printf("%-12s %.6f\n", name, *found.value);
  }
  return std::abs(*evaluate(metrics.at("carried_load"), grasp).value - mu) < 1e-12 ? 0 : 1;
}
