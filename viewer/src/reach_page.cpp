#include "graspfit/viewer/reach_page.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/units.hpp"
#include "page_template.hpp"

namespace graspfit::viewer {
namespace {

using hands::Pinch;
using hands::PinchChart;
using hands::PinchKind;
using internal::escaped_for_html;

// Of the picture [pixels].
constexpr double kWidth = 760.0;
constexpr double kHeight = 420.0;
constexpr double kLeft = 62.0;
constexpr double kRight = 738.0;
constexpr double kTop = 44.0;
constexpr double kBottom = 300.0;
constexpr double kBarTop = 352.0;
constexpr double kBarStep = 16.0;
constexpr double kMostLean = 80.0;  // of the axis [degrees]

const char* color_of(PinchKind kind) {
  switch (kind) {
    case PinchKind::Tips:
      return "#2f6690";
    case PinchKind::TwoFingers:
      return "#2e7d4f";
    case PinchKind::Palm:
      return "#7a4ab2";
    case PinchKind::Proximal:
      return "#d97d1f";
  }
  return "";
}

/// With so many digits after the point, whatever the locale.
std::string number(double value, int decimals = 1) {
  std::array<char, 64> text{};
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value,
                                                 std::chars_format::fixed, decimals);
  return {text.data(), end.ptr};
}

std::vector<PinchChart> drawn_charts(const ReachScene& scene) {
  std::vector<PinchChart> charts = scene.charts;
  std::erase_if(charts, [](const PinchChart& chart) { return chart.pinches.empty(); });
  return charts;
}

/// Positions in the picture.
class Axes {
 public:
  explicit Axes(const std::vector<PinchChart>& charts) {
    double largest = 0.0;
    for (const PinchChart& chart : charts) {
      largest = std::max(largest, chart.step * static_cast<double>(chart.pinches.size()));
    }
    // 1, 2 or 5 times a power of ten, so that there are at most ten marks.
    const double power = std::pow(10.0, std::floor(std::log10(std::max(1e-3, 1e2 * largest))));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
      tick_ = factor * power;
      if (10.0 * tick_ >= 1e3 * largest) break;
    }
    most_mm_ = std::max(tick_, tick_ * std::ceil(1e3 * largest / tick_ - 1e-9));
  }
  double x(double opening) const { return kLeft + (kRight - kLeft) * 1e3 * opening / most_mm_; }
  double y(double lean) const {
    return kBottom - (kBottom - kTop) * lean / base::kRadiansPerDegree / kMostLean;
  }
  double most_mm() const { return most_mm_; }
  double tick() const { return tick_; }

 private:
  double tick_ = 0.0;     ///< Between marks [mm].
  double most_mm_ = 0.0;  ///< Of the axis [mm].
};

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) +
         "\" y2=\"" + number(y2) + "\" " + style + "/>\n";
}

std::string label(double x, double y, const char* anchor, const std::string& words,
                  const char* color = "#667078") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor +
         "\" fill=\"" + color + "\">" + escaped_for_html(words) + "</text>\n";
}

std::string frame(const Axes& axes) {
  std::string text;
  const std::string grid = "stroke=\"#e2e4e3\"";
  for (double lean = 0.0; lean <= kMostLean; lean += 20.0) {
    const double y = axes.y(lean * base::kRadiansPerDegree);
    text += line(kLeft, y, kRight, y, grid) + label(kLeft - 8, y + 4, "end", number(lean, 0));
  }
  for (double mm = 0.0; mm <= axes.most_mm() + 1e-9; mm += axes.tick()) {
    const double x = axes.x(1e-3 * mm);
    text += line(x, kTop, x, kBottom, grid) + label(x, kBottom + 18, "middle", number(mm, 0));
  }
  text += label((kLeft + kRight) / 2, kBottom + 36, "middle", "opening [mm]");
  text += "<text transform=\"translate(18 " + number((kTop + kBottom) / 2) +
          ") rotate(-90)\" text-anchor=\"middle\" fill=\"#667078\">least lean of the pads "
          "[degrees]</text>\n";
  return text;
}

