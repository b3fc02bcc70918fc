#include "graspfit/sweep/result_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "graspfit/base/number_text.hpp"

namespace graspfit::sweep {
namespace {

std::string text_field(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

struct FieldText {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const {
    return std::isfinite(value) ? base::shortest_decimal(value) : "";
  }
  std::string operator()(const std::string& value) const { return text_field(value); }
};

}  // namespace

std::string csv_field(const Value& value) { return std::visit(FieldText(), value); }

std::optional<double> csv_number(const std::string& field) {
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [last, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || last != end) return std::nullopt;
  return value;
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += (&field == &fields.front() ? "" : ",") + field;
  return line + '\n';
}

ResultRow::ResultRow(const std::vector<Column>& columns) : values_(columns.size()) {
  for (const Column& column : columns) names_.push_back(column.name);
}

void ResultRow::set(std::string_view column, Value value) {
  const auto found = std::find(names_.begin(), names_.end(), column);
  if (found == names_.end()) {
    throw std::logic_error("ResultRow: no column " + std::string(column));
  }
  values_[found - names_.begin()] = std::move(value);
}

std::vector<std::string> ResultRow::csv_fields() const {
  std::vector<std::string> fields;
  for (const Value& value : values_) fields.push_back(csv_field(value));
  return fields;
}

}  // namespace graspfit::sweep
