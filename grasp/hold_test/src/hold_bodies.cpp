#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test {

HoldObject prepare_hold_object(const geometry::TriangleMesh& mesh,
                               const geometry::ConvexDecompositionOptions& options) {
  const geometry::MassProperties mass = geometry::mass_properties(mesh);
  return {geometry::cached_convex_decomposition(mesh, options), mass.center_of_mass,
          mass.inertia / mass.volume};
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
