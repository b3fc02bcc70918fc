#include "graspfit/hands/pad_samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "graspfit/base/option_check.hpp"
#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/kinematic_chain.hpp"
#include "workspace/tip_pair.hpp"

namespace graspfit::hands {
namespace {

/// Of a joint: steps of two degrees of a finger that closes by 130.
constexpr int kMostPositions = 64;

/// Multiples of it are spread evenly between whole numbers.
constexpr double kGoldenShare = 0.6180339887498949;

/// Largest n ≥ 2 with nᵏ ≤ most, and no more than the most positions of a joint.
int per_joint(std::size_t num_joints, int most) {
  int n = 2;
  while (n < kMostPositions && std::pow(n + 1, static_cast<double>(num_joints)) <= most) ++n;
  return n;
}

}  // namespace

std::vector<PadSamples> pad_samples(const HandModel& model, const std::vector<int>& pads,
                                    int max_samples, bool along_pads) {
  validate(model);
  base::require(max_samples >= 1, "pad_samples", "max_samples", max_samples, ">= 1");
  const internal::SampledHand hand(model);
  // A joint is shared if pads of several fingers, or of a finger and the palm, hang from it.
  std::map<int, int> least_counts;  // by joint
  std::map<int, std::vector<std::optional<int>>> fingers_of;
  const auto count_of = [&](int joint, const PadSamples& samples) {
    const bool is_moving = model.joints[joint].upper > model.joints[joint].lower;
    return is_moving ? per_joint(samples.joints.size(), max_samples) : 1;
  };
  std::vector<PadSamples> all;
  for (const int pad : pads) {
    PadSamples samples;
    samples.pad = pad;
    samples.joints = leaders_of(model, joints_to(model, model.pads[pad].link));
    for (const int joint : samples.joints) {
      const int count = count_of(joint, samples);
      const auto [known, is_new] = least_counts.try_emplace(joint, count);
      if (!is_new) known->second = std::min(known->second, count);
      fingers_of[joint].push_back(model.pads[pad].finger);
    }
    all.push_back(std::move(samples));
  }
  const auto is_shared = [&](int joint) {
    const std::vector<std::optional<int>>& fingers = fingers_of[joint];
    return std::any_of(fingers.begin(), fingers.end(),
                       [&](const std::optional<int>& finger) { return finger != fingers.front(); });
  };
  for (PadSamples& samples : all) {
    const auto first_shared = std::stable_partition(samples.joints.begin(), samples.joints.end(),
                                                    [&](int joint) { return !is_shared(joint); });
    samples.num_shared = static_cast<std::size_t>(samples.joints.end() - first_shared);
    std::vector<int> counts;
    Eigen::Index size = 1;
    for (std::size_t j = 0; j < samples.joints.size(); ++j) {
      const int joint = samples.joints[j];
      counts.push_back(is_shared(joint) ? least_counts[joint] : count_of(joint, samples));
      size *= counts.back();
      if (j + samples.num_shared < samples.joints.size()) {
        samples.range_size = static_cast<std::size_t>(size);
      }
    }
    if (samples.num_shared == samples.joints.size()) samples.range_size = 1;
    samples.positions.resize(std::ssize(samples.joints), size);
    samples.points_H.resize(3, size);
    samples.normals_H.resize(3, size);
    for (Eigen::Index sample = 0; sample < size; ++sample) {
      Eigen::VectorXd q = hand.open();
      Eigen::Index rest = sample;
      for (int j = 0; j < std::ssize(samples.joints); ++j) {
        const Joint& joint = model.joints[samples.joints[j]];
        const int count = counts[j];
        const double share = count == 1 ? 0.0 : static_cast<double>(rest % count) / (count - 1);
        rest /= count;
        q[samples.joints[j]] = joint.lower + share * (joint.upper - joint.lower);
        samples.positions(j, sample) = q[samples.joints[j]];
      }
      const std::vector<RigidTransform> X_HL = hand.poses(q);
      const internal::Tip tip = hand.tip(samples.pad, X_HL);
      samples.points_H.col(sample) = tip.point;
      if (along_pads) {
        const ContactPad& pad = model.pads[samples.pad];
        double whole = 0.0;
        const double share = std::modf(kGoldenShare * static_cast<double>(sample), &whole);
        samples.points_H.col(sample) =
            X_HL[pad.link] * (pad.X_LC * pad_point_toward_end_C(pad, share));
      }
      samples.normals_H.col(sample) = tip.normal;
    }
  }
  return all;
}

}  // namespace graspfit::hands
