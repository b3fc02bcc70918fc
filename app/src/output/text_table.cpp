#include "output/text_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace graspfit::app {

namespace {

/// Width of the longest field in each column.
std::vector<std::size_t> widths_of(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  return widths;
}

}  // namespace

std::string indented_table(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<std::size_t> widths = widths_of(rows);
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += "  " + row[i];
      if (i + 1 < row.size()) text += std::string(widths[i] - row[i].size(), ' ');
    }
    text += '\n';
  }
  return text;
}

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<std::size_t> widths = widths_of(rows);
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += "  ";
      text += std::string(widths[i] - row[i].size(), ' ') + row[i];
    }
    text += '\n';
  }
  return text;
}

std::string fixed_decimal(double value, int decimals) {
  // 309 digits before the point of the largest double, its sign, the point and the decimals.
  std::array<char, 400> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::fixed, std::min(decimals, 20));
  return {text.data(), end};
}

std::string significant_decimal(double value, int digits) {
  std::array<char, 40> text{};  // sign, digits, point, exponent
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::general, std::min(digits, 17));
  return {text.data(), end};
}

std::string vector_text(const Eigen::Vector3d& v, int decimals) {
  return '(' + fixed_decimal(v.x(), decimals) + ", " + fixed_decimal(v.y(), decimals) + ", " +
         fixed_decimal(v.z(), decimals) + ')';
}

}  // namespace graspfit::app
