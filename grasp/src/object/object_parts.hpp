#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp::internal {

/// What of an object model may be kept between runs.
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

/// Their inverse; empty unless the bytes are those of parts on that lattice, of a mesh of so many
/// faces.
std::optional<ObjectParts> from_bytes(std::string_view bytes, const geometry::VoxelLattice& lattice,
                                      std::size_t num_faces);

}  // namespace graspfit::grasp::internal
