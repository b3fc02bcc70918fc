#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/hands/pinch_chart.hpp"
#include "workspace/model_key.hpp"

namespace graspfit::hands {
namespace {

// The number is raised whenever the same hand and options may give another chart.
constexpr const char* kChartAlgorithm = "pinch chart 2";
constexpr const char* kCacheKind = "pinch_chart";

/// All that a chart depends on.
std::string chart_key(const HandModel& model, PinchKind kind, const PinchChartOptions& options) {
  base::ContentKey key(kChartAlgorithm);
  key.number(static_cast<std::int64_t>(kind));
  key.number(options.step);
  key.number(options.max_configurations);
  key.number(options.touch_depth);
  internal::append(key, model);
  return key.sha256();
}

std::string chart_to_text(const PinchChart& chart) {
  base::NumberWriter out;
  out.number(static_cast<std::int64_t>(chart.num_sets));
  out.number(static_cast<std::int64_t>(chart.pinches.size()));
  out.end_line();
  for (const std::optional<Pinch>& pinch : chart.pinches) {
    out.number(std::int64_t{pinch.has_value()});
    if (pinch) {
      out.number(pinch->opening);
      out.number(pinch->lean);
      out.indices({pinch->pads.begin(), pinch->pads.end()});
      for (const double q : pinch->q) out.number(q);
    }
    out.end_line();
  }
  return out.text();
}

std::optional<PinchChart> chart_from_text(std::string_view text, const HandModel& model,
                                          PinchKind kind, double step) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  base::NumberReader in(text);
  PinchChart chart;
  chart.kind = kind;
  chart.step = step;
  chart.num_sets = static_cast<int>(in.integer(0, kMost));
  chart.pinches.resize(in.integer(0, PinchChart::kMostClasses));
  for (std::optional<Pinch>& pinch : chart.pinches) {
    if (in.integer(0, 1) == 0) continue;
    pinch.emplace();
    pinch->opening = in.real(0.0);
    pinch->lean = in.real(0.0);
    const std::vector<std::int32_t> pads = in.indices(static_cast<std::int64_t>(model.pads.size()));
    pinch->pads.assign(pads.begin(), pads.end());
    pinch->q.resize(std::ssize(model.joints));
    for (double& q : pinch->q) q = in.real();
  }
  if (!in.is_finished()) return std::nullopt;
  return chart;
}

}  // namespace

PinchChart cached_pinch_chart(const HandModel& model, PinchKind kind,
                              const PinchChartOptions& options, const base::ContentCache& cache) {
  options.validate();
  validate(model);
  return cache.value(
      kCacheKind, chart_key(model, kind, options),
      [&] { return pinch_chart(model, kind, options); },
      [&](std::string_view text) { return chart_from_text(text, model, kind, options.step); },
      chart_to_text);
}

}  // namespace graspfit::hands
