#pragma once

#include <cstddef>
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

/// "20 to 185, 190 to 195": the square widths in millimeters; "none", "no such pads".
std::string square_widths_text(const hands::PinchChart& chart, double friction);

/// The names of a pinch's pads.
std::string pads_text(const hands::HandModel& hand, const hands::Pinch& pinch,
                      const std::string& separator);

/// The openings of a class of the chart in millimeters: "2.5 to 5".
std::string opening_text(const hands::PinchChart& chart, std::size_t number_of_class);

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
