#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <system_error>

#include "cells/hold_cell.hpp"
#include "dataset/dataset_card.hpp"
#include "dataset/dataset_columns.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/exchange/grasp_arrays.hpp"
#include "graspfit/experiments/grasp_dataset.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/sweep/column_dictionary.hpp"
#include "graspfit/sweep/table_comparison.hpp"

namespace graspfit::experiments {
namespace dataset_files_parts {
namespace {

namespace fs = std::filesystem;
using namespace internal;

constexpr std::size_t kObjectsPerFile = 1000;

/// The rows of a CSV table, one after another: a table may be larger than memory.
class TableRows {
 public:
  explicit TableRows(const fs::path& file) : file_(file), stream_(file) {
    if (!std::getline(stream_, header_)) throw base::IoError(file.string() + ": cannot be read");
    const std::vector<std::string> columns =
        sweep::parse_csv(header_ + '\n', file.string()).columns;
    for (std::size_t i = 0; i < columns.size(); ++i) columns_[columns[i]] = i;
  }

  bool next() {
    std::string line;
    if (!std::getline(stream_, line)) return false;
    row_ = sweep::parse_csv(header_ + '\n' + line + '\n', file_.string()).rows.at(0);
    return true;
  }

  const std::string& at(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) throw base::IoError(file_.string() + ": has no column " + column);
    return row_[found->second];
  }

  std::int64_t count(const std::string& column) const {
    return static_cast<std::int64_t>(sweep::csv_number(at(column)).value_or(0.0));
  }

 private:
  fs::path file_;
  std::ifstream stream_;
  std::string header_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::string> row_;
};

exchange::HoldFinding finding_of(const TableRows& details) {
  exchange::HoldFinding finding;
  const std::string& stage = details.at(kStageColumn);
  if (!stage.empty()) finding.is_held = stage == kHeldStage;
  finding.margin_force = sweep::csv_number(details.at(kMarginColumns[0]));
  finding.margin_torque = sweep::csv_number(details.at(kMarginColumns[1]));
  return finding;
}

/// A reason without the file that it is about, such as "read_mesh: /x/a.off: ", so that alike ones
/// count together.
std::string kind_of(const std::string& reason) {
  const std::size_t path = reason.find('/');
  const std::size_t end = path == std::string::npos ? path : reason.find(": ", path);
  return end == std::string::npos ? reason : reason.substr(end + 2);
}

std::string array_file(const std::string& hand, std::size_t part) {
  std::array<char, 24> number{};
  std::snprintf(number.data(), number.size(), "_%04zu.npz", part + 1);
  return "arrays/" + hand + number.data();
}

const sweep::Axis& axis_named(const sweep::ParameterSweep& sweep, const std::string& name) {
  for (const sweep::Axis& axis : sweep.axes) {
    if (axis.name == name) return axis;
  }
  throw base::InvalidInput("dataset: its configuration has no axis " + name);
}

/// Goes through a data set's tables once: arrays are written on the way, the rest is counted.
class Reader {
 public:
  Reader(const fs::path& folder, const sweep::ExperimentConfig& config)
      : folder_(folder), rows_(folder / "dataset.csv"), details_(folder / "dataset.details.csv") {
    const auto& objects = axis_named(config.sweep, sweep::kObjectAxis).values;
    for (std::size_t i = 0; i < objects.size(); ++i) numbers_[objects[i].label] = i;
    for (const sweep::AxisValue& hand : axis_named(config.sweep, "hand").values) {
      hand_numbers_[hand.label] = counts_.hands.size();
      counts_.hands.emplace_back().name = hand.label;
    }
    counts_.objects = static_cast<std::int64_t>(objects.size());
    arrays_.resize(counts_.hands.size());
  }

  DatasetCounts read() {
    while (rows_.next()) {
      const std::size_t part = numbers_.at(rows_.at("object")) / kObjectsPerFile;
      if (part != part_) write_arrays();
      part_ = part;
      add_row();
    }
    write_arrays();
    return std::move(counts_);
  }

 private:
  void add_row() {
    const std::size_t number = hand_numbers_.at(rows_.at("hand"));
    HandCounts& hand = counts_.hands[number];
    ++hand.cells;
    if (rows_.at("status") != "ok") {
      ++hand.failed;
      ++counts_.reasons[kind_of(rows_.at("reason"))];
      return;
    }
    const std::int64_t num_grasps = rows_.count(kGraspsColumn);
    ++counts_.licenses[rows_.at(kLicenseColumn)];
    hand.attempts += rows_.count("attempts");
    hand.grasps += num_grasps;
    hand.held += rows_.count("held");
    if (num_grasps == 0) return;
    ++hand.with_grasps;
    std::vector<exchange::HoldFinding> findings;
    for (std::int64_t i = 0; i < num_grasps; ++i) {
      const bool is_own = details_.next() && details_.at("object") == rows_.at("object") &&
                          details_.at("hand") == rows_.at("hand");
      if (!is_own) {
        throw base::IoError((folder_ / "dataset.details.csv").string() +
                            ": has not the grasps of " + rows_.at("object") + " and " +
                            rows_.at("hand") + "; run or merge the data set again");
      }
      findings.push_back(finding_of(details_));
    }
    arrays_[number].add(rows_.at("object"), rows_.at(kLicenseColumn),
                        grasp::read_grasps(folder_ / rows_.at(kGraspFileColumn)), findings);
  }

  void write_arrays() {
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      if (arrays_[i].num_objects() == 0) continue;
      const std::string name = array_file(counts_.hands[i].name, part_);
      std::error_code error;
      fs::create_directories(folder_ / "arrays", error);
      if (error) throw base::IoError((folder_ / "arrays").string() + ": " + error.message());
      base::write_file_atomically(folder_ / name, arrays_[i].npz());
      counts_.arrays.push_back(name);
      arrays_[i] = {};
    }
  }

  fs::path folder_;
  TableRows rows_;
  TableRows details_;
  std::map<std::string, std::size_t> numbers_;
  std::map<std::string, std::size_t> hand_numbers_;
  std::vector<exchange::GraspArrays> arrays_;  ///< Per hand, of the objects of `part_`.
  std::size_t part_ = 0;
  DatasetCounts counts_;
};

}  // namespace
}  // namespace dataset_files_parts

DatasetFiles write_dataset_files(const std::filesystem::path& folder,
                                 const sweep::ExperimentConfig& config) {
  const internal::DatasetCounts counts = dataset_files_parts::Reader(folder, config).read();
  base::write_file_atomically(folder / "dataset.columns.json",
                              sweep::column_dictionary(dataset_experiment(), config));
  base::write_file_atomically(folder / "CARD.md", internal::dataset_card(config, counts));
  DatasetFiles files;
  files.arrays.assign(counts.arrays.begin(), counts.arrays.end());
  files.card = "CARD.md";
  return files;
}

}  // namespace graspfit::experiments
