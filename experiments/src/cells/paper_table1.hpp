#pragma once

#include <optional>
#include <string_view>

namespace graspfit::experiments::internal {

/// What the paper's Table 1 says of a method on an object: Barrett hand, averages over 100 usable
/// grasps, on a desktop computer of 2017 or so; object sizes are not given.
struct PaperFigures {
  double time_s;
  double quality;
};

/// Returns the figures for the label of an object and of a method. Both `bowling_pin` and
/// `bowling_ball` have the figures of the paper's BOWLING, `gs` and `gs-targets` those of its GS,
/// `ma` and `ma-full-retreat` those of its MA, and all methods that begin with `fitting` those of
/// the paper's own method. The result is empty for others.
std::optional<PaperFigures> paper_table1(std::string_view object, std::string_view method);

}  // namespace graspfit::experiments::internal
