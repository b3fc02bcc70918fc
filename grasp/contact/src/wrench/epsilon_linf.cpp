#include "graspfit/contact/epsilon_linf.hpp"

#include <vector>

#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/geometry/minkowski_sum.hpp"
#include "wrench/convention_text.hpp"

namespace graspfit::contact {

std::string describe_linf(const WrenchConvention& convention) {
  return internal::describe(convention, "L-infinity");
}

LInfinityEpsilon epsilon_linf(std::span<const Contact> contacts,
                              const WrenchConvention& convention) {
  LInfinityEpsilon result;
  const Wrenches wrenches = contact_wrenches(contacts, convention);
  if (contacts.empty()) return result;
  const Eigen::Index num_edges = convention.options.num_cone_edges;
  std::vector<Eigen::MatrixXd> cones;
  for (Eigen::Index first = 0; first < wrenches.cols(); first += num_edges) {
    cones.emplace_back(wrenches.middleCols(first, num_edges));
  }
  const geometry::InradiusBounds bounds = geometry::minkowski_sum_inradius(cones);
  result.lower = bounds.lower;
  result.upper = bounds.upper;
  result.num_points = bounds.num_points;
  return result;
}

}  // namespace graspfit::contact
