#include "quality/contact_hull.hpp"

#include <cstdint>

#include "graspfit/base/disjoint_sets.hpp"

namespace graspfit::contact::internal {
namespace {

using Eigen::Vector3d;

constexpr double kCollinearRel = 1e-3;  // second over first singular value
constexpr double kPlanarRel = 0.1;      // thickness over extent

}  // namespace

ContactHull contact_hull(std::span<const Vector3d> contacts, double merge_distance) {
  base::DisjointSets sets(contacts.size());
  for (std::int32_t i = 0; i < std::ssize(contacts); ++i) {
    for (std::int32_t j = i + 1; j < std::ssize(contacts); ++j) {
      if ((contacts[i] - contacts[j]).norm() < merge_distance) {
        sets.unite(i, j);
      }
    }
  }
  const std::vector<std::int32_t> set_of = sets.numbered();
  ContactHull result;
  result.num_contacts = contacts.size();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    // Each set has become a point where its first contact was met.
    if (set_of[i] < std::ssize(result.points)) continue;
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (std::size_t j = i; j < contacts.size(); ++j) {
      if (set_of[j] != set_of[i]) continue;
      sum += contacts[j];
      ++count;
    }
    result.points.push_back(count == 1 ? contacts[i] : Vector3d(sum / count));
  }
  result.hull = geometry::convex_hull(result.points,
                                      {.collinear_rel = kCollinearRel, .planar_rel = kPlanarRel});
  return result;
}

}  // namespace graspfit::contact::internal
