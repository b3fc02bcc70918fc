#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shape_diameter.hpp"

namespace graspfit::geometry::internal {

/// Per face, 1 if it may be thinner than `limit` [m]: some ray of `shape_diameter` that counts is
/// shorter. Where none is the thickness, a mean of such rays, is no less: certain, and much cheaper
/// than the thickness, as no ray goes farther than the limit.
std::vector<char> may_be_thinner(const MeshQuery& mesh, std::span<const std::int32_t> faces,
                                 double limit, const ShapeDiameterOptions& options);

}  // namespace graspfit::geometry::internal
