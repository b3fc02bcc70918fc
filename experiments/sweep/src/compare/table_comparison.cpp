#include "graspfit/sweep/table_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/sweep/run_manifest.hpp"

namespace graspfit::sweep {
namespace {

[[noreturn]] void fail(const std::string& what) { throw base::InvalidInput(what); }

bool is_integer(const std::string& text) {
  return text.find_first_not_of("-0123456789") == std::string::npos;
}

/// One line's fields; `at` moves behind its line break.
std::vector<std::string> read_line(const std::string& text, std::size_t& at) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') {
      const bool is_literal = is_quoted && at + 1 < text.size() && text[at + 1] == '"';
      if (is_literal) fields.back() += text[++at];
      if (!is_literal) is_quoted = !is_quoted;
    } else if (is_quoted || (c != ',' && c != '\n')) {
      fields.back() += c;
    } else if (c == ',') {
      fields.emplace_back();
    } else {
      ++at;
      break;
    }
  }
  return fields;
}

/// "object=bunny hand=barrett" of every row; repeated labels get " row 2", " row 3", ..., rows
/// without labels "row 1", "row 2", ...
std::vector<std::string> row_names(const CsvTable& table, std::size_t num_labels) {
  std::vector<std::string> names;
  std::map<std::string, int> count;
  for (const std::vector<std::string>& row : table.rows) {
    std::string name;
    for (std::size_t i = 0; i < num_labels; ++i) {
      name += (i > 0 ? " " : "") + table.columns[i] + '=' + row[i];
    }
    const int repeat = ++count[name];
    if (repeat > 1 || name.empty())
      name += (name.empty() ? "row " : " row ") + std::to_string(repeat);
    names.push_back(name);
  }
  return names;
}

/// What a comparison needs of a run's manifest.
struct RunFacts {
  std::size_t num_axes = 0;   ///< Number of axes: so many first columns of its tables are labels.
  std::size_t num_cells = 0;  ///< Rows of its table of cells.
};

RunFacts run_facts(const std::filesystem::path& manifest) {
  const auto json = nlohmann::json::parse(base::read_json_file(manifest), nullptr, false);
  const nlohmann::json::json_pointer axes("/config/as_run/axes");
  const nlohmann::json::json_pointer cells("/cells/total");
  if (!json.is_object() || !json.contains(axes) || !json.at(axes).is_array() ||
      !json.contains(cells) || !json.at(cells).is_number_unsigned()) {
    fail(manifest.string() + ": is damaged");
  }
  return {json.at(axes).size(), json.at(cells).get<std::size_t>()};
}

/// Notes the rows of their table that ours lacks although the run has their cell. `cells` are the
/// labels of the run's cells, which are the first fields of a row; without `cells` all rows are
/// expected.
void note_missing_rows(const CsvTable& ours, const CsvTable& theirs, std::size_t num_labels,
                       const std::optional<std::set<std::vector<std::string>>>& cells,
                       TableComparison& result) {
  const std::vector<std::string> our_names = row_names(ours, num_labels);
  const std::set<std::string> known(our_names.begin(), our_names.end());
  const std::vector<std::string> names = row_names(theirs, num_labels);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (known.count(names[i]) > 0) continue;
    const auto labels_end = theirs.rows[i].begin() + num_labels;
    if (cells && cells->count({theirs.rows[i].begin(), labels_end}) == 0) continue;
    result.missing_rows.push_back(names[i]);
    result.are_same_bytes = false;
  }
}

class Comparer {
 public:
  Comparer(const ComparisonOptions& options, TableComparison& result)
      : options_(options), result_(result) {}

  void compare(const std::string& row, const std::string& column, const std::string& ours,
               const std::string& theirs) {
    if (ours == theirs) return;
    result_.are_same_bytes = false;
    if (!are_near(ours, theirs)) result_.differences.push_back({row, column, ours, theirs});
  }

 private:
  bool are_near(const std::string& ours, const std::string& theirs) {
    const std::optional<double> a = csv_number(ours);
    const std::optional<double> b = csv_number(theirs);
    if (!a || !b) return false;
    if (*a == 0.0 && *b == 0.0) return true;  // "-0" and "0", which look like integers
    if (is_integer(ours) && is_integer(theirs)) return false;
    const double magnitude = std::max(std::abs(*a), std::abs(*b));
    if (magnitude <= options_.absolute) return true;
    const double relative = std::abs(*a - *b) / magnitude;
    if (!(relative <= options_.relative)) return false;
    result_.largest_relative = std::max(result_.largest_relative, relative);
    return true;
  }

