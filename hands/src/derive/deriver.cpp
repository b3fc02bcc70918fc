#include "derive/deriver.hpp"

#include <algorithm>

#include "derive/derived_exclusions.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::hands::internal {

Sidecar Deriver::derive() {
  Sidecar sidecar = given_;
  chains();
  signs();
  if (!sidecar.closing) sidecar.closing = closing();
  take_signs(*sidecar.closing);
  palm_direction();
  if (!given_.closing) {
    fore_joints();
    sidecar.closing = closing();
    take_signs(*sidecar.closing);
    note_closing(*sidecar.closing);
  }
  if (!sidecar.fingers) sidecar.fingers = fingers();
  if (!sidecar.palm || !sidecar.pads) {
    const std::vector<SidecarPad> found = pads(*sidecar.fingers);
    if (!sidecar.palm) sidecar.palm = palm(found, sidecar.pads);
    if (!sidecar.pads) sidecar.pads = found;
  }
  if (!sidecar.exclusions) sidecar.exclusions = derived_exclusions(tree_, findings_);
  return sidecar;
}

void Deriver::fail(const std::string& what) const {
  throw InvalidInput(tree_.description_file + ": " + what);
}

HandConfiguration Deriver::followed(const VectorXd& q) const {
  HandConfiguration configuration;
  configuration.q = q;
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    const Joint& joint = tree_.joints[j];
    if (!joint.coupling) continue;
    configuration.q[j] = followed_position(joint, q);
  }
  return configuration;
}

std::vector<RigidTransform> Deriver::poses(const VectorXd& q) const {
  return forward_kinematics(tree_, followed(q));
}

VectorXd Deriver::rest() const {
  VectorXd q(std::ssize(tree_.joints));
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    q[j] = std::clamp(0.0, tree_.joints[j].lower, tree_.joints[j].upper);
  }
  return q;
}

VectorXd Deriver::closed_by(double share) const {
  VectorXd q = rest();
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    const Joint& joint = tree_.joints[j];
    if (joint.closing_sign == 0) continue;
    const double open = joint.open_limit();
    q[j] = open + share * (joint.closed_limit() - open);
  }
  return q;
}

const RigidTransform& Deriver::pose_of_body(const std::vector<RigidTransform>& X_HL,
                                            int body) const {
  return X_HL[bodies_[body].links.front()];
}

Vector3d Deriver::tip(const Chain& chain, const std::vector<RigidTransform>& X_HL) const {
  return pose_of_body(X_HL, chain.bodies.back()) * chain.tip_B;
}

Vector3d Deriver::axis_H(int joint, const std::vector<RigidTransform>& X_HL) const {
  // The axis does not turn under its own joint.
  const Joint& j = tree_.joints[joint];
  return X_HL[j.child_link].linear() * j.axis_J;
}

}  // namespace graspfit::hands::internal
