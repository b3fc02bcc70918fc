#include "workspace/model_key.hpp"

#include <cstdint>

namespace graspfit::hands::internal {
namespace {

void append(base::ContentKey& key, const RigidTransform& pose) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) key.number(pose.matrix()(i, j));
  }
}

void append(base::ContentKey& key, int value) { key.number(std::int64_t{value}); }

void append(base::ContentKey& key, std::size_t value) {
  key.number(static_cast<std::int64_t>(value));
}

void append(base::ContentKey& key, const std::optional<int>& index) {
  append(key, index.value_or(-1));
}

void append(base::ContentKey& key, const Eigen::Vector3d& vector) {
  for (const double x : vector) key.number(x);
}

}  // namespace

void append(base::ContentKey& key, const HandModel& model) {
  append(key, model.links.size());
  for (const Link& link : model.links) {
    append(key, link.parent_link);
    append(key, link.parent_joint);
    append(key, link.X_PL_fixed);
    key.list(link.mesh_L.vertices);
    key.list(link.mesh_L.faces);
  }
  append(key, model.joints.size());
  for (const Joint& joint : model.joints) {
    append(key, static_cast<int>(joint.type));
    append(key, joint.X_PJ);
    append(key, joint.axis_J);
    key.number(joint.lower);
    key.number(joint.upper);
    append(key, joint.closing_sign);
    append(key, joint.coupling ? joint.coupling->leader : -1);
    if (joint.coupling) {
      key.number(joint.coupling->ratio);
      key.number(joint.coupling->offset);
      append(key, joint.coupling->breakaway ? 1 : 0);
    }
  }
  append(key, model.pads.size());
  for (const ContactPad& pad : model.pads) {
    append(key, pad.finger);
    append(key, pad.link);
    append(key, pad.X_LC);
    key.list(pad.outline);
    key.list(pad.surface);
  }
  append(key, model.fingers.size());
  for (const Finger& finger : model.fingers) append(key, finger.tip_pad);
  append(key, model.thumb());
  append(key, model.palm.pad);
  append(key, model.palm.center_H);
  append(key, model.exclusions.size());
  for (const CollisionExclusion& exclusion : model.exclusions) {
    append(key, exclusion.link_a);
    append(key, exclusion.link_b);
  }
}

}  // namespace graspfit::hands::internal
