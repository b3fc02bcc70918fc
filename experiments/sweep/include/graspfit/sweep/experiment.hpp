#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/sweep/parameter_sweep.hpp"
#include "graspfit/sweep/result_table.hpp"

namespace graspfit::sweep {

/// A setting of a cell cannot be used. The reader of the configuration adds where it was written.
class SettingError : public base::InvalidInput {
 public:
  /// `key` is the setting's name, or empty where none is to blame; `what` says value and what is
  /// allowed.
  SettingError(std::string key, const std::string& what)
      : base::InvalidInput(what), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// A file that is not part of the repository is not on this machine: the cell is skipped, not
/// failed, and tried again by the next run.
class MissingData : public base::IoError {
 public:
  using base::IoError::IoError;
};

/// The results of a cell.
struct CellResult {
  ResultRow row;                        ///< Of `Experiment::columns`.
  ResultRow timings;                    ///< Of `Experiment::timings`.
  std::vector<ResultRow> details = {};  ///< Of `Experiment::details`.
};

/// What a table over all cells is made of: a finished cell's labels, details and row as CSV fields.
struct FinishedCell {
  std::vector<std::string> labels;  ///< One per axis.
  std::vector<std::vector<std::string>> details;
  std::vector<std::string> row = {};  ///< One field per column of the experiment.
};

/// A table over all cells.
struct SummaryTable {
  std::string name;  ///< Name of the table in its file's name, `<slug>.<name>.csv`.
  std::vector<Column> columns;
  /// Makes the rows of the table from the cells that are ok, in sweep order. They depend on nothing
  /// else.
  std::function<std::vector<ResultRow>(const ParameterSweep&, const std::vector<FinishedCell>&)>
      rows;
};

/// An experiment: a question, the unit of work that answers a part of it, and the columns in which
/// the answer is written. Its axes and fixed settings are in `configs/<slug>.json`.
struct Experiment {
  std::string slug;  ///< Letters, digits and _; the same in every file name.
  std::vector<Column>
      columns;  ///< Results: the same bytes for every run of a build on a processor.
  std::vector<Column> timings = {};          ///< What may differ from run to run.
  std::vector<Column> settings = {};         ///< Settings beside the shared ones.
  std::vector<Column> shared_settings = {};  ///< Settings that it shares with other experiments.
  std::vector<Column> details = {};  ///< Columns of the rows that a cell's row sums up, any number
                                     ///< per cell (one per grasp); if empty, there is no such
                                     ///< table.

  /// Checks a cell's settings without doing its work. @throws SettingError.
  std::function<void(const Cell&)> check;

  /// Does a cell's work, on one thread; several may run at once. It may write files beside its row
  /// into `folder`, which exists only from its first file on (`cell_folder`).
  /// @throws MissingData, which skips the cell, or anything else, which fails it; the reason is in
  /// its row in either case.
  std::function<CellResult(const Cell&, const std::filesystem::path& folder)> run;

  std::vector<SummaryTable> summaries = {};  ///< Tables over all cells, made of their details.

  /// The files that a cell reads, for the manifest; those that are not there are left out.
  std::function<std::vector<std::filesystem::path>(const Cell&)> inputs;
};

}  // namespace graspfit::sweep
