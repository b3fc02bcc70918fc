#include "model/hand_bodies.hpp"

#include "graspfit/base/as_index.hpp"

namespace graspfit::hands::internal {

std::vector<Body> bodies_of(const HandModel& tree) {
  std::vector<Body> bodies;
  std::vector<int> body_of(tree.links.size());
  for (int i = 0; i < std::ssize(tree.links); ++i) {
    const Link& link = tree.links[i];
    std::optional<int> above;
    if (link.parent_link) above = body_of[*link.parent_link];
    if (above && !link.parent_joint) {
      body_of[i] = *above;
    } else {
      body_of[i] = base::as_index<int>(bodies.size());
      Body& body = bodies.emplace_back();
      body.joint = link.parent_joint;
      body.parent = above;
      if (above) bodies[*above].children.push_back(body_of[i]);
    }
    bodies[body_of[i]].links.push_back(i);
  }
  for (Body& body : bodies) {
    const std::vector<RigidTransform> X_BL = poses_in_body(tree, body);
    std::vector<TriangleMesh> meshes;
    for (std::size_t i = 0; i < body.links.size(); ++i) {
      meshes.push_back(transformed(tree.links[body.links[i]].mesh_L, X_BL[i]));
    }
    body.mesh = geometry::concatenated(meshes);
  }
  return bodies;
}

std::vector<int> body_of_links(const std::vector<Body>& bodies, std::size_t num_links) {
  std::vector<int> body_of(num_links);
  for (int b = 0; b < std::ssize(bodies); ++b) {
    for (const int link : bodies[b].links) body_of[link] = b;
  }
  return body_of;
}

std::vector<RigidTransform> poses_in_body(const HandModel& tree, const Body& body) {
  std::vector<RigidTransform> X_BL;
  for (const int link : body.links) {
    RigidTransform X = RigidTransform::Identity();
    for (int at = link; at != body.links.front(); at = *tree.links[at].parent_link) {
      X = tree.links[at].X_PL_fixed * X;
    }
    X_BL.push_back(X);
  }
  return X_BL;
}

}  // namespace graspfit::hands::internal
