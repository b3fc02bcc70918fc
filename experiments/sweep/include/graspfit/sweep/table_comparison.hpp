#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/sweep/experiment.hpp"

namespace graspfit::sweep {

/// A CSV table as texts.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< As many fields as columns.
};

/// Reads what `csv_line` writes. `name` is for messages. @throws InvalidInput, naming the line.
CsvTable parse_csv(const std::string& text, const std::string& name);

/// How near numbers of two machines must be to count as equal.
struct ComparisonOptions {
  double relative = 1e-9;   ///< Largest difference over the larger magnitude, ≥ 0.
  double absolute = 1e-12;  ///< Numbers up to this magnitude are zeros but for rounding, ≥ 0.
  void validate() const;    ///< Throws InvalidInput naming the field and its value.
};

/// A field of two tables that differs.
struct FieldDifference {
  std::string row;  ///< "object=bunny hand=barrett".
  std::string column;
  std::string ours;
  std::string theirs;
};

/// What a comparison found.
struct TableComparison {
  std::size_t num_rows = 0;       ///< Number of rows compared.
  std::size_t num_not_ours = 0;   ///< Rows of theirs that we do not have.
  bool are_same_bytes = true;     ///< Whether all compared fields are the same texts and no
                                  ///< row is missing.
  double largest_relative = 0.0;  ///< Largest relative difference of numbers that are near enough.
  std::vector<FieldDifference> differences;  ///< In the order of our rows.
  /// Names of rows of theirs that we should have, found by `compare_with_published`.
  std::vector<std::string> missing_rows = {};

  bool is_equal() const { return differences.empty() && missing_rows.empty(); }
};

/// Compares our rows with those of the same labels in their table. The first `num_labels` columns
/// are labels; rows with the same labels are told apart by their order.
///
/// Fields are equal if their texts are equal, if both are numbers (not both integers) that are near
/// enough, or if both are zeros, whatever their signs. So counts and seeds are compared exactly.
/// @throws InvalidInput, naming it, if a column is missing or we have a row that they do not have.
TableComparison compare_tables(const CsvTable& ours, const CsvTable& theirs, std::size_t num_labels,
                               const ComparisonOptions& options = {});

/// A table of a run beside the published one.
struct PublishedComparison {
  std::string file;
  TableComparison comparison;
};

/// Compares the results of a finished run with published ones, perhaps of another machine: rows of
/// cells, details, and, if the run is of the whole sweep, its summary. Timings are not compared.
/// The run may lack published cells. Rows of the details of its own cells that it lacks and, if it
/// has all cells, rows of the summary are reported as `missing_rows`.
/// @throws IoError if a file is missing; InvalidInput as `compare_tables`, if the run's table has
/// not a row for each of its cells, and as `require_tables_of_manifest` for both folders.
std::vector<PublishedComparison> compare_with_published(const Experiment& experiment,
                                                        const std::filesystem::path& folder,
                                                        const std::filesystem::path& published,
                                                        const ComparisonOptions& options = {});

/// Says in what the run in `folder` and the published one differ besides their results, by their
/// manifests: the base seed, the settings of all cells and of axis values that both have, and the
/// code. The text is one line for people; it is empty if nothing differs or one of them has no
/// manifest.
///
///     published with other settings: max-attempts 200, here 5; by other code: commit a7a0195,
///     here 44d19b0
///
/// @throws InvalidInput if a manifest is damaged.
std::string published_otherwise(const Experiment& experiment, const std::filesystem::path& folder,
                                const std::filesystem::path& published);

}  // namespace graspfit::sweep