/// A curve through the middles of a chart's classes, broken where one is empty.
std::string curve(const Axes& axes, const PinchChart& chart) {
  std::string path;
  bool is_drawing = false;
  for (std::size_t k = 0; k < chart.pinches.size(); ++k) {
    const std::optional<Pinch>& pinch = chart.pinches[k];
    if (pinch) {
      const double middle = (static_cast<double>(k) + 0.5) * chart.step;
      path +=
          (is_drawing ? " L" : " M") + number(axes.x(middle)) + ' ' + number(axes.y(pinch->lean));
      if (!is_drawing) path += " h0";  // a dot, where no line follows
    }
    is_drawing = pinch.has_value();
  }
  return "<path d=\"" + path +
         "\" fill=\"none\" stroke-width=\"2\" stroke-linecap=\"round\" stroke=\"" +
         color_of(chart.kind) + "\"/>\n";
}

std::string bars(const Axes& axes, const PinchChart& chart, double friction, double y) {
  std::string text;
  for (const hands::OpeningRange& range : hands::square_widths(chart, friction)) {
    const double x = axes.x(range.smallest);
    text += "<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" +
            number(std::max(2.0, axes.x(range.largest) - x)) + "\" height=\"9\" rx=\"2\" fill=\"" +
            color_of(chart.kind) + "\"/>\n";
  }
  return text;
}

std::string table_row(const std::vector<std::string>& cells, const char* element = "td") {
  std::string row = "<tr>";
  for (const std::string& cell : cells) {
    row += std::string("<") + element + '>' + escaped_for_html(cell) + "</" + element + '>';
  }
  return row + "</tr>\n";
}

/// The picture as an element; `attributes` are its first ones.
std::string chart_element(const ReachScene& scene, const std::string& attributes) {
  const std::vector<PinchChart> charts = drawn_charts(scene);
  const Axes axes(charts);
  const double height =
      kHeight + kBarStep * std::max(0.0, static_cast<double>(charts.size()) - 3.0);
  std::string svg = "<svg " + attributes + "viewBox=\"0 0 " + number(kWidth, 0) + ' ' +
                    number(height, 0) + "\" width=\"" + number(kWidth, 0) + "\" height=\"" +
                    number(height, 0) +
                    "\" font-family=\"system-ui, Noto Sans, DejaVu Sans, sans-serif\" "
                    "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  svg += frame(axes);
  const double limit =
      axes.y(std::min(std::atan(scene.friction), kMostLean * base::kRadiansPerDegree));
  svg += line(kLeft, limit, kRight, limit, "stroke=\"#9a3b34\" stroke-dasharray=\"5 4\"");
  svg += label(kRight, limit - 5, "end", "friction " + number(scene.friction, 2), "#9a3b34");
  double x = kLeft;
  for (const PinchChart& chart : charts) {
    svg += curve(axes, chart);
    svg += line(x, kTop - 22, x + 18, kTop - 22,
                std::string("stroke-width=\"3\" stroke=\"") + color_of(chart.kind) + '"');
    svg += label(x + 24, kTop - 18, "start", pinch_name(chart.kind), "#24282d");
    x += 44.0 + 6.6 * static_cast<double>(pinch_name(chart.kind).size());
  }
  double y = kBarTop;
  for (const PinchChart& chart : charts) {
    svg += bars(axes, chart, scene.friction, y);
    y += kBarStep;
  }
  svg += label(kLeft, y + 10, "start",
               "bars: widths pinched squarely, leans within atan " + number(scene.friction, 2));
  return svg + "</svg>\n";
}

}  // namespace

std::string square_widths_text(const PinchChart& chart, double friction) {
  const std::vector<hands::OpeningRange> ranges = hands::square_widths(chart, friction);
  if (ranges.empty()) return chart.num_sets == 0 ? "no such pads" : "none";
  return base::list_text(ranges, [](const hands::OpeningRange& range) {
    return number(1e3 * range.smallest, 0) + " to " + number(1e3 * range.largest, 0);
  });
}

