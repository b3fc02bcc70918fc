#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace graspfit::app {

/// Rows of cells as lines of text: columns as wide as their widest cell, aligned to the right, two
/// spaces apart.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// Rows of cells as lines of text with columns aligned to the left, two blanks before each: for
/// tables of words.
std::string indented_table(const std::vector<std::vector<std::string>>& rows);

/// `value` with `decimals` digits after the point, in the C locale. Not for files.
std::string fixed_decimal(double value, int decimals);

/// `value` with at most `digits` significant digits, in the C locale. Not for files.
std::string significant_decimal(double value, int digits);

/// (x, y, z), each as `fixed_decimal` writes it.
std::string vector_text(const Eigen::Vector3d& v, int decimals);

}  // namespace graspfit::app
