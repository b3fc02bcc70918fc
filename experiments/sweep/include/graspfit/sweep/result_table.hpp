#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace graspfit::sweep {

/// A column of a table of results.
struct Column {
  std::string name;     ///< Ends in its unit where it has one: `largest_gap_m`.
  std::string unit;     ///< "m", "rad", "s", "1" for plain numbers and counts, "" for texts.
  std::string meaning;  ///< One sentence or less.
};

/// What stands in a field: nothing, yes or no, a count, a number, a text.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// A value as a CSV field: empty; true/false; shortest round-trip decimal; quoted where a text
/// needs it, with line breaks turned into blanks. Numbers that are not finite are empty: nothing is
/// known.
std::string csv_field(const Value& value);

/// Reads a field that is a number as a whole; empty for an empty field or a text.
std::optional<double> csv_number(const std::string& field);

/// Fields joined by commas, with a line break.
std::string csv_line(const std::vector<std::string>& fields);

/// The values of one row, set by the names of their columns.
class ResultRow {
 public:
  /// All values empty.
  explicit ResultRow(const std::vector<Column>& columns);

  /// @throws std::logic_error for a column that is not there: a mistake in the experiment.
  void set(std::string_view column, Value value);

  /// One per column, ready for `csv_line`.
  std::vector<std::string> csv_fields() const;

 private:
  std::vector<std::string> names_;
  std::vector<Value> values_;
};

}  // namespace graspfit::sweep
