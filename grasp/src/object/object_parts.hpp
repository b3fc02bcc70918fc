#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp::internal {

/// The parts of an object model that may be cached between runs.
struct ObjectParts {
  std::vector<geometry::SurfacePatch> patches;
  geometry::VoxelGrid grid;
  geometry::SignedDistanceMap distance;
  ContactScoreMap scores;
};

/// SHA-256 of all that the parts depend on: vertices, faces, options, version of the algorithms.
std::string object_parts_key(const geometry::TriangleMesh& mesh, const ObjectModelOptions& options);

/// The parts as bytes of this machine, for a cache that does not leave it.
std::string to_bytes(const ObjectParts& parts);

/// The inverse of `to_bytes`; empty unless the bytes are those of parts on `lattice`, of a mesh
/// with `num_faces` faces.
std::optional<ObjectParts> from_bytes(std::string_view bytes, const geometry::VoxelLattice& lattice,
                                      std::size_t num_faces);

}  // namespace graspfit::grasp::internal
