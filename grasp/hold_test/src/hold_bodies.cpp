#include <algorithm>
#include <limits>

#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test {
namespace {

constexpr double kFootHeight = 1e-3;  // [m]

/// See `HoldObject::foot_O`.
std::vector<Eigen::Vector3d> foot(const geometry::TriangleMesh& mesh,
                                  const Eigen::Vector3d& center) {
  double lowest = center.z();
  for (const Eigen::Vector3d& vertex : mesh.vertices) lowest = std::min(lowest, vertex.z());
  std::vector<Eigen::Vector3d> low;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if (vertex.z() <= lowest + kFootHeight) low.push_back(vertex);
  }
  std::vector<Eigen::Vector3d> corners;
  for (const std::size_t i : geometry::convex_hull(low).vertices) {
    corners.push_back(low[i]);
    corners.push_back(low[i] + kFootHeight * (center - low[i]).normalized());
  }
  return corners;
}

}  // namespace

HoldObject prepare_hold_object(const geometry::TriangleMesh& mesh,
                               const geometry::ConvexDecompositionOptions& options) {
  const geometry::MassProperties mass = geometry::mass_properties(mesh);
  return {geometry::cached_convex_decomposition(mesh, options), mass.center_of_mass,
          mass.inertia / mass.volume, mass.volume, foot(mesh, mass.center_of_mass)};
}

double table_z_O(const HoldObject& object) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : object.foot_O) lowest = std::min(lowest, point.z());
  for (const geometry::TriangleMesh& piece : object.shape.pieces) {
    for (const Eigen::Vector3d& vertex : piece.vertices) lowest = std::min(lowest, vertex.z());
  }
  return lowest;
}

HoldHand prepare_hold_hand(const hands::HandModel& hand,
                           const geometry::ConvexDecompositionOptions& options) {
  HoldHand result{hand, {}};
  for (const hands::Link& link : hand.links) {
    result.links.push_back(link.mesh_L.faces.empty()
                               ? geometry::ConvexDecomposition{}

                               : geometry::cached_convex_decomposition(link.mesh_L, options));
  }
  return result;
}

}  // namespace graspfit::hold_test
