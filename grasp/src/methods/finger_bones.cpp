#include "methods/finger_bones.hpp"

#include <optional>

#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kUnderPad = 0.003;  // where a line ends, below the pad's contact point [m]

/// In the frame in which `X_L` has the links.
std::vector<Vector3d> line_to(const hands::HandModel& hand, int pad, const std::vector<int>& links,
                              const std::vector<RigidTransform>& X_L) {
  std::vector<Vector3d> line;
  for (const int link : links) line.push_back(X_L[link].translation());
  line.emplace_back(hands::pad_contact_point(hand, pad, X_L) -
                    kUnderPad * hands::pad_pose(hand, pad, X_L).linear().col(2));
  return line;
}

}  // namespace

FingerBones::FingerBones(const hands::HandModel& hand, const geometry::MeshQuery& object,
                         const std::vector<const hands::PadSamples*>& samples)
    : hand_(hand), object_(object) {
  for (const hands::ContactPad& pad : hand.pads) {
    std::vector<int>& links = links_.emplace_back();
    for (const int link : hands::links_to(hand, pad.link)) {
      if (!hands::joints_to(hand, link).empty()) links.push_back(link);
    }
  }
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  configuration.X_OH = RigidTransform::Identity();
  for (const hands::PadSamples* of_pad : samples) {
    Lines& lines = lines_.emplace_back();
    lines.per_sample = std::ssize(links_[of_pad->pad]) + 1;
    lines.points_H.resize(3, of_pad->points_H.cols() * lines.per_sample);
    for (Index sample = 0; sample < of_pad->points_H.cols(); ++sample) {
      for (int j = 0; j < std::ssize(of_pad->joints); ++j) {
        configuration.q[of_pad->joints[j]] = of_pad->positions(j, sample);
      }
      hands::apply_couplings(hand, configuration.q);
      const std::vector<Vector3d> line = line_to(hand, of_pad->pad, links_[of_pad->pad],
                                                 hands::forward_kinematics(hand, configuration));
      for (Index i = 0; i < lines.per_sample; ++i) {
        lines.points_H.col(sample * lines.per_sample + i) = line[i];
      }
    }
  }
}

bool FingerBones::is_free(std::size_t samples, std::int32_t sample,
                          const RigidTransform& X_OH) const {
  const Lines& lines = lines_[samples];
  const Index first = sample * lines.per_sample;
  for (Index i = first; i + 1 < first + lines.per_sample; ++i) {
    if (crosses(X_OH * lines.points_H.col(i), X_OH * lines.points_H.col(i + 1))) return false;
  }
  return true;
}

bool FingerBones::are_free(const std::vector<int>& pads,
                           const std::vector<RigidTransform>& X_OL) const {
  for (const int pad : pads) {
    const std::vector<Vector3d> line = line_to(hand_, pad, links_[pad], X_OL);
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      if (crosses(line[i], line[i + 1])) return false;
    }
  }
  return true;
}

bool FingerBones::crosses(const Vector3d& from_O, const Vector3d& to_O) const {
  const Vector3d way = to_O - from_O;
  if (way.isZero(0.0)) return false;
  const std::optional<geometry::RayHit> hit = object_.first_hit(from_O, way);
  return hit && hit->distance <= way.norm();
}

}  // namespace graspfit::grasp::internal