std::string pads_text(const hands::HandModel& hand, const Pinch& pinch,
                      const std::string& separator) {
  return base::list_text(
      pinch.pads, [&](int pad) { return hand.pads[pad].name; }, separator);
}

std::string opening_text(const PinchChart& chart, std::size_t number_of_class) {
  const auto first = static_cast<double>(number_of_class);
  const auto millimeters = [&](double classes) {
    // Whole micrometers: steps such as 2.5 and 0.1 mm are told apart.
    std::string text = number(1e3 * classes * chart.step, 3);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  };
  return millimeters(first) + " to " + millimeters(first + 1.0);
}

std::string pinch_name(PinchKind kind) {
  switch (kind) {
    case PinchKind::Tips:
      return "fingertips";
    case PinchKind::TwoFingers:
      return "thumb and two fingers";
    case PinchKind::Palm:
      return "fingertip and palm";
    case PinchKind::Proximal:
      return "other pads";
  }
  return "";
}

std::string reach_chart_svg(const ReachScene& scene) {
  return chart_element(scene, "xmlns=\"http://www.w3.org/2000/svg\" ");
}

std::string reach_page_html(const ReachScene& scene) {
  const std::vector<PinchChart> charts = drawn_charts(scene);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\"><title>" +
      escaped_for_html(scene.hand.name) +
      ": reach</title>\n<style>\nbody { font: 14px/1.45 system-ui, \"Noto Sans\", \"DejaVu Sans\", "
      "sans-serif; color: #24282d; max-width: 800px; margin: 24px auto; padding: 0 16px; }\n"
      "h1 { font-size: 18px; } p { color: #667078; }\n"
      "table { border-collapse: collapse; margin: 16px 0; }\n"
      "th, td { padding: 2px 12px 2px 0; text-align: left; vertical-align: top; "
      "border-bottom: 1px solid #e2e4e3; }\nsvg { max-width: 100%; height: auto; }\n"
      "</style></head><body>\n<h1>What " +
      escaped_for_html(scene.hand.name) + " pinches squarely</h1>\n";
  html +=
      "<p>How much the pads must lean to the line between them, by the distance between their "
      "contact points: kinematics alone, no links in one another. An object with parallel faces "
      "is held where the lean is within the angle of friction.</p>\n";
  html += chart_element(scene, "");
  html += "<table>\n" + table_row({"pinch", "squarely, mm", "least lean", "at"}, "th");
  for (const PinchChart& chart : charts) {
    const Pinch& best = *hands::squarest(chart);
    html +=
        table_row({pinch_name(chart.kind), square_widths_text(chart, scene.friction),
                   number(best.lean / base::kRadiansPerDegree) + "\u00b0",
                   number(1e3 * best.opening, 0) + " mm, " + pads_text(scene.hand, best, ", ")});
  }
  html += "</table>\n<table>\n";
  std::vector<std::string> heading = {"opening, mm"};
  std::size_t num_rows = 0;
  for (const PinchChart& chart : charts) {
    heading.push_back(pinch_name(chart.kind));
    num_rows = std::max(num_rows, chart.pinches.size());
  }
  html += table_row(heading, "th");
  for (std::size_t k = 0; k < num_rows; ++k) {
    std::vector<std::string> cells = {opening_text(charts.front(), k)};
    for (const PinchChart& chart : charts) {
      const bool has_pinch = k < chart.pinches.size() && chart.pinches[k];
      cells.push_back(
          has_pinch ? number(chart.pinches[k]->lean / base::kRadiansPerDegree) + "\u00b0" : "");
    }
    html += table_row(cells);
  }
  return html + "</table>\n</body></html>\n";
}

void write_reach_chart(const std::filesystem::path& file, const ReachScene& scene) {
  base::write_file_atomically(file, reach_chart_svg(scene));
}

void write_reach_page(const std::filesystem::path& file, const ReachScene& scene) {
  base::write_file_atomically(file, reach_page_html(scene));
}

}  // namespace graspfit::viewer
