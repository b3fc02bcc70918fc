#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/hands/pinch_chart.hpp"

namespace graspfit::viewer {

/// What a hand can pinch squarely: its charts, and the friction at which widths count as square.
struct ReachScene {
  hands::HandModel hand;
  std::vector<hands::PinchChart> charts;  ///< One curve each; those without a pinch are left out.
  double friction = 0.0;                  ///< Coulomb's μ, ≥ 0.
};

/// What the kind of pinch is called: "fingertips".
std::string pinch_name(hands::PinchKind kind);

/// The picture: lean of the pads in degrees over the opening in millimeters, a curve per chart, and
/// below the openings at which the lean is within the friction. One SVG document; the same input
/// gives the same bytes.
std::string reach_chart_svg(const ReachScene& scene);

/// The page: one self-contained HTML document with the picture, the square widths, and per opening
/// the least leans. The same input gives the same bytes.
std::string reach_page_html(const ReachScene& scene);

/// Write them atomically. @throws IoError if that fails.
void write_reach_chart(const std::filesystem::path& file, const ReachScene& scene);
void write_reach_page(const std::filesystem::path& file, const ReachScene& scene);

}  // namespace graspfit::viewer
