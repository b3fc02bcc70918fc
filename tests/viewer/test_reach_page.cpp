#include <numbers>
#include <string>

#include "graspfit/viewer/reach_page.hpp"
#include "support/catch.hpp"

namespace graspfit::test_reach_page {
namespace {

using testing::Contains;

/// A hand with two pads, and a chart whose leans are 30, none, 10 and 20 degrees.
viewer::ReachScene sample_reach() {
  viewer::ReachScene scene;
  scene.hand.name = "two <pads>";
  for (const char* name : {"left & right", "other"}) scene.hand.pads.emplace_back().name = name;
  scene.friction = 0.4;
  hands::PinchChart chart{hands::PinchKind::Tips, 0.01, 1, {}};
  const double degree = std::numbers::pi / 180.0;
  chart.pinches = {hands::Pinch{0.005, 30.0 * degree, {0, 1}, {}}, std::nullopt,
                   hands::Pinch{0.025, 10.0 * degree, {0, 1}, {}},
                   hands::Pinch{0.031, 20.0 * degree, {0, 1}, {}}};
  scene.charts = {chart, {hands::PinchKind::Palm, 0.01, 1, {}}};
  return scene;
}

}  // namespace

TEST_CASE("The picture of a reach has a curve per chart, broken where there is no pinch",
          "[viewer][reach_page]") {
  const std::string svg = viewer::reach_chart_svg(sample_reach());
  CHECK(svg.rfind("<svg xmlns=", 0) == 0);
  CHECK_THAT(svg, Contains("fingertips"));
  CHECK_THAT(svg, !Contains("palm"));  // A chart without a pinch has no curve.
  // The axis ends at 40 mm: 676 pixels. Classes of 10 mm have their middles at 5, 25 and 35 mm, and
  // 80 degrees are 256 pixels above 300.
  CHECK_THAT(svg, Contains("M146.5 204.0 h0 M484.5 268.0 h0 L653.5 236.0"));
  // Within 21.8 degrees: the pinches at 25 and 31 mm.
  CHECK_THAT(svg, Contains("<rect x=\"484.5\" y=\"352.0\" width=\"101.4\""));
  CHECK(svg == viewer::reach_chart_svg(sample_reach()));
}

TEST_CASE("Openings and widths are written in millimeters", "[viewer][reach_page]") {
  viewer::ReachScene scene = sample_reach();
  scene.charts[0].step = 0.0025;
  CHECK(viewer::opening_text(scene.charts[0], 1) == "2.5 to 5");
  CHECK(viewer::opening_text(scene.charts[0], 4) == "10 to 12.5");
  CHECK(viewer::square_widths_text(scene.charts[0], 0.4) == "25 to 31");
  CHECK(viewer::square_widths_text(scene.charts[1], 0.4) == "none");
  scene.charts[1].num_sets = 0;
  CHECK(viewer::square_widths_text(scene.charts[1], 0.4) == "no such pads");
  // However wide a class is, the axis has few marks.
  scene.charts[0].step = 1e9;
  CHECK(viewer::reach_chart_svg(scene).size() < 10000);
}

TEST_CASE("The page of a reach names no other file and escapes names", "[viewer][reach_page]") {
  const std::string html = viewer::reach_page_html(sample_reach());
  CHECK(html.find("://") == std::string::npos);
  CHECK(html.find("src=") == std::string::npos);
  CHECK_THAT(html, Contains("default-src 'none'"));
  CHECK_THAT(html, Contains("two &lt;pads&gt;"));
  CHECK_THAT(html, Contains("left &amp; right, other"));
  CHECK_THAT(html, Contains("<td>25 to 31</td>"));
  CHECK_THAT(html, Contains("<td>10 to 20</td><td></td>"));
}

}  // namespace graspfit::test_reach_page
