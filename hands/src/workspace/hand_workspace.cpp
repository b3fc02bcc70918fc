#include "graspfit/hands/hand_workspace.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/option_check.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "workspace/model_key.hpp"
#include "workspace/tip_pair.hpp"

namespace graspfit::hands {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Overlap of links up to which they count as touching [m].
constexpr double kTouchDepth = 1e-4;

// The number is raised whenever the same hand and options may give another workspace.
constexpr const char* kAlgorithm = "hand workspace 2";
constexpr const char* kKind = "hand_workspace";

/// All that `hand_workspace` depends on.
std::string workspace_key(const HandModel& model, const WorkspaceOptions& options) {
  base::ContentKey key(kAlgorithm);
  key.number(std::int64_t{options.samples_per_joint});
  key.number(options.max_configurations);
  key.number(options.facing_angle);
  internal::append(key, model);
  return key.sha256();
}

std::string to_text(const HandWorkspace& workspace) {
  base::NumberWriter out;
  const auto line = [&out](const std::vector<DistanceRange>& ranges) {
    for (const DistanceRange& range : ranges) {
      for (const double end : {range.smallest, range.largest, range.error}) out.number(end);
    }
    out.end_line();
  };
  for (const std::vector<DistanceRange>& row : workspace.tip_to_tip) line(row);
  line(workspace.palm_to_tip);
  line(workspace.graspable_diameter);
  line({workspace.any_graspable_diameter});
  return out.text();
}

std::optional<HandWorkspace> from_text(std::string_view text, std::size_t num_fingers) {
  base::NumberReader in(text);
  const auto line = [&in](std::size_t size) {
    std::vector<DistanceRange> ranges(size);
    for (DistanceRange& range : ranges) {
      for (double* end : {&range.smallest, &range.largest, &range.error}) *end = in.real(0.0);
    }
    return ranges;
  };
  HandWorkspace workspace;
  for (std::size_t i = 0; i < num_fingers; ++i) workspace.tip_to_tip.push_back(line(num_fingers));
  workspace.palm_to_tip = line(num_fingers);
  workspace.graspable_diameter = line(num_fingers);
  workspace.any_graspable_diameter = line(1).front();
  if (!in.is_finished()) return std::nullopt;
  return workspace;
}

}  // namespace

void WorkspaceOptions::validate() const {
  const char* const where = "WorkspaceOptions";
  base::require(samples_per_joint >= 2, where, "samples_per_joint", samples_per_joint, ">= 2");
  base::require(max_configurations >= 4, where, "max_configurations", max_configurations, ">= 4");
  base::require(facing_angle > 0.0 && facing_angle < std::numbers::pi / 2, where, "facing_angle",
                facing_angle, "in (0, pi/2) rad");
}

TipDistances tip_distances(const HandModel& model, const WorkspaceOptions& options) {
  options.validate();
  validate(model);
  const internal::SampledHand hand(model);
  const std::size_t size = model.fingers.size();
  TipDistances ranges(size, std::vector<DistanceRange>(size));
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = a + 1; b < size; ++b) {
      const std::optional<int>& pad_a = model.fingers[a].tip_pad;
      const std::optional<int>& pad_b = model.fingers[b].tip_pad;
      if (!pad_a || !pad_b) continue;
      ranges[a][b] = ranges[b][a] = internal::tip_distance_range(hand, pad_a, *pad_b, options);
    }
  }
  return ranges;
}

std::vector<DistanceRange> palm_distances(const HandModel& model, const WorkspaceOptions& options) {
  options.validate();
  validate(model);
  const internal::SampledHand hand(model);
  std::vector<DistanceRange> ranges;
  for (const Finger& finger : model.fingers) {
    ranges.push_back(
        finger.tip_pad ? internal::tip_distance_range(hand, std::nullopt, *finger.tip_pad, options)
                       : DistanceRange{});
  }
  return ranges;
}

HandWorkspace hand_workspace(const HandModel& model, const WorkspaceOptions& options) {
  HandWorkspace workspace;
  workspace.tip_to_tip = tip_distances(model, options);
  workspace.palm_to_tip = palm_distances(model, options);
  workspace.graspable_diameter.resize(model.fingers.size());
  const internal::SampledHand hand(model);
  const HandCollision collision(model);
  const internal::IsClear is_clear = internal::clear_of_itself(hand, collision, kTouchDepth);
  const int thumb = model.thumb();
  for (int f = 0; f < std::ssize(model.fingers); ++f) {
    const std::optional<int>& thumb_pad = model.fingers[thumb].tip_pad;
    const std::optional<int>& pad = model.fingers[f].tip_pad;
    if (f == thumb || !thumb_pad || !pad) continue;
    const DistanceRange range =
        internal::facing_distance_range(hand, *thumb_pad, *pad, options, is_clear);
    workspace.graspable_diameter[f] = range;
    DistanceRange& any = workspace.any_graspable_diameter;
    if (range.largest == 0.0) continue;
    any = any.largest == 0.0 ? range
                             : DistanceRange{std::min(any.smallest, range.smallest),
                                             std::max(any.largest, range.largest), kInfinity};
  }
  return workspace;
}

HandWorkspace cached_hand_workspace(const HandModel& model, const WorkspaceOptions& options,
                                    const base::ContentCache& cache) {
  options.validate();
  validate(model);
  return cache.value(
      kKind, workspace_key(model, options), [&] { return hand_workspace(model, options); },
      [&](std::string_view text) { return from_text(text, model.fingers.size()); }, to_text);
}

}  // namespace graspfit::hands
