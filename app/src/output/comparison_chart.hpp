#pragma once

#include <string>

#include "output/comparison.hpp"

namespace graspfit::app {

/// A picture of the rates of both sides on all objects, as the text of an SVG file: for each
/// property two bars side by side, with lines for the 95 % intervals. What was not looked for has
/// no bar.
std::string comparison_chart_svg(const SetComparison& comparison);

}  // namespace graspfit::app