  const ComparisonOptions& options_;
  TableComparison& result_;
};

}  // namespace

CsvTable parse_csv(const std::string& text, const std::string& name) {
  CsvTable table;
  std::size_t at = 0;
  if (text.empty()) fail(name + ": is empty");
  table.columns = read_line(text, at);
  while (at < text.size()) {
    table.rows.push_back(read_line(text, at));
    if (table.rows.back().size() == table.columns.size()) continue;
    fail(name + ": line " + std::to_string(table.rows.size() + 1) + " has " +
         std::to_string(table.rows.back().size()) + " fields instead of " +
         std::to_string(table.columns.size()));
  }
  return table;
}

void ComparisonOptions::validate() const {
  const auto require_not_negative = [](const char* name, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    fail(std::string("ComparisonOptions: ") + name + " = " + std::to_string(value) +
         ", must be >= 0");
  };
  require_not_negative("relative", relative);
  require_not_negative("absolute", absolute);
}

TableComparison compare_tables(const CsvTable& ours, const CsvTable& theirs, std::size_t num_labels,
                               const ComparisonOptions& options) {
  options.validate();
  if (ours.columns != theirs.columns) {
    for (const auto& [some, others, whose] :
         {std::tuple(&ours, &theirs, "published"), std::tuple(&theirs, &ours, "run's")}) {
      for (const std::string& column : some->columns) {
        const auto& there = others->columns;
        if (std::find(there.begin(), there.end(), column) != there.end()) continue;
        fail(std::string("column ") + column + " is not in the " + whose + " table");
      }
    }
    fail("the tables have the same columns in different orders");
  }
  const std::vector<std::string> names = row_names(theirs, num_labels);
  std::map<std::string, std::size_t> row_of;
  for (std::size_t i = 0; i < names.size(); ++i) row_of[names[i]] = i;

  TableComparison result;
  Comparer comparer(options, result);
  const std::vector<std::string> our_names = row_names(ours, num_labels);
  for (std::size_t i = 0; i < our_names.size(); ++i) {
    const auto found = row_of.find(our_names[i]);
    if (found == row_of.end()) fail("row " + our_names[i] + " is not in the published table");
    for (std::size_t k = 0; k < ours.columns.size(); ++k) {
      comparer.compare(our_names[i], ours.columns[k], ours.rows[i][k],
                       theirs.rows[found->second][k]);
    }
    ++result.num_rows;
  }
  result.num_not_ours = theirs.rows.size() - result.num_rows;
  return result;
}

std::vector<PublishedComparison> compare_with_published(const Experiment& experiment,
                                                        const std::filesystem::path& folder,
                                                        const std::filesystem::path& published,
                                                        const ComparisonOptions& options) {
  const std::string manifest = experiment.slug + ".manifest.json";
  const RunFacts facts = run_facts(folder / manifest);
  require_tables_of_manifest(folder / manifest);
  if (std::filesystem::exists(published / manifest)) {
    require_tables_of_manifest(published / manifest);
  }
  const auto read = [](const std::filesystem::path& file) {
    return parse_csv(base::read_file(file), file.string());
  };
  std::vector<PublishedComparison> tables;
  const auto compare = [&](const std::string& ending, std::size_t num_labels,
                           const std::optional<std::set<std::vector<std::string>>>& cells) {
    const std::string file = experiment.slug + ending;
    const CsvTable ours = read(folder / file);
    const CsvTable theirs = read(published / file);
    tables.push_back({file, compare_tables(ours, theirs, num_labels, options)});
    note_missing_rows(ours, theirs, num_labels, cells, tables.back().comparison);
  };

  const std::filesystem::path table_of_cells = folder / (experiment.slug + ".csv");
  const CsvTable run = read(table_of_cells);
  if (run.rows.size() != facts.num_cells) {
    fail(table_of_cells.string() + ": has " + std::to_string(run.rows.size()) + " rows for " +
         std::to_string(facts.num_cells) + " cells; run the experiment again");
  }
  std::set<std::vector<std::string>> cells;
  for (const std::vector<std::string>& row : run.rows) {
    cells.emplace(row.begin(), row.begin() + facts.num_axes);
  }
  compare(".csv", facts.num_axes, cells);
  const bool is_whole = tables.front().comparison.num_not_ours == 0;
  if (!experiment.details.empty()) compare(".details.csv", facts.num_axes, cells);
  if (is_whole) {
    for (const SummaryTable& summary : experiment.summaries) {
      compare('.' + summary.name + ".csv", 0, std::nullopt);
    }
  }
  return tables;
}

}  // namespace graspfit::sweep
