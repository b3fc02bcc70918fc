#include "output/comparison_chart.hpp"

#include <algorithm>

#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

// In pixels, y downward.
constexpr double kWidth = 760;
constexpr double kHeight = 470;
constexpr double kPlotLeft = 70;
constexpr double kPlotRight = 740;
constexpr double kPlotTop = 110;
constexpr double kPlotBottom = 400;
constexpr double kBarWidth = 40;
constexpr std::array<const char*, 2> kSideColors = {"#3d6f9e", "#d88a3a"};
constexpr const char* kInk = "#24282d";
constexpr const char* kPale = "#5a636b";
constexpr std::size_t kMostLetters = 88;  // of a side's name; longer ones lose their beginning

std::string pixels(double value) { return fixed_decimal(value, 1); }

double height_of(double share) { return kPlotBottom - (kPlotBottom - kPlotTop) * share; }

/// A text with what means something to XML replaced, and what it does not allow left out.
std::string escaped_for_xml(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) escaped += c;
    }
  }
  return escaped;
}

/// The end of a long text, from a whole character on.
std::string shortened(const std::string& text) {
  if (text.size() <= kMostLetters) return text;
  std::size_t start = text.size() - kMostLetters;
  while (start < text.size() && (static_cast<unsigned char>(text[start]) & 0xc0U) == 0x80U) ++start;
  return "..." + text.substr(start);
}

std::string line_element(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + pixels(x1) + "\" y1=\"" + pixels(y1) + "\" x2=\"" + pixels(x2) +
         "\" y2=\"" + pixels(y2) + "\" " + style + "/>\n";
}

std::string text_element(double x, double y, const std::string& style, const std::string& words) {
  return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\" " + style + '>' +
         escaped_for_xml(words) + "</text>\n";
}

std::string in_color(const char* anchor, const char* color) {
  return std::string("text-anchor=\"") + anchor + "\" fill=\"" + color + '"';
}

/// The axis of shares with its lines and name.
std::string share_axis() {
  std::string svg;
  for (int percent = 0; percent <= 100; percent += 20) {
    const double y = height_of(0.01 * percent);
    svg += line_element(kPlotLeft, y, kPlotRight, y,
                        percent == 0 ? "stroke=\"#24282d\"" : "stroke=\"#dfe2e1\"");
    svg += text_element(kPlotLeft - 8, y + 5, in_color("end", kPale), std::to_string(percent));
  }
  return svg + "<text transform=\"translate(22 " + pixels((kPlotTop + kPlotBottom) / 2) +
         ") rotate(-90)\" " + in_color("middle", kInk) + ">share of grasps [%]</text>\n";
}

std::string bar(double x, const ComparedRate& rate, const char* color) {
  const double top = height_of(rate.share());
  std::string svg = "<rect x=\"" + pixels(x) + "\" y=\"" + pixels(top) + "\" width=\"" +
                    pixels(kBarWidth) + "\" height=\"" + pixels(kPlotBottom - top) + "\" fill=\"" +
                    color + "\"/>\n";
  const double middle = x + kBarWidth / 2;
  const double low = height_of(rate.interval().low);
  const double high = height_of(rate.interval().high);
  constexpr double kCap = 5;
  const std::string style = std::string("stroke=\"") + kInk + "\" stroke-width=\"1.5\"";
  svg += line_element(middle, low, middle, high, style);
  svg += line_element(middle - kCap, low, middle + kCap, low, style);
  svg += line_element(middle - kCap, high, middle + kCap, high, style);
  return svg + text_element(middle, kPlotBottom + 17, in_color("middle", kPale),
                            std::to_string(rate.num_hits) + '/' + std::to_string(rate.num_known));
}

}  // namespace

std::string comparison_chart_svg(const SetComparison& comparison) {
  const std::array<ComparedSet, 2> sides = {comparison.all(ComparedSide::A),
                                            comparison.all(ComparedSide::B)};
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                    fixed_decimal(kWidth, 0) + ' ' + fixed_decimal(kHeight, 0) + "\" width=\"" +
                    fixed_decimal(kWidth, 0) + "\" height=\"" + fixed_decimal(kHeight, 0) +
                    "\" font-family=\"system-ui, Noto Sans, DejaVu Sans, sans-serif\" "
                    "font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  const std::size_t num_objects = comparison.objects.size();
  svg += text_element(
      kPlotLeft, 28, in_color("start", kInk) + " font-size=\"17\" font-weight=\"600\"",
      "Grasps of A and B on " + (num_objects == 1 ? comparison.objects[0].name
                                                  : std::to_string(num_objects) + " objects"));
  for (std::size_t side = 0; side < sides.size(); ++side) {
    const double y = 52 + 20 * static_cast<double>(side);
    svg += "<rect x=\"" + pixels(kPlotLeft) + "\" y=\"" + pixels(y - 11) +
           "\" width=\"12\" height=\"12\" fill=\"" + kSideColors.at(side) + "\"/>\n";
    svg +=
        text_element(kPlotLeft + 18, y, in_color("start", kInk) + " font-size=\"13\"",
                     std::string(side == 0 ? "A: " : "B: ") + shortened(comparison.names.at(side)));
  }
  svg += share_axis();
  const double step = (kPlotRight - kPlotLeft) / static_cast<double>(kComparedRates.size());
  for (std::size_t i = 0; i < kComparedRates.size(); ++i) {
    const double middle = kPlotLeft + step * (static_cast<double>(i) + 0.5);
    for (std::size_t side = 0; side < sides.size(); ++side) {
      const double x = middle + (side == 0 ? -kBarWidth - 4 : 4.0);
      if (const auto rate = rate_of(sides.at(side), i)) svg += bar(x, *rate, kSideColors.at(side));
    }
    svg += text_element(middle, kPlotBottom + 37, in_color("middle", kInk),
                        std::string(kComparedRates[i]));
  }
  svg += text_element(
      (kPlotLeft + kPlotRight) / 2, kPlotBottom + 60,
      in_color("middle", kPale) + " font-size=\"13\"",
      "property; lines: 95 % intervals" +
          (comparison.protocol.empty() ? std::string() : "; held: under " + comparison.protocol));
  return svg + "</svg>\n";
}

}  // namespace graspfit::app
