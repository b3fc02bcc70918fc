#include "workspace/joint_samples.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::hands::internal {

std::vector<JointGroup> each_alone(const std::vector<int>& joints) {
  std::vector<JointGroup> groups;
  for (const int joint : joints) groups.push_back({joint});
  return groups;
}

namespace {

/// Whether the share of a joint's range is counted from its upper limit.
bool is_reversed(const HandModel& model, const JointGroup& group, int joint) {
  const Joint& own = model.joints[joint];
  if (group.size() == 1) return false;
  if (own.closing_sign != 0) return own.closing_sign < 0;
  const Joint& first = model.joints[group.front()];
  const bool is_same = own.lower == first.lower && own.upper == first.upper;
  const bool is_mirrored = own.lower == -first.upper && own.upper == -first.lower;
  return first.closing_sign == 0 && is_mirrored && !is_same;
}

}  // namespace

void move_group(const HandModel& model, const JointGroup& group, double share, Eigen::VectorXd& q) {
  for (const int joint : group) {
    const Joint& limits = model.joints[joint];
    const double way =
        (is_reversed(model, group, joint) ? -share : share) * (limits.upper - limits.lower);
    q[joint] = std::clamp(q[joint] + way, limits.lower, limits.upper);
  }
}

JointSamples::JointSamples(const HandModel& model, std::vector<JointGroup> groups, int per_group,
                           std::int64_t count)
    : model_(model), groups_(std::move(groups)), per_group_(per_group), size_(count) {
  if (groups_.empty()) size_ = 1;
  if (per_group_ > 0) {
    size_ = 1;
    for (std::size_t i = 0; i < groups_.size(); ++i) size_ *= per_group_;
  }
}

void JointSamples::set(std::int64_t sample, Eigen::VectorXd& q) const {
  auto random = base::Random::stream(0, static_cast<std::uint64_t>(sample));
  for (const JointGroup& group : groups_) {
    double share = 0.0;
    if (per_group_ > 0) {
      share = static_cast<double>(sample % per_group_) / (per_group_ - 1);
      sample /= per_group_;
    } else {
      share = random.uniform();
    }
    for (const int joint : group) {
      const Joint& limits = model_.joints[joint];
      const double from_lower = is_reversed(model_, group, joint) ? 1.0 - share : share;
      q[joint] = limits.lower + from_lower * (limits.upper - limits.lower);
    }
  }
}

PairJoints joints_of_pair(const HandModel& model, int link_a, int link_b) {
  PairJoints result;
  std::vector<int> to_a = joints_to(model, link_a);
  std::vector<int> to_b = joints_to(model, link_b);
  const auto parting = std::mismatch(to_a.begin(), to_a.end(), to_b.begin(), to_b.end());
  result.carrying.assign(to_a.begin(), parting.first);
  to_a.erase(to_a.begin(), parting.first);
  to_b.erase(to_b.begin(), parting.second);
  const std::vector<int> a = leaders_of(model, to_a);
  const std::vector<int> b = leaders_of(model, to_b);
  const std::vector<int> carriers = leaders_of(model, result.carrying);
  const auto has = [](const std::vector<int>& list, int joint) {
    return std::binary_search(list.begin(), list.end(), joint);
  };
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result.all));
  for (const int joint : result.all) {
    // A joint that also sets a joint before the chains part must have one position for both tips.
    const bool is_shared = (has(a, joint) && has(b, joint)) || has(carriers, joint);
    (is_shared ? result.shared : has(a, joint) ? result.only_a : result.only_b).push_back(joint);
  }
  return result;
}

}  // namespace graspfit::hands::internal
