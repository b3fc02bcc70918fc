#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "decomposition/outside_depth.hpp"
#include "decomposition/piece_hull.hpp"
#include "decomposition/solid_part.hpp"

namespace graspfit::geometry::internal {

/// The plane that separates most of what makes the hull of a part reach out of the solid: segments
/// between points of the part's surface, and faces of the hull, weighted by how far beyond
/// `allowed_depth` [m] outside the solid they pass. Empty if no such plane was found. Deterministic
/// for a seed.
std::optional<CutPlane> choose_cut(const SolidPart& part, const PieceHull& hull,
                                   const OutsideDepth& depth, const TriangleMesh& mesh,
                                   double allowed_depth, std::uint64_t seed);

/// Greatest depth sampled on segments from random `starts` to random `ends` [m]; a depth beyond
/// `limit` ends the search.
double deepest_segment(std::span<const Eigen::Vector3d> starts,
                       std::span<const Eigen::Vector3d> ends, const OutsideDepth& depth,
                       std::size_t num_segments, double limit);

/// Greatest depth sampled on a hull's boundary and on segments between its vertices [m]; a depth
/// beyond `limit` ends the search.
double sampled_depth(const PieceHull& hull, const OutsideDepth& depth, double limit);

}  // namespace graspfit::geometry::internal
