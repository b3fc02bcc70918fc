#pragma once

#include <vector>

#include "graspfit/grasp/fitting_hand.hpp"

namespace graspfit::grasp::internal {

/// A surface cut into pieces that are at most about `size` [m] wide: large triangles are halved,
/// then triangles are gathered by halving their box. Together the pieces are the surface, up to the
/// rounding of the new corners.
std::vector<FittingHand::Piece> pieces_of(const geometry::TriangleMesh& mesh, double size);

}  // namespace graspfit::grasp::internal
