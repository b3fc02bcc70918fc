#pragma once

#include <optional>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

/// Links that are joined by fixed joints, and so move as one rigid body.
struct Body {
  std::vector<int> links;     ///< Ascending; the first is the child of `joint`.
  std::optional<int> joint;   ///< The movable joint above it; empty for the root.
  std::optional<int> parent;  ///< Body before the joint; empty for the root.
  std::vector<int> children;
  TriangleMesh mesh;  ///< All its links' surfaces, in the frame of its first link.
};

/// The bodies of a tree, parents first; body 0 holds the root link.
std::vector<Body> bodies_of(const HandModel& tree);

/// The index of every link's body.
std::vector<int> body_of_links(const std::vector<Body>& bodies, std::size_t num_links);

/// Poses of a body's links in the frame of its first link, in the order of `Body::links`.
std::vector<RigidTransform> poses_in_body(const HandModel& tree, const Body& body);

}  // namespace graspfit::hands::internal
