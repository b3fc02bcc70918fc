#include "input/hand_poses.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "cli/exit_codes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/hand_closing.hpp"

namespace graspfit::app {
namespace {

using base::InvalidInput;
using base::shortest_decimal;

/// A pose as the words of --pose give it.
struct WantedPose {
  std::string name;
  double share = 0.0;  ///< Share of closing.
  std::map<int, double> positions;
};

std::optional<double> share_named(const std::string& word) {
  if (word == "open") return 0.0;
  if (word == "half") return 0.5;
  if (word == "closed") return 1.0;
  return std::nullopt;
}

double position_of(const hands::Joint& joint, const std::string& text) {
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last || !std::isfinite(value)) {
    throw UsageError("--pose " + joint.name + " \"" + text + "\" is not a number");
  }
  if (value < joint.lower || value > joint.upper) {
    throw InvalidInput("--pose: joint " + joint.name + " at " + shortest_decimal(value) +
                       " is outside its limits " + shortest_decimal(joint.lower) + " to " +
                       shortest_decimal(joint.upper) +
                       (joint.type == hands::JointType::Revolute ? " rad" : " m"));
  }
  return value;
}

Eigen::VectorXd joint_positions(const hands::HandModel& hand, const WantedPose& wanted) {
  Eigen::VectorXd q = wanted.share == 0.0 ? hands::open_configuration(hand).q
                                          : hands::closed_without_overlap(hand, wanted.share).q;
  if (wanted.positions.empty()) return q;
  // Followers are open at first: breakaway joints would stay further closed.
  const Eigen::VectorXd open = hands::open_configuration(hand).q;
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    if (hand.joints[j].coupling) {
      q[j] = open[j];
    }
  }
  for (const auto& [joint, position] : wanted.positions) q[joint] = position;
  hands::apply_couplings(hand, q);
  constexpr double kSame = 1e-9;  // [rad or m]; positions of followers that people type are rounded
  for (const auto& [index, position] : wanted.positions) {
    const hands::Joint& joint = hand.joints[index];
    if (!joint.coupling || std::abs(q[index] - position) <= kSame) continue;
    const std::string& leader = hand.joints[joint.coupling->leader].name;
    throw InvalidInput("--pose: joint " + joint.name + " follows " + leader +
                       ", which puts it at " + shortest_decimal(q[index]) + ", not " +
                       shortest_decimal(position) + "; set " + leader);
  }
  return q;
}

}  // namespace

std::vector<viewer::HandPose> read_poses(const std::vector<std::string>& words,
                                         const hands::HandModel& hand) {
  std::vector<WantedPose> wanted;
  for (const std::string& word : words) {
    if (const auto share = share_named(word)) {
      wanted.push_back({word, *share, {}});
      continue;
    }
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos || sign == 0) {
      throw UsageError("--pose \"" + word + "\" is none of open, half, closed and JOINT=VALUE");
    }
    const int joint = hand.joint_index(word.substr(0, sign));
    const double position = position_of(hand.joints[joint], word.substr(sign + 1));
    if (wanted.empty()) wanted.push_back({"", 0.0, {}});
    WantedPose& pose = wanted.back();
    if (!pose.positions.emplace(joint, position).second) {
      throw UsageError("--pose sets joint " + word.substr(0, sign) + " twice");
    }
    pose.name += (pose.name.empty() ? "" : ", ") + word;
  }
  std::vector<viewer::HandPose> poses;
  for (const WantedPose& pose : wanted) poses.push_back({pose.name, joint_positions(hand, pose)});
  return poses;
}

}  // namespace graspfit::app
